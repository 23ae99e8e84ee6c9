//! Reads the ports of a Verilated module from Verilator's header, so that one harness serves every module.

use std::fs;
use std::path::Path;

use super::Error;

/// One port.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Port {
    /// The name in the Verilog.
    name: String,
    /// The name in the C++ class. Verilator renames words that C++ reserves.
    member: String,
    bits: u32,
    input: bool,
}

/// Reads lines such as `VL_IN8(&clk,0,0);` and `VL_OUTW(&data,511,0,16);`.
pub(super) fn read(header: &Path) -> Result<Vec<Port>, Error> {
    let text = fs::read_to_string(header).map_err(|e| Error::io("read", header, e))?;
    let unexpected = |what: String| Error::Unexpected { path: header.to_owned(), what };
    let mut ports = Vec::new();
    for line in text.lines().map(str::trim) {
        let input = line.starts_with("VL_IN");
        if line.starts_with("VL_INOUT") {
            return Err(unexpected(format!("`{line}`: bidirectional ports are not supported")));
        }
        if input || line.starts_with("VL_OUT") {
            ports.push(parse(line, input).ok_or_else(|| unexpected(format!("cannot read the port `{line}`")))?);
        }
    }
    if ports.is_empty() {
        return Err(unexpected("declares no port".to_owned()));
    }
    Ok(ports)
}

fn parse(line: &str, input: bool) -> Option<Port> {
    let (_, rest) = line.split_once('(')?;
    let mut fields = rest.split_once(')')?.0.split(',').map(str::trim);
    let member = fields.next()?.trim_start_matches('&').to_owned();
    let (high, low): (u32, u32) = (fields.next()?.parse().ok()?, fields.next()?.parse().ok()?);
    let bits = high.checked_sub(low)? + 1;
    Some(Port { name: verilog_name(&member), member, bits, input })
}

/// Undoes Verilator's renaming: `__SYM__` before C++ words, `__0` and two hex digits for other characters.
fn verilog_name(member: &str) -> String {
    let plain = member.strip_prefix("__SYM__").unwrap_or(member);
    let mut name = String::new();
    let mut rest = plain;
    while let Some((before, after)) = rest.split_once("__0") {
        name.push_str(before);
        match after.get(..2).and_then(|code| u8::from_str_radix(code, 16).ok()) {
            Some(code) => {
                name.push(char::from(code));
                rest = &after[2..];
            }
            None => {
                name.push_str("__0");
                rest = after;
            }
        }
    }
    name + rest
}

/// `ports.inc`, which `tb/harness.cpp` includes.
pub(super) fn include_file(ports: &[Port]) -> String {
    let line = |port: &Port| {
        let direction = if port.input { "AFU_INPUT" } else { "AFU_OUTPUT" };
        format!("AFU_PORT(\"{}\", {}, {direction}, {})\n", port.name, port.bits, port.member)
    };
    ports.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_scalars_words_and_renamed_ports() {
        let port =
            |name: &str, member: &str, bits, input| Port { name: name.into(), member: member.into(), bits, input };
        assert_eq!(parse("VL_IN8(&clk,0,0);", true), Some(port("clk", "clk", 1, true)));
        assert_eq!(parse("VL_OUTW(&data,511,0,16);", false), Some(port("data", "data", 512, false)));
        assert_eq!(parse("VL_IN8(&__SYM__abort,0,0);", true), Some(port("abort", "__SYM__abort", 1, true)));
        assert_eq!(parse("VL_IN64(a___05Fb,57,0);", true), Some(port("a__b", "a___05Fb", 58, true)));
        assert_eq!(parse("VL_IN8(broken);", true), None);
    }
}
