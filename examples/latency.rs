//! Where the cycles of a small job go: the predicted parts and their sum beside the simulated cycles.
//!
//! `cargo run --release --example latency -- [LINK [PAIRS]...]`: LINK is a preset or a TOML file (default: harp1) and
//! loses its latency tail. PAIRS are numbers of pairs (default: 1 2 20).

use std::error::Error;
use std::fs;

use contact_afu::config::{Config, Shell};
use contact_afu::link::Description;
use contact_afu::report::latency;
use contact_afu::verify::Bench;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "harp1".to_owned());
    let numbers: Vec<u32> = arguments.map(|number| number.parse()).collect::<Result<_, _>>()?;
    let numbers = if numbers.is_empty() { vec![1, 2, 20] } else { numbers };

    let config = Config { shell: Shell::Line, ..Config::default() };
    let description: Description =
        if name.ends_with(".toml") { Description::parse(&name, &fs::read_to_string(&name)?)? } else { name.parse()? };
    let mut link = description.at(config.clock_mhz)?;
    (link.read.tail, link.write.tail) = (0, 0);

    let text = latency::text(&Bench::new(&config)?, &link, &numbers)?
        .ok_or_else(|| format!("{name}: the cycles of such jobs are no sum of parts"))?;
    println!("{name} without its tail, {} SCPUs, {} MHz", config.scpus, config.clock_mhz);
    println!("{text}");
    Ok(())
}
