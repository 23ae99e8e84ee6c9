//! The AXI4-Lite slave of the shell `axi` under a property set that others wrote and the user gives: the file
//! `faxil_slave.v` of ZipCPU's wb2axip.

use std::fs;
use std::path::PathBuf;

use crate::design::Design;
use crate::mutants::{self, Mutant};
use crate::proofs::{Method, Proof};
use crate::tools::{self, Verdict};

/// The variable with the path of the file; `./scripts/prove --axi-lite FILE` sets it.
const VARIABLE: &str = "AXI_LITE_PROPERTIES";
/// Cycles in which every delay that the set allows has passed.
const CYCLES: u32 = 14;

/// The user's file.
fn properties() -> (String, String) {
    let path = std::env::var_os(VARIABLE).map(PathBuf::from);
    let path = path.unwrap_or_else(|| panic!("{VARIABLE} is not set: run ./scripts/prove --axi-lite faxil_slave.v"));
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(text.contains("module faxil_slave"), "{}: expected the module faxil_slave of wb2axip", path.display());
    ("faxil_slave.v".to_owned(), text)
}

fn check(method: Method, defines: &'static [&'static str], mut files: Vec<(String, String)>) -> Verdict {
    files.push(properties());
    let proof = Proof::new("the public set", "axi_lite_public", 1, method).with(defines);
    tools::check(&Proof { design: Design::Axi, ..proof }, None, &files)
}

/// Proven by induction, and an access of each kind ends. Each fault of the slave breaks the set itself.
#[test]
#[ignore = "needs a file: scripts/prove --axi-lite"]
fn the_public_property_set_holds() {
    let files = || Design::Axi.files(1);
    assert_eq!(check(Method::Inductive(CYCLES), &[], files()), Verdict::Proven);
    assert_eq!(check(Method::Reached(CYCLES), &[], files()), Verdict::Proven);
    for mutant in mutants::all().iter().filter(|mutant| mutant.tried_in == "axi_lite") {
        let Mutant { what, .. } = mutant;
        let verdict = check(Method::Bounded(CYCLES), &["ONLY_PUBLIC"], mutant.files());
        println!("mutant: {what}: {verdict:?}");
        assert!(matches!(verdict, Verdict::Falsified(_)), "{what}");
    }
}
