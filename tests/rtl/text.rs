//! What a reader of the Verilog meets in every configuration: lines that fit a screen, and names and expressions that a
//! person would write.

use std::collections::HashSet;
use std::sync::LazyLock;

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Multipliers, Results, Search, Shell};

/// Configurations that between them have every module and every way to write it.
fn configurations() -> Vec<Config> {
    let shipped = Config::shipped();
    let with = |profile: &str, contact: &str, interval: u32| Config {
        profile: profile.parse().unwrap(),
        contact: contact.parse().unwrap(),
        interval,
        ..Config::shipped()
    };
    let hits = |contact: &str| Config { results: Results::Hits, ..with("wide", contact, 1) };
    vec![
        shipped.clone(),
        Config { interval: 1, ..shipped.clone() },
        Config { interval: 2, scpus: 64, ..shipped.clone() },
        Config { interval: 10, ..shipped.clone() },
        Config { shell: Shell::Line, prefix: Some("a_prefix_of_a_long_name".to_owned()), ..shipped.clone() },
        Config { multipliers: Multipliers::Spare, ..shipped },
        with("wide", "hit", 1),
        with("wide", "hit", 5),
        with("exact", "hit,depth,normal,position", 1),
        with("paper", "hit,depth,normal,position", 10),
        with("half", "depth", 3),
        with("e11f52", "position,depth", 1),
        Config { shell: Shell::Axi, ..with("wide", "hit", 1) },
        Config { shell: Shell::Axi, bus: 128, outstanding: 256, ..with("half", "depth", 3) },
        Config { shell: Shell::Axi, bus: 256, outstanding: 16, ..hits("depth") },
        hits("hit"),
        hits("depth"),
        hits("hit,depth,normal,position"),
        Config { decide: 1, interval: 8, scpus: 1, ..hits("hit,depth,normal,position") },
        Config { decide: 2, interval: 5, scpus: 3, shell: Shell::Axi, ..hits("depth") },
        super::spheres(Search::default()),
        super::spheres(Search { table: 65_536, lanes: 256, deciders: 1, ..Search::default() }),
        Config { shell: Shell::Axi, ..super::spheres(Search::default()) },
        Config { shell: Shell::Spl2, ..super::spheres(Search::default()) },
    ]
}

static LINES: LazyLock<Vec<(String, String)>> = LazyLock::new(lines);

/// Each line of each module's file, with what it is a line of. Benches also hold data.
fn lines() -> Vec<(String, String)> {
    let mut found = Vec::new();
    for config in configurations() {
        let files = Afu::generate(Spec::from(config.clone())).unwrap().files();
        for (name, text) in files.into_iter().filter(|(name, _)| name.ends_with(".v") && !name.contains('/')) {
            let place = format!("{name} of {} at interval {}", config.profile, config.interval);
            found.extend(text.lines().map(|line| (place.clone(), line.to_owned())));
        }
    }
    assert!(found.len() > 20_000, "{} lines", found.len());
    found
}

/// The name that a line declares, and whether it is that of a register.
fn declared(line: &str) -> Option<(&str, bool)> {
    let line = line.trim_start();
    let line = line.strip_prefix("output ").unwrap_or(line);
    let (kind, rest) = line.split_once(' ').filter(|(kind, _)| matches!(*kind, "reg" | "wire"))?;
    let rest = rest.trim_start();
    let name = if rest.starts_with('[') { rest.split_once("] ")?.1.trim_start() } else { rest };
    let end = name.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(name.len());
    Some((&name[..end], kind == "reg"))
}

/// The fault of a name, if a person would have chosen another one.
fn fault(name: &str, is_register: bool) -> Option<&'static str> {
    const BETWEEN: [&str; 12] =
        ["or", "and", "if", "unless", "plus", "minus", "equals", "below", "times", "xor", "nor", "with"];
    let is_number = |word: &str| !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_digit());
    let is_stage = |word: &str| word.strip_prefix(['s', 'd']).is_some_and(is_number);
    let words: Vec<&str> = name.split('_').filter(|word| !is_stage(word)).collect();
    let last = words.last().copied().unwrap_or_default();
    match () {
        () if words.contains(&"not") => Some("a negation is called not_"),
        () if words.contains(&"wide") => Some("a widening has a name"),
        () if is_register && last == "next" => Some("a register has the name of a next value"),
        () if BETWEEN.contains(&last) => Some("the name is cut off"),
        () if words.windows(2).any(|pair| pair.iter().all(|word| BETWEEN.contains(word))) => {
            Some("the name is cut off")
        }
        () if words[0].strip_prefix('n').is_some_and(is_number) => Some("the name begins with a constant"),
        () if name.len() > 72 => Some("the name is too long"),
        () => None,
    }
}

#[test]
fn names_are_those_that_a_person_would_choose() {
    let faults: std::collections::BTreeSet<String> = LINES
        .iter()
        .filter_map(|(place, line)| {
            let (name, is_register) = declared(line)?;
            Some(format!("{name} in {place}: {}", fault(name, is_register)?))
        })
        .collect();
    assert!(faults.is_empty(), "{faults:#?}");
    // Names that the printer once made.
    for (name, is_register) in [
        ("not_buffer_lines_wide_below_d1", true),
        ("align_by_16_loses_or_or_or_or_s2", true),
        ("accept_and_not_refuses", false),
        ("word_0_next", true),
        ("a_significand_3_0_zeros_if_s1", true),
        ("scpus_0_0_wide", false),
        ("n1_below_scpus", false),
    ] {
        assert!(fault(name, is_register).is_some(), "{name}");
    }
    assert_eq!(declared("  output reg  [511:0] line_next,"), Some(("line_next", true)));
}

/// True if a sum with a constant is compared with a constant, or if zeros stand above zeros.
fn is_unfolded(line: &str) -> bool {
    let is_constant = |text: &str| {
        let width = text.bytes().take_while(u8::is_ascii_digit).count();
        width > 0 && text[width..].starts_with("'d")
    };
    let compared = line.match_indices(") == ").any(|(at, sign)| {
        let summand = line[..at].rsplit_once(" + ").map_or("", |(_, last)| last);
        let is_whole = !summand.contains(['(', ')', ' ']);
        is_whole && is_constant(summand) && is_constant(&line[at + sign.len()..])
    });
    let above = line.match_indices("'d0, {").any(|(at, sign)| {
        // `{1'b0, {4{x}}}` repeats a bit, and `{1'b0, {1'b0, a} + b}` is a sum.
        let rest = &line[at + sign.len()..];
        let close = rest.find('}').map_or("", |close| &rest[close + 1..]);
        !rest.starts_with(|c: char| c.is_ascii_digit()) && (close.starts_with('}') || close.starts_with(','))
    });
    compared || above
}

#[test]
fn constants_are_folded() {
    for (place, line) in &*LINES {
        assert!(!is_unfolded(line), "{place}: {line}");
    }
    assert!(is_unfolded("  wire a = (turn + 2'd2) == 2'd2;"));
    assert!(is_unfolded("  wire [7:0] flags = {5'd0, {flow, hit}};"));
    assert!(!is_unfolded("  wire a = (turn + 2'd2) == scpus;"));
}

/// A value waits in a shift register, not in a chain of registers with a number each. A register behind a memory is no
/// chain.
#[test]
fn chains_are_shift_registers() {
    let assigned = |line: &'static str| {
        let (left, right) = line.split_once(" <= ")?;
        Some((left.rsplit(' ').next()?, right.trim_end_matches(';')))
    };
    let base = |name: &'static str| {
        let (base, number) = name.rsplit_once("_kept_")?;
        (!number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())).then_some(base)
    };
    let is_link = |line: &'static str| {
        let (register, source) = assigned(line)?;
        (base(register)? == base(source)?).then_some(source)
    };
    assert_eq!(is_link("    if (phase_4) hit_kept_11 <= hit_kept_10;"), Some("hit_kept_10"));
    let of_memories: HashSet<(&str, &str)> = LINES
        .iter()
        .filter_map(|(place, line)| {
            let (register, source) = assigned(line)?;
            source.contains("_words[").then_some((place.as_str(), register))
        })
        .collect();
    for (place, line) in &*LINES {
        let is_chain = is_link(line).is_some_and(|source| !of_memories.contains(&(place.as_str(), source)));
        assert!(!is_chain, "{place}: {line}");
    }
}

/// The header of a shared kernel says what each unit does in each phase, and so does the code.
#[test]
fn a_shared_kernel_prints_its_schedule() {
    for interval in [2, 5, 10, 16] {
        let afu = Afu::generate(Spec::from(Config { interval, ..Config::shipped() })).unwrap();
        let files = afu.files();
        let (_, text) = files.iter().find(|(name, _)| name == "sphere_kernel.v").unwrap();
        let begin = text.find("// phase  cycle  unit").unwrap();
        let header = &text[begin..text.find("\n`default_nettype none").unwrap()];
        let phases: Vec<u32> = header
            .lines()
            .filter_map(|line| {
                let mut words = line.strip_prefix("// ")?.split_whitespace().map(str::parse::<u32>);
                let (phase, cycle) = (words.next()?.ok()?, words.next()?.ok()?);
                assert_eq!(phase, cycle % interval, "{line}");
                Some(phase)
            })
            .collect();
        assert!(phases.len() > 30 && phases.is_sorted(), "{header}");
        assert!(header.contains("  ny = dy * inverse_distance"), "{header}");
        // Every selection by phase is a complete case with a comment for each phase.
        let cases = text.matches("    case (operand_").count();
        let notes = text.lines().filter(|line| line.starts_with("      // phase ")).count();
        assert!(cases > 4 && notes >= 2 * cases, "interval {interval}: {cases} cases, {notes} notes");
        assert_eq!(text.matches("      default: ").count(), text.matches("    endcase").count());
    }
}

#[test]
fn every_line_fits_120_columns() {
    for (place, line) in &*LINES {
        assert!(line.len() <= 120, "{place}: {} columns: {line}", line.len());
        assert_eq!(line.trim_end(), line, "{place}: space at the end");
    }
}
