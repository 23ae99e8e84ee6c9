//! Errors in CSV files that common tools write, with the option of the tool that avoids each.

use csv::StringRecord;

/// The error for a header that pandas or NumPy writes by default. `None` if its fault is unknown.
pub fn of_header(record: &StringRecord, columns: &[&str]) -> Option<String> {
    let first = record.get(0).unwrap_or_default();
    let header = columns.join(",");
    let is_known = |name: &str| columns.contains(&name.trim());
    if first.starts_with('#') {
        return Some(format!(
            "expected the header {header}, found one that begins with `#` (numpy.savetxt: comments=\"\")"
        ));
    }
    for (separator, name) in [(';', "`;`"), ('\t', "tabs"), ('|', "`|`"), (' ', "spaces")] {
        if record.len() == 1 && first.split(separator).filter(|name| is_known(name)).count() > 1 {
            return Some(format!(
                "columns are separated by {name}; separate them by commas (pandas: sep=\",\", numpy.savetxt: delimiter=\",\")"
            ));
        }
    }
    if record.iter().any(|name| name.is_empty() || name == "index" || name.starts_with("Unnamed: ")) {
        return Some("found an index column among the pair's columns; leave it out (pandas: index=False)".to_owned());
    }
    if record.iter().all(|name| name.split_whitespace().all(|part| part.parse::<f64>().is_ok())) {
        return Some(format!(
            "expected the header {header}, found `{first}` (numpy.savetxt: header=\"{header}\", comments=\"\")"
        ));
    }
    None
}

/// The error for a row that holds no pair.
pub fn of_row(record: &StringRecord) -> Option<String> {
    let first = record.get(0).unwrap_or_default();
    first.starts_with('#').then(|| "comments are not supported: leave this line out".to_owned())
}

/// The error for a field that should be a number.
pub fn of_number(text: &str) -> String {
    if text.is_empty() {
        return "empty; write a number, or nan if it is unknown (pandas: na_rep=\"nan\")".to_owned();
    }
    let comment = if text.starts_with('#') { "; comments are not supported" } else { "" };
    format!("expected a number, found `{text}`{comment}")
}
