//! The values of ports that are not valid have no effect. Addresses may be anywhere in their range.

use contact_afu::afu::ADDRESS_BITS;
use contact_afu::cosim::Job;
use contact_afu::link::LinkModel;

use crate::bench::{Case, committed, driver, of};

/// Pseudo-random bits, the same in each run.
fn junk(state: &mut u64) -> u64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state
}

#[test]
fn responses_that_are_not_valid_and_starts_while_busy_are_not_looked_at() {
    let case = Case::random(&of(3), 201, 31);
    let model = committed(3);
    for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
        let afu = model.instance(seed).unwrap();
        let mut driver = driver(&afu, link, seed);
        let widths = [("rd_rsp_tag", 10), ("rd_rsp_error", 1), ("wr_rsp_tag", 10), ("wr_rsp_error", 1)];
        let job_widths = [("start", 1), ("source", 58), ("destination", 58), ("count", 32), ("mode", 4), ("epoch", 4)];
        let ports = widths.map(|(name, bits)| (afu.input(name, bits).unwrap(), bits));
        let job_ports = job_widths.map(|(name, bits)| (afu.input(name, bits).unwrap(), bits));
        let data = afu.input("rd_rsp_data", 512).unwrap();
        let busy = afu.output("busy", 1).unwrap();
        let mut state = 0x9E37_79B9_7F4A_7C15 + seed;
        for _ in 0..3 {
            driver.start(&case.job()).unwrap();
            let outcome = loop {
                // For a valid response the driver overwrites all of this before the clock edge.
                data.set_words(&[(); 16].map(|()| junk(&mut state) as u32));
                for (port, bits) in ports {
                    port.set(junk(&mut state) >> (64 - bits));
                }
                for (port, bits) in job_ports {
                    port.set(if busy.is_high() { junk(&mut state) >> (64 - bits) } else { 0 });
                }
                if driver.step().unwrap() {
                    break driver.finish().unwrap();
                }
            };
            case.check(&outcome, link);
        }
    }
}

#[test]
fn source_and_destination_anywhere() {
    let case = Case::random(&of(3), 131, 32);
    let lines = case.lines.len() as u64;
    let afu = committed(3).instance(1).unwrap();
    let mut driver = driver(&afu, "shuffled", 1);
    let (first, last, carry) = (0, (1 << ADDRESS_BITS) - lines, (1 << 32) - lines / 2);
    for (source_address, destination_address) in
        [(first, last), (last, first), (first, lines), (carry, carry + lines), (carry + lines, carry)]
    {
        let outcome = driver.run(&Job { source_address, destination_address, ..case.job() }).unwrap();
        case.check(&outcome, &format!("from {source_address:#x} to {destination_address:#x}"));
    }
}
