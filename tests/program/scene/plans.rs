//! The RTL contains exactly the operators that a plan requires, and records contain exactly the required fields.

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::Config;
#[cfg(feature = "cosim")]
use contact_afu::config::Shell;
#[cfg(feature = "cosim")]
use contact_afu::link::LinkModel;
use contact_afu::pairs::Set;
use contact_afu::query::Fields;
#[cfg(feature = "cosim")]
use contact_afu::query::PairRecord;
#[cfg(feature = "cosim")]
use contact_afu::scene::Still;
use contact_afu::scene::{Part, Plan};
#[cfg(feature = "cosim")]
use contact_afu::verify::Bench;

use super::scene;

/// A module's name without its formats: everything before `_e` and a digit.
fn operator(name: &str) -> &str {
    let format = name.match_indices("_e").find(|(at, _)| name[at + 2..].starts_with(|c: char| c.is_ascii_digit()));
    format.map_or(name, |(at, _)| &name[..at])
}

/// The operators in the kernel's Verilog as `name × count`, without formats. At an interval of 1 each operation has its
/// own operator.
fn instances(example: &str) -> Vec<String> {
    instances_of(Config { interval: 1, ..Plan::of(&scene(example)).unwrap().config })
}

fn instances_of(config: Config) -> Vec<String> {
    let files = Afu::generate(Spec::from(config)).unwrap().verilog();
    let (_, kernel) = files.iter().find(|(name, _)| name == "sphere_kernel.v").expect("the kernel's file");
    let names = kernel.lines().filter_map(|line| line.trim().strip_prefix("fp_")?.split_once(" "));
    let mut names: Vec<String> = names.map(|(name, _)| operator(name).to_owned()).collect();
    names.sort();
    let mut counted: Vec<(String, usize)> = Vec::new();
    for name in names {
        match counted.last_mut() {
            Some((last, count)) if *last == name => *count += 1,
            _ => counted.push((name, 1)),
        }
    }
    counted.into_iter().map(|(name, count)| format!("{name} × {count}")).collect()
}

#[test]
fn each_example_s_hardware_is_what_its_plan_calls_for() {
    // Without a position, three products and sums, the offset and its halving are absent. With one radius, so is r1 +
    // r2.
    let no_position = [
        "add_magnitudes × 2",
        "at_most × 1",
        "convert × 4",
        "greater × 1",
        "mul × 3",
        "recip × 1",
        "sqrt × 1",
        "square × 3",
        "sub × 1",
        "widening_sub × 3",
    ];
    assert_eq!(instances("diamond"), no_position);
    // Arithmetic with fewer bits than the records rounds their words first, so differences are of converted words.
    let shorter = no_position.map(|line| match line {
        "convert × 4" => "convert × 10",
        "sub × 1" => "sub × 4",
        line => line,
    });
    let shorter: Vec<&str> = shorter.into_iter().filter(|line| !line.starts_with("widening")).collect();
    assert_eq!(instances("gas"), shorter);
    let with_position = [
        "add",
        "add_magnitudes",
        "at_most",
        "convert",
        "greater",
        "halve",
        "mul",
        "recip",
        "sqrt",
        "square",
        "sub",
        "widening_sub",
    ];
    let names = |example: &str| -> Vec<String> {
        instances(example).iter().map(|line| line.split(" ×").next().unwrap_or_default().to_owned()).collect()
    };
    assert_eq!(names("billiards"), with_position);
    // Different radii are part of the records.
    let with_radii: Vec<&str> = with_position[..11].iter().copied().chain(["widening_add", "widening_sub"]).collect();
    assert_eq!(names("column"), with_radii);
    // A test for touching has neither root nor division, and words are added directly.
    let touching = ["add_magnitudes", "at_most", "root_exceeds", "square", "widening_add", "widening_sub"];
    assert_eq!(names("touching"), touching);
}

/// As planned, operations share operators while the AFU still takes one full line of pairs per cycle. So there are
/// fewer operators, and none that is not required.
#[test]
fn operators_are_shared_as_far_as_the_link_lets_them() {
    for (example, absent) in
        [("diamond", &["halve"][..]), ("touching", &["sqrt", "recip", "mul", "halve"]), ("column", &[])]
    {
        let plan = Plan::of(&scene(example)).unwrap();
        assert_eq!((plan.config.scpus, plan.config.interval), (10, 5), "{example}");
        let shared = instances_of(plan.config);
        let count = |list: &[String]| -> u32 {
            list.iter().map(|line| line.split("× ").nth(1).and_then(|count| count.parse().ok()).unwrap_or(0)).sum()
        };
        assert!(3 * count(&shared) <= 2 * count(&instances(example)), "{example}: {shared:?}");
        for name in absent {
            assert!(!shared.iter().any(|line| line.starts_with(&format!("{name} "))), "{example}: {name}, {shared:?}");
        }
    }
}

#[test]
fn each_example_s_fields_and_records_are_what_it_calls_for() {
    for (example, contact, radius, profile, parts) in [
        ("diamond", "hit,depth,normal", Some(0.5), "wide", &[Part::Pull, Part::Bounce, Part::Energy][..]),
        (
            "billiards",
            "hit,depth,normal,position",
            Some(0.0285),
            "wide",
            &[Part::Gravity, Part::Friction, Part::Spin, Part::Walls, Part::Contacts],
        ),
        (
            "column",
            "hit,depth,normal,position",
            None,
            "wide",
            &[Part::Gravity, Part::Friction, Part::Damping, Part::Floor, Part::Sleeping],
        ),
        ("touching", "hit", None, "wide", &[Part::Contacts]),
        ("gas", "hit,depth,normal", Some(0.1), "e10f17z", &[Part::Bounce, Part::Walls]),
    ] {
        let plan = Plan::of(&scene(example)).unwrap();
        assert_eq!(plan.config.contact.to_string(), contact, "{example}");
        assert_eq!(plan.config.radius, radius, "{example}");
        assert_eq!(plan.config.profile.to_string(), profile, "{example}");
        assert!(parts.iter().all(|part| plan.has(*part)), "{example}");
        assert_eq!(plan.has(Part::Motion), example != "touching");
        // Every active row names its reason, or is one of those that are active by default.
        for row in plan.rows.iter().filter(|row| row.on && row.calls.is_empty()) {
            assert!(
                ["arithmetic", "SCPUs", "radii in records", "run"].contains(&row.name.as_str()),
                "{example}: {row:?}"
            );
        }
    }
}

/// Fields computed by both are equal bit for bit, with every field selected and with only the required fields.
#[test]
fn what_both_compute_is_the_same_bits() {
    let mut pairs = Set::Random(3_000).pairs(5);
    for example in ["diamond", "billiards", "touching"] {
        let plan = Plan::of(&scene(example)).unwrap();
        if let Some(radius) = plan.config.radius {
            for pair in &mut pairs {
                (pair.0[3], pair.0[7]) = (radius.to_bits(), radius.to_bits());
            }
        }
        let config = plan.config.contact;
        let (few, all) = (plan.config.profile.reference(config), plan.config.profile.reference(Fields::ALL));
        let mut touching = 0;
        for (few, all) in few.run_all(&pairs).into_iter().zip(all.run_all(&pairs)) {
            assert_eq!(few.flags(), all.flags());
            let words = [(config.position, 0..3), (config.normal, 3..6), (config.depth, 6..7)];
            for (_, words) in words.into_iter().filter(|(asked, _)| *asked) {
                assert_eq!(few.0[words.clone()], all.0[words]);
            }
            touching += u32::from(few.is_contact());
        }
        assert!(touching > 100, "{example}: {touching}");
    }
}

/// Simulates each example's AFU: it finds the same as the reference with every field, and the bytes over the link are
/// those of the plan. Bytes do not depend on the arithmetic, so scenes that need more than touching use a small one.
#[cfg(feature = "cosim")]
#[test]
fn the_bytes_over_the_link_are_the_plan_s() {
    for example in super::EXAMPLES {
        let scene = scene(example);
        let plan = Plan::of(&scene).unwrap();
        let query = Still::of(&scene).unwrap();
        let mut pairs: Vec<PairRecord> = query.pairs().into_iter().chain(Set::Random(400).pairs(2)).collect();
        if let Some(radius) = plan.config.radius {
            pairs.iter_mut().for_each(|pair| (pair.0[3], pair.0[7]) = (radius.to_bits(), radius.to_bits()));
        }
        let small = if example == "touching" { plan.config.profile.clone() } else { "e8f3z".parse().unwrap() };
        // Uses the line port directly, because a shell reads and writes additional lines.
        let config = Config { shell: Shell::Line, profile: small, ..plan.config.clone() };
        let verdict = Bench::new(&config).unwrap().run(&pairs, &LinkModel::ideal(), 1).unwrap();
        assert!(verdict.is_good(), "{example}: {:?}", verdict.failed_checks);
        let everything = config.profile.reference(Fields::ALL).run_all(&pairs);
        let hits: Vec<bool> = everything.iter().map(|contact| contact.is_contact()).collect();
        let found: Vec<bool> = verdict.by_pair().iter().map(|contact| contact.is_contact()).collect();
        assert_eq!(found, hits, "{example}");
        let contacts = hits.iter().filter(|hit| **hit).count() as u64;
        let cost = plan.cost().unwrap();
        // The link transfers whole lines.
        let lines = |bytes: f64| (bytes / 64.0).ceil() as u64 * 64;
        assert_eq!(verdict.outcome.bytes_read, lines(cost.bytes_sent * pairs.len() as f64), "{example}");
        assert_eq!(verdict.outcome.bytes_written, lines(cost.bytes_returned * contacts as f64), "{example}");
        assert!(contacts > 20 && contacts < pairs.len() as u64, "{example}: {contacts}");
    }
}
