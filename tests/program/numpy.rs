//! docs/numpy.md is a program: its Python blocks run one after the other, unchanged.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use assert_cmd::cargo::cargo_bin;

/// The blocks of Python in docs/numpy.md.
fn program() -> String {
    let page = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/numpy.md")).expect("the page");
    let blocks = page.split("```python\n").skip(1);
    let blocks: Vec<&str> = blocks.map(|rest| rest.split_once("```").expect("the end of a block").0).collect();
    assert!(blocks.len() > 5, "the page has {} blocks of Python", blocks.len());
    blocks.join("\n")
}

/// Runs `program` with numpy in an empty folder, with the `afu` of this build first on the path.
fn run(program: &str) -> Result<(), String> {
    let room = tempfile::tempdir().expect("a folder");
    fs::write(room.path().join("page.py"), program).expect("written");
    let afu = cargo_bin("afu");
    let folders = env::var_os("PATH").unwrap_or_default();
    let folders: Vec<PathBuf> =
        afu.parent().map(Path::to_owned).into_iter().chain(env::split_paths(&folders)).collect();
    let python = Path::new(env!("CARGO_MANIFEST_DIR")).join(".venv/bin/python");
    let output = Command::new(python)
        .arg("page.py")
        .current_dir(room.path())
        .env("PATH", env::join_paths(folders).expect("a path"))
        .output()
        .expect("scripts/setup --test installs Python and numpy");
    if output.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&output.stderr).into_owned()) }
}

#[test]
fn the_page_runs_as_it_stands() {
    run(&program()).expect("docs/numpy.md runs");
}

/// The check can fail: the page with a wrong index of the depth does not pass.
#[test]
fn a_wrong_word_is_noticed() {
    let wrong = program().replacen("numbers[:, 6]", "numbers[:, 5]", 1);
    let why = run(&wrong).expect_err("word 5 is not the depth");
    assert!(why.contains("np.allclose(depth[touching]"), "{why}");
}
