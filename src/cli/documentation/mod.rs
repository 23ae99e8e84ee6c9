//! Tests that hold what the documentation says of the command line: the page made from the help texts, every command
//! line, every path and every link. They are here because only the program has clap's [`Command`](clap::Command).

mod afu_line;
mod cargo_line;
mod code;
mod links;
mod markdown;
mod options;

use std::fs;
use std::path::{Path, PathBuf};

/// The repository.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A text of the repository, as Markdown.
struct Page {
    /// Relative to the repository.
    path: PathBuf,
    text: String,
}

/// The Markdown files of the repository's root, docs, rtl and tb.
fn pages() -> Vec<Page> {
    let mut paths: Vec<PathBuf> =
        ["README.md", "ARCHITECTURE.md", "CHANGELOG.md"].into_iter().map(PathBuf::from).collect();
    let mut folders: Vec<PathBuf> = ["docs", "rtl", "tb"].into_iter().map(PathBuf::from).collect();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(root().join(&folder)).expect("a folder of the repository") {
            let entry = entry.expect("a readable folder");
            let path = folder.join(entry.file_name());
            if entry.path().is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "md") {
                paths.push(path);
            }
        }
    }
    paths.sort();
    paths.into_iter().map(|path| Page { text: read(&path), path }).collect()
}

/// The comments of the example scenes and links, as Markdown with the lines of the files.
fn comments() -> Vec<Page> {
    let folders = ["examples/scenes", "examples/links"];
    let entries = folders.iter().flat_map(|folder| fs::read_dir(root().join(folder)).expect("a folder"));
    let toml = entries.map(|entry| entry.expect("a readable folder").path());
    toml.map(|path| {
        let path = path.strip_prefix(root()).expect("below it").to_owned();
        let comment = |line: &str| line.split_once("# ").map_or(String::new(), |(_, text)| text.to_owned());
        Page { text: read(&path).lines().map(comment).collect::<Vec<_>>().join("\n"), path }
    })
    .collect()
}

/// The long options of all commands, with their dashes.
fn options_of_afu() -> Vec<String> {
    let command = super::usage::command();
    let all = command.get_subcommands().flat_map(clap::Command::get_arguments);
    all.filter_map(clap::Arg::get_long).map(|name| format!("--{name}")).chain(["--version".to_owned()]).collect()
}

fn read(path: &Path) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
