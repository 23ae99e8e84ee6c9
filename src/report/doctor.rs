//! The report of `afu doctor`.

use serde::Serialize;

use crate::tools::{FEATURES, Feature, Tool};

/// The findings for other programs.
#[derive(Serialize)]
pub struct Report<'a> {
    schema: &'static str,
    version: &'static str,
    features: &'static [Feature],
    tools: &'a [Tool],
}

impl<'a> Report<'a> {
    /// The report about these tools.
    pub fn new(tools: &'a [Tool]) -> Self {
        Self { schema: "contact-afu/doctor/1", version: env!("CARGO_PKG_VERSION"), features: &FEATURES, tools }
    }
}

/// The findings for people: one paragraph per feature and per tool, because versions are long.
pub fn text(tools: &[Tool]) -> String {
    let mut lines = Vec::new();
    for feature in &FEATURES {
        let found = if feature.built_in { "built in" } else { "NOT BUILT IN" };
        lines.push(format!("{:<16}{found}", format!("feature {}", feature.name)));
        lines.push(format!("{:<16}for {}", "", feature.needed_for));
        if !feature.built_in {
            lines.push(format!("{:<16}build this program with: --features {}", "", feature.name));
        }
    }
    for tool in tools {
        let found = tool.found.as_deref().unwrap_or("MISSING");
        lines.push(format!("{:<16}{found}", tool.name));
        lines.push(format!("{:<16}for {}", "", tool.needed_for));
        if tool.found.is_none() {
            lines.push(format!("{:<16}install with: {}", "", tool.install));
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_tool_comes_with_its_command() {
        let tool = |found| Tool { name: "T", found, needed_for: "tests", required: true, install: "get t" };
        let text = text(&[tool(Some("T 1.0".into())), tool(None)]);
        assert_eq!(text.matches("install with: get t").count(), 1);
        assert!(text.contains("T 1.0") && text.contains("MISSING"));
    }
}
