//! The command line's contract: what it says, where, and how it exits.

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
    assert_eq!(text(&version.get_output().stdout), concat!("afu ", env!("CARGO_PKG_VERSION"), "\n"));
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
    // Whether tools are missing is this machine's affair: 0 or 3.
    let output = Command::cargo_bin("afu").expect("built").args(["doctor", "--json", "-"]).output().expect("runs");
    assert!(matches!(output.status.code(), Some(0 | 3)), "{output:?}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON alone on standard output");
    assert_eq!(report["schema"], "contact-afu/doctor/1");
    let said = text(&output.stderr);
    for tool in report["tools"].as_array().expect("a list") {
        assert!(said.contains(tool["name"].as_str().expect("a name")), "{said}");
        assert!(tool["install"].as_str().is_some_and(|command| !command.is_empty()));
    }
}

#[test]
fn doctor_without_a_compiler_is_exit_3_and_says_the_command() {
    let mut command = Command::cargo_bin("afu").expect("built");
    let assert = command.args(["doctor"]).env("CXX", "no-such-compiler").assert().code(3);
    let said = text(&assert.get_output().stderr);
    assert!(said.contains("C++ compiler is missing; install it with: "), "{said}");
}
