//! How many cycles a job may take before its host gives up: never fewer than a right AFU needs.
//!
//! The bound follows from the job, the AFU and the link alone. Each part is a worst case, and parts that overlap are
//! added up, so the sum is far above what jobs take; but it is a sum of the job's own figures, so an AFU that hangs is
//! reported after a small multiple of the time that a right one needs.
//!
//! **The SCPUs.** The AFU says its number of SCPUs and their interval. In each interval each SCPU takes a pair, and all
//! together no more than one line per cycle ([`Capability::computing_cycles`]).
//!
//! **A search.** Its comparisons and its contacts are bounded by their numbers ([`SearchWork`]). The SCPUs compute the
//! contacts.
//!
//! **Requests.** A line that is read or written takes 1 ÷ rate cycles of its direction's bandwidth and of the bandwidth
//! that both share. An AFU keeps `WINDOW` requests of a direction in flight, or as many as the link takes. All of
//! them are answered within the link's longest latency (tail and stragglers included) and the time of so many lines.
//! So *n* lines take at most ⌈n ÷ window⌉ times that latency beside their bandwidth. Between two windows the AFU takes
//! `TURNAROUND` cycles to ask again, and may miss a turn of its SCPUs. Its results wait in a memory that holds all
//! that its SCPUs do, so its own latency counts once. One window more is what an earlier job may have left in flight.
//!
//! **Refusals.** A direction that stalls does so at random: in each cycle outside a stall one begins with chance *c*.
//! The number of stalls before *n* open cycles is a sum of *n* geometric variables, so by Chernoff's bound, for any *s*
//! from 1 to 1 ÷ c, it is *k* or more with a chance of at most ((1 − c) ÷ (1 − c·s))ⁿ · s⁻ᵏ. `refused` takes the *k*
//! for which that chance is `RARE`, and each stall at its longest. Reads wait for what refuses reads, and writes for
//! what refuses writes.
//!
//! **The shell.** SPL2's shell finds the job after its longest pause and two reads. While the job runs it polls the
//! control memory. A poll that delays no line takes no time, so there are no more of them than lines of the job; and
//! each follows a pause. Polls that take up to half a pause at most double the job, so that they are no more than the
//! pauses in twice the time that the job takes without them. If each takes longer, the job has fewer lines than that.
//! The shell's writes are counters, fence and status. Almost-full and acknowledgements that are held back are refusals.

use crate::afu::shell::spl2::map;
use crate::link::spl2::Spl2Model;
use crate::link::{Direction, LinkModel, Stalls};
use crate::record::Capability;

/// Requests of one direction that an AFU keeps in flight, whatever its shell: the line port has 64, SPL2's almost-full
/// stops it at 54 and more.
const WINDOW: u32 = 48;
/// Cycles from a response to the request that it makes room for, through the shell, with much to spare.
const TURNAROUND: f64 = 32.0;
/// Source lines that an AFU may hold: those it may ask for at once, and the feeder's two.
const HELD_LINES: u64 = 66;
/// Lines that SPL2's shell reads for itself besides polls: the context, and the control memory before the job.
const SHELL_READS: u64 = 2;
/// Lines that it writes for itself: identity, scratch, latency, performance, fence, status.
const SHELL_WRITES: u64 = 6;
/// Cycles in which the host writes the registers of a job over AXI4-Lite, with much to spare.
const AXI_ACCESSES: f64 = 1000.0;
/// The chance that a right AFU meets more refusals than are allowed for.
const RARE: f64 = 1e-9;

/// A job, as far as it takes time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Pairs.
    pub pairs: u64,
    /// Source lines.
    pub reads: u64,
    /// Destination lines, at most.
    pub writes: u64,
    /// Cycles without a response after which the AFU itself gives up, if it does.
    pub watchdog: u32,
    /// A search among spheres, if there is one.
    pub search: SearchWork,
}

/// A search among spheres, as far as it takes time. It may take all of that without a sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SearchWork {
    /// Cycles until all contacts are found, at most.
    pub cycles: u64,
    /// Contacts that it finds, at most.
    pub contacts: u64,
}

impl SearchWork {
    /// Cycles that it takes on this AFU at most, as if the SCPUs began when all contacts are found.
    fn bound(self, afu: &Capability) -> u64 {
        let computing = if self.contacts == 0 { 0 } else { afu.computing_cycles(self.contacts) };
        self.cycles.saturating_add(computing)
    }
}

/// When a host gives up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patience {
    /// Cycles since the start.
    pub whole: u64,
    /// Cycles without a request of the AFU's, or a response to one, that is part of the job.
    pub quiet: u64,
}

/// Patience with an AFU at the line port itself.
pub fn line(afu: &Capability, link: &LinkModel, work: &Work) -> Patience {
    both(afu, work, |work| cycles(afu, link, work, &[], &[]))
}

/// Patience with an AFU below SPL2.
pub fn spl2(afu: &Capability, link: &LinkModel, spl2: &Spl2Model, work: &Work) -> Patience {
    let held = Stalls { chance: spl2.held, longest: 1 };
    let (of_reads, of_writes) = ([spl2.almostfull], [spl2.almostfull, held]);
    let pause = f64::from(map::RUNNING_POLL_CYCLES);
    both(afu, work, |work| {
        let own = Work { reads: work.reads + SHELL_READS, writes: work.writes + SHELL_WRITES, ..*work };
        let polls = (2.0 * cycles(afu, link, &own, &of_reads, &of_writes) / pause) as u64;
        let reads = own.reads + polls.min(own.reads);
        pause + cycles(afu, link, &Work { reads, ..own }, &of_reads, &of_writes)
    })
}

/// Patience with an AFU behind AXI4, whose memory refuses and holds back as these stalls say, beside its link.
pub(crate) fn axi(
    afu: &Capability,
    link: &LinkModel,
    of_reads: &[Stalls],
    of_writes: &[Stalls],
    work: &Work,
) -> Patience {
    both(afu, work, |work| AXI_ACCESSES + cycles(afu, link, work, of_reads, of_writes))
}

/// The bound for the whole job, and for what an AFU may hold of it: with that much inside and nothing more to read, it
/// may compute without a sign.
fn both(afu: &Capability, work: &Work, cycles: impl Fn(&Work) -> f64) -> Patience {
    let held = Work {
        pairs: work.pairs.min(HELD_LINES * u64::from(afu.pairs_per_line())),
        reads: work.reads.min(HELD_LINES),
        writes: work.writes.min(HELD_LINES),
        ..*work
    };
    let search = work.search.bound(afu);
    let bound = |work: &Work| (cycles(work).ceil() as u64).saturating_add(work.watchdog.into()).saturating_add(search);
    Patience { whole: bound(work), quiet: bound(&held) }
}

/// The bound for `work` over a link, below a shell that refuses requests as these stalls say besides.
fn cycles(afu: &Capability, link: &LinkModel, work: &Work, of_reads: &[Stalls], of_writes: &[Stalls]) -> f64 {
    let between = TURNAROUND + f64::from(afu.interval);
    let lines = |lines: u64, direction: &Direction, shell: &[Stalls]| {
        let window = direction.in_flight.min(WINDOW);
        let windows = lines.div_ceil(u64::from(window)) + 1;
        let all = lines as f64 + f64::from(direction.in_flight);
        let slowest = [direction.latency, direction.tail, direction.stragglers.cycles].map(f64::from);
        let bandwidth = 1.0 / direction.lines_per_cycle + 1.0 / link.lines_per_cycle;
        let open = all * bandwidth + windows as f64 * (slowest.iter().sum::<f64>() + between);
        open + [direction.stalls].iter().chain(shell).map(|stalls| refused(stalls, open)).sum::<f64>()
    };
    let computing = (afu.computing_cycles(work.pairs) + afu.latency_cycles()) as f64;
    computing + lines(work.reads, &link.read, of_reads) + lines(work.writes, &link.write, of_writes)
}

/// The largest number of refused cycles among this number of open cycles, except with probability [`RARE`].
fn refused(stalls: &Stalls, open: f64) -> f64 {
    let Stalls { chance: c, longest } = *stalls;
    if c <= 0.0 || longest == 0 {
        return 0.0;
    }
    // Each s gives a bound; the smallest counts.
    let bound = |power: i32| {
        let s = c.powf(-f64::from(power) / 64.0);
        (open * ((1.0 - c) / (1.0 - c * s)).ln() - RARE.ln()) / s.ln()
    };
    (1..64).map(bound).fold(f64::INFINITY, f64::min).max(0.0) * f64::from(longest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;

    fn afu(scpus: u32, interval: u32) -> Capability {
        Capability::new(&Config { scpus, interval, ..Config::default() }, 60)
    }

    fn work(pairs: u64) -> Work {
        Work { pairs, reads: pairs.div_ceil(2), writes: pairs.div_ceil(2), watchdog: 0, search: SearchWork::default() }
    }

    #[test]
    fn no_bound_is_below_what_link_and_scpus_allow() {
        for name in LinkModel::PRESETS {
            let link: LinkModel = name.parse().expect("a preset");
            for (scpus, interval, pairs) in [(1, 64, 3000), (10, 1, 100_000), (64, 5, 1), (3, 7, 0)] {
                let (afu, work) = (afu(scpus, interval), work(pairs));
                let least = link.limit_cycles(work.reads, work.writes);
                let least = least.max((pairs * u64::from(interval)).div_ceil(u64::from(scpus)) as f64) as u64;
                let line = line(&afu, &link, &work);
                let below = spl2(&afu, &link, &Spl2Model::default(), &work);
                assert!(least < line.whole && line.whole < below.whole, "{name}: {least} {line:?} {below:?}");
                assert!(line.quiet <= line.whole && below.quiet <= below.whole);
            }
        }
    }

    /// A hang costs a small multiple of the job.
    #[test]
    fn a_bound_is_no_blank_cheque() {
        let (afu, link) = (afu(10, 5), LinkModel::ideal());
        let patience = spl2(&afu, &link, &Spl2Model::default(), &work(90_000));
        assert!(patience.whole < 8 * 45_000 && patience.quiet < 10_000, "{patience:?}");
        let short = line(&afu, &link, &work(10));
        assert!(short.whole < 2_000, "{short:?}");
        assert_eq!(short.whole + 77, line(&afu, &link, &Work { watchdog: 77, ..work(10) }).whole);
    }

    #[test]
    fn contacts_of_a_search_take_turns_in_the_scpus() {
        let (link, search) = (LinkModel::ideal(), SearchWork { cycles: 1000, contacts: 50_000 });
        let work = |search| Work { reads: 80, writes: 50_000, search, ..Work::default() };
        let bound = |scpus, interval, search| line(&afu(scpus, interval), &link, &work(search)).whole;
        let by_the_contacts =
            |scpus, interval| bound(scpus, interval, search) - bound(scpus, interval, SearchWork::default()) - 1000;
        assert_eq!(by_the_contacts(1, 4), 4 * 50_000 + 4);
        assert_eq!(by_the_contacts(2, 4), 2 * 50_000 + 4);
    }

    /// Against the sum itself, drawn many times.
    #[test]
    fn refusals_stay_below_their_bound() {
        use rand::{Rng, SeedableRng};
        let mut random = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(1);
        for (chance, open) in [(0.04, 1000), (0.5, 300), (0.9, 20), (0.99, 1), (1e-4, 30_000)] {
            let bound = refused(&Stalls { chance, longest: 1 }, f64::from(open));
            let mean = f64::from(open) * chance / (1.0 - chance);
            let most = (0..300)
                .map(|_| {
                    let mut stalls = 0;
                    let mut left = open;
                    while left > 0 {
                        let stalled = ((random.next_u64() >> 11) as f64) < chance * (1u64 << 53) as f64;
                        if stalled { stalls += 1 } else { left -= 1 }
                    }
                    stalls
                })
                .max();
            let most = f64::from(most.unwrap_or(0));
            assert!(most <= bound, "{chance}: {most} of {bound}");
            assert!(bound <= 2.0 * mean + 50.0 / -chance.ln() + 20.0, "{chance}: {bound}, on average {mean}");
        }
        assert_eq!(refused(&Stalls::default(), 1e6), 0.0);
    }
}
