//! Building, loading and stepping Verilated models.
#![cfg(feature = "cosim")]

use std::path::Path;

use contact_afu::cosim::{Model, Source, Trace};

fn echo() -> Source {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/echo");
    Source::from_folder(&folder, "contact_afu").unwrap()
}

#[test]
fn ports_are_found_and_carry_values() {
    let model = Model::build(&echo().parameter("SCPUS", 7), Trace::Off).unwrap();
    let afu = model.instance(1).unwrap();
    let (clk, rst) = (afu.clock("clk").unwrap(), afu.input("rst", 1).unwrap());
    let capability = afu.output("capability", 64).unwrap();
    rst.set(1);
    clk.tick(2).unwrap();
    rst.set(0);
    clk.tick(1).unwrap();
    assert_eq!(capability.get() & 0xff, 7);
    assert_eq!(afu.wide_output::<16>("wr_req_data").unwrap().get().len(), 16);
    assert!(!afu.output("done", 1).unwrap().is_high());
    assert!(afu.input("rd_rsp_tag", 9).is_err(), "the width is checked");
    assert!(afu.output("rd_rsp_tag", 10).is_err(), "the direction is checked");
}

#[test]
fn a_generated_afu_and_its_source_have_one_hash() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("rtl");
    let source = Source::from_folder(&folder, "contact_afu").unwrap();
    let manifest = std::fs::read_to_string(folder.join("manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    assert_eq!(manifest["rtl_sha256"], source.sha256());
    if let Some(model) = Model::built_in() {
        assert_eq!(model.rtl_sha256(), source.sha256());
    }
}
