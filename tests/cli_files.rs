//! Files of pairs on the command line: made, read, and refused with one line that says where.

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

/// A fault once: results for a device became a file in its place.
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
