//! Lists on the command line: `1,2,4`, `1..16` (16 included), or both together.

use std::str::FromStr;

/// Numbers in the order given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct List(pub Vec<u32>);

impl FromStr for List {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut numbers = Vec::new();
        for part in text.split(',') {
            let number = |digits: &str| {
                let digits = digits.trim();
                digits.parse::<u16>().map(u32::from).map_err(|_| format!("`{digits}` is not a number from 0 to 65535"))
            };
            match part.split_once("..") {
                None => numbers.push(number(part)?),
                Some((first, last)) => {
                    let (first, last) = (number(first)?, number(last)?);
                    if first > last {
                        return Err(format!("`{part}`: a range goes upwards, as in 1..16 (16 included)"));
                    }
                    numbers.extend(first..=last);
                }
            }
        }
        Ok(Self(numbers))
    }
}

#[cfg(test)]
mod tests {
    use super::List;

    #[test]
    fn lists_and_ranges() {
        assert_eq!("1,2, 4".parse(), Ok(List(vec![1, 2, 4])));
        assert_eq!("1..4".parse(), Ok(List(vec![1, 2, 3, 4])));
        assert_eq!("1..2,16".parse(), Ok(List(vec![1, 2, 16])));
        for bad in ["", "1,", "4..1", "1..=4", "x", "-1", "1...4", "99999"] {
            assert!(bad.parse::<List>().is_err(), "{bad}");
        }
    }
}
