//! Files of pairs on the command line: written, read, and rejected with one line that names the place.

use std::fs;
use std::path::Path;

use assert_cmd::Command;

fn afu(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("afu").expect("the program is built").current_dir(folder).args(arguments).assert()
}

#[test]
fn pairs_are_written_as_csv_and_npy() {
    let room = tempfile::tempdir().expect("a temporary folder");
    for (set, out, size) in [("diamond:3", "d.npy", 128 + 132 * 32), ("random:5", "r.npy", 128 + 5 * 32)] {
        afu(room.path(), &["pairs", set, "--out", out]).success();
        assert_eq!(fs::metadata(room.path().join(out)).expect("written").len(), size, "{set}");
    }
    afu(room.path(), &["pairs", "diamond:3", "--out", "d.csv"]).success();
    let text = fs::read_to_string(room.path().join("d.csv")).expect("written");
    assert_eq!(text.lines().next(), Some("x1,y1,z1,r1,x2,y2,z2,r2"));
    assert_eq!(text.lines().count(), 133);
}

#[test]
fn a_seed_decides_random_pairs() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let made = |seed: &str| {
        afu(room.path(), &["pairs", "random:100", "--seed", seed, "--out", "r.csv"]).success();
        fs::read(room.path().join("r.csv")).expect("written")
    };
    let (first, again, other) = (made("7"), made("7"), made("8"));
    assert_eq!(first, again);
    assert_ne!(first, other);
}

#[test]
fn pairs_go_to_standard_output() {
    let room = tempfile::tempdir().expect("a temporary folder");
    afu(room.path(), &["pairs", "hard:20", "--out", "p.csv"]).success();
    let assert = afu(room.path(), &["pairs", "hard:20", "--out", "-"]).success();
    assert_eq!(assert.get_output().stdout, fs::read(room.path().join("p.csv")).expect("written"));
    assert!(!room.path().join("-").exists());
}

/// Every error starts with the program's name, gives its cause once, and does not name a temporary file.
#[test]
fn an_error_is_told_once_and_with_one_prefix() {
    let room = tempfile::tempdir().expect("a temporary folder");
    for (arguments, expected) in [
        (&["pairs", "random:1e6", "--out", "x.csv"][..], "did you mean random:1000000?"),
        (&["pairs", "diamnd:3", "--out", "x.csv"], "did you mean diamond:3?"),
        (&["pairs", "random:3", "--seed", "-1", "--out", "x.csv"], "did you mean 1?"),
        (&["pairs", "random:3"], "--out <FILE>"),
        (&["rtl", "--scpus", "-1", "--out", "x"], "--scpus <N>"),
    ] {
        let said = String::from_utf8(afu(room.path(), arguments).code(2).get_output().stderr.clone()).expect("UTF-8");
        assert!(said.starts_with("afu: ") && said.contains(expected), "{said}");
    }
    let cause = "No such file or directory";
    let assert = afu(room.path(), &["pairs", "random:3", "--out", "no/such/x.csv"]).code(4);
    let said = String::from_utf8(assert.get_output().stderr.clone()).expect("UTF-8");
    assert_eq!(said.matches(cause).count(), 1, "{said}");
    // No file can be created in /proc, so creating a temporary file there fails.
    if Path::new("/proc/self").exists() {
        let assert = afu(room.path(), &["rtl", "--out", "/proc/build"]).code(4);
        let said = String::from_utf8(assert.get_output().stderr.clone()).expect("UTF-8");
        assert!(said.starts_with("afu: /proc/build: ") && !said.contains(".afu-"), "{said}");
        let assert = afu(room.path(), &["pairs", "random:3", "--out", "/proc/x.csv"]).code(4);
        let said = String::from_utf8(assert.get_output().stderr.clone()).expect("UTF-8");
        assert!(said.starts_with("afu: /proc/x.csv: ") && !said.contains(".afu-"), "{said}");
    }
}

#[cfg(feature = "cosim")]
#[test]
fn pairs_in_float64_run_with_a_note_of_what_was_rounded() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2, 4), }\n";
    let mut bytes = [&b"\x93NUMPY\x01\x00"[..], &(header.len() as u16).to_le_bytes(), header.as_bytes()].concat();
    bytes.extend([0.1, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0_f64].iter().flat_map(|value| value.to_le_bytes()));
    fs::write(room.path().join("p.npy"), bytes).expect("written");
    for option in ["--pairs", "--replay"] {
        let assert = afu(room.path(), &["cosim", option, "p.npy"]).success();
        let said = String::from_utf8(assert.get_output().stderr.clone()).expect("UTF-8");
        let note = "afu: p.npy: 1 of 8 numbers was rounded to binary32; the first is x1 of pair 0";
        assert!(said.contains(note), "{said}");
    }
}

#[test]
fn a_wrong_set_or_file_name_is_exit_2_and_writes_nothing() {
    let room = tempfile::tempdir().expect("a temporary folder");
    for arguments in [
        ["pairs", "diamond:0", "--out", "x.csv"],
        ["pairs", "cube:3", "--out", "x.csv"],
        ["pairs", "random:ten", "--out", "x.csv"],
        ["pairs", "diamond:3", "--out", "x.txt"],
    ] {
        let assert = afu(room.path(), &arguments).code(2);
        assert!(!assert.get_output().stderr.is_empty());
        assert_eq!(fs::read_dir(room.path()).expect("there").count(), 0, "{arguments:?}");
    }
}

/// A former fault: results for a device replaced it by a file.
#[cfg(unix)]
#[test]
fn a_pipe_is_written_and_stays_one() {
    use std::os::unix::fs::FileTypeExt;
    let room = tempfile::tempdir().expect("a temporary folder");
    for (name, arguments) in [
        ("pairs.csv", &["pairs", "random:3", "--out", "pairs.csv"][..]),
        ("found", &["choose", "--max-error", "1e-3", "--out", "found"]),
    ] {
        let pipe = room.path().join(name);
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || fs::read_to_string(pipe)
        });
        afu(room.path(), arguments).success();
        assert!(fs::metadata(&pipe).expect("there").file_type().is_fifo(), "{arguments:?}");
        let text = reader.join().expect("read").expect("text");
        assert!(text.lines().count() > 3, "{arguments:?}: {text}");
    }
}
