//! Proofs of the controller: Yosys and Yices check the properties of `tb/formal` for the accelerator that `design`
//! generates. Each mutant of it breaks one property.
//!
//! The test command runs only some of the proofs. `scripts/prove` runs all; `docs/verification.md` says what is proven
//! and what is not.

mod design;
mod mutants;
mod proofs;
mod public;
mod search;
#[path = "../support/side_by_side.rs"]
mod side_by_side;
mod tools;

use std::sync::Mutex;
use std::time::Instant;

use mutants::Mutant;
use proofs::{Proof, proofs};
use side_by_side::side_by_side;
use tools::Verdict;

/// An error text if the proof does not hold.
fn fails(proof: &Proof) -> Option<String> {
    let began = Instant::now();
    let verdict = tools::check(proof, None, &proof.files());
    println!("{:<40} {verdict:?}, {:.0} s", proof.to_string(), began.elapsed().as_secs_f64());
    (verdict != Verdict::Proven).then(|| format!("{proof}: {verdict:?}"))
}

/// An error text if the mutant does not break its property.
fn stands(mutant: &Mutant) -> Option<String> {
    let proof = mutant.proof();
    let began = Instant::now();
    let verdict = tools::check(&proof, Some(mutant.breaks), &mutant.files());
    println!("{:<40} {verdict:?}, {:.0} s", format!("mutant: {}", mutant.what), began.elapsed().as_secs_f64());
    let wanted = Verdict::Falsified(vec![mutant.breaks.to_owned()]);
    (verdict != wanted).then(|| format!("`{}` must break {} of {proof}: {verdict:?}", mutant.what, mutant.breaks))
}

fn none(errors: Vec<String>) {
    assert!(errors.is_empty(), "{errors:#?}");
}

/// The errors that `check` finds in the items, on as many threads as there are cores.
fn errors_of<T: Sync>(items: &[T], check: impl Fn(&T) -> Option<String> + Sync) -> Vec<String> {
    let errors = Mutex::new(Vec::new());
    side_by_side(items, |item| {
        let error = check(item);
        errors.lock().expect("no push panics").extend(error);
    });
    errors.into_inner().expect("no push panics")
}

/// True if the long command runs this proof: `PROOFS` is not set or is part of the proof's line, as in "SCPU 3".
fn is_chosen(proof: &Proof) -> bool {
    std::env::var("PROOFS").map_or(true, |part| proof.to_string().contains(&part))
}

#[test]
fn a_share_of_the_proofs_holds() {
    // The long ones are the last of the list, and begin first.
    let chosen: Vec<Proof> = proofs().into_iter().filter(|proof| proof.is_short).rev().collect();
    none(errors_of(&chosen, fails));
}

#[test]
fn a_share_of_the_mutants_falls() {
    none(mutants::all().iter().filter(|mutant| mutant.is_short).filter_map(stands).collect());
}

/// Each mutant's original text occurs exactly once in its file, even if the mutant is not run here.
#[test]
fn every_mutant_is_one_change() {
    for mutant in mutants::all() {
        mutant.files();
    }
}

/// Every property can fail: some mutant breaks it.
#[test]
fn every_property_has_a_mutant() {
    let mutants = mutants::all();
    for (harness, property) in proofs::properties() {
        let breaks = |mutant: &&Mutant| mutant.proof().harness == harness && mutant.breaks == property;
        assert!(mutants.iter().any(|mutant| breaks(&mutant)), "no mutant breaks {property} of {harness}");
    }
}

#[test]
#[ignore = "minutes: scripts/prove"]
fn every_proof_holds() {
    let chosen: Vec<Proof> = proofs().into_iter().filter(is_chosen).collect();
    none(errors_of(&chosen, fails));
}

#[test]
#[ignore = "minutes: scripts/prove"]
fn every_mutant_falls() {
    let chosen: Vec<Mutant> = mutants::all().into_iter().filter(|mutant| is_chosen(&mutant.proof())).collect();
    none(errors_of(&chosen, stands));
}
