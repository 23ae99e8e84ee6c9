//! Files of spheres (CSV `x,y,z,r`, or npy n × 4) and of the spheres that touch.

use std::path::Path;

use super::sphere::WORDS;
use super::{Hit, Sphere, SphereSet, SphereSetError, Spheres};
use crate::pairs::{Columns, FileError, Rounded, Words, read_records, write_records, write_touching};

/// Why spheres could not be loaded.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// A set's name is wrong.
    #[error(transparent)]
    Set(#[from] SphereSetError),
    /// A file is wrong.
    #[error(transparent)]
    File(#[from] FileError),
}

/// The spheres of a named set (`diamond:10`, `gas:4096:0.1` with `seed`; `diamond:10+1000` is moved by so much along
/// each axis) or of a file, and which numbers of the file were rounded to binary32.
///
/// # Errors
/// Returns an error if the name or the file is wrong.
pub fn load(source: &str, seed: u64) -> Result<(Spheres, Option<Rounded>), LoadError> {
    let path = Path::new(source);
    if source.contains(':') && !path.exists() {
        let (set, distance) = moved(source).unwrap_or((source, 0.0));
        let Spheres { first, second } = set.parse::<SphereSet>()?.spheres(seed);
        let along = |spheres: Vec<Sphere>| spheres.into_iter().map(|sphere| sphere.moved(distance)).collect();
        return Ok((Spheres { first: along(first), second: second.map(along) }, None));
    }
    let (first, rounded) = read_spheres(path)?;
    Ok((Spheres { first, second: None }, rounded))
}

/// The name of a set, and the distance behind its `+`: up to seven digits, all of which binary32 holds.
fn moved(source: &str) -> Option<(&str, f32)> {
    let (set, digits) = source.rsplit_once('+')?;
    let is_distance = (1..=7).contains(&digits.len()) && digits.bytes().all(|byte| byte.is_ascii_digit());
    Some((set, digits.parse().ok().filter(|_| is_distance)?))
}

/// The spheres of a `.csv` or `.npy` file, and which of its numbers were rounded to binary32. (Decimals in CSV are
/// always taken as the nearest binary32 number.)
///
/// # Errors
/// Returns an error if the file cannot be read or is not of that form.
pub fn read_spheres(file: &Path) -> Result<(Vec<Sphere>, Option<Rounded>), FileError> {
    let (records, rounded) = read_records(Columns::SPHERE, file)?;
    let sphere = |words: Words| Sphere(std::array::from_fn(|word| words[word]));
    Ok((records.into_iter().map(sphere).collect(), rounded))
}

/// Writes spheres to a `.csv` or `.npy` file, which is there whole or not at all.
///
/// # Errors
/// Returns an error if the name has another ending or the file cannot be written.
pub fn write_spheres(file: &Path, spheres: &[Sphere]) -> Result<(), FileError> {
    let words = |sphere: &Sphere| {
        let mut words = Words::default();
        words[..WORDS].copy_from_slice(&sphere.0);
        words
    };
    write_records(Columns::SPHERE, file, spheres.iter().map(words))
}

/// Writes the spheres that touch to a `.csv` or `.npy` file, which is there whole or not at all. Each row or record
/// begins with the numbers of the two spheres. The contact follows: in CSV its flow and numbers, in npy its eight
/// words.
///
/// # Errors
/// Returns an error if the name has another ending or the file cannot be written.
pub fn write_hits(file: &Path, hits: &[Hit]) -> Result<(), FileError> {
    write_touching(file, &hits.iter().map(|hit| (hit.spheres, hit.contact)).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::query::ContactRecord;

    #[test]
    fn spheres_come_back_as_they_were() {
        let folder = tempfile::tempdir().expect("a folder");
        let spheres = [[0.1, -0.0, 1e-45, 3.0], [f32::NAN, f32::INFINITY, 2.5, -1.0]].map(Sphere::new);
        for name in ["s.csv", "s.npy"] {
            let file = folder.path().join(name);
            write_spheres(&file, &spheres).expect("written");
            assert_eq!(read_spheres(&file).expect("read"), (spheres.to_vec(), None), "{name}");
            assert_eq!(load(&file.display().to_string(), 1).expect("loaded").0.first, spheres);
        }
    }

    #[test]
    fn a_set_is_moved_along_each_axis() {
        let [here, there] = ["probes:3:5", "probes:3:5+1000"].map(|name| load(name, 1).expect("a set").0);
        let by = |sphere: &Sphere| {
            let [x, y, z, r] = sphere.values();
            Sphere::new([x + 1000.0, y + 1000.0, z + 1000.0, r])
        };
        assert_eq!(there.first, here.first.iter().map(by).collect::<Vec<_>>());
        assert_eq!(there.second, here.second.map(|second| second.iter().map(by).collect()));
    }

    #[test]
    fn a_wrong_file_is_told_by_line_and_field() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("s.csv");
        std::fs::write(&file, "x,y,z,r\n1,2,3,4\n1,2,three,4\n").expect("written");
        let error = load(&file.display().to_string(), 1).expect_err("wrong").to_string();
        assert!(error.contains("s.csv, line 3, field z:"), "{error}");
        for bad in ["gas:5:0.1+", "gas:5:0.1+-1", "gas:5:0.1+12345678", "gas:5:0.1+1+1"] {
            load(bad, 1).expect_err(bad);
        }
        let error = load("gas:x:0.1", 1).expect_err("wrong").to_string();
        assert!(error.contains("expected a number of spheres"), "{error}");
        let pairs = folder.path().join("p.npy");
        crate::pairs::write_pairs(Default::default(), &pairs, &[Default::default()]).expect("written");
        let error = read_spheres(&pairs).expect_err("pairs").to_string();
        assert!(error.contains("shape: expected [n, 4], found [1, 8]"), "{error}");
    }

    #[test]
    fn hits_name_their_spheres_and_their_contact() {
        let folder = tempfile::tempdir().expect("a folder");
        let [a, b, c, d, e, f, g] = [1.0_f32, 2.0, 3.0, 0.0, 1.0, 0.0, 0.25].map(f32::to_bits);
        let contact = ContactRecord([a, b, c, d, e, f, g, 7]);
        let hits = [Hit { spheres: [3, 17], contact }];
        let file = folder.path().join("h.csv");
        write_hits(&file, &hits).expect("written");
        let text = std::fs::read_to_string(&file).expect("read");
        let expected =
            "first,second,flow,pos_x,pos_y,pos_z,normal_x,normal_y,normal_z,depth\n3,17,real,1,2,3,0,1,0,0.25\n";
        assert_eq!(text, expected);
        let file = folder.path().join("h.npy");
        write_hits(&file, &hits).expect("written");
        let bytes = std::fs::read(&file).expect("read");
        let (_, words) = bytes.split_at(bytes.len() - 40);
        let words: Vec<u32> = words.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
        assert_eq!(words, [3, 17, a, b, c, d, e, f, g, 7]);
    }
}
