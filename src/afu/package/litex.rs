//! The accelerator as a module of LiteX.

use super::super::shell::axi::most_lines;
use super::super::{Afu, file_list};

/// The text of the Python file.
pub(super) fn module(afu: &Afu) -> String {
    let spec = afu.spec();
    // Behind deciders the number of SCPUs is fixed.
    let (argument, parameter) = if spec.config.has_deciders() {
        (String::new(), "")
    } else {
        (format!("scpus={}, ", spec.config.scpus), "p_SCPUS=scpus, ")
    };
    let values = [
        ("@ORIGIN@", afu.origin()),
        ("@TOP@", afu.top_name()),
        ("@LIST@", file_list(&spec.config)),
        ("@FILE@", spec.config.prefixed("contact_afu_litex")),
        ("@BUS@", spec.config.bus.to_string()),
        ("@ARGUMENT@", argument),
        ("@PARAMETER@", parameter.to_owned()),
        ("@BURST_LINES@", most_lines(spec).to_string()),
    ];
    values.into_iter().fold(include_str!("litex.py").to_owned(), |text, (name, value)| text.replace(name, &value))
}
