//! Makes files nearly right: changes bytes, rows and cells, and values in a tree.

use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde_json::{Map, Value, json};

/// A file's structure, which decides on mutations that stay close to valid files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    Bytes,
    /// Rows of cells separated by commas.
    Csv,
    Json,
    Toml,
}

/// Values that break readers: ends of ranges, nesting, wrong types, invalid text.
const WORDS: [&[u8]; 24] = [
    b"-1",
    b"0",
    b"1e400",
    b"-1e-400",
    b"nan",
    b"inf",
    b"18446744073709551616",
    b"4294967295",
    b"\"",
    b"\n",
    b"\r\n",
    b",",
    b"[",
    b"{",
    b"}",
    b"]",
    b"null",
    b"true",
    b"\xff\xfe",
    b"\0",
    b"(9223372036854775807, 8)",
    b"\xef\xbb\xbf",
    b"1.7976931348623157e308",
    b"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
];

/// Makes one to four changes: in half of the files only to bytes, in the others also to the structure.
pub fn mutated(form: Form, seed: &[u8], random: &mut Xoshiro256PlusPlus) -> Vec<u8> {
    let changes = random.random_range(1..5);
    let by_form = random.random::<bool>();
    let mut text = seed.to_vec();
    for _ in 0..changes {
        let changed = match form {
            Form::Csv if by_form => Some(cells(&text, random)),
            Form::Json if by_form => json_tree(&text, random),
            Form::Toml if by_form => toml_tree(&text, random),
            _ => None,
        };
        text = changed.unwrap_or_else(|| bytes(text, random));
    }
    text
}

fn word(random: &mut Xoshiro256PlusPlus) -> &'static [u8] {
    WORDS[random.random_range(0..WORDS.len())]
}

/// Replaces a byte, a word or a number; or cuts, duplicates or moves a piece.
fn bytes(mut text: Vec<u8>, random: &mut Xoshiro256PlusPlus) -> Vec<u8> {
    let at = random.random_range(0..=text.len());
    let end = (at + random.random_range(0..40)).min(text.len());
    let word = word(random);
    match random.random_range(0..7) {
        0 if at < text.len() => text[at] ^= 1 << random.random_range(0..8),
        1 => text.truncate(at),
        2 => drop(text.splice(at..at, word.iter().copied())),
        3 => drop(text.splice(at..end, word.iter().copied())),
        4 => drop(text.drain(at..end)),
        5 => {
            let piece = text[at..end].repeat(random.random_range(1..20));
            text.splice(at..at, piece);
        }
        _ => {
            // The next number, whatever its value, is replaced by another word.
            let is_digit = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-');
            if let Some(begin) = text[at..].iter().position(is_digit).map(|begin| at + begin) {
                let end = begin + text[begin..].iter().take_while(|byte| is_digit(byte)).count();
                text.splice(begin..end, word.iter().copied());
            }
        }
    }
    text
}

/// Replaces, duplicates or removes a cell; duplicates, moves or removes a row; or removes a column.
fn cells(text: &[u8], random: &mut Xoshiro256PlusPlus) -> Vec<u8> {
    let mut rows: Vec<Vec<Vec<u8>>> = text
        .split(|&byte| byte == b'\n')
        .map(|row| row.split(|&byte| byte == b',').map(<[u8]>::to_vec).collect())
        .collect();
    let row = random.random_range(0..rows.len());
    let cell = random.random_range(0..rows[row].len());
    match random.random_range(0..7) {
        0 | 1 => rows[row][cell] = word(random).to_vec(),
        2 => {
            let again = rows[row][cell].clone();
            rows[row].insert(cell, again);
        }
        3 => drop(rows[row].remove(cell)),
        4 => {
            let again = rows[row].clone();
            rows.push(again);
        }
        5 => {
            let other = random.random_range(0..rows.len());
            rows.swap(row, other);
        }
        _ => rows.iter_mut().filter(|row| cell < row.len()).for_each(|row| drop(row.remove(cell))),
    }
    rows.iter().map(|row| row.join(&b',')).collect::<Vec<_>>().join(&b'\n')
}

fn json_tree(text: &[u8], random: &mut Xoshiro256PlusPlus) -> Option<Vec<u8>> {
    let mut tree: Value = serde_json::from_slice(text).ok()?;
    change(&mut tree, random);
    serde_json::to_vec(&tree).ok()
}

fn toml_tree(text: &[u8], random: &mut Xoshiro256PlusPlus) -> Option<Vec<u8>> {
    let mut tree: Value = toml::from_str(std::str::from_utf8(text).ok()?).ok()?;
    change(&mut tree, random);
    // One top-level key per line, with everything below it inline.
    let lines = tree.as_object()?.iter().map(|(key, value)| format!("{} = {}", json!(key), in_line(value)));
    Some(lines.collect::<Vec<_>>().join("\n").into_bytes())
}

/// Formats a value as inline TOML. `null` is written as `null`, which every reader must reject.
fn in_line(value: &Value) -> String {
    match value {
        Value::Array(all) => format!("[{}]", all.iter().map(in_line).collect::<Vec<_>>().join(", ")),
        Value::Object(all) => {
            let entries = all.iter().map(|(key, value)| format!("{} = {}", json!(key), in_line(value)));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}

fn size(tree: &Value) -> usize {
    1 + match tree {
        Value::Array(all) => all.iter().map(size).sum(),
        Value::Object(all) => all.values().map(size).sum(),
        _ => 0,
    }
}

/// The value with this index in depth-first order.
fn place(tree: &mut Value, number: usize) -> Option<&mut Value> {
    if number == 0 {
        return Some(tree);
    }
    let mut left = number - 1;
    let children: Vec<&mut Value> = match tree {
        Value::Array(all) => all.iter_mut().collect(),
        Value::Object(all) => all.values_mut().collect(),
        _ => return None,
    };
    for child in children {
        let inside = size(child);
        if left < inside {
            return place(child, left);
        }
        left -= inside;
    }
    None
}

/// Replaces a value by another of the same or any type; or duplicates, renames or removes an entry.
fn change(tree: &mut Value, random: &mut Xoshiro256PlusPlus) {
    let number = random.random_range(0..size(tree));
    let Some(value) = place(tree, number) else { return };
    let any = [
        json!(-1),
        json!(0),
        json!(1),
        json!(4_294_967_295_u64),
        json!(4_294_967_296_u64),
        json!(i64::MAX),
        json!(u64::MAX),
        json!(1e-300),
        json!(f64::MAX),
        json!(f64::MIN),
        json!(0.5),
        json!(""),
        json!("nan"),
        json!("e63f127zr"),
        json!("x".repeat(1000)),
        json!(true),
        json!([]),
        json!({}),
        Value::Null,
    ];
    let other = any[random.random_range(0..any.len())].clone();
    match value {
        Value::Array(all) if !all.is_empty() && random.random::<bool>() => {
            let at = random.random_range(0..all.len());
            match random.random_range(0..3) {
                0 => drop(all.remove(at)),
                1 => all.extend(vec![all[at].clone(); random.random_range(1..20)]),
                _ => all[at] = other,
            }
        }
        Value::Object(all) if !all.is_empty() && random.random::<bool>() => {
            let names: Vec<String> = all.keys().cloned().collect();
            let name = &names[random.random_range(0..names.len())];
            let entry = all.remove(name).unwrap_or_default();
            match random.random_range(0..4) {
                0 => {}
                1 => drop(all.insert(format!("{name}_"), entry)),
                2 => drop(all.insert(names[0].clone(), entry)),
                _ => drop(all.insert(name.clone(), other)),
            }
        }
        Value::Number(_) if random.random::<bool>() => {
            let numbers: Vec<Value> = any.into_iter().filter(Value::is_number).collect();
            *value = numbers[random.random_range(0..numbers.len())].clone();
        }
        _ if random.random_range(0..4) == 0 => {
            // Deeply nested.
            let mut deep = value.take();
            for _ in 0..random.random_range(1..300) {
                deep = if random.random::<bool>() {
                    Value::Array(vec![deep])
                } else {
                    Value::Object(Map::from_iter([("in".to_owned(), deep)]))
                };
            }
            *value = deep;
        }
        _ => *value = other,
    }
}
