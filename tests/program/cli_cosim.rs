//! `afu cosim`: bad files, reports, exit codes, and the detection of a planted fault.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

fn afu(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("afu").expect("the program is built").current_dir(folder).args(arguments).assert()
}

fn said(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).expect("UTF-8")
}

fn room() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn json(folder: &Path, name: &str) -> Value {
    serde_json::from_slice(&fs::read(folder.join(name)).expect("written")).expect("JSON")
}

/// An npy file of version 1.0 with this header and data.
fn npy(header: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

#[test]
fn a_bad_file_is_one_line_with_file_line_and_field_and_nothing_is_written() {
    let room = room();
    let header = "x1,y1,z1,r1,x2,y2,z2,r2\n";
    let lying = npy("{'descr': '<f4', 'fortran_order': False, 'shape': (1000000000000, 8), }\n", &[0; 32]);
    let flat = npy("{'descr': '<f4', 'fortran_order': False, 'shape': (8,), }\n", &[0; 32]);
    let integers = npy("{'descr': '<i8', 'fortran_order': False, 'shape': (1, 8), }\n", &[0; 64]);
    let files: Vec<(&str, Vec<u8>, &[&str])> = vec![
        ("column.csv", "x1,y1,z1,r1,x2,y2,z2\n0,0,0,1,0,0,0\n".into(), &["column.csv", "line 1", "field r2"]),
        (
            "text.csv",
            format!("{header}0,0,0,1,0,0,0,1\n0,0,near,1,0,0,0,1\n").into(),
            &["text.csv", "line 3", "field z1"],
        ),
        ("short.csv", format!("{header}0,0,0,1\n").into(), &["short.csv", "line 2", "field x2"]),
        ("long.csv", format!("{header}0,0,0,1,0,0,0,1,9\n").into(), &["long.csv", "line 2"]),
        ("empty.csv", vec![], &["empty.csv", "line 1", "empty"]),
        ("empty.npy", vec![], &["empty.npy", "header"]),
        ("lying.npy", lying, &["lying.npy", "shape"]),
        ("flat.npy", flat, &["flat.npy", "shape"]),
        ("integers.npy", integers, &["integers.npy", "descr", "astype"]),
        ("pairs.txt", header.into(), &["pairs.txt"]),
    ];
    for (name, content, words) in &files {
        fs::write(room.path().join(name), content).expect("written");
        let arguments = ["cosim", "--pairs", name, "--contacts", "out.csv", "--json", "out.json", "--junit", "out.xml"];
        let refused = afu(room.path(), &arguments).code(2);
        let said = said(&refused);
        assert_eq!(said.lines().count(), 1, "{name}: {said}");
        assert!(words.iter().all(|word| said.contains(word)), "{name}: {said}");
        assert!(refused.get_output().stdout.is_empty(), "{name}");
    }
    let absent = afu(room.path(), &["cosim", "--pairs", "absent.csv", "--json", "out.json"]).code(2);
    assert!(said(&absent).contains("absent.csv"), "{}", said(&absent));
    assert_eq!(fs::read_dir(room.path()).expect("there").count(), files.len(), "nothing but the files themselves");
}

#[test]
fn wrong_options_are_exit_2_before_anything_is_built() {
    let room = room();
    fs::write(room.path().join("link.json"), r#"{"name": "x", "read": {"latency": 0}}"#).expect("written");
    for (arguments, word) in [
        (&["--link", "perfect"][..], "unknown link `perfect`"),
        (&["--link", "link.json"], "link.json"),
        (&["--link", "absent.json"], "absent.json"),
        (&["--pairs", "diamond:0"], "diamond:0"),
        (&["--trace", "wave.txt"], ".vcd or .fst"),
        (&["--contacts", "out.txt"], ".csv or .npy"),
        (
            &["--pairs", "diamond:2", "--pairs", "diamond:3", "--contacts", "out.csv"],
            "--contacts works with one job only",
        ),
        (&["--json", "-", "--junit", "-"], "only one of them can write to standard output"),
        (&["--rtl", "absent"], "absent"),
        (&["--rtl", "absent", "--profile", "paper"], "--profile does not go with --rtl"),
        (&["--rtl", "absent", "--query", "sphere-plane"], "--query does not go with --rtl"),
        (&["--interval", "0"], "interval 0"),
        (&["--shell", "axi", "--bus", "100"], "bus of 100 bits"),
        (&["--spheres", "diamond:2"], "--spheres needs an AFU that takes spheres"),
        (&["--tile", "512"], "--tile needs an AFU that takes spheres"),
        (&["--lanes", "32"], "lanes with input direct"),
        (&["--input", "spheres", "--pairs", "diamond:2"], "--pairs does not go with --input spheres"),
        (&["--input", "spheres", "--profile", "paper"], "exponent bits"),
        (&["--input", "spheres", "--table", "1000"], "table 1000: expected a power of two"),
        (&["--input", "spheres", "--scpus", "3"], "use --deciders"),
        (&["--input", "spheres", "--spheres", "diamond:0"], "diamond:0"),
    ] {
        let refused = afu(room.path(), &[&["cosim"][..], arguments].concat()).code(2);
        let said = said(&refused);
        assert!(said.lines().count() == 1 && said.contains(word), "{arguments:?}: {said}");
    }
}

/// Two spheres that touch, one that is apart, and one that is no sphere.
#[test]
fn spheres_that_touch_come_back_as_numbers() {
    let room = room();
    fs::write(room.path().join("four.csv"), "x,y,z,r\n0,0,0,0.5\n5,0,0,0.5\n0,0,0,-1\n0,1,0,0.5\n").expect("written");
    let arguments =
        ["cosim", "--input", "spheres", "--spheres", "four.csv", "--json", "out.json", "--contacts", "out.csv"];
    let small = ["--table", "512", "--deciders", "1", "--link"];
    let [axi, spl2] =
        [["axi", "zynqmp"], ["spl2", "harp1"]].map(|[shell, link]| [&["--shell", shell], &small[..], &[link]].concat());
    for shell in [&[][..], &axi, &spl2] {
        afu(room.path(), &[&arguments, shell].concat()).success();
        let report = json(room.path(), "out.json");
        let job = &report["jobs"][0];
        let counts = ["spheres", "invalid", "candidates", "contacts", "mismatches"].map(|key| job[key].as_u64());
        assert_eq!(counts, [4, 1, 1, 1, 0].map(Some), "{shell:?}");
        assert!(job["ns_per_sphere"].as_f64().is_some_and(|ns| ns > 0.0), "{shell:?}");
        let contacts = fs::read_to_string(room.path().join("out.csv")).expect("written");
        assert!(contacts.lines().nth(1).is_some_and(|line| line.starts_with("0,3,real")), "{shell:?}: {contacts}");
    }
    // A table that is too small is told, with the option that helps.
    let refused =
        afu(room.path(), &["cosim", "--input", "spheres", "--table", "512", "--spheres", "gas:600:0.1"]).code(2);
    assert!(said(&refused).contains("600 spheres") && said(&refused).contains("--tile 512"), "{}", said(&refused));
    let found = |more: &[&str]| {
        let arguments = ["cosim", "--input", "spheres", "--spheres", "gas:600:0.1", "--json", "-"];
        let output = afu(room.path(), &[&arguments, more].concat()).success().get_output().stdout.clone();
        let report: serde_json::Value = serde_json::from_slice(&output).expect("JSON");
        ["spheres", "candidates", "contacts", "jobs"].map(|key| report["jobs"][0][key].as_u64().expect("a number"))
    };
    let (whole, tiles) = (found(&["--table", "1024"]), found(&["--table", "512", "--tile", "512"]));
    assert_eq!(whole[..3], tiles[..3]);
    assert_eq!((whole[3], tiles[3]), (1, 3));
}

/// Counts rows and bytes of a job that returns only contacts.
#[test]
fn hits_come_back_with_their_numbers() {
    let room = room();
    let csv = "x1,y1,z1,r1,x2,y2,z2,r2\n0,0,0,0.5,2,0,0,0.5\n0,0,0,0.5,1,0,0,0.5\nNaN,0,0,1,0,0,0,1\n3,4,5,1,3,4,5,2\n";
    fs::write(room.path().join("four.csv"), csv).expect("written");
    let arguments = ["cosim", "--results", "hits", "--pairs", "four.csv", "--json", "out.json", "--contacts"];
    afu(room.path(), &[&arguments[..], &["out.csv"]].concat()).success();
    let report = json(room.path(), "out.json");
    assert_eq!(report["flows"], serde_json::json!({"fake": 1, "grazing": 1, "real": 1, "invalid": 1}));
    assert_eq!((&report["pairs"], &report["contacts"], &report["mismatches"]), (&4.into(), &2.into(), &0.into()));
    // Two lines of contacts, and three lines that the shell writes: latency, performance, status.
    assert_eq!((&report["config"]["results"], &report["link"]["bytes_written"]), (&"hits".into(), &(64 * 5).into()));
    let contacts = fs::read_to_string(room.path().join("out.csv")).expect("written");
    let rows: Vec<&str> = contacts.lines().skip(1).collect();
    assert_eq!(rows, ["1,real,0.5,0,0,-1,0,0,0,0", "3,grazing,3,4,5,1,0,0,3,0"]);
    afu(room.path(), &[&arguments[..], &["out.npy"]].concat()).success();
    let bytes = fs::read(room.path().join("out.npy")).expect("written");
    assert!(String::from_utf8_lossy(&bytes).contains("(2, 9)"));
    assert_eq!(bytes[bytes.len() - 72..][..4], [1, 0, 0, 0]);
}

#[test]
fn pairs_come_back_as_contacts_and_figures() {
    let room = room();
    let csv = "x1,y1,z1,r1,x2,y2,z2,r2\n0,0,0,0.5,1,0,0,0.5\n0,0,0,0.5,2,0,0,0.5\n3,4,5,1,3,4,5,2\nNaN,0,0,1,0,0,0,1\n";
    fs::write(room.path().join("four.csv"), csv).expect("written");
    let arguments = ["cosim", "--scpus", "2", "--pairs", "four.csv", "--contacts", "out.csv", "--json", "-"];
    let done = afu(room.path(), &arguments).success();
    let report: Value = serde_json::from_slice(&done.get_output().stdout).expect("JSON alone on standard output");
    assert!(said(&done).contains("mismatches with the reference"), "the table moves to standard error");

    let keys = "schema version seed replay tools rtl_sha256 config pairs contacts flows mismatches cycles \
                cycles_per_pair latency_cycles clock_mhz ns_per_pair link host_seconds";
    for key in keys.split_whitespace() {
        assert!(!report[key].is_null(), "{key} in {report}");
    }
    for key in ["name", "bytes_read", "bytes_written", "limit_ns_per_pair", "efficiency"] {
        assert!(!report["link"][key].is_null(), "link.{key} in {report}");
    }
    assert_eq!(report["schema"], "contact-afu/cosim/1");
    assert_eq!(report["flows"], serde_json::json!({"fake": 1, "grazing": 1, "real": 1, "invalid": 1}));
    assert_eq!((&report["pairs"], &report["contacts"], &report["mismatches"]), (&4.into(), &2.into(), &0.into()));
    assert_eq!(report["config"]["scpus"], 2);
    // Two lines of pairs and two of contacts, plus the shell's own lines: it reads the control memory twice, and writes
    // latency, performance and status.
    let link = (&report["link"]["bytes_read"], &report["link"]["bytes_written"]);
    assert_eq!(link, (&(64 * 4).into(), &(64 * 5).into()));

    let contacts = fs::read_to_string(room.path().join("out.csv")).expect("written");
    let lines: Vec<&str> = contacts.lines().collect();
    assert_eq!(lines[0], "pair,flow,pos_x,pos_y,pos_z,normal_x,normal_y,normal_z,depth,invalid");
    assert_eq!(lines[1], "0,real,0.5,0,0,-1,0,0,0,0");
    assert_eq!(lines[3], "2,grazing,3,4,5,1,0,0,3,0");
    assert!(lines[2].starts_with("1,fake,") && lines[4].starts_with("3,invalid,") && lines[4].ends_with(",1"));
}

#[test]
fn no_pairs_are_a_job() {
    let room = room();
    fs::write(room.path().join("none.csv"), "x1,y1,z1,r1,x2,y2,z2,r2\n").expect("written");
    let arguments = ["cosim", "--scpus", "2", "--pairs", "none.csv", "--contacts", "out.npy", "--json", "out.json"];
    afu(room.path(), &arguments).success();
    let report = json(room.path(), "out.json");
    assert_eq!((&report["pairs"], &report["cycles_per_pair"]), (&0.into(), &Value::Null));
    assert_eq!(fs::metadata(room.path().join("out.npy")).expect("written").len(), 128, "a header and no record");
}

#[test]
fn several_sets_are_several_jobs_over_any_link() {
    let room = room();
    let arguments = [
        "cosim",
        "--scpus",
        "2",
        "--pairs",
        "diamond:3",
        "--pairs",
        "random:500",
        "--link",
        "hostile",
        "--seed",
        "5",
        "--json",
        "out.json",
        "--junit",
        "out.xml",
    ];
    let done = afu(room.path(), &arguments).success();
    let table = String::from_utf8(done.get_output().stdout.clone()).expect("UTF-8");
    assert!(table.contains("diamond:3") && table.contains("random:500"), "{table}");
    assert!(table.ends_with("\nPASS: 2 jobs, 632 pairs, every bit as in the reference\n"), "{table}");
    let report = json(room.path(), "out.json");
    assert_eq!(report["pairs"], 132 + 500);
    assert_eq!((&report["jobs"][0]["pairs"], &report["jobs"][1]["pairs"]), (&132.into(), &500.into()));
    let replay = report["replay"].as_str().expect("a command");
    assert_eq!(replay, "afu cosim --scpus 2 --interval 2 --pairs diamond:3 --pairs random:500 --link hostile --seed 5");
    let words: Vec<&str> = replay.split(' ').skip(1).collect();
    afu(room.path(), &[&words[..], &["--json", "again.json"]].concat()).success();
    assert_eq!(json(room.path(), "again.json")["cycles"], report["cycles"], "the same seed, the same cycles");
    let junit = fs::read_to_string(room.path().join("out.xml")).expect("written");
    assert!(junit.contains(r#"tests="2""#) && junit.contains(r#"failures="0""#), "{junit}");
}

#[test]
fn a_planted_fault_is_found_told_and_kept() {
    let room = room();
    afu(room.path(), &["rtl", "--scpus", "2", "--out", "rtl"]).success();
    let file = room.path().join("rtl/scpu.v");
    let text = fs::read_to_string(&file).expect("written");
    // Inverts the lowest bit of every depth.
    let faulty = text.replacen("assign record = {", "assign record = 256'd1 << 192 ^ {", 1);
    assert_ne!(text, faulty, "the place to break is there:\n{text}");
    fs::write(&file, faulty).expect("written");

    let arguments = ["cosim", "--rtl", "rtl", "--pairs", "diamond:3", "--json", "out.json", "--junit", "out.xml"];
    let failed = afu(room.path(), &[&arguments[..], &["--replay", "corpus.csv"]].concat()).code(1);
    let told = said(&failed);
    for word in ["mismatch: diamond:3, pair 0, written in cycle ", "depth     expected 00000000 (0.0), got 00000001"] {
        assert!(told.contains(word), "{word} in {told}");
    }
    assert!(told.contains("replay: afu cosim --rtl rtl --scpus 2 --pairs diamond:3"), "{told}");
    let table = String::from_utf8(failed.get_output().stdout.clone()).expect("UTF-8");
    assert!(table.ends_with("\nFAIL: 1 of 1 job: diamond:3\n"), "{table}");
    let report = json(room.path(), "out.json");
    assert_eq!((&report["passed"], &report["mismatches"]), (&false.into(), &132.into()));
    let differ = "132 of 132 records differ from the reference";
    assert_eq!(report["failures"], serde_json::json!([format!("diamond:3: {differ}")]));
    let job = &report["jobs"][0];
    assert_eq!(job["failures"], serde_json::json!([differ]));
    assert_eq!(job["first_mismatches"].as_array().map(Vec::len), Some(10));
    let first = &job["first_mismatches"][0];
    assert!(first["cycle"].as_u64().is_some_and(|cycle| cycle > 50), "{first}");
    let words = serde_json::json!([{"word": 6, "field": "depth", "expected": "00000000", "got": "00000001"}]);
    assert_eq!((&first["pair"], &first["words"]), (&0.into(), &words));
    let junit = fs::read_to_string(room.path().join("out.xml")).expect("written");
    assert!(junit.contains("132 of 132 records differ"), "{junit}");

    let corpus = fs::read_to_string(room.path().join("corpus.csv")).expect("written");
    assert_eq!(corpus.lines().count(), 1 + 132);
    let again = ["cosim", "--scpus", "2", "--pairs", "diamond:1", "--replay", "corpus.csv", "--json", "again.json"];
    afu(room.path(), &again).success();
    let report = json(room.path(), "again.json");
    assert_eq!((&report["jobs"][0]["name"], &report["jobs"][0]["pairs"]), (&"corpus.csv".into(), &132.into()));
}

#[test]
fn a_job_that_does_not_finish_is_exit_1_and_says_what_it_waits_for() {
    let room = room();
    afu(room.path(), &["rtl", "--scpus", "2", "--reset", "async-low", "--out", "rtl"]).success();
    let file = room.path().join("rtl/contact_afu_dispatcher.v");
    let text = fs::read_to_string(&file).expect("written");
    // Lines pile up, because no write is ever requested.
    let faulty = text.replacen(
        "wr_req_valid <= (goes & ~drops_requests) |",
        "wr_req_valid <= 1'b0 & (goes & ~drops_requests) |",
        1,
    );
    assert_ne!(text, faulty, "the place to break is there:\n{text}");
    fs::write(&file, faulty).expect("written");

    let arguments = ["cosim", "--rtl", "rtl", "--pairs", "diamond:3", "--json", "out.json", "--junit", "out.xml"];
    let failed = afu(room.path(), &arguments).code(1);
    let told = said(&failed);
    let reason = told.lines().find(|line| line.starts_with("diamond:3: the job did not finish after "));
    let reason = reason.unwrap_or_else(|| panic!("{told}"));
    let cycles = reason.split_whitespace().find_map(|word| word.parse::<u64>().ok()).expect("a number of cycles");
    assert!((100..5_000).contains(&cycles), "132 pairs, of which the last line is never written: {reason}");
    assert!(reason.contains("waiting for the AFU (0 reads and 0 writes without a response)"), "{reason}");
    let report = json(room.path(), "out.json");
    assert_eq!((&report["passed"], &report["jobs"][0]["passed"]), (&false.into(), &false.into()));
    let failure = report["failures"][0].as_str().expect("text");
    assert!(failure.starts_with("diamond:3: the job did not finish after "), "{failure}");
    let junit = fs::read_to_string(room.path().join("out.xml")).expect("written");
    assert!(junit.contains("did not finish"), "{junit}");
}

/// On a pseudo-terminal: shows the expected time for building a model, and that the host is working when the bar is
/// full.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_sees_what_is_going_on() {
    let room = room();
    let program = assert_cmd::cargo::cargo_bin("afu");
    let command = format!("{} cosim --scpus 2 --pairs diamond:3", program.display());
    let shown =
        Command::new("script").args(["-qec", &command, "/dev/null"]).current_dir(room.path()).assert().success();
    let shown = String::from_utf8_lossy(&shown.get_output().stdout).into_owned();
    for words in [
        "building the AFU's model with Verilator and the C++ compiler, 0s",
        "comparing every bit with the reference, 0s",
    ] {
        assert!(shown.contains(words), "{words}: {shown}");
    }
}

#[test]
fn without_verilator_it_is_exit_3_and_says_the_command() {
    let room = room();
    let mut command = Command::cargo_bin("afu").expect("the program is built");
    command.current_dir(room.path()).env("AFU_VERILATOR", "no-such-verilator");
    // Not the built-in AFU.
    let assert = command.args(["cosim", "--scpus", "63", "--pairs", "diamond:2"]).assert().code(3);
    assert!(said(&assert).contains("Verilator is missing") && said(&assert).contains("install"), "{}", said(&assert));
}

/// Former faults: a VCD's destructor threw (status 134), one writer of FST files called `abort`, the other ignored
/// errors.
#[cfg(unix)]
#[test]
fn a_waveform_that_cannot_be_written_is_exit_4_and_leaves_no_file() {
    for name in ["wave.vcd", "wave.fst"] {
        let room = room();
        let arguments = ["cosim", "--scpus", "1", "--profile", "e8f3z", "--contact", "hit", "--pairs", "diamond:3"];
        let arguments = [&arguments[..], &["--trace", name]].concat();
        // The first run has no limit and builds the model.
        let whole = afu(room.path(), &arguments);
        if whole.get_output().status.code() != Some(0) {
            assert!(name == "wave.fst", "{}", said(&whole));
            continue; // the libraries of FST are missing
        }
        let bytes = fs::metadata(room.path().join(name)).expect("written").len();
        fs::remove_file(room.path().join(name)).expect("removed");
        // Limits of the file size in KiB: less than the header needs, half, and all but the end.
        for limit in [4, bytes / 2048, bytes / 1024] {
            let program = assert_cmd::cargo::cargo_bin("afu");
            let limited = format!("ulimit -f {limit}; exec \"$0\" \"$@\"");
            let mut command = Command::new("bash");
            command.current_dir(room.path()).args(["-c", &limited]).arg(program).args(&arguments);
            let failed = command.assert().code(4);
            let said = said(&failed);
            let last = said.lines().last().unwrap_or_default();
            assert!(last.starts_with("afu: ") && last.contains(name), "{limit}: {said}");
            assert_eq!(fs::read_dir(room.path()).expect("there").count(), 0, "{name}, {limit}: no half file");
        }
    }
}

#[test]
fn a_waveform_is_written() {
    let room = room();
    let arguments = ["cosim", "--scpus", "1", "--pairs", "diamond:2", "--trace", "wave.vcd"];
    let told = String::from_utf8_lossy(&afu(room.path(), &arguments).success().get_output().stdout).into_owned();
    assert!(told.ends_with("waves: open them with `gtkwave wave.vcd` or `surfer wave.vcd`\n"), "{told}");
    let wave = fs::read_to_string(room.path().join("wave.vcd")).expect("written");
    assert!(wave.contains("$enddefinitions") && wave.contains("afu_tx_rd_valid"));
}
