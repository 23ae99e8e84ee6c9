//! Writes the files of a study beside its measurements.

use super::columns::COLUMNS;
use super::{Study, Time, page, picture};
use crate::report::folder::{self, replace_csv, replace_file, replace_json};
use std::path::Path;
use std::{fs, io};

/// Writes report.html, front.svg (latency of a single pair), throughput.svg (if areas are known), link.svg, results.csv
/// and results.json into a folder. Each file is replaced as a whole, and no file of an earlier run stays.
///
/// # Errors
/// Returns an error if the file system refuses.
pub fn write(results: &Study, folder: &Path) -> Result<(), folder::Error> {
    replace_json(&folder.join("results.json"), results)?;
    replace_csv(&folder.join("results.csv"), |out| csv(results, out))?;
    for (name, time) in [("front.svg", Time::Lone), ("throughput.svg", Time::Device), ("link.svg", Time::Link)] {
        match results.times().contains(&time) {
            true => replace_file(&folder.join(name), picture(results, time).svg().as_bytes())?,
            false => remove(&folder.join(name))?,
        }
    }
    replace_file(&folder.join("report.html"), page(results).as_bytes())
}

fn remove(path: &Path) -> Result<(), folder::Error> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            Err(folder::Error::Io { path: path.to_owned(), error })
        }
        _ => Ok(()),
    }
}

fn csv(results: &Study, out: &mut csv::Writer<Vec<u8>>) -> Result<(), csv::Error> {
    let heading = ["configuration", "axis", "profile"].into_iter().chain(COLUMNS.iter().map(|column| column.key));
    out.write_record(heading)?;
    for point in &results.points {
        let words = [point.name.clone(), point.axis.clone(), point.config.profile.to_string()];
        let figure = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        let figures = COLUMNS.iter().map(|column| figure((column.value)(results, point)));
        out.write_record(words.into_iter().chain(figures))?;
    }
    Ok(())
}
