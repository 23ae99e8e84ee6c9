//! Files of pairs and contacts: what is written reads back the same, and errors are named.

use contact_afu::kernel::Reference;
use contact_afu::number::Format;
use contact_afu::pairs::{self, Set};
use contact_afu::query::{ContactRecord, Fields, PairRecord, Query};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn put(folder: &TempDir, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let file = folder.path().join(name);
    fs::write(&file, bytes).unwrap();
    file
}

/// The word of a number after CSV, which has only one NaN.
fn canonical(word: u32) -> u32 {
    if f32::from_bits(word).is_nan() { 0x7FC0_0000 } else { word }
}

#[test]
fn pairs_survive_both_formats() {
    let folder = folder();
    for set in [Set::Diamond(3), Set::Random(20_000), Set::Random(0)] {
        let expected = set.pairs(3);
        let npy = folder.path().join("pairs.npy");
        pairs::write_pairs(Query::SphereSphere, &npy, &expected).unwrap();
        assert_eq!(pairs::read_pairs(Query::SphereSphere, &npy).unwrap(), expected);
        let csv = folder.path().join("pairs.csv");
        pairs::write_pairs(Query::SphereSphere, &csv, &expected).unwrap();
        let canonical: Vec<_> = expected.iter().map(|pair| PairRecord(pair.0.map(canonical))).collect();
        assert_eq!(pairs::read_pairs(Query::SphereSphere, &csv).unwrap(), canonical);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "nothing is left beside the files");
    }
}

#[test]
fn contacts_survive_both_formats() {
    let folder = folder();
    for set in [Set::Random(20_000), Set::Random(0)] {
        let expected = Reference::new(Format::WIDE, Fields::ALL).run_all(&set.pairs(4));
        for name in ["contacts.npy", "contacts.CSV"] {
            let file = folder.path().join(name);
            pairs::write_contacts(&file, &expected).unwrap();
            assert_eq!(pairs::read_contacts(&file).unwrap(), expected);
        }
    }
}

#[test]
fn hits_survive_both_formats_with_their_numbers() {
    let folder = folder();
    let all = Reference::new(Format::WIDE, Fields::ALL).run_all(&Set::Random(5_000).pairs(4));
    let hits: Vec<_> = (0..).zip(all).filter(|(_, contact)| contact.is_contact()).collect();
    assert!(hits.len() > 1_000);
    for (expected, name) in [(&hits[..], "hits.csv"), (&hits, "hits.npy"), (&[], "none.csv"), (&[], "none.npy")] {
        let file = folder.path().join(name);
        pairs::write_hits(&file, expected).unwrap();
        assert_eq!(pairs::read_hits(&file).unwrap(), expected);
    }
    let text = fs::read_to_string(folder.path().join("hits.csv")).unwrap();
    assert_eq!(text.lines().nth(1).unwrap().split(',').next(), Some(hits[0].0.to_string().as_str()));
    // An array for numpy with nine words per record, the number first.
    let bytes = fs::read(folder.path().join("hits.npy")).unwrap();
    let header = String::from_utf8_lossy(&bytes[..128]).into_owned();
    assert!(header.contains("'<u4'") && header.contains(&format!("({}, 9)", hits.len())), "{header}");
    let data = &bytes[bytes.len() - 36 * hits.len()..];
    assert_eq!(data[..4], hits[0].0.to_le_bytes());
    // Records in another order are rejected.
    for name in ["hits.csv", "hits.npy"] {
        let file = folder.path().join(name);
        pairs::write_hits(&file, &[hits[1], hits[0]]).unwrap();
        let error = pairs::read_hits(&file).unwrap_err().to_string();
        assert!(error.contains(&hits[0].0.to_string()), "{error}");
    }
}

#[test]
fn csv_is_plain_to_read() {
    let folder = folder();
    let file = folder.path().join("pairs.csv");
    let pair = PairRecord::from_spheres([0.1, -0.0, 1e-45, f32::MAX], [16_777_216.0, f32::NAN, f32::INFINITY, 1.0]);
    pairs::write_pairs(Query::SphereSphere, &file, &[pair]).unwrap();
    let expected = "x1,y1,z1,r1,x2,y2,z2,r2\n0.1,-0,1e-45,3.4028235e38,16777216,NaN,inf,1\n";
    assert_eq!(fs::read_to_string(&file).unwrap(), expected);

    let file = folder.path().join("contacts.csv");
    let contacts = Reference::new(Format::BINARY32, Fields::ALL)
        .run_all(&[PairRecord::from_spheres([0.0, 0.0, 0.0, 0.5], [1.0, 0.0, 0.0, 0.5]), pair]);
    pairs::write_contacts(&file, &contacts).unwrap();
    let expected = "pair,flow,pos_x,pos_y,pos_z,normal_x,normal_y,normal_z,depth,invalid\n\
                    0,real,0.5,0,0,-1,0,0,0,0\n\
                    1,invalid,0,0,0,0,0,0,0,1\n";
    assert_eq!(fs::read_to_string(&file).unwrap(), expected);
}

#[test]
fn columns_stand_in_any_order_and_spaces_do_not_count() {
    let folder = folder();
    let file = put(&folder, "pairs.csv", "\u{feff}r2, r1,x1,y1,z1,x2,y2,z2\r\n8, 4,1,2,3,5,6,+7e0\r\n");
    let expected = PairRecord::from_spheres([1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0]);
    assert_eq!(pairs::read_pairs(Query::SphereSphere, &file).unwrap(), [expected]);
}

/// Another library reads our npy files, and we read its files.
#[test]
fn npy_is_understood_by_another_library() {
    use npyz::WriterBuilder;
    let folder = folder();
    let expected = Set::Diamond(3).pairs(0);
    let ours = folder.path().join("ours.npy");
    pairs::write_pairs(Query::SphereSphere, &ours, &expected).unwrap();
    let read = npyz::NpyFile::new(fs::File::open(&ours).unwrap()).unwrap();
    assert_eq!(read.shape(), [132, 8]);
    let values: Vec<f32> = read.into_vec().unwrap();
    assert!(values.into_iter().eq(expected.iter().flat_map(|pair| pair.values())));

    let theirs = folder.path().join("theirs.npy");
    let out = fs::File::create(&theirs).unwrap();
    let mut writer = npyz::WriteOptions::new().default_dtype().shape(&[132, 8]).writer(out).begin_nd().unwrap();
    writer.extend(expected.iter().flat_map(|pair| pair.values())).unwrap();
    writer.finish().unwrap();
    assert_eq!(pairs::read_pairs(Query::SphereSphere, &theirs).unwrap(), expected);
}

const HEADER: &str = "x1,y1,z1,r1,x2,y2,z2,r2\n";

fn spheres(file: &Path) -> Result<Vec<PairRecord>, pairs::FileError> {
    pairs::read_pairs(Query::SphereSphere, file)
}

/// The single error line for an invalid file, without its folder.
fn complaint<T: std::fmt::Debug>(read: fn(&Path) -> Result<T, pairs::FileError>, file: &Path) -> String {
    let error = read(file).unwrap_err().to_string();
    let name = file.display().to_string();
    assert!(error.starts_with(&name), "{error} names {name}");
    assert!(!error.contains('\n'), "{error}");
    error[name.len()..].to_owned()
}

#[test]
fn a_wrong_csv_is_named_by_line_and_field() {
    let folder = folder();
    for (text, expected) in [
        (String::new(), ", line 1: the file is empty; it must begin with the header x1,y1,z1,r1,x2,y2,z2,r2"),
        ("x1,y1,z1,r1,x2,y2,z2\n".into(), ", line 1, field r2: the header has no such column"),
        ("x1,y1,z1,r1,x2,y2,z2,r2,x1\n".into(), ", line 1, field x1: the header has this column twice"),
        ("a,b\n".into(), ", line 1: unknown column `a`: expected the header x1,y1,z1,r1,x2,y2,z2,r2"),
        (
            format!("{HEADER}1,2,3,4,5,6,7,8\n1,2,three,4,5,6,7,8\n"),
            ", line 3, field z1: expected a number, found `three`",
        ),
        (
            "x1,y1,z1,r1,x2,y2,z2,r2\r\n1,2,3,4,5,6,7,8\r\n1,2,3,x,5,6,7,8".into(),
            ", line 3, field r1: expected a number, found `x`",
        ),
        (format!("{HEADER}1,2,3,4,5,6,7\n"), ", line 2, field r2: missing: the line has 7 of 8 fields"),
        (
            format!("{HEADER}1,2,3,4,,6,7,8\n"),
            ", line 2, field x2: empty; write a number, or nan if it is unknown (pandas: na_rep=\"nan\")",
        ),
        (format!("{HEADER}\n\n1,2,3,4,5,6,7,8,9\n"), ", line 4: expected 8 fields, as in the header, found 9"),
        (format!("{HEADER}1,2,3,4,5,6,7,1e39\n"), ", line 2, field r2: `1e39` is beyond the largest binary32 number"),
    ] {
        let file = put(&folder, "pairs.csv", &text);
        assert_eq!(complaint(spheres, &file), expected, "{text}");
    }
    let file = put(&folder, "pairs.csv", [HEADER.as_bytes(), b"1,2,3,4,5,6,7,8\n1,\xFF,3,4,5,6,7,8\n"].concat());
    assert_eq!(complaint(spheres, &file), ", line 3: expected text in UTF-8");

    let header = "pair,flow,pos_x,pos_y,pos_z,normal_x,normal_y,normal_z,depth,invalid\n";
    for (line, expected) in [
        ("1,fake,0,0,0,0,0,0,0,0", "field pair: expected 0, found `1`"),
        ("0,none,0,0,0,0,0,0,0,0", "field flow: expected fake, grazing, real or invalid, found `none`"),
        ("0,fake,0,0,0,0,0,0,0,1", "field invalid: expected 0 for flow fake, found `1`"),
    ] {
        let file = put(&folder, "contacts.csv", format!("{header}{line}\n"));
        assert_eq!(complaint(pairs::read_contacts, &file), format!(", line 2, {expected}"));
    }
}

/// Files in the default formats of pandas and NumPy are rejected, and the error names the option that helps.
#[test]
fn a_csv_of_a_common_tool_is_refused_with_its_cure() {
    let folder = folder();
    let text = |header: &str, row: &str| format!("{header}\n{row}\n");
    let spaces = HEADER.trim().replace(',', " ");
    let row = "1,2,3,4,5,6,7,8";
    for (text, expected) in [
        (
            text(&format!(",{}", HEADER.trim()), &format!("0,{row}")),
            "line 1: found an index column among the pair's columns; leave it out (pandas: index=False)",
        ),
        (text(&format!("Unnamed: 0,{}", HEADER.trim()), &format!("0,{row}")), "index=False"),
        (
            text(&format!("# {}", HEADER.trim()), row),
            "line 1: expected the header x1,y1,z1,r1,x2,y2,z2,r2, found one that begins with `#` (numpy.savetxt: comments=\"\")",
        ),
        (
            text(&HEADER.trim().replace(',', ";"), &row.replace(',', ";")),
            "line 1: columns are separated by `;`; separate them by commas (pandas: sep=\",\", numpy.savetxt: delimiter=\",\")",
        ),
        (text(&spaces, &row.replace(',', " ")), "separated by spaces; separate them by commas"),
        (text(&HEADER.trim().replace(',', "\t"), row), "separated by tabs"),
        (text(row, row), "line 1: expected the header x1,y1,z1,r1,x2,y2,z2,r2, found `1` (numpy.savetxt: header="),
        (text("1.0e+00 2.0e+00 3.0e+00", "1 2 3"), "expected the header x1,y1"),
        (text(HEADER.trim(), "# made by hand"), "line 2: comments are not supported: leave this line out"),
        (
            text(HEADER.trim(), &format!("# {row}")),
            "line 2, field x1: expected a number, found `# 1`; comments are not supported",
        ),
    ] {
        let file = put(&folder, "pairs.csv", &text);
        let said = complaint(spheres, &file);
        assert!(said.contains(expected), "{text}{said}");
    }
}

/// Arrays of NumPy's other types and shapes are accepted, and rounded numbers are reported.
#[test]
fn arrays_of_other_types_and_orders_are_converted() {
    use npyz::{Order, WriterBuilder};
    let folder = folder();
    let expected = Set::Random(50).pairs(5);
    let expected: Vec<_> = expected.into_iter().filter(|pair| !pair.values().iter().any(|v| v.is_nan())).collect();
    let count = expected.len();
    let file = folder.path().join("theirs.npy");
    let place = |shape: &[u64], order, pair: usize, word: usize| match (order, shape.len()) {
        (Order::C, _) => 8 * pair + word,
        (Order::Fortran, 2) => pair + count * word,
        (Order::Fortran, _) => pair + count * (word / 4 + 2 * (word % 4)),
    };
    for shape in [&[count as u64, 8][..], &[count as u64, 2, 4]] {
        for order in [Order::C, Order::Fortran] {
            let mut values = vec![0.0_f32; 8 * count];
            for (pair, record) in expected.iter().enumerate() {
                for (word, value) in record.values().into_iter().enumerate() {
                    values[place(shape, order, pair, word)] = value;
                }
            }
            for descr in ["<f4", ">f4", "<f8", ">f8"] {
                fn write<T: npyz::Serialize>(
                    (file, descr, shape, order): (&Path, &str, &[u64], Order),
                    values: impl Iterator<Item = T>,
                ) {
                    let options = npyz::WriteOptions::new().dtype(npyz::DType::new_scalar(descr.parse().unwrap()));
                    let out = fs::File::create(file).unwrap();
                    let mut writer = options.shape(shape).order(order).writer(out).begin_nd().unwrap();
                    writer.extend(values).unwrap();
                    writer.finish().unwrap();
                }
                let array = (file.as_path(), descr, shape, order);
                match descr.ends_with('4') {
                    true => write(array, values.iter().copied()),
                    false => write(array, values.iter().map(|value| f64::from(*value))),
                }
                let loaded = pairs::read_with_notes(Query::SphereSphere, &file).unwrap();
                assert_eq!(loaded.pairs, expected, "{descr} {shape:?} {order:?}");
                assert_eq!(loaded.rounded, None);
            }
        }
    }
}

#[test]
fn numbers_that_binary32_does_not_have_are_rounded_with_a_note() {
    let folder = folder();
    let header = |descr: &str| format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (2, 8), }}\n");
    // Sixteen numbers. The fourth and the ninth are not representable in binary32, and the last is a NaN.
    let mut values = [1.0_f64; 16];
    (values[3], values[8], values[15]) = (0.1, 1e-60, f64::NAN);
    let data: Vec<u8> = values.iter().flat_map(|value| value.to_be_bytes()).collect();
    let mut bytes = npy(&header(">f8"), 0);
    bytes.extend(&data);
    let loaded = pairs::read_with_notes(Query::SphereSphere, &put(&folder, "pairs.npy", &bytes)).unwrap();
    assert_eq!(loaded.pairs[0].values(), [1.0, 1.0, 1.0, 0.1, 1.0, 1.0, 1.0, 1.0]);
    assert_eq!(loaded.pairs[1].values()[0], 0.0);
    assert!(loaded.pairs[1].values()[7].is_nan());
    let expected =
        "2 of 16 numbers were rounded to binary32; the first is r1 of pair 0: 0.1 became 0.10000000149011612";
    assert_eq!(loaded.rounded.unwrap().to_string(), expected);

    // Every binary16 number is a binary32 number: 1.5, the smallest subnormal, the largest, infinity, a NaN.
    let halves = [0x3E00_u16, 0x0001, 0xFBFF, 0x7C00, 0x7E01, 0x8000, 0, 0];
    let mut bytes = npy(&header("<f2"), 0);
    bytes.extend(halves.iter().chain(&halves).flat_map(|half| half.to_le_bytes()));
    let loaded = pairs::read_with_notes(Query::SphereSphere, &put(&folder, "pairs.npy", &bytes)).unwrap();
    let values = loaded.pairs[1].values();
    assert_eq!(values[..4], [1.5, 2.0_f32.powi(-24), -65504.0, f32::INFINITY]);
    assert!(values[4].is_nan() && values[5].to_bits() == 0x8000_0000);
    assert_eq!(loaded.rounded, None);
}

/// An npy file with a header of version 1.0.
fn npy(dictionary: &str, data: usize) -> Vec<u8> {
    let length = (dictionary.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\x00", &length[..], dictionary.as_bytes(), &vec![0; data]].concat()
}

#[test]
fn a_wrong_npy_is_named_by_field() {
    let folder = folder();
    let array = |descr: &str, order: &str, shape: &str, data| {
        npy(&format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}\n"), data)
    };
    for (bytes, expected) in [
        (Vec::new(), ", header: the file is empty"),
        (HEADER.into(), ", header: this is not an npy file"),
        (array("<i8", "False", "(1, 8)", 64), ", descr: expected f2, f4 or f8, found '<i8'; save a.astype(\"<f4\")"),
        (array("<f16", "False", "(1, 8)", 128), ", descr: expected f2, f4 or f8, found '<f16'; save a.astype(\"<f4\")"),
        (array("<f4", "False", "(8,)", 32), ", shape: expected [n, 8] or [n, 2, 4], found [8]"),
        (array("<f4", "False", "(8, 1)", 32), ", shape: expected [n, 8] or [n, 2, 4], found [8, 1]"),
        (array("<f4", "False", "(1, 4, 2)", 32), ", shape: expected [n, 8] or [n, 2, 4], found [1, 4, 2]"),
        (array("<f8", "False", "(1, 8)", 32), ", shape: expected 1 record of 64 bytes, found 32 bytes of data"),
        (array("<f4", "False", "(3, 8)", 64), ", shape: expected 3 records of 32 bytes, found 64 bytes of data"),
        (array("<f4", "False", "(1, 8)", 33), ", shape: expected 1 record of 32 bytes, found 33 bytes of data"),
        (
            array("<f4", "False", "(576460752303423488, 8)", 0),
            ", shape: expected 576 460 752 303 423 488 records of 32 bytes, found 0 bytes of data",
        ),
        (b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec(), ", header: expected at most 1024 bytes, found 4294967295"),
    ] {
        let file = put(&folder, "pairs.npy", &bytes);
        assert_eq!(complaint(spheres, &file), expected);
    }
    let mut beyond = array("<f8", "False", "(1, 2, 4)", 64);
    let at = beyond.len() - 16;
    beyond[at..at + 8].copy_from_slice(&(-1e39_f64).to_le_bytes());
    let file = put(&folder, "pairs.npy", beyond);
    let expected = ", data: -1e39, z2 of pair 0, is beyond the largest binary32 number";
    assert_eq!(complaint(spheres, &file), expected);
    let file = put(&folder, "contacts.npy", array("<f4", "False", "(1, 8)", 32));
    assert_eq!(complaint(pairs::read_contacts, &file), ", descr: expected '<u4', found '<f4'");
}

#[test]
fn an_absent_file_and_a_strange_name_are_refused() {
    let folder = folder();
    for name in ["absent.csv", "absent.npy"] {
        let complaint = complaint(spheres, &folder.path().join(name));
        assert!(complaint.starts_with(": cannot be read: "), "{complaint}");
    }
    let strange = folder.path().join("pairs.txt");
    assert_eq!(complaint(spheres, &strange), ": the name must end in .csv or .npy");
    assert!(pairs::write_pairs(Query::SphereSphere, &strange, &[]).is_err());
    let error = pairs::write_contacts(&folder.path().join("no/such/folder.csv"), &[ContactRecord::default()]);
    assert!(error.unwrap_err().to_string().contains("cannot be written"));
    assert!(
        pairs::load(Query::SphereSphere, "diamond:x", 0)
            .unwrap_err()
            .to_string()
            .contains("expected a number from 1 to 100, found `x`")
    );
    assert!(
        pairs::load(Query::SphereSphere, "diamnd:3", 0).unwrap_err().to_string().ends_with("did you mean diamond:3?")
    );
    assert_eq!(pairs::load(Query::SphereSphere, "diamond:3", 0).unwrap().len(), 132);
}
