//! Spheres in, the numbers of those that touch out: every hit, in its order, as the search in software finds them.

use std::fs;
use std::path::Path;

use contact_afu::afu::{Afu, SearchModel, Spec};
use contact_afu::config::{Config, Input, Results, Search, Shell};
use contact_afu::cosim::Trace;
use contact_afu::link::{Description, LinkModel, NAMES};
use contact_afu::query::Fields;
use contact_afu::spheres::{Sphere, SphereSet, Spheres, hilbert_order, reorder};
use contact_afu::synth::Target;
use contact_afu::verify::{Bench, SpheresVerdict, VerifyError};

use crate::primitives::primitives;

fn config(search: Search) -> Config {
    Config {
        input: Input::Spheres,
        results: Results::Hits,
        contact: Fields::HIT,
        shell: Shell::Line,
        search,
        ..Config::default()
    }
}

fn set(name: &str) -> Spheres {
    name.parse::<SphereSet>().unwrap().spheres(3)
}

fn sorted(spheres: Spheres) -> Spheres {
    let sort = |set: Vec<Sphere>| reorder(&set, &hilbert_order(&set));
    Spheres { first: sort(spheres.first), second: spheres.second.map(sort) }
}

/// Pairs of spheres that nearly touch, at many scales: what a box must not lose.
fn tangents() -> Spheres {
    let mut spheres = Vec::new();
    for scale in -20..20 {
        let unit = 2_f32.powi(3 * scale);
        for ulps in 0..4 {
            // Each pair lies far from the others.
            let (y, radius) = (unit * 64.0 * (1 + ulps) as f32, f32::from_bits(unit.to_bits() + ulps));
            spheres.push([-unit, y, 0.0, unit]);
            spheres.push([f32::from_bits(radius.to_bits() + ulps), y, 0.0, radius]);
        }
    }
    let counterexample = [[-1.0, -9.0, 0.0, 1.0], [2_f32.powi(-30) + 2_f32.powi(-53), -9.0, 0.0, 2_f32.powi(-30)]];
    spheres.extend(counterexample);
    Spheres { first: spheres.into_iter().map(Sphere::new).collect(), second: None }
}

fn run(bench: &Bench, spheres: &Spheres, link: &str, seed: u64) -> Result<SpheresVerdict, VerifyError> {
    bench.run_spheres(spheres, &link_of(link), seed, None)
}

fn link_of(name: &str) -> LinkModel {
    name.parse::<Description>().unwrap().at(200.0).unwrap()
}

#[test]
fn every_link_gives_every_hit_in_order() {
    let bench = Bench::new(&config(Search { table: 2048, lanes: 32, deciders: 4, ..Search::default() })).unwrap();
    for link in LinkModel::PRESETS {
        for spheres in [sorted(set("diamond:8")), set("probes:300:700")] {
            let verdict = run(&bench, &spheres, link, 5).unwrap();
            assert!(verdict.is_good(), "{link}: {:?}", verdict.failed_checks);
            assert!(!verdict.hits.is_empty());
        }
    }
}

#[test]
fn any_size_of_the_search_gives_the_same() {
    // Where every pair touches, all rows that may be inside are, and most of them wait before the first stage.
    let crowd = Spheres { first: vec![Sphere::new([1.0, 2.0, 3.0, 0.5]); 600], second: None };
    let sets = [sorted(set("gas:1500:0.3")), set("gas:500:0.3"), tangents(), crowd];
    let mut found: Vec<Vec<_>> = vec![Vec::new(); sets.len()];
    for (lanes, deciders, box_bits) in [(16, 1, 24), (64, 8, 18), (256, 16, 32)] {
        let search = Search { table: 2048, lanes, deciders, box_bits };
        let config = config(search);
        let bench = Bench::new(&config).unwrap();
        cycles_are_predicted(&bench, &config);
        for (spheres, found) in sets.iter().zip(&mut found) {
            let verdict = run(&bench, spheres, "hostile", 2).unwrap();
            assert!(verdict.is_good(), "{search:?}: {:?}", verdict.failed_checks);
            found.push(verdict.hits);
        }
    }
    for found in found {
        assert!(!found[0].is_empty() && found.iter().all(|hits| *hits == found[0]));
    }
}

/// The model's cycles are those of the RTL, to 3 %, over every link but the one that is as irregular as it may be.
fn cycles_are_predicted(bench: &Bench, config: &Config) {
    for set in [sorted(set("gas:2000:0.3")), sorted(set("diamond:11")), set("probes:2000:2000")] {
        let model = SearchModel::new(config, &set).unwrap();
        for link in NAMES.into_iter().filter(|link| *link != "hostile") {
            let verdict = run(bench, &set, link, 1).unwrap();
            assert!(verdict.is_good(), "{:?}: {:?}", config.search, verdict.failed_checks);
            let predicted = model.predict(config, &link_of(link)).unwrap();
            let ratio = predicted.cycles as f64 / verdict.outcome.cycles as f64;
            let (search, cycles) = (config.search, verdict.outcome.cycles);
            assert!((ratio - 1.0).abs() < 0.03, "{search:?}, {link}: {cycles} cycles, predicted {predicted:?}");
        }
    }
}

#[test]
fn too_many_spheres_are_told_before_anything_runs() {
    let bench = Bench::new(&config(Search { table: 512, lanes: 16, deciders: 2, box_bits: 32 })).unwrap();
    let error = run(&bench, &set("gas:513:0.1"), "ideal", 1).unwrap_err().to_string();
    assert!(error.contains("513 spheres") && error.contains("--table"), "{error}");
}

/// A configuration whose SCPUs compute every field of a contact.
fn with_contacts(search: Search, scpus: u32, interval: u32) -> Config {
    Config { contact: Fields::ALL, scpus, interval, ..config(search) }
}

#[test]
fn contacts_come_with_all_their_fields() {
    let search = Search { table: 2048, lanes: 64, deciders: 8, ..Search::default() };
    let two_per_cycle = Search { lanes: 256, deciders: 16, ..search };
    for (search, scpus, interval) in [(search, 1, 1), (Search { lanes: 16, ..search }, 2, 5), (two_per_cycle, 2, 1)] {
        let config = with_contacts(search, scpus, interval);
        let bench = Bench::new(&config).unwrap();
        cycles_are_predicted(&bench, &config);
        let crowd = Spheres { first: vec![Sphere::new([1.0, 2.0, 3.0, 0.5]); 50], second: None };
        for link in LinkModel::PRESETS {
            for spheres in [&sorted(set("gas:700:0.3")), &set("probes:100:300"), &tangents(), &crowd] {
                let verdict = run(&bench, spheres, link, 4).unwrap();
                assert!(verdict.is_good(), "{link}: {:?}", verdict.failed_checks);
                assert_eq!(verdict.contacts.len(), verdict.hits.len());
                assert!(verdict.contacts.iter().all(|contact| contact.is_contact() && contact.depth() >= 0.0));
            }
        }
    }
}

/// A fault: what it is, the file, the text before an expression, the expression, and the one that takes its place.
type Fault = (&'static str, &'static str, &'static str, &'static str, &'static str);

const FAULTS: [Fault; 9] = [
    (
        "a box is one unit too small",
        "sphere_box.v",
        "r_increased = ",
        "{1'b0, r[30:0]} + 32'd2",
        "{1'b0, r[30:0]} + 32'd1",
    ),
    ("a lane is not wired", "contact_afu_near.v", "meets_3 <= ", "&meets_3_by_side", "1'b0"),
    ("a comparison too few", "contact_afu_candidates.v", "meets_0_7 <= ", "&meets_0_7_by_side", "1'b0"),
    ("a place by the wrong rank", "bit_of_rank.v", "6'd16: part_and_rank_word = ", "2'd2", "2'd1"),
    (
        "the last row is left out",
        "contact_afu_rows.v",
        "table_rows_minus_1 = ",
        "table_rows - 13'd1",
        "table_rows - 13'd2",
    ),
    ("answers of another decider", "contact_afu.v", ".answer_0       (", "decider_0_answer", "decider_1_answer"),
    (
        "numbers of another row",
        "contact_afu_decider.v",
        "about <= ",
        "shares_oldest[20:8]",
        "shares_oldest[20:8] ^ 13'd1",
    ),
    (
        "rows are kept too short",
        "contact_afu_loader.v",
        "turns_to_second_set) | ",
        "~rows_inside[4] | row_ends",
        "1'b1",
    ),
    ("a queue has room that it has not", "queue_32x50_slack_8.v", "has_room <= ", "(words_inside < 6'd23)", "1'b1"),
];

/// The same where contacts come back.
const FAULTS_OF_CONTACTS: [Fault; 2] = [
    (
        "the two spheres are exchanged",
        "contact_afu_resolver.v",
        "",
        "{kept_spheres_word, table_spheres_word}",
        "{table_spheres_word, kept_spheres_word}",
    ),
    (
        "a contact more than there are SCPUs for",
        "contact_afu.v",
        "",
        "dispatcher_accepts & resolver_may_come",
        "dispatcher_accepts",
    ),
];

/// The same with two SCPUs side by side, and with two rows that are compared at once.
const FAULTS_OF_TWO: [Fault; 2] = [
    ("lanes are exchanged", "contact_afu.v", ".numbers         (", "waiting_hits_record_0", "waiting_hits_record_1"),
    (
        "rows end before their hits have left",
        "contact_afu_waiting_hits.v",
        "rows_until = ",
        "readable_any ? oldest_row : rows_came",
        "rows_came",
    ),
];
const FAULTS_OF_TWO_ROWS: [Fault; 1] =
    [("the even row instead of the odd one", "contact_afu_candidates.v", "is_odd_row = ", "|walked_bit[3:2]", "1'b0")];

/// Each fault is found in one of four jobs over one of two links, by the hits, by the counts, or because the job does
/// not end. Without a fault, none of these jobs fails.
#[test]
fn planted_faults_are_found() {
    let search = Search { table: 512, lanes: 16, deciders: 2, box_bits: 32 };
    found(&config(search), &FAULTS);
    found(&with_contacts(search, 1, 4), &FAULTS_OF_CONTACTS);
    found(&with_contacts(search, 2, 1), &FAULTS_OF_TWO);
    found(&config(Search { lanes: 128, ..search }), &FAULTS_OF_TWO_ROWS);
}

/// One model contains all of these faults, because a separate model for each would take twenty seconds. A job selects
/// one by the last four bits of its number of spheres, counted from 1; with zero there, none is active.
fn found(config: &Config, faults: &[Fault]) {
    let folder = tempfile::tempdir().unwrap();
    write(&Afu::generate(Spec::from(config.clone())).unwrap(), folder.path());
    for (number, &(_, file, before, right, wrong)) in (1..).zip(faults) {
        let chosen = format!("contact_afu.control.job_count[3:0] == 4'd{number}");
        let planted = format!("{before}(({chosen}) ? ({wrong}) : ({right}))");
        plant(&folder.path().join(file), &format!("{before}{right}"), &planted);
    }
    let bench = Bench::of_folder(folder.path(), None, Trace::Off).unwrap();
    let crowd = Spheres { first: vec![Sphere::new([1.0, 2.0, 3.0, 0.5]); 320], second: None };
    let sets = [sorted(set("gas:510:0.4")), tangents(), set("probes:110:300"), crowd];
    let failure = |selected: usize| {
        let cut = |spheres: &Spheres| {
            let mut spheres = spheres.clone();
            spheres.first.truncate(spheres.first.len() - (spheres.first.len() - selected) % 16);
            spheres
        };
        let mut jobs = ["ideal", "hostile"].into_iter().flat_map(|link| sets.iter().map(move |set| (cut(set), link)));
        jobs.find_map(|(spheres, link)| match run(&bench, &spheres, link, 1) {
            Err(error) => Some(error.to_string()),
            Ok(verdict) => (!verdict.is_good()).then(|| verdict.failed_checks.join(", ")),
        })
    };
    assert_eq!(failure(0), None, "without a fault");
    for (selected, (what, file, ..)) in (1..).zip(faults) {
        assert!(failure(selected).is_some(), "{what}: {file}");
    }
}

/// As synthesis for an ECP5 reads it: every block memory is a model that gives wrong bits for a word that is read in
/// the cycle in which it is written. Spheres of the table are in the memories of 1 024 words.
#[test]
fn a_search_in_primitives_finds_every_hit() {
    let config = config(Search { table: 2048, lanes: 16, deciders: 2, ..Search::default() });
    let afu = Afu::generate(Spec { delays: Target::Ecp5.delays(), ..Spec::from(config) }).unwrap();
    let folder = tempfile::tempdir().unwrap();
    write(&afu, folder.path());
    assert!(folder.path().join("line_memory_1024x18_ecp5.v").exists());
    fs::write(folder.path().join("primitives.v"), primitives()).unwrap();
    let list = folder.path().join("contact_afu.f");
    let files = fs::read_to_string(&list).unwrap();
    fs::write(&list, format!("primitives.v\n{files}")).unwrap();
    let bench = Bench::of_folder(folder.path(), None, Trace::Off).unwrap();
    for link in ["ideal", "hostile"] {
        for spheres in [sorted(set("diamond:11")), set("probes:500:700")] {
            let verdict = run(&bench, &spheres, link, 5).unwrap();
            assert!(verdict.is_good() && !verdict.hits.is_empty(), "{link}: {:?}", verdict.failed_checks);
        }
    }
}

fn write(afu: &Afu, folder: &Path) {
    for (name, text) in afu.files() {
        let path = folder.join(&name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

fn plant(file: &Path, old: &str, new: &str) {
    let text = fs::read_to_string(file).unwrap();
    assert!(text.contains(old), "{} has no `{old}`", file.display());
    fs::write(file, text.replacen(old, new, 1)).unwrap();
}
