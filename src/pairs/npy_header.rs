//! The header of an npy file: a Python dictionary with three keys, read without trusting a length in it.
//!
//! NumPy's format is described in its `numpy.lib.format`: a magic string, a version, the length of the text, the text.

const MAGIC: &[u8] = b"\x93NUMPY";
/// The maximum length of the text, in bytes. An n × 8 array has 118 bytes.
const LONGEST: usize = 1024;

/// The header of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Header {
    /// Type of the elements, as in `<f4`.
    pub descr: String,
    /// Whether the first index varies fastest.
    pub fortran_order: bool,
    /// Elements along each dimension.
    pub shape: Vec<u64>,
}

/// The part of the header that is wrong, and the error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem(pub &'static str, pub String);

impl Header {
    /// Reads the header at the beginning of a file, and gives what follows it.
    pub fn split(file: &[u8]) -> Result<(Self, &[u8]), Problem> {
        let problem = |text: String| Problem("header", text);
        if file.is_empty() {
            return Err(problem("the file is empty".to_owned()));
        }
        let rest = file.strip_prefix(MAGIC).ok_or_else(|| problem("this is not an npy file".to_owned()))?;
        let (length, rest) = match rest {
            [1, 0, a, b, rest @ ..] => (u32::from(u16::from_le_bytes([*a, *b])), rest),
            [2 | 3, 0, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]), rest),
            _ => {
                return Err(problem(
                    "expected version 1.0, 2.0 or 3.0 of npy, found another version or too few bytes".to_owned(),
                ));
            }
        };
        let length = length as usize;
        if length > LONGEST {
            return Err(problem(format!("expected at most {LONGEST} bytes, found {length}")));
        }
        let cut_short = || problem(format!("expected {length} bytes, found {}", rest.len()));
        let (text, data) = rest.split_at_checked(length).ok_or_else(cut_short)?;
        let text = std::str::from_utf8(text).map_err(|_| problem("expected text in UTF-8".to_owned()))?;
        Ok((Self::parse(text)?, data))
    }

    /// The bytes of a version 1.0 header, padded as NumPy does so that the data begins at a multiple of 64.
    pub fn bytes(&self) -> Vec<u8> {
        let order = if self.fortran_order { "True" } else { "False" };
        let shape: String = self.shape.iter().map(|n| format!("{n}, ")).collect();
        let shape = if self.shape.len() == 1 { shape.trim_end() } else { shape.trim_end_matches(", ") };
        let mut text = format!("{{'descr': '{}', 'fortran_order': {order}, 'shape': ({shape}), }}", self.descr);
        let unpadded = MAGIC.len() + 4 + text.len() + 1;
        text.extend(std::iter::repeat_n(' ', unpadded.next_multiple_of(64) - unpadded));
        text.push('\n');
        [MAGIC, &[1, 0], &(text.len() as u16).to_le_bytes(), text.as_bytes()].concat()
    }

    fn parse(text: &str) -> Result<Self, Problem> {
        let (mut descr, mut fortran_order, mut shape) = (None, None, None);
        let odd = || Problem("header", "expected the dictionary that NumPy writes".to_owned());
        let mut rest = Scanner(text);
        rest.expect('{').ok_or_else(odd)?;
        while !rest.take('}') {
            let key = rest.string().ok_or_else(odd)?;
            rest.expect(':').ok_or_else(odd)?;
            match key {
                "descr" => {
                    let records = || {
                        Problem(
                            "descr",
                            "expected one type, found records with named fields; save an n x 8 array".to_owned(),
                        )
                    };
                    descr = Some(rest.string().ok_or_else(records)?.to_owned());
                }
                "fortran_order" => {
                    let neither = || Problem("fortran_order", "expected True or False".to_owned());
                    fortran_order = Some(rest.truth().ok_or_else(neither)?);
                }
                "shape" => {
                    let no_shape = || Problem("shape", "expected a tuple of numbers below 2^64".to_owned());
                    shape = Some(rest.tuple().ok_or_else(no_shape)?);
                }
                _ => return Err(odd()),
            }
            if !rest.take(',') {
                rest.expect('}').ok_or_else(odd)?;
                break;
            }
        }
        let missing = |key| Problem(key, "missing in the header".to_owned());
        Ok(Self {
            descr: descr.ok_or_else(|| missing("descr"))?,
            fortran_order: fortran_order.ok_or_else(|| missing("fortran_order"))?,
            shape: shape.ok_or_else(|| missing("shape"))?,
        })
    }
}

/// The rest of a text. Spaces are ignored.
struct Scanner<'a>(&'a str);

impl<'a> Scanner<'a> {
    fn take(&mut self, mark: char) -> bool {
        let rest = self.0.trim_start().strip_prefix(mark);
        self.0 = rest.unwrap_or(self.0);
        rest.is_some()
    }

    fn expect(&mut self, mark: char) -> Option<()> {
        self.take(mark).then_some(())
    }

    fn string(&mut self) -> Option<&'a str> {
        let quote = ['\'', '"'].into_iter().find(|&quote| self.take(quote))?;
        let (string, rest) = self.0.split_once(quote)?;
        self.0 = rest;
        Some(string)
    }

    fn truth(&mut self) -> Option<bool> {
        for (word, value) in [("True", true), ("False", false)] {
            if let Some(rest) = self.0.trim_start().strip_prefix(word) {
                self.0 = rest;
                return Some(value);
            }
        }
        None
    }

    fn tuple(&mut self) -> Option<Vec<u64>> {
        let mut numbers = Vec::new();
        self.expect('(')?;
        while !self.take(')') {
            let text = self.0.trim_start();
            let end = text.find(|c: char| !c.is_ascii_digit())?;
            numbers.push(text[..end].parse().ok()?);
            self.0 = &text[end..];
            if !self.take(',') {
                self.expect(')')?;
                break;
            }
        }
        Some(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(descr: &str, fortran_order: bool, shape: &[u64]) -> Header {
        Header { descr: descr.to_owned(), fortran_order, shape: shape.to_owned() }
    }

    #[test]
    fn headers_read_back() {
        for header in [header("<f4", false, &[0, 8]), header("<u4", true, &[3]), header("|b1", false, &[])] {
            let mut bytes = header.bytes();
            assert_eq!(bytes.len() % 64, 0);
            bytes.extend([1, 2, 3]);
            assert_eq!(Header::split(&bytes), Ok((header, &[1, 2, 3][..])));
        }
    }

    #[test]
    fn no_bytes_make_it_panic() {
        // Every single-byte change and every shortening of a good file.
        let good = header("<f4", false, &[12, 8]).bytes();
        for at in 0..good.len() {
            assert!(Header::split(&good[..at]).is_err(), "cut at {at}");
            for byte in 0..=255 {
                let mut bytes = good.clone();
                bytes[at] = byte;
                let _ = Header::split(&bytes);
            }
        }
    }

    #[test]
    fn what_is_wrong_is_said() {
        let problem = |text: &str| Header::parse(text).unwrap_err().0;
        assert_eq!(problem("{'descr': '<f4', 'fortran_order': False, }"), "shape");
        assert_eq!(problem("{'descr': [('x', '<f4')], 'fortran_order': False, 'shape': (1,), }"), "descr");
        assert_eq!(problem("{'descr': '<f4', 'fortran_order': 0, 'shape': (1,), }"), "fortran_order");
        assert_eq!(problem("{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999, 8), }"), "shape");
        assert_eq!(problem("{'descr': '<f4', 'fortran_order': False, 'shape': (-1, 8), }"), "shape");
        assert_eq!(problem("[]"), "header");
    }
}
