//! Project rules that a compiler does not check: which module may import which, the length of files, and forbidden
//! names.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The modules that each module may import; `ARCHITECTURE.md` draws them. A module may always import itself.
const HOUSE: &[(&str, &[&str])] = &[
    ("number", &[]),
    ("count", &[]),
    ("files", &[]),
    ("store", &["files"]),
    ("study", &["store", "files"]),
    ("hdl", &[]),
    ("plot", &[]),
    ("query", &["number"]),
    ("kernel", &["query", "number"]),
    ("pairs", &["count", "number", "query", "kernel", "files"]),
    ("spheres", &["pairs", "query", "kernel", "number"]),
    ("config", &["number", "query", "kernel", "spheres"]),
    ("record", &["number", "query", "kernel", "spheres", "config"]),
    ("ode", &["count", "pairs", "spheres", "query", "kernel"]),
    ("operator", &["hdl", "number"]),
    ("pipeline", &["operator", "query", "kernel", "hdl", "number"]),
    ("link", &["number"]),
    (
        "afu",
        &["count", "link", "record", "config", "pipeline", "operator", "spheres", "kernel", "query", "hdl", "number"],
    ),
    ("patience", &["link", "afu", "record", "config"]),
    ("outcome", &["link", "afu"]),
    (
        "cosim",
        &[
            "count", "outcome", "store", "query", "record", "config", "patience", "afu", "link", "pairs", "number",
            "files",
        ],
    ),
    (
        "host",
        &[
            "count", "outcome", "query", "record", "cosim", "patience", "link", "afu", "config", "spheres", "kernel",
            "number",
        ],
    ),
    (
        "verify",
        &["count", "query", "record", "host", "cosim", "link", "pairs", "spheres", "afu", "config", "kernel", "number"],
    ),
    ("tools", &["cosim"]),
    (
        "synth",
        &[
            "count", "study", "store", "query", "record", "tools", "config", "afu", "pipeline", "operator", "hdl",
            "number", "files",
        ],
    ),
    (
        "report",
        &[
            "count", "study", "query", "record", "plot", "synth", "verify", "host", "tools", "cosim", "config", "afu",
            "link", "pairs", "number", "files",
        ],
    ),
    (
        "accuracy",
        &[
            "count", "study", "store", "query", "record", "report", "plot", "tools", "synth", "verify", "host",
            "cosim", "config", "ode", "afu", "link", "pairs", "kernel", "number",
        ],
    ),
    (
        "paper",
        &[
            "count", "query", "store", "report", "plot", "verify", "host", "cosim", "config", "ode", "afu", "link",
            "pairs", "kernel", "number",
        ],
    ),
    (
        "scene",
        &[
            "count", "spheres", "query", "record", "report", "plot", "synth", "ode", "config", "afu", "pipeline",
            "link", "kernel", "pairs", "number",
        ],
    ),
    (
        "sweep",
        &[
            "study", "store", "count", "spheres", "query", "record", "report", "plot", "synth", "verify", "host",
            "cosim", "config", "afu", "link", "pairs", "number",
        ],
    ),
];

/// A longer file should be split.
const LINES: usize = 420;

fn files(folder: &str, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)];
    while let Some(folder) = open.pop() {
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        for entry in entries {
            let path = entry.expect("a readable folder").path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| extensions.iter().any(|known| e == *known)) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn short(path: &Path) -> String {
    path.strip_prefix(env!("CARGO_MANIFEST_DIR")).unwrap_or(path).display().to_string()
}

/// The modules that a line of code names through `crate::`, in a `use` (including braces) or in a path.
fn imported(line: &str) -> Vec<String> {
    let code = line.split("//").next().unwrap_or_default();
    let mut names = Vec::new();
    for (_, rest) in code.match_indices("crate::").map(|(at, word)| (at, &code[at + word.len()..])) {
        let mut depth = 0;
        let mut word = String::new();
        for c in rest.chars().chain([';']) {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                c if c.is_alphanumeric() || c == '_' => {
                    word.push(c);
                    continue;
                }
                _ => {}
            }
            if !word.is_empty() {
                names.push(std::mem::take(&mut word));
            }
            // A path names one module. A list in braces names one after each comma.
            if depth == 0 {
                break;
            }
        }
    }
    names
}

/// Imports of modules above or beside this one.
fn strays(module: &str, source: &str) -> Vec<String> {
    let allowed: BTreeMap<_, _> = HOUSE.iter().copied().collect();
    let Some(allowed) = allowed.get(module) else { return vec![format!("`{module}` is not in the house")] };
    let known = |name: &str| HOUSE.iter().any(|(module, _)| *module == name);
    let mut wrong = Vec::new();
    for (number, line) in source.lines().enumerate() {
        for name in imported(line) {
            if known(&name) && name != module && !allowed.contains(&name.as_str()) {
                wrong.push(format!("line {}: `{module}` may not import `{name}`", number + 1));
            }
        }
    }
    wrong
}

/// The documented steps for a new query match the files of the last one.
#[test]
fn the_way_of_a_new_query_is_written_down() {
    let page = text(&Path::new(env!("CARGO_MANIFEST_DIR")).join("ARCHITECTURE.md"));
    let (_, section) = page.split_once("## A new query").expect("the section");
    let section = section.split("\n## ").next().unwrap_or_default();
    let steps = section.split_once("1. ").map_or("", |(_, steps)| steps).split("\n\n").next().unwrap_or_default();
    let mut listed: Vec<&str> = steps.split('`').filter(|word| word.starts_with("src/")).collect();
    listed.sort_unstable();
    let names_it = |path: &PathBuf| {
        let code = text(path);
        let code = code.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        path.ends_with("sphere_plane.rs") || code.contains("sphere_plane") || code.contains("SpherePlane")
    };
    let touched: Vec<String> = files("src", &["rs"]).iter().filter(|path| names_it(path)).map(|p| short(p)).collect();
    assert_eq!(touched, listed, "ARCHITECTURE.md lists what a new query takes");
}

#[test]
fn imports_go_down_only() {
    let mut wrong = Vec::new();
    for path in files("src", &["rs"]) {
        let name = short(&path);
        let mut parts = name.split('/').skip(1);
        let module = parts.next().expect("a file in src").trim_end_matches(".rs").to_owned();
        if ["lib", "main", "cli"].contains(&module.as_str()) {
            continue;
        }
        wrong.extend(strays(&module, &text(&path)).into_iter().map(|what| format!("{name}: {what}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_stray_import_is_seen() {
    assert_eq!(strays("kernel", "use crate::number::Format;\n").len(), 0);
    assert_eq!(strays("kernel", "use crate::hdl::Graph;\n").len(), 1);
    assert_eq!(strays("number", "fn f(x: crate::query::Fields) {}\n").len(), 1);
    assert_eq!(strays("hdl", "use crate::{number::Format, hdl::Graph};\n").len(), 1);
    assert_eq!(strays("garden", "").len(), 1);
}

#[test]
fn a_file_is_one_thing() {
    let sources = ["src", "tests", "examples", "benches", "tb"].map(|f| files(f, &["rs", "h", "cpp"])).concat();
    let long: Vec<_> =
        sources.iter().map(|p| (short(p), text(p).lines().count())).filter(|(_, lines)| *lines > LINES).collect();
    assert!(long.is_empty(), "more than {LINES} lines: {long:?}");
}

/// The formatter does not wrap comments.
#[test]
fn comments_keep_to_the_width_of_code() {
    let is_wide = |line: &&str| line.trim_start().starts_with("//") && line.chars().count() > 120;
    let sources = ["src", "tests", "examples", "benches"].map(|folder| files(folder, &["rs"])).concat();
    let wide: Vec<_> = sources
        .iter()
        .flat_map(|path| {
            text(path).lines().filter(is_wide).map(|line| format!("{}: {line}", short(path))).collect::<Vec<_>>()
        })
        .collect();
    assert!(wide.is_empty(), "{wide:#?}");
}

#[test]
fn no_file_names_a_registry_host_or_a_path_of_one_machine() {
    // Written in pieces, so that this file does not contain these names.
    let hosts = ["deb.deb~ian.org", "pypi~.org", "pythonhosted~.org", "crates~.io", "npmjs~.org"];
    let paths = ["/wo~rk/", "/fa~rm/", "/ho~me/", "/Us~ers/"];
    let words: Vec<String> = hosts.iter().chain(&paths).map(|word| word.replace('~', "")).collect();
    let mut checked = ["README.md", "ARCHITECTURE.md", "CHANGELOG.md", "Cargo.toml", "build.rs", ".ci/run"]
        .map(PathBuf::from)
        .to_vec();
    for path in &mut checked {
        *path = Path::new(env!("CARGO_MANIFEST_DIR")).join(&path);
    }
    for folder in ["src", "tests", "examples", "benches", "tb", "rtl", "scripts", "docs"] {
        checked.extend(files(folder, &["rs", "h", "cpp", "v", "sv", "md", "json", "core", "f", "toml", "sdc", "xdc"]));
    }
    for name in [
        "demo",
        "docs",
        "fit-delays",
        "intervals",
        "operators",
        "paper",
        "prove",
        "release",
        "setup",
        "spheres",
        "test",
    ] {
        checked.push(Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts").join(name));
    }
    for name in ["local", "merge", "rehearse", "site.conf", "submit", "task"] {
        checked.push(Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/slurm").join(name));
    }
    for name in ["pyproject.toml", ".github/workflows/ci.yml", "scripts/packaging/test", "scripts/packaging/wheel"] {
        checked.push(Path::new(env!("CARGO_MANIFEST_DIR")).join(name));
    }
    checked.extend(files("scripts", &["py"]));
    let mut found = Vec::new();
    checked.retain(|path| path.exists());
    assert!(checked.len() > 20, "the files are where this test looks");
    for path in &checked {
        for (number, line) in text(path).lines().enumerate() {
            found.extend(
                words.iter().filter(|w| line.contains(*w)).map(|w| format!("{}:{}: {w}", short(path), number + 1)),
            );
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn the_readme_shows_the_example_as_it_is() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let example = text(&root.join("examples/verify.rs"));
    let readme = text(&root.join("README.md"));
    assert!(readme.contains(&format!("```rust\n{example}```")), "README.md must hold examples/verify.rs verbatim");
    assert!(example.lines().count() < 30, "an example of a test is short");
}

/// Dependencies that only the program needs are not compiled for other crates.
#[test]
fn the_library_compiles_nothing_of_the_program_s() {
    let program = ["anyhow", "clap", "clap_complete", "indicatif"];
    let tree = |features: &str| {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let output = Command::new(cargo)
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .args(["tree", "--locked", "--offline", "-e", "normal,build", "--prefix", "none", "--format", "{p}"])
            .args(["--no-default-features", "--features", features])
            .output()
            .expect("cargo runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = String::from_utf8(output.stdout).expect("UTF-8");
        let names: Vec<_> = text.lines().filter_map(|line| line.split(' ').next().map(str::to_owned)).collect();
        program.into_iter().filter(|name| names.iter().any(|found| found == name)).collect::<Vec<_>>()
    };
    assert_eq!(tree("cosim"), [""; 0]);
    assert_eq!(tree("cli"), program);
}
