//! The pictures: error over time.

use super::front::{Time, front};
use super::{Point, Study};
use crate::plot::{Axis, Line, Marker, Plot, Scale, Series};

/// The picture of one kind of time.
pub fn picture(results: &Study, time: Time) -> Plot {
    let routed = |point: &Point| point.routed_mhz().is_some();
    let place = |point: &Point| Some((time.of(point, results)?, results.worst(point)));
    let of = |which: &dyn Fn(&Point) -> bool| -> (Vec<(f64, f64)>, Vec<String>) {
        let chosen = results.points.iter().filter(|point| which(point));
        chosen.filter_map(|point| Some((place(point)?, point.name.clone()))).unzip()
    };
    let line = |among: &dyn Fn(&Point) -> bool| -> Vec<(f64, f64)> {
        front(results, time, among).into_iter().filter_map(|index| place(&results.points[index])).collect()
    };
    let times = results.points.iter().filter_map(|point| time.of(point, results));
    let [least, most] = times.fold([f64::INFINITY, 0.0], |[least, most], t| [least.min(t), most.max(t)]);
    let x = Axis::new(label(time), Scale::Linear);
    // Room for names at both ends. If the times are almost equal, the axis starts from zero.
    let room = 0.12 * (most - least);
    let x = match most - least > 0.1 * most {
        true => x.with_range((least - room).max(0.0), most + room),
        false if most > 0.0 => x.with_range(0.0, 2.0 * most),
        false => x,
    };
    let title = match time {
        Time::Lone => "Latency of a single pair",
        Time::Device => "Throughput of a full device",
        Time::Link => "Over the link",
    };
    let y = Axis::new("largest relative error on the scenes", Scale::Log);
    let mut plot = Plot::new(title, x, y);
    let anyone_routed = results.points.iter().any(routed);
    plot = if anyone_routed {
        plot.with(Series::new("front, placed and routed", 0, line(&routed)).line(Line::Solid))
    } else {
        plot.with(Series::new("front by the delay model, not routed", 5, line(&|_| true)).line(Line::Dotted))
    };
    if anyone_routed {
        let (points, names) = of(&routed);
        plot = plot.with(Series::new("placed and routed", 0, points).marker(Marker::Circle).named(names));
    }
    let (points, names) = of(&|point| !routed(point));
    if !points.is_empty() {
        plot = plot
            .with(Series::new("clock by the delay model, not routed", 1, points).hollow(Marker::Circle).named(names));
    }
    plot
}

fn label(time: Time) -> &'static str {
    match time {
        Time::Lone => "latency of a single pair, line in to line out, ns",
        Time::Device => "ns per pair, of a device full of SCPUs",
        Time::Link => "ns per pair over the link, one SCPU",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_words_lie_on_others_in_the_pictures_of_the_committed_study() {
        let results = super::super::committed().expect("results");
        for time in results.times() {
            crate::plot::overlap::check(&picture(&results, time).svg());
        }
    }
}
