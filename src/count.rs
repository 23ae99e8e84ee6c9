//! Counts as text: digits in groups of three, and a noun in the right number.

/// `12354` as `12 354`.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// A count with its noun: `1 SCPU`, `12 354 pairs`, `2 mismatches`.
pub fn counted(number: u64, noun: &str) -> String {
    let ending = match number {
        1 => "",
        _ if noun.ends_with("ch") => "es",
        _ => "s",
    };
    format!("{} {noun}{ending}", grouped(number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_grouped_in_threes() {
        for (number, text) in [(0, "0"), (999, "999"), (1000, "1 000"), (12_354, "12 354"), (1_234_567, "1 234 567")] {
            assert_eq!(grouped(number), text);
        }
    }

    #[test]
    fn one_is_singular() {
        for (number, text) in [(0, "0 pairs"), (1, "1 pair"), (12_354, "12 354 pairs")] {
            assert_eq!(counted(number, "pair"), text);
        }
        assert_eq!([1, 2].map(|number| counted(number, "mismatch")), ["1 mismatch", "2 mismatches"]);
    }
}
