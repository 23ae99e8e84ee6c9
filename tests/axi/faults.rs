//! Faults planted in the shell's Verilog are found.

use contact_afu::afu::shell::axi::map;
use contact_afu::cosim::{File, Instance};
use contact_afu::host::HostError;
use contact_afu::link::axi::Handshake;

use crate::bench::{Case, build, config, files, machine, run, session};

/// File, left-hand side of an assignment, the expression assigned instead, the words of the error that must come.
const FAULTS: [(&str, &str, &str, &str); 8] = [
    ("axi_read.v", " coming_follows = ", "rd_address == next_line", "it crosses 4 KB"),
    ("axi_read.v", " arvalid <= ", "burst_closes", "channel AR changed"),
    ("axi_write.v", " awvalid <= ", "burst_closes", "channel AW changed"),
    ("axi_write.v", " wvalid <= ", "beat_leaves", "channel W changed"),
    ("axi_write.v", " wlast <= ", "beat_number", "WLAST"),
    ("axi_write.v", "awlen <= ", "8'd1", "WLAST"),
    ("axi_write.v", " acknowledges <= ", "response_turns", "did not finish"),
    ("axi_control.v", " write_answered <= ", "register_written", "channel B changed"),
];

/// The Verilog with all faults. The number of a fault, from 1, in the scratch register chooses it.
fn spoilt() -> Vec<File> {
    let mut files = files(&config(2, 256));
    for (number, (name, left, wrong, _)) in (1..).zip(FAULTS) {
        let file = files.iter_mut().find(|file| file.name == name).unwrap();
        let chosen = format!("contact_afu_axi.control.scratch == 32'd{number}");
        let mut parts = file.text.split(left);
        let mut text = parts.next().unwrap_or_default().to_owned();
        let mut found = 0;
        for part in parts {
            let (right, after) = part.split_once(';').unwrap();
            // The reset value stays.
            let is_reset = right.chars().all(|c| c == '\'' || c.is_ascii_alphanumeric());
            found += u32::from(!is_reset);
            let right = if is_reset { right.to_owned() } else { format!("({chosen}) ? ({wrong}) : ({right})") };
            text += &format!("{left}{right};{after}");
        }
        assert_eq!(found, 1, "{name}: one `{left}`");
        file.text = text;
    }
    files
}

/// What comes of a job with this fault, over buffers at the end of 4 KB.
fn outcome(afu: &Instance, fault: u32) -> String {
    let (config, case) = (config(2, 256), Case::random(301, 3));
    let mut machine = machine(afu, "hostile", Handshake::Free, 3);
    if let Err(error) = machine.write_register(map::SCRATCH.offset, fault) {
        return error.to_string();
    }
    let mut session = session(machine, &config, case.workspace(3, 5));
    session.max_cycles = Some(40_000);
    match run(&mut session, &case) {
        Err(error @ (HostError::Transport(_) | HostError::NoStatus { .. })) => error.to_string(),
        Err(other) => panic!("{other}"),
        Ok(outcome) => if case.is_right(&outcome) { "right" } else { "wrong" }.to_owned(),
    }
}

#[test]
fn faults_of_the_shell_are_found() {
    let model = build(spoilt(), 2);
    for (fault, expected) in (0..).zip(["right"].into_iter().chain(FAULTS.map(|(.., expected)| expected))) {
        // After a fault, only a new machine has none.
        let afu = model.instance(1).unwrap();
        let found = outcome(&afu, fault);
        assert!(found.contains(expected), "fault {fault}: expected `{expected}`, found `{found}`");
    }
}
