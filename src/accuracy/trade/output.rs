//! What a study leaves in its folder beside its store.

use super::columns::COLUMNS;
use super::{ResultsError, Study, Time, page, picture};
use crate::report::folder::replace_file;
use std::path::Path;
use std::{fs, io};

/// Writes report.html, front.svg (a lone pair), throughput.svg (where areas are known), link.svg, results.csv and
/// results.json into a folder that [`run`](super::run) made; each is replaced whole, and none of an earlier run stays.
///
/// # Errors
/// When the file system refuses.
pub fn write(results: &Study, folder: &Path) -> Result<(), ResultsError> {
    let file = |name: &str, text: &[u8]| replace_file(&folder.join(name), text);
    let mut json = serde_json::to_vec_pretty(results).map_err(ResultsError::write)?;
    json.push(b'\n');
    file("results.json", &json)?;
    file("results.csv", &csv(results)?)?;
    for (name, time) in [("front.svg", Time::Lone), ("throughput.svg", Time::Device), ("link.svg", Time::Link)] {
        match results.times().contains(&time) {
            true => file(name, picture(results, time).svg().as_bytes())?,
            false => remove(&folder.join(name))?,
        }
    }
    Ok(file("report.html", page(results).as_bytes())?)
}

fn remove(path: &Path) -> Result<(), ResultsError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(ResultsError::Io { path: path.to_owned(), error }),
        _ => Ok(()),
    }
}

fn csv(results: &Study) -> Result<Vec<u8>, ResultsError> {
    let mut out = csv::Writer::from_writer(Vec::new());
    let heading = ["configuration", "axis", "profile"].into_iter().chain(COLUMNS.iter().map(|column| column.key));
    out.write_record(heading).map_err(ResultsError::write)?;
    for point in &results.points {
        let words = [point.name.clone(), point.axis.clone(), point.config.profile.to_string()];
        let figure = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        let figures = COLUMNS.iter().map(|column| figure((column.value)(results, point)));
        out.write_record(words.into_iter().chain(figures)).map_err(ResultsError::write)?;
    }
    out.into_inner().map_err(ResultsError::write)
}
