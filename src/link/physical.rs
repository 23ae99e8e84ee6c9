//! A link in nanoseconds and bytes per second, each figure with its source, and its conversion to a clock.

use serde::Deserialize;

use super::direction::{Direction, Order, Shape};
use super::fault::Fault;
use super::figure::{Figure, count, rate, time};
use super::memory::LINE_BYTES;
use super::model::{LinkError, LinkModel, SessionCost};

/// A link as its makers and those who measured it describe it, in a TOML file. `src/link/presets` has the named ones.
/// `examples/links` has one with every key.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Physical {
    /// The name in reports.
    pub name: String,
    /// True if reads may overtake each other, and writes too unless `write_order` differs.
    pub order: OrderName,
    /// True if writes may overtake each other.
    #[serde(default)]
    pub write_order: Option<OrderName>,
    /// From a read request to its data.
    pub read: PhysicalDirection,
    /// From a write request to its acknowledgement.
    pub write: PhysicalDirection,
    /// The bandwidth that both directions share.
    pub joint: Joint,
    /// The waiting times of the host.
    #[serde(default)]
    pub session: PhysicalSession,
    /// Faults planted from the start.
    #[serde(default)]
    pub faults: Vec<Fault>,
}

/// [`Order`] as a link's file names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OrderName {
    /// Responses in the order of requests.
    InOrder,
    /// Responses in any order.
    Any,
}

/// One direction of a link.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhysicalDirection {
    /// The minimum time from a request to its response, in nanoseconds.
    #[serde(deserialize_with = "time")]
    pub latency_ns: Figure,
    /// The maximum time in nanoseconds. Without it there is no tail.
    #[serde(default, deserialize_with = "Figure::optional_time")]
    pub slowest_ns: Option<Figure>,
    /// The mean number of nanoseconds beyond `latency_ns`, for a geometric distribution cut off at `slowest_ns`.
    /// Without it, every time between the two is equally likely.
    #[serde(default, deserialize_with = "Figure::optional_time")]
    pub mean_wait_ns: Option<Figure>,
    /// 10⁹ bytes per second.
    #[serde(deserialize_with = "rate")]
    pub bandwidth_gb_s: Figure,
    /// 10⁹ bytes per second that the port could carry. The bandwidth may not exceed it.
    #[serde(default, deserialize_with = "Figure::optional_rate")]
    pub ceiling_gb_s: Option<Figure>,
    /// Lines that may be in flight.
    #[serde(deserialize_with = "count")]
    pub in_flight: Figure,
}

/// The bandwidth that the directions share.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// 10⁹ bytes per second in both directions together.
    #[serde(deserialize_with = "rate")]
    pub bandwidth_gb_s: Figure,
}

/// The host's waiting times before and after a job; those left out are zero.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhysicalSession {
    /// Nanoseconds before each transaction.
    #[serde(default, deserialize_with = "Figure::optional_time")]
    pub set_up_ns: Option<Figure>,
    /// Nanoseconds after each transaction.
    #[serde(default, deserialize_with = "Figure::optional_time")]
    pub tear_down_ns: Option<Figure>,
    /// Nanoseconds from the host's write of a control register to the AFU.
    #[serde(default, deserialize_with = "Figure::optional_time")]
    pub csr_write_ns: Option<Figure>,
}

impl Physical {
    /// Reads the description in the TOML text `text`. Errors call it `file`.
    ///
    /// # Errors
    /// Returns [`LinkError::File`], with the line, for text that is not TOML, an unknown or missing key, a value out of
    /// range, or a figure without its source. Also for figures that contradict each other.
    pub fn parse(file: &str, text: &str) -> Result<Self, LinkError> {
        let physical: Self = toml::from_str(text).map_err(|error| {
            let place = error.span().map(|span| {
                let before = text.get(..span.start).unwrap_or_default();
                let number = before.matches('\n').count() + 1;
                let line = text.lines().nth(number - 1).unwrap_or_default().trim();
                format!("line {number} (`{line}`): ")
            });
            let message = format!("{}{}", place.unwrap_or_default(), error.message());
            LinkError::File { file: file.to_owned(), message }
        })?;
        physical.contradiction().map_or(Ok(()), |message| Err(LinkError::File { file: file.to_owned(), message }))?;
        Ok(physical)
    }

    fn contradiction(&self) -> Option<String> {
        for (name, direction) in [("read", &self.read), ("write", &self.write)] {
            let PhysicalDirection { latency_ns, slowest_ns, mean_wait_ns, bandwidth_gb_s, ceiling_gb_s, .. } =
                direction;
            if let Some(slowest) = slowest_ns.as_ref().filter(|slowest| slowest.value < latency_ns.value) {
                let (slowest, latency) = (slowest.value, latency_ns.value);
                return Some(format!(
                    "{name}.slowest_ns: expected at least {name}.latency_ns, which is {latency}, found {slowest}"
                ));
            }
            if mean_wait_ns.is_some() && slowest_ns.is_none() {
                return Some(format!(
                    "{name}.mean_wait_ns needs {name}.slowest_ns too, which says where the tail ends"
                ));
            }
            if let Some(ceiling) = ceiling_gb_s.as_ref().filter(|ceiling| ceiling.value < bandwidth_gb_s.value) {
                let (ceiling, bandwidth) = (ceiling.value, bandwidth_gb_s.value);
                return Some(format!(
                    "{name}.bandwidth_gb_s: expected at most {name}.ceiling_gb_s, which is {ceiling}, found {bandwidth}"
                ));
            }
        }
        None
    }

    /// The link at a clock of `mhz`. Times are rounded to the nearest cycle. A direction carries at most one line per
    /// cycle, like the AFU's port.
    ///
    /// # Errors
    /// Returns an error if, at that clock, a value is outside the range of a model.
    pub fn at(&self, mhz: f64) -> Result<LinkModel, LinkError> {
        let cycles = |ns: f64| (ns * mhz / 1000.0).round();
        let lines_per_cycle = |gb_s: &Figure| gb_s.value * 1000.0 / (LINE_BYTES as f64 * mhz);
        let direction = |d: &PhysicalDirection| {
            let latency = cycles(d.latency_ns.value);
            let slowest = d.slowest_ns.as_ref().map_or(latency, |slowest| cycles(slowest.value));
            let mean = d.mean_wait_ns.as_ref().map(|mean| mean.value * mhz / 1000.0);
            Direction {
                shape: mean.map_or(Shape::Even, Shape::Geometric),
                lines_per_cycle: lines_per_cycle(&d.bandwidth_gb_s).min(1.0),
                in_flight: d.in_flight.value as u32,
                ..Direction::steady(latency.max(1.0) as u32, (slowest - latency) as u32)
            }
        };
        let wait = |figure: &Option<Figure>| figure.as_ref().map_or(0, |figure| cycles(figure.value) as u64);
        let PhysicalSession { set_up_ns, tear_down_ns, csr_write_ns } = &self.session;
        let model = LinkModel {
            name: self.name.clone(),
            read: direction(&self.read),
            write: direction(&self.write),
            order: self.order.into(),
            write_order: self.write_order.map(Order::from),
            lines_per_cycle: lines_per_cycle(&self.joint.bandwidth_gb_s).min(2.0),
            session: SessionCost {
                set_up: wait(set_up_ns),
                tear_down: wait(tear_down_ns),
                csr_write: wait(csr_write_ns),
            },
            faults: self.faults.clone(),
        };
        model.check()?;
        Ok(model)
    }

    /// All figures with their keys.
    pub fn figures(&self) -> Vec<(String, &Figure)> {
        let Self { read, write, joint, session, .. } = self;
        let shared = [("bandwidth_gb_s", Some(&joint.bandwidth_gb_s))];
        let host = [
            ("set_up_ns", session.set_up_ns.as_ref()),
            ("tear_down_ns", session.tear_down_ns.as_ref()),
            ("csr_write_ns", session.csr_write_ns.as_ref()),
        ];
        let (reads, writes) = (read.figures(), write.figures());
        let groups = [("read", &reads[..]), ("write", &writes), ("joint", &shared), ("session", &host)];
        let all = groups.iter().flat_map(|(group, keys)| keys.iter().map(move |(key, figure)| (group, key, *figure)));
        all.filter_map(|(group, key, figure)| Some((format!("{group}.{key}"), figure?))).collect()
    }
}

impl PhysicalDirection {
    fn figures(&self) -> [(&'static str, Option<&Figure>); 6] {
        [
            ("latency_ns", Some(&self.latency_ns)),
            ("slowest_ns", self.slowest_ns.as_ref()),
            ("mean_wait_ns", self.mean_wait_ns.as_ref()),
            ("bandwidth_gb_s", Some(&self.bandwidth_gb_s)),
            ("ceiling_gb_s", self.ceiling_gb_s.as_ref()),
            ("in_flight", Some(&self.in_flight)),
        ]
    }
}

impl From<OrderName> for Order {
    fn from(name: OrderName) -> Self {
        match name {
            OrderName::InOrder => Self::InOrder,
            OrderName::Any => Self::Shuffled,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::{Description, NAMES};

    const HARP1: &str = include_str!("presets/harp1.toml");

    fn named(name: &str) -> Physical {
        match name.parse().unwrap() {
            Description::Physical(physical) => *physical,
            Description::Cycles(model) => panic!("{model} is in cycles"),
        }
    }

    /// The error for the first preset with one piece of text replaced.
    #[track_caller]
    fn refused(from: &str, to: &str) -> String {
        assert!(HARP1.contains(from), "{from}");
        Physical::parse("own.toml", &HARP1.replacen(from, to, 1)).unwrap_err().to_string()
    }

    #[test]
    fn every_name_is_a_link_at_every_clock() {
        for name in NAMES {
            let description: Description = name.parse().unwrap();
            for mhz in [1.0, 50.0, 199.9, 400.0, 1000.0] {
                assert_eq!(description.at(mhz).unwrap().name, name);
            }
        }
        for name in ["harp1", "harp2", "pcie3x8", "zynqmp", "ddr4"] {
            assert!(named(name).figures().len() >= 12, "{name}");
        }
    }

    #[test]
    fn harp1_at_its_own_clock() {
        let model = named("harp1").at(200.0).unwrap();
        assert_eq!((model.read.latency, model.read.tail, model.read.in_flight), (71, 47, 58));
        assert_eq!((model.write.latency, model.write.tail, model.write.in_flight), (71, 0, 54));
        assert_eq!((model.order, model.write_order), (Order::InOrder, Some(Order::Shuffled)));
        assert_eq!(model.session, SessionCost { set_up: 400, tear_down: 400, csr_write: 146 });
        assert_eq!(model.read.shape, Shape::Geometric(8.0));
        assert!((model.read.lines_per_cycle - 7.0 / 12.8).abs() < 1e-12);
        assert!((model.write.lines_per_cycle - 4.9 / 12.8).abs() < 1e-12);
        assert!((model.lines_per_cycle - 6.5 / 12.8).abs() < 1e-12);
    }

    /// max(bytes read / read bandwidth, bytes written / write bandwidth, all bytes / joint bandwidth), in nanoseconds.
    #[test]
    fn the_limit_is_the_tightest_bandwidth() {
        for name in ["harp1", "harp2", "pcie3x8", "zynqmp", "ddr4"] {
            let physical = named(name);
            let gb_s = |figure: &Figure, most: f64| figure.value.min(most);
            for (reads, writes) in [(1000, 1000), (1000, 0), (0, 1000), (900, 400), (100, 1000)] {
                let (read, written) = (64.0 * reads as f64, 64.0 * writes as f64);
                let port = 12.8; // a line per cycle of 5 ns
                let alone = (read / gb_s(&physical.read.bandwidth_gb_s, port))
                    .max(written / gb_s(&physical.write.bandwidth_gb_s, port));
                let ns = alone.max((read + written) / gb_s(&physical.joint.bandwidth_gb_s, 2.0 * port));
                let limit = 5.0 * physical.at(200.0).unwrap().limit_cycles(reads, writes);
                assert!((limit / ns - 1.0).abs() < 1e-12, "{name}, {reads} and {writes} lines: {limit} ns, not {ns}");
            }
        }
    }

    #[test]
    fn a_fast_clock_rounds_times_and_a_slow_one_is_the_limit_itself() {
        let harp1 = named("harp1");
        assert_eq!(harp1.at(250.0).unwrap().read.latency, 89); // 88.75
        let slow = harp1.at(50.0).unwrap(); // a line per cycle is 3.2 GB/s
        assert_eq!((slow.read.lines_per_cycle, slow.write.lines_per_cycle, slow.lines_per_cycle), (1.0, 1.0, 2.0));
        assert_eq!(harp1.at(0.001).unwrap().read.latency, 1);
    }

    #[test]
    fn what_is_wrong_is_said_with_file_line_and_key() {
        let unknown = refused("latency_ns", "latency");
        assert!(unknown.starts_with("own.toml: line 7 (`latency = { value = 355, "), "{unknown}");
        assert!(unknown.contains("unknown field `latency`, expected one of `latency_ns`"), "{unknown}");
        let negative = refused("value = 355", "value = -355");
        assert!(negative.starts_with("own.toml: line 7 (`latency_ns = "), "{negative}");
        assert!(negative.ends_with("the value is -355, but must be from 0 to 1e9"), "{negative}");
        let bare = refused("{ value = 7.0, source = \"recalled: Choi et al., DAC 2016\" }", "7.0");
        assert!(bare.contains("line 10 (`bandwidth_gb_s = 7.0`)") && bare.contains("a figure: { value"), "{bare}");
        let without = refused(", source = \"assumed: as a read; no figure known\"", "");
        assert!(without.contains("line 15 (`latency_ns = ") && without.contains("missing field `source`"), "{without}");
        let empty = refused("\"assumed: as a read; no figure known\"", "\" \"");
        assert!(empty.contains("line 15") && empty.contains("the source is empty"), "{empty}");
        let many = refused("value = 58", "value = 58.5");
        assert!(many.contains("line 12") && many.contains("58.5, but must be a whole number"), "{many}");
        let nothing = refused("order = \"in_order\"", "order = \"sorted\"");
        assert!(nothing.contains("line 3") && nothing.contains("unknown variant `sorted`"), "{nothing}");
        let broken = refused("[joint]", "[joint");
        assert!(broken.contains("line 20 (`[joint`)"), "{broken}");
        let gone = refused("[joint]", "[apart]");
        assert!(gone.contains("line 20 (`[apart]`)") && gone.contains("unknown field `apart`"), "{gone}");
    }

    #[test]
    fn figures_that_contradict_each_other_are_refused() {
        let early = refused("value = 590", "value = 300");
        assert_eq!(early, "own.toml: read.slowest_ns: expected at least read.latency_ns, which is 355, found 300");
        let above = refused("value = 12.8", "value = 6");
        assert_eq!(above, "own.toml: read.bandwidth_gb_s: expected at most read.ceiling_gb_s, which is 6, found 7");
        let endless = refused("slowest_ns = { value = 590, source", "# slowest_ns = { value = 590, source");
        assert!(endless.contains("read.mean_wait_ns needs read.slowest_ns too"), "{endless}");
    }

    #[test]
    fn the_example_has_every_key_and_a_fault() {
        let lossy = Physical::parse("lossy.toml", include_str!("../../examples/links/lossy.toml")).unwrap();
        assert_eq!(lossy.figures().len(), 5 + 1 + 3 + 1 + 3);
        assert_eq!(lossy.at(200.0).unwrap().faults, [Fault::ReadLost(7)]);
    }

    /// docs/link.md shows every figure of the presets with its source.
    #[test]
    fn the_page_shows_the_figures() {
        let page = include_str!("../../docs/link.md");
        for name in ["harp1", "harp2", "pcie3x8", "zynqmp", "ddr4"] {
            for (key, Figure { value, source }) in named(name).figures() {
                let row = format!("| {name} | `{key}` | {value} | {source} |");
                assert!(page.contains(&row), "docs/link.md lacks: {row}");
            }
        }
    }
}
