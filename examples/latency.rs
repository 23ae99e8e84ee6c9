//! Where the cycles of a small job go: the sum of the parts beside what the Verilog takes.
//!
//! `cargo run --release --example latency -- [LINK [PAIRS]...]`: a link's name or TOML file, whose tail is cut off
//! (harp1), and numbers of pairs (1 2 20).

use std::fs;

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Shell};
use contact_afu::link::Description;
use contact_afu::pairs::Set;
use contact_afu::report::table;
use contact_afu::verify::{Bench, account};

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "harp1".to_owned());
    let numbers: Vec<u32> = arguments.map(|number| number.parse()).collect::<Result<_, _>>()?;
    let numbers = if numbers.is_empty() { vec![1, 2, 20] } else { numbers };

    let config = Config { shell: Shell::Line, ..Config::default() };
    let description: Description =
        if name.ends_with(".toml") { Description::parse(&name, &fs::read_to_string(&name)?)? } else { name.parse()? };
    let mut link = description.at(config.clock_mhz)?;
    (link.read.tail, link.write.tail) = (0, 0);

    let afu = Afu::generate(Spec::from(config.clone()))?;
    let bench = Bench::new(&config)?;
    let mut columns = Vec::new();
    for &pairs in &numbers {
        let parts = account(&afu, &link, pairs)
            .ok_or_else(|| anyhow::anyhow!("{pairs} pairs over {name}: more than a sum of parts"))?;
        let measured = bench.run(&Set::Random(pairs.into()).pairs(1), &link, 1)?.outcome.cycles;
        columns.push((parts, measured));
    }
    let named = columns.iter().map(|(parts, _)| parts).max_by_key(|parts| parts.len());
    let mut rows: Vec<Vec<String>> = Vec::new();
    for part in named.into_iter().flatten() {
        let cycles = |parts: &[contact_afu::verify::Part]| {
            parts.iter().find(|other| other.name == part.name).map_or(0, |part| part.cycles).to_string()
        };
        rows.push([part.name.to_owned()].into_iter().chain(columns.iter().map(|(parts, _)| cycles(parts))).collect());
    }
    let sums = columns.iter().map(|(parts, _)| parts.iter().map(|part| part.cycles).sum::<u64>().to_string());
    rows.push(["sum".to_owned()].into_iter().chain(sums).collect());
    let measured = columns.iter().map(|(_, measured)| measured.to_string());
    rows.push(["measured".to_owned()].into_iter().chain(measured).collect());

    let heading: Vec<String> =
        ["cycles".to_owned()].into_iter().chain(numbers.iter().map(|pairs| format!("{pairs} pairs"))).collect();
    println!("{name} without its tail, {} SCPUs, {} MHz", config.scpus, config.clock_mhz);
    println!("{}", table::table(&heading.iter().map(String::as_str).collect::<Vec<_>>(), rows));
    Ok(())
}
