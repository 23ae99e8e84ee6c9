//! Every relative link of the documentation leads to a file and, with an anchor, to a heading.

use std::path::{Component, Path, PathBuf};

use super::{markdown, pages, read, root};

/// What is wrong with a link of the page at `path`, if anything.
fn fault(path: &Path, text: &str, link: &str) -> Option<String> {
    if link.contains("://") || link.starts_with("mailto:") {
        return None;
    }
    let (file, anchor) = link.split_once('#').map_or((link, None), |(file, anchor)| (file, Some(anchor)));
    let target = match file {
        "" => path.to_owned(),
        _ => normal(&path.parent().unwrap_or(Path::new("")).join(file)),
    };
    if !file.is_empty() && !root().join(&target).exists() {
        return Some(format!("link to {link}: {} does not exist", target.display()));
    }
    let anchor = anchor?;
    if target.extension().is_none_or(|extension| extension != "md") {
        return Some(format!("link to {link}: only Markdown has anchors"));
    }
    let anchors = markdown::anchors(&if file.is_empty() { text.to_owned() } else { read(&target) });
    let is_there = anchors.iter().any(|known| known == anchor);
    (!is_there).then(|| format!("link to {link}: expected one of the headings {}", anchors.join(", ")))
}

/// The path without `.` and `..`.
fn normal(path: &Path) -> PathBuf {
    let mut whole = PathBuf::new();
    for component in path.components() {
        match component {
            Component::ParentDir => {
                whole.pop();
            }
            Component::CurDir => {}
            other => whole.push(other),
        }
    }
    whole
}

#[test]
fn every_link_leads_somewhere() {
    let mut faults = Vec::new();
    for page in pages() {
        let found = markdown::links(&page.text).into_iter();
        let wrong = found.filter_map(|(line, link)| Some((line, fault(&page.path, &page.text, &link)?)));
        faults.extend(wrong.map(|(line, fault)| format!("{}:{line}: {fault}", page.path.display())));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_link_that_leads_nowhere_is_found() {
    let text = "# One heading\n";
    for (link, expected) in [
        ("no-such-page.md", "docs/no-such-page.md does not exist"),
        ("../docs/no-such-page.md#x", "does not exist"),
        ("#another-heading", "expected one of the headings one-heading"),
        ("../README.md#no-such-heading", "expected one of the headings"),
        ("../Cargo.toml#x", "only Markdown has anchors"),
    ] {
        let fault = fault(Path::new("docs/x.md"), text, link).expect(link);
        assert!(fault.contains(expected), "{fault}");
    }
    for good in ["https://example.org/x", "#one-heading", "../README.md", "img"] {
        assert_eq!(fault(Path::new("docs/x.md"), text, good), None);
    }
}
