//! What the checks need of a Markdown text: its code, its links and its headings.

use std::collections::HashMap;

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};

/// A piece of code.
#[derive(Debug, PartialEq)]
pub struct Code {
    /// The line of the file, from 1.
    pub line: usize,
    /// One line of a block, or a whole span.
    pub text: String,
    /// Whether it is a line of a block, not a span within a sentence.
    pub is_block: bool,
}

/// The languages of blocks that hold commands; an indented block has none.
const SHELL: [&str; 5] = ["", "sh", "bash", "console", "shell"];

fn parser(text: &str) -> impl Iterator<Item = (Event<'_>, std::ops::Range<usize>)> {
    Parser::new_ext(text, Options::ENABLE_TABLES | Options::ENABLE_FOOTNOTES).into_offset_iter()
}

fn line_of(text: &str, offset: usize) -> usize {
    1 + text[..offset].matches('\n').count()
}

/// The code spans, and the lines of code blocks that hold commands. A line that ends in `\` continues in the next.
pub fn code(text: &str) -> Vec<Code> {
    let mut found = Vec::new();
    let mut is_shell = None;
    let mut whole = String::new();
    for (event, range) in parser(text) {
        match event {
            Event::Start(Tag::CodeBlock(kind)) => {
                is_shell = Some(match kind {
                    CodeBlockKind::Indented => true,
                    CodeBlockKind::Fenced(language) => SHELL.contains(&&*language),
                });
            }
            Event::End(TagEnd::CodeBlock) => is_shell = None,
            Event::Text(block) if is_shell == Some(true) => {
                let first = line_of(text, range.start);
                for (index, line) in block.lines().enumerate() {
                    whole += line;
                    if let Some(begin) = whole.strip_suffix('\\') {
                        whole = begin.to_owned();
                    } else {
                        found.push(Code { line: first + index, text: std::mem::take(&mut whole), is_block: true });
                    }
                }
            }
            Event::Code(span) => {
                found.push(Code { line: line_of(text, range.start), text: span.to_string(), is_block: false });
            }
            _ => {}
        }
    }
    found
}

/// The targets of links and pictures, each with its line.
pub fn links(text: &str) -> Vec<(usize, String)> {
    let target = |event: Event| match event {
        Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => Some(dest_url.to_string()),
        _ => None,
    };
    parser(text).filter_map(|(event, range)| Some((line_of(text, range.start), target(event)?))).collect()
}

/// The anchors of the headings, as GitHub makes them: lower case, `-` for a space, no punctuation, numbered if equal.
pub fn anchors(text: &str) -> Vec<String> {
    let mut anchors = Vec::new();
    let mut heading: Option<String> = None;
    let mut uses: HashMap<String, u32> = HashMap::new();
    for (event, _) in parser(text) {
        match event {
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::Text(part) | Event::Code(part) => {
                if let Some(heading) = &mut heading {
                    *heading += &part;
                }
            }
            Event::End(TagEnd::Heading(_)) => {
                let slug = slug(&heading.take().unwrap_or_default());
                let count = uses.entry(slug.clone()).or_default();
                anchors.push(if *count == 0 { slug } else { format!("{slug}-{count}") });
                *count += 1;
            }
            _ => {}
        }
    }
    anchors
}

/// The anchor of a heading.
pub fn slug(heading: &str) -> String {
    let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.flat_map(char::to_lowercase).map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[test]
fn code_links_and_anchors_are_found_with_their_lines() {
    let text =
        "# A `b` c, d\n\nuse `afu x` [here](y.md#z)\n\n    afu a \\\n      b\n\n```text\noutput\n```\n\n## A\n\n## A\n";
    let span = |line, text: &str| Code { line, text: text.to_owned(), is_block: false };
    let block = Code { line: 6, text: "afu a   b".to_owned(), is_block: true };
    assert_eq!(code(text), [span(1, "b"), span(3, "afu x"), block]);
    assert_eq!(links(text), [(3, "y.md#z".to_owned())]);
    assert_eq!(anchors(text), ["a-b-c-d", "a", "a-1"]);
}
