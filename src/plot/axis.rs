//! Axes: their range, the place of a value on them, and the values with a tick.

/// How values are spread over an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps for equal differences.
    Linear,
    /// Equal steps for equal ratios. Values that are not above zero have no place.
    Log,
}

/// An axis: its label with the unit, its scale, and its range unless it follows the data.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The text beside the axis.
    pub label: String,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// The smallest and largest value shown. `None` covers all data with ticks (a linear axis starts from 0 if no value
    /// is less).
    pub range: Option<[f64; 2]>,
}

/// The minimum number of steps between ticks on an axis.
const STEPS: f64 = 5.0;

impl Axis {
    /// An axis that follows its data.
    pub fn new(label: &str, scale: Scale) -> Self {
        Self { label: label.to_owned(), scale, range: None }
    }

    /// The same, from `least` to `most`.
    #[must_use]
    pub(crate) fn with_range(self, least: f64, most: f64) -> Self {
        Self { range: Some([least, most]), ..self }
    }

    /// True if a value has a place on the axis.
    pub(super) fn holds(&self, value: f64) -> bool {
        value.is_finite() && (self.scale == Scale::Linear || value > 0.0)
    }

    /// The range for these values, and ticks in it.
    pub(super) fn fit(&self, values: impl Iterator<Item = f64>) -> Fitted {
        let held = values.filter(|&v| self.holds(v));
        let seen = held.fold(None, |seen: Option<[f64; 2]>, v| {
            Some(seen.map_or([v, v], |[least, most]| [least.min(v), most.max(v)]))
        });
        let given = self.range.filter(|[a, b]| self.holds(*a) && self.holds(*b) && a < b);
        match self.scale {
            Scale::Linear => linear(given, seen.unwrap_or([0.0, 1.0])),
            Scale::Log => log(given, seen.unwrap_or([1.0, 10.0])),
        }
    }
}

/// An axis with its range and ticks.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fitted {
    scale: Scale,
    least: f64,
    most: f64,
    /// Values with the text beside them.
    pub(super) ticks: Vec<(f64, String)>,
}

impl Fitted {
    /// Removes every other tick until any two neighbours, given by place and text, have room.
    pub(super) fn thin(&mut self, has_room: impl Fn([(f64, &str); 2]) -> bool) {
        loop {
            let placed: Vec<(f64, &str)> = self.ticks.iter().map(|(v, text)| (self.place(*v), text.as_str())).collect();
            if placed.windows(2).all(|two| has_room([two[0], two[1]])) {
                return;
            }
            let mut keep = false;
            self.ticks.retain(|_| {
                keep = !keep;
                keep
            });
        }
    }

    /// The least and the largest value.
    pub(super) const fn ends(&self) -> [f64; 2] {
        [self.least, self.most]
    }

    /// The place of a value: 0 at the smallest, 1 at the largest.
    pub(super) fn place(&self, value: f64) -> f64 {
        let on = |v: f64| if self.scale == Scale::Log { v.log10() } else { v };
        (on(value) - on(self.least)) / (on(self.most) - on(self.least))
    }
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `least`.
fn round_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0].map(|n| n * power).into_iter().find(|&step| step >= least * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

fn linear(given: Option<[f64; 2]>, seen: [f64; 2]) -> Fitted {
    let [mut least, mut most] = given.unwrap_or([seen[0].min(0.0), seen[1]]);
    if most <= least {
        most = least + 1.0;
    }
    let step = round_step((most - least) / (STEPS + 2.0));
    if given.is_none() {
        least = (least / step + 1e-9).floor() * step;
        most = (most / step - 1e-9).ceil() * step;
    }
    let places = if step >= 1.0 { 0 } else { (-step.log10()).ceil() as usize };
    let (first, last) = ((least / step - 1e-9).ceil() as i64, (most / step + 1e-9).floor() as i64);
    let ticks = (first..=last).map(|n| n as f64 * step).map(|v| (v, number(v, places))).collect();
    Fitted { scale: Scale::Linear, least, most, ticks }
}

fn log(given: Option<[f64; 2]>, seen: [f64; 2]) -> Fitted {
    let [least, most] = given.unwrap_or_else(|| {
        let (low, high) = ((seen[0].log10() + 1e-9).floor(), (seen[1].log10() - 1e-9).ceil());
        [10_f64.powf(low), 10_f64.powf(high.max(low + 1.0))]
    });
    let decades = most.log10() - least.log10();
    let every = ((decades / 8.0).ceil() as i32).max(1);
    let factors: &[f64] = if decades <= 2.2 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let (first, last) = ((least.log10() - 1e-9).floor() as i32, (most.log10() + 1e-9).floor() as i32);
    let inside = |v: &f64| *v >= least * (1.0 - 1e-9) && *v <= most * (1.0 + 1e-9);
    let values = (first..=last).filter(|n| (n - first) % every == 0).flat_map(|n| {
        let power = 10_f64.powi(n);
        factors.iter().map(move |factor| factor * power)
    });
    let ticks = values.filter(inside).map(|v| (v, power(v))).collect();
    Fitted { scale: Scale::Log, least, most, ticks }
}

/// `12354.5` as `12 354.5`: with thin spaces that do not break.
fn number(value: f64, places: usize) -> String {
    let text = format!("{:.places$}", if value == 0.0 { 0.0 } else { value.abs() });
    let (whole, rest) = text.split_once('.').map_or((text.as_str(), None), |(w, r)| (w, Some(r)));
    let mut grouped = String::from(if value < 0.0 { "−" } else { "" });
    for (place, digit) in whole.chars().enumerate() {
        if place > 0 && (whole.len() - place).is_multiple_of(3) && whole.len() > 4 {
            grouped.push('\u{202f}');
        }
        grouped.push(digit);
    }
    rest.map_or(grouped.clone(), |rest| format!("{grouped}.{rest}"))
}

/// A tick of a logarithmic axis: in full if that is short, otherwise as a power of ten.
fn power(value: f64) -> String {
    if (1e-3..1e6).contains(&value) {
        let places = if value < 1.0 { (-value.log10() - 1e-9).ceil() as usize } else { 0 };
        return number(value, places);
    }
    let exponent = (value.log10() + 1e-9).floor();
    let raised = |c: char| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(c.to_digit(10).unwrap_or(0) as usize).unwrap_or('⁻');
    let power: String = format!("{exponent:.0}").chars().map(|c| if c == '-' { '⁻' } else { raised(c) }).collect();
    match value / 10_f64.powf(exponent) {
        factor if factor < 1.5 => format!("10{power}"),
        factor => format!("{factor:.0}·10{power}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(axis: Axis, values: &[f64]) -> Vec<String> {
        axis.fit(values.iter().copied()).ticks.into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn linear_ticks_are_round_and_hold_the_data() {
        let axis = || Axis::new("", Scale::Linear);
        assert_eq!(ticks(axis(), &[10.0, 1000.0]), ["0", "200", "400", "600", "800", "1000"]);
        assert_eq!(ticks(axis(), &[0.013, 0.09]), ["0.00", "0.02", "0.04", "0.06", "0.08", "0.10"]);
        assert_eq!(ticks(axis(), &[-3.0, 4.0]), ["−3", "−2", "−1", "0", "1", "2", "3", "4"]);
        assert_eq!(ticks(axis().with_range(0.0, 90_000.0), &[]).last().map(String::as_str), Some("80\u{202f}000"));
        assert_eq!(ticks(axis(), &[5.0, 5.0]).first().map(String::as_str), Some("0"));
    }

    #[test]
    fn log_ticks_are_powers_and_hold_the_data() {
        let axis = || Axis::new("", Scale::Log);
        assert_eq!(ticks(axis(), &[10.0, 90_000.0]), ["10", "100", "1000", "10\u{202f}000", "100\u{202f}000"]);
        assert_eq!(ticks(axis(), &[20.0, 50.0]), ["10", "20", "50", "100"]);
        assert_eq!(ticks(axis(), &[0.02, 0.05, 0.0, -1.0]), ["0.01", "0.02", "0.05", "0.10"].map(trim));
        assert_eq!(ticks(axis(), &[1e-8, 1e-6]), ["10⁻⁸", "2·10⁻⁸", "5·10⁻⁸", "10⁻⁷", "2·10⁻⁷", "5·10⁻⁷", "10⁻⁶"]);
        let fitted = axis().fit([1.0, 100.0].into_iter());
        assert!((fitted.place(10.0) - 0.5).abs() < 1e-12);
    }

    fn trim(text: &str) -> String {
        text.strip_suffix("10").map_or(text.to_owned(), |rest| format!("{rest}1"))
    }
}
