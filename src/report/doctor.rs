//! What `afu doctor` says.

use serde::Serialize;

use crate::tools::Tool;

/// The findings for other programs.
#[derive(Serialize)]
pub struct Report<'a> {
    schema: &'static str,
    version: &'static str,
    tools: &'a [Tool],
}

impl<'a> Report<'a> {
    /// Of these tools.
    pub fn new(tools: &'a [Tool]) -> Self {
        Self { schema: "contact-afu/doctor/1", version: env!("CARGO_PKG_VERSION"), tools }
    }
}

/// The findings for people: a paragraph a tool, for versions are long.
pub fn text(tools: &[Tool]) -> String {
    let mut lines = Vec::new();
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
