//! The cycles of a small job, split into the parts of the AFU and of the link.

use crate::afu::Afu;
use crate::config::Results;
use crate::link::{LinkModel, Order};

/// A part of a job, and the cycles that it takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// The name of the part.
    pub name: &'static str,
    /// Cycles.
    pub cycles: u64,
}

/// The cycles of a job of `pairs` pairs over `link`, part by part, from the cycle in which `start` is high to the one
/// in which `done` is. Their sum is exactly the job's number of cycles.
///
/// `None` for a job or a link whose cycles are not such a sum. The reasons are a shell that polls, randomness (a tail,
/// stalls, stragglers, reads in any order that wait for one another), fewer SCPUs than pairs in a line, an interval
/// above 1, contacts alone as results, or more lines than may be in flight or than the AFU takes before its first
/// write.
pub fn account(afu: &Afu, link: &LinkModel, pairs: u32) -> Option<Vec<Part>> {
    if afu.has_shell() {
        return None;
    }
    let (timing, layout, config) = (afu.timing(), afu.layout(), &afu.spec().config);
    let part = |name, cycles: u64| Part { name, cycles };
    let of = |name, cycles: u32| part(name, cycles.into());
    if pairs == 0 {
        let nothing = of("packer: that there is nothing", timing.nothing);
        return Some(vec![of("control: start", timing.start), nothing, of("control: done", timing.done)]);
    }
    let pairs = u64::from(pairs);
    let (sources, destinations) = (layout.source_lines(pairs), layout.destination_lines(pairs));
    let in_flight = [link.read.in_flight, link.write.in_flight, afu.spec().max_outstanding].into_iter().min()?;
    let is_steady = [link.read, link.write].iter().all(|d| d.tail == 0 && d.stalls.longest == 0);
    let no_stragglers = [link.read, link.write].iter().all(|d| d.stragglers.share == 0.0);
    let wide = config.scpus >= layout.pairs_per_line() && config.interval == 1 && config.results == Results::All;
    if !(is_steady && no_stragglers && wide && sources.max(destinations) <= in_flight.into()) {
        return None;
    }
    // At best, a source line arrives in each cycle. A destination line is full once the source line of its last pair
    // has passed through.
    let arrivals = link.pace_of_reads(&(0..sources).collect::<Vec<_>>());
    let last_arrival = arrivals.last().copied()?;
    let shuffled = link.order == Order::Shuffled && last_arrival != sources - 1;
    if shuffled || last_arrival >= u64::from(timing.scpu) {
        return None;
    }
    let per_line = u64::from(layout.contacts_per_line());
    let last_pair = |line: u64| (line * per_line + per_line).min(pairs) - 1;
    let arrival = |pair: u64| arrivals[(pair / u64::from(layout.pairs_per_line())) as usize];
    let flush = if pairs.is_multiple_of(per_line) { 0 } else { u64::from(timing.flush) };
    let is_last = |line| line == destinations - 1;
    let full: Vec<u64> =
        (0..destinations).map(|line| arrival(last_pair(line)) + if is_last(line) { flush } else { 0 }).collect();
    let last_written = link.pace_of_writes(&full).last().copied()?;
    Some(vec![
        of("control: start", timing.start),
        of("collector: the first request", timing.request),
        of("link: read latency", link.read.latency),
        part("link: the lines behind the first", last_arrival),
        of("collector: back in order", timing.collect),
        of("feeder: to the slots", timing.feed),
        of("slot: the SCPU and the registers before it", timing.scpu),
        of("chain of slots: a register each", timing.chain),
        of("packer: a line", timing.pack),
        part("packer: a last line that is not full", flush),
        of("dispatcher: its request", timing.dispatch),
        part("link: writes that wait for one another", last_written - last_arrival - flush),
        of("link: write latency", link.write.latency),
        of("dispatcher: the acknowledgement", timing.acknowledge),
        of("control: done", timing.done),
    ])
}
