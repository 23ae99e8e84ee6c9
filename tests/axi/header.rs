//! A driver in C compiles with the generated header, and drives the Verilated shell with it.

use std::fs;
use std::path::Path;
use std::process::Command;

use contact_afu::afu::{Afu, Spec};

use crate::bench::{config, model};

#[test]
fn a_driver_in_c_drives_the_shell() {
    let (root, room) = (Path::new(env!("CARGO_MANIFEST_DIR")), tempfile::tempdir().unwrap());
    let config = config(1, 512);
    let files = Afu::generate(Spec::from(config.clone())).unwrap().files();
    let (_, header) = files.iter().find(|(name, _)| name == "contact_afu_regs.h").unwrap();
    let model = model(&config);
    let library = model.shared_object().unwrap();
    let run = |header: &str| {
        fs::write(room.path().join("contact_afu_regs.h"), header).unwrap();
        let program = room.path().join("driver");
        let compiled = Command::new("cc")
            .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-D_DEFAULT_SOURCE", "-I"])
            .args([room.path(), Path::new("-I"), &root.join("tb"), Path::new("-o"), &program])
            .args([&root.join("tests/axi/driver.c"), Path::new("-ldl")])
            .output()
            .unwrap();
        assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
        let ran = Command::new(&program).arg(library).output().unwrap();
        String::from_utf8_lossy(&[ran.stdout, ran.stderr].concat()).into_owned()
    };
    assert_eq!(run(header), "done\n");
    // The driver notices a header of another map.
    let moved = header.replace("CONTACT_AFU_SCRATCH 0xa4u", "CONTACT_AFU_SCRATCH 0xa8u");
    assert_ne!(moved, *header);
    assert_eq!(run(&moved), "the scratch register does not keep its value\n");
}
