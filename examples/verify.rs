//! What a test in another crate looks like: builds an AFU, runs pairs of its own, asserts.

use contact_afu::{Bench, Config, LinkModel, PairRecord};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let config = Config { scpus: 3, profile: "paper".parse()?, ..Config::default() };
    let bench = Bench::new(&config)?; // Verilog, Verilator, C++ compiler: or from the cache

    // A row of touching spheres, each x, y, z, radius, and its neighbour.
    let sphere = |i: u16| [f32::from(i), 0.0, 0.0, 0.5];
    let pairs: Vec<_> = (0..1000).map(|i| PairRecord::from_spheres(sphere(i), sphere(i + 1))).collect();

    // Over a link that answers late, out of order and with stalls; 7 is its seed.
    let verdict = bench.run(&pairs, &LinkModel::hostile(), 7)?;
    verdict.assert_good(); // every bit is the reference kernel's, and status and counters are right
    assert!(verdict.contacts.iter().all(|contact| contact.is_contact() && contact.depth() == 0.0));
    assert_eq!(verdict.contacts[4].position(), [4.5, 0.0, 0.0]);
    println!("{} contacts in {} cycles", verdict.contacts.len(), verdict.outcome.cycles);
    Ok(())
}
