//! The controller around a kernel of fixed delay, run in the evaluator over small links of the test's own: every
//! pair comes back once, in order, whatever the link does.

use std::collections::VecDeque;
use std::sync::Arc;

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::Config;
use contact_afu::hdl::{Evaluator, Graph, Module, Pin};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

const LATENCY: u32 = 5;

/// A kernel that passes words through: hit where x1's lowest bit is set, fields from x1 on.
fn kernel() -> Arc<Module> {
    let graph = Graph::new("sphere_kernel");
    let words: Vec<_> = ["x1", "y1", "z1", "r1", "x2", "y2", "z2", "r2"].map(|name| graph.input(name, 32)).to_vec();
    let valid = graph.input("valid", 1);
    graph.output("hit", (valid & words[0].bit(0)).delay(LATENCY));
    graph.output("grazing", words[0].bit(1).delay(LATENCY));
    let names = ["pos_x", "pos_y", "pos_z", "normal_x", "normal_y", "normal_z", "depth"];
    for (name, word) in names.iter().zip(&words) {
        graph.output(name, word.delay(LATENCY));
    }
    let mut module = graph.finish().unwrap();
    Arc::get_mut(&mut module).unwrap().latency = LATENCY;
    module
}

struct Ports {
    pins: Vec<(&'static str, Pin)>,
}

impl Ports {
    fn pin(&self, name: &str) -> Pin {
        self.pins.iter().find(|(known, _)| *known == name).unwrap().1
    }
}

const NAMES: [&str; 30] = [
    "start",
    "source",
    "destination",
    "count",
    "mode",
    "epoch",
    "watchdog",
    "abort_job",
    "rd_req_ready",
    "rd_rsp_valid",
    "rd_rsp_tag",
    "rd_rsp_data",
    "rd_rsp_error",
    "wr_req_ready",
    "wr_rsp_valid",
    "wr_rsp_tag",
    "wr_rsp_error",
    "busy",
    "done",
    "error",
    "contacts",
    "invalid",
    "first_invalid",
    "rd_req_valid",
    "rd_req_address",
    "rd_req_tag",
    "wr_req_valid",
    "wr_req_address",
    "wr_req_tag",
    "wr_req_data",
];

struct Bench {
    run: Evaluator,
    ports: Ports,
    random: Xoshiro256PlusPlus,
    /// Chance in 8 that the link is ready or answers in a cycle; 8 is an ideal link.
    eagerness: u32,
    reads: Vec<(u64, u64)>,
    writes: VecDeque<u64>,
    written: Vec<(u64, Vec<u64>)>,
}

impl Bench {
    fn new(scpus: u32, eagerness: u32, seed: u64) -> Self {
        let afu = Afu::around(Spec::from(Config { scpus, ..Config::default() }), kernel()).unwrap();
        let mut run = Evaluator::new(afu.top(), &[("SCPUS", scpus)]).unwrap();
        run.reset();
        let pins = NAMES.iter().map(|name| (*name, run.pin(name).unwrap())).collect();
        Self {
            run,
            ports: Ports { pins },
            random: Xoshiro256PlusPlus::seed_from_u64(seed),
            eagerness,
            reads: Vec::new(),
            writes: VecDeque::new(),
            written: Vec::new(),
        }
    }

    fn set(&mut self, name: &str, value: u64) {
        let pin = self.ports.pin(name);
        self.run.write(pin, value);
    }

    fn get(&mut self, name: &str) -> u64 {
        let pin = self.ports.pin(name);
        self.run.read(pin)
    }

    fn eager(&mut self) -> bool {
        self.random.random_range(0..8) < self.eagerness
    }

    /// One cycle of a link that answers in random order, at random times.
    fn cycle(&mut self) {
        let (read_ready, write_ready) = (self.eager(), self.eager());
        self.set("rd_req_ready", u64::from(read_ready));
        self.set("wr_req_ready", u64::from(write_ready));
        let answer_read = self.eager() && !self.reads.is_empty();
        self.set("rd_rsp_valid", u64::from(answer_read));
        if answer_read {
            let index = if self.eagerness == 8 { 0 } else { self.random.random_range(0..self.reads.len()) };
            let (address, tag) = self.reads.remove(index);
            self.set("rd_rsp_tag", tag);
            let pin = self.ports.pin("rd_rsp_data");
            self.run.write_words(pin, &line(address));
        }
        let answer_write = self.eager() && !self.writes.is_empty();
        self.set("wr_rsp_valid", u64::from(answer_write));
        if answer_write {
            let index = if self.eagerness == 8 { 0 } else { self.random.random_range(0..self.writes.len()) };
            let tag = self.writes.remove(index).unwrap();
            self.set("wr_rsp_tag", tag);
        }
        if read_ready && self.get("rd_req_valid") == 1 {
            let request = (self.get("rd_req_address"), self.get("rd_req_tag"));
            assert!(self.reads.iter().all(|(_, tag)| *tag != request.1), "a read tag is used twice");
            self.reads.push(request);
            assert!(self.reads.len() <= 64);
        }
        if write_ready && self.get("wr_req_valid") == 1 {
            let (address, tag) = (self.get("wr_req_address"), self.get("wr_req_tag"));
            assert!(!self.writes.contains(&tag), "a write tag is used twice");
            self.writes.push_back(tag);
            let pin = self.ports.pin("wr_req_data");
            let mut data = vec![0; 8];
            self.run.read_words(pin, &mut data);
            self.written.push((address, data));
        }
        self.run.step();
    }

    fn start(&mut self, count: u64, epoch: u64) {
        self.written.clear();
        for (name, value) in [("source", 1000), ("destination", 5000), ("count", count), ("epoch", epoch), ("start", 1)]
        {
            self.set(name, value);
        }
        self.cycle();
        self.set("start", 0);
    }

    /// Runs to the end of the job; gives the cycles it took.
    fn finish(&mut self) -> u64 {
        for cycles in 1..200_000 {
            if self.get("done") == 1 {
                return cycles;
            }
            self.cycle();
        }
        panic!("the job does not end");
    }

    fn check(&mut self, count: u64) {
        assert_eq!(self.get("error"), 0);
        assert!(self.reads.is_empty() && self.writes.is_empty());
        self.written.sort();
        assert_eq!(self.written.len() as u64, count.div_ceil(2));
        for (index, (address, data)) in self.written.iter().enumerate() {
            assert_eq!(*address, 5000 + index as u64);
            for half in 0..2 {
                let pair = 2 * index as u64 + half;
                let got = &data[4 * half as usize..4 * half as usize + 4];
                let expected = if pair < count { expected(pair) } else { [0; 4] };
                assert_eq!(got, expected, "pair {pair} of {count}");
            }
        }
        let contacts = (0..count).filter(|pair| x1(*pair) & 1 == 1).count() as u64;
        assert_eq!(self.get("contacts"), contacts);
    }
}

/// The first word of a pair: a number of its own, never a NaN or an infinity.
fn x1(pair: u64) -> u64 {
    (pair.wrapping_mul(2_654_435_761) ^ pair << 3) & 0x3fff_ffff
}

fn words(pair: u64) -> [u64; 8] {
    let mut words = [pair & 0xffff; 8];
    words[0] = x1(pair);
    words
}

fn line(address: u64) -> Vec<u64> {
    let first = 2 * (address - 1000);
    let words: Vec<u64> = [first, first + 1].into_iter().flat_map(words).collect();
    words.chunks(2).map(|pair| pair[0] | pair[1] << 32).collect()
}

fn expected(pair: u64) -> [u64; 4] {
    let mut record = words(pair);
    let hit = record[0] & 1;
    let flow = if hit == 0 { 1 } else { 3 - (record[0] >> 1 & 1) };
    record[7] = hit | flow << 1;
    std::array::from_fn(|index| record[2 * index] | record[2 * index + 1] << 32)
}

#[test]
fn every_pair_comes_back_once_and_in_order() {
    for scpus in [1, 2, 3, 7, 10, 16] {
        for eagerness in [8, 5, 2] {
            let mut bench = Bench::new(scpus, eagerness, u64::from(scpus));
            for (epoch, count) in [0, 1, 2, 3, 257, 128, 1].into_iter().enumerate() {
                bench.start(count, epoch as u64);
                bench.finish();
                bench.check(count);
            }
        }
    }
}

#[test]
fn an_ideal_link_is_kept_busy() {
    let mut bench = Bench::new(2, 8, 1);
    bench.start(4000, 1);
    let cycles = bench.finish();
    assert!(cycles < 2000 + 60, "4000 pairs on two SCPUs took {cycles} cycles");
    let mut bench = Bench::new(1, 8, 1);
    bench.start(4000, 1);
    let cycles = bench.finish();
    assert!(cycles < 4000 + 60, "4000 pairs on one SCPU took {cycles} cycles");
}

#[test]
fn an_aborted_job_ends_and_the_next_is_right() {
    for at in 0..120 {
        let mut bench = Bench::new(3, 5, at);
        bench.start(60, 1);
        for _ in 0..at {
            bench.cycle();
        }
        let ended = bench.get("done") == 1;
        bench.set("abort_job", 1);
        bench.cycle();
        bench.set("abort_job", 0);
        bench.finish();
        if !ended {
            let error = bench.get("error");
            assert!(error == 1 || error == 0 && bench.written.len() == 30, "aborted after {at} cycles: error {error}");
        }
        assert!(bench.reads.is_empty() && bench.writes.is_empty(), "ended with requests unanswered");
        bench.start(33, 2);
        bench.finish();
        bench.check(33);
    }
}

#[test]
fn after_a_reset_stale_responses_do_no_harm() {
    for at in 0..120 {
        let mut bench = Bench::new(3, 3, at);
        bench.start(60, 1);
        for _ in 0..at {
            bench.cycle();
        }
        bench.run.reset();
        bench.start(33, 2);
        bench.finish();
        bench.reads.retain(|(_, tag)| tag >> 6 == 2);
        bench.writes.retain(|tag| tag >> 6 == 2);
        bench.check(33);
    }
}

#[test]
fn a_lost_response_ends_in_the_watchdog() {
    let mut bench = Bench::new(3, 8, 1);
    bench.set("watchdog", 50);
    bench.start(60, 1);
    for _ in 0..10 {
        bench.cycle();
    }
    bench.reads.remove(0);
    bench.finish();
    assert_eq!(bench.get("error"), 4);
    bench.start(33, 2);
    bench.finish();
    bench.check(33);
}

#[test]
fn error_responses_and_unknown_modes_end_the_job() {
    for (port, code) in [("rd_rsp_error", 2), ("wr_rsp_error", 3)] {
        let mut bench = Bench::new(3, 8, 1);
        bench.start(300, 1);
        for _ in 0..40 {
            bench.cycle();
        }
        bench.set(port, 1);
        for _ in 0..3 {
            bench.cycle();
        }
        bench.set(port, 0);
        bench.finish();
        assert_eq!(bench.get("error"), code);
        bench.start(33, 2);
        bench.finish();
        bench.check(33);
    }
    let mut bench = Bench::new(3, 8, 1);
    bench.set("mode", 1);
    bench.start(33, 1);
    bench.finish();
    assert_eq!(bench.get("error"), 5);
    bench.set("mode", 0);
    bench.start(33, 2);
    bench.finish();
    bench.check(33);
}
