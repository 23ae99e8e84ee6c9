//! Waveforms: a job's VCD and FST contain the AFU's ports, and the VCD contains their changes.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use contact_afu::cosim::{Instance, Model, Trace};

use crate::bench::{Case, config, driver, source};

struct Traced {
    ports: Vec<(String, u32)>,
    cycles: u64,
}

const HALF_PERIOD_PS: u64 = 2_500;

/// Runs a short job with a waveform to `path`.
fn trace(kind: Trace, path: &Path) -> Traced {
    let config = config(2, "e5f2z", "hit");
    let case = Case::random(&config, 9, 1);
    let model = Model::build(&source(&config), kind).unwrap();
    assert_eq!(model.trace(), kind);
    let afu: Instance = model.instance(1).unwrap();
    afu.trace_open(path, HALF_PERIOD_PS).unwrap();
    let cycles = {
        let mut driver = driver(&afu, "ideal", 1);
        let outcome = driver.run(&case.job()).unwrap();
        case.check(&outcome, "traced");
        driver.cycle()
    };
    afu.trace_close().unwrap();
    Traced { ports: afu.port_list().into_iter().map(|(name, bits, _)| (name, bits)).collect(), cycles }
}

#[test]
fn a_vcd_has_the_ports_and_the_whole_job() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("job.vcd");
    let Traced { ports, cycles } = trace(Trace::Vcd, &path);
    let text = fs::read_to_string(&path).unwrap();
    let (header, changes) = text.split_once("$enddefinitions $end").expect("a VCD header");

    // $var wire 10 4# rd_req_tag [9:0] $end
    let mut codes = HashMap::new();
    for line in header.lines() {
        if let ["$var", _, bits, code, name, ..] = line.split_whitespace().collect::<Vec<_>>()[..] {
            codes.entry(name.to_owned()).or_insert((bits.parse::<u32>().unwrap(), code.to_owned()));
        }
    }
    for (name, bits) in &ports {
        assert_eq!(codes.get(name).map(|(bits, _)| bits), Some(bits), "{name}");
    }
    let times: Vec<u64> = changes.lines().filter_map(|line| line.strip_prefix('#')?.parse().ok()).collect();
    assert!(times.is_sorted());
    let end = times.last().unwrap() * picoseconds(header);
    let (whole, edge) = (2 * HALF_PERIOD_PS * cycles, 2 * HALF_PERIOD_PS);
    assert!((whole - edge..=whole).contains(&end), "{end} ps for {cycles} cycles");
    // A change of a one-bit signal is a line with its value and its code. The clock changes twice per cycle; `done`
    // ends high.
    let of = |name: &str| -> Vec<&str> {
        let code = &codes[name].1;
        changes.lines().filter(|line| line.len() == code.len() + 1 && line.ends_with(code.as_str())).collect()
    };
    assert!((2 * cycles..=2 * cycles + 1).contains(&(of("clk").len() as u64)));
    assert!(of("done").last().unwrap().starts_with('1'));
    assert!(of("start").len() >= 3, "low, high, low");
}

/// A VCD's time unit in picoseconds.
fn picoseconds(header: &str) -> u64 {
    let unit =
        header.split_once("$timescale").unwrap().1.split("$end").next().unwrap().split_whitespace().collect::<String>();
    assert!(unit == "1ps", "{unit}");
    1
}

/// Reads the header block of GTKWave's format: times, numbers of scopes and variables, and the writer.
#[test]
fn an_fst_has_variables_and_the_whole_job() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("job.fst");
    let Traced { ports, cycles } = trace(Trace::Fst, &path);
    let bytes = fs::read(&path).unwrap();
    let number = |at: usize| u64::from_be_bytes(bytes[at..at + 8].try_into().unwrap());
    assert_eq!((bytes[0], number(1)), (0, 329), "a finished header block");
    let (begin, end) = (number(9), number(17));
    assert!(begin == 0 && end > 2 * HALF_PERIOD_PS * (cycles - 1), "{begin} to {end} ps for {cycles} cycles");
    let (scopes, variables) = (number(41), number(49));
    assert!(scopes >= 5 && variables as usize > 2 * ports.len(), "{scopes} scopes, {variables} variables");
}
