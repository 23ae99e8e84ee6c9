//! The controller around a kernel of fixed delay, in the evaluator, connected to a small model of a link; and the
//! expected results.

use std::collections::VecDeque;
use std::sync::Arc;

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Shell};
use contact_afu::hdl::{Evaluator, Graph, Module, Pin, Port};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

const LATENCY: u32 = 5;

/// A kernel that passes words through. A pair hits if x1's lowest bit is set; the fields are its words from x1 on.
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
    pins: Vec<(String, Pin)>,
}

impl Ports {
    fn pin(&self, name: &str) -> Pin {
        self.pins.iter().find(|(known, _)| known == name).unwrap().1
    }
}

pub struct Bench {
    spec: Spec,
    /// Decides which pairs hit.
    pub hits: fn(u64) -> bool,
    pub run: Evaluator,
    ports: Ports,
    random: Xoshiro256PlusPlus,
    /// The link is ready or answers in a cycle with a chance of `eagerness` in 8; 8 is an ideal link.
    eagerness: u32,
    /// The same for writes.
    pub write_eagerness: u32,
    pub reads: Vec<(u64, u64)>,
    pub writes: VecDeque<u64>,
    pub written: Vec<(u64, Vec<u64>)>,
    /// True if the link accepts and answers requests.
    pub accepts: bool,
    pub answers: bool,
    /// A response that replaces the link's in the next cycle: port and tag.
    pub forged: Option<(&'static str, u64)>,
}

impl Bench {
    pub fn new(scpus: u32, eagerness: u32, seed: u64) -> Self {
        Self::of(Spec::from(Config { scpus, ..Config::default() }), eagerness, seed)
    }

    /// The core alone, whichever shell the specification names.
    pub fn of(mut spec: Spec, eagerness: u32, seed: u64) -> Self {
        spec.config.shell = Shell::Line;
        let scpus = spec.config.scpus;
        let afu = Afu::around(spec.clone(), kernel()).unwrap();
        let mut run = Evaluator::new(afu.top(), &[("SCPUS", scpus)]).unwrap();
        run.reset();
        // No job begins before the delay lines beside the SCPUs are filled.
        (0..2 * (LATENCY + scpus)).for_each(|_| run.step());
        let pin = |port: &Port| (port.name.clone(), run.pin(&port.name).unwrap());
        let pins = afu.top().ports.iter().map(pin).collect();
        Self {
            spec,
            hits: |pair| mixed(pair) & 1 == 1,
            run,
            ports: Ports { pins },
            random: Xoshiro256PlusPlus::seed_from_u64(seed),
            eagerness,
            write_eagerness: eagerness,
            reads: Vec::new(),
            writes: VecDeque::new(),
            written: Vec::new(),
            accepts: true,
            answers: true,
            forged: None,
        }
    }

    pub fn set(&mut self, name: &str, value: u64) {
        let pin = self.ports.pin(name);
        self.run.write(pin, value);
    }

    pub fn get(&mut self, name: &str) -> u64 {
        let pin = self.ports.pin(name);
        self.run.read(pin)
    }

    fn eager(&mut self, eagerness: u32) -> bool {
        self.random.random_range(0..8) < eagerness
    }

    /// One cycle of a link that answers in random order, at random times.
    pub fn cycle(&mut self) {
        let (read_ready, write_ready) = (self.eager(self.eagerness), self.eager(self.write_eagerness));
        let (read_ready, write_ready) = (read_ready && self.accepts, write_ready && self.accepts);
        let forged = self.forged.take();
        self.set("rd_req_ready", u64::from(read_ready));
        self.set("wr_req_ready", u64::from(write_ready));
        let answers = self.answers && forged.is_none();
        let answer_read = self.eager(self.eagerness) && !self.reads.is_empty() && answers;
        self.set("rd_rsp_valid", u64::from(answer_read));
        if answer_read {
            let index = if self.eagerness == 8 { 0 } else { self.random.random_range(0..self.reads.len()) };
            let (address, tag) = self.reads.remove(index);
            self.set("rd_rsp_tag", tag);
            let pin = self.ports.pin("rd_rsp_data");
            let line = self.line(address);
            self.run.write_words(pin, &line);
        }
        let answer_write = self.eager(self.write_eagerness) && !self.writes.is_empty() && answers;
        self.set("wr_rsp_valid", u64::from(answer_write));
        if answer_write {
            let index = if self.write_eagerness == 8 { 0 } else { self.random.random_range(0..self.writes.len()) };
            let tag = self.writes.remove(index).unwrap();
            self.set("wr_rsp_tag", tag);
        }
        if let Some((port, tag)) = forged {
            self.set(&format!("{port}_rsp_valid"), 1);
            self.set(&format!("{port}_rsp_tag"), tag);
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
            let mut data = vec![0; self.spec.line_bits as usize / 64];
            self.run.read_words(pin, &mut data);
            self.written.push((address, data));
        }
        self.run.step();
    }

    /// A source line of pairs.
    fn line(&self, address: u64) -> Vec<u64> {
        let per_line = u64::from(self.spec.line_bits / 256);
        let first = per_line * (address - 1000);
        let words: Vec<u64> = (first..first + per_line).flat_map(|pair| words(self.x1(pair), pair)).collect();
        words.chunks(2).map(|two| two[0] | two[1] << 32).collect()
    }

    /// The first word of a pair: a number that identifies it, never a NaN or an infinity.
    fn x1(&self, pair: u64) -> u64 {
        mixed(pair) & !1 | u64::from((self.hits)(pair))
    }

    pub fn start(&mut self, count: u64, epoch: u64) {
        self.written.clear();
        for (name, value) in [("source", 1000), ("destination", 5000), ("count", count), ("epoch", epoch), ("start", 1)]
        {
            self.set(name, value);
        }
        self.cycle();
        self.set("start", 0);
    }

    /// Runs to the end of the job; returns the number of cycles.
    pub fn finish(&mut self) -> u64 {
        for cycles in 1..200_000 {
            if self.get("done") == 1 {
                return cycles;
            }
            self.cycle();
        }
        panic!("the job does not end: {:?}", self.spec.config);
    }

    pub fn check(&mut self, count: u64) {
        assert_eq!(self.get("error"), 0);
        assert!(self.reads.is_empty() && self.writes.is_empty());
        self.written.sort();
        assert_eq!(self.written.len() as u64, count.div_ceil(2));
        for (index, (address, data)) in self.written.iter().enumerate() {
            assert_eq!(*address, 5000 + index as u64);
            for half in 0..2 {
                let pair = 2 * index as u64 + half;
                let got = &data[4 * half as usize..4 * half as usize + 4];
                let expected = if pair < count { expected(self.x1(pair), pair) } else { [0; 4] };
                assert_eq!(got, expected, "pair {pair} of {count}");
            }
        }
        let contacts = (0..count).filter(|pair| (self.hits)(*pair)).count() as u64;
        assert_eq!(self.get("contacts"), contacts);
    }

    /// Checks a job that returns only contacts: they are in order and densely packed while there is room, and all are
    /// counted.
    pub fn check_hits(&mut self, count: u64, room: u64) {
        let what = format!("{count} pairs, {:?}", self.spec);
        let hits: Vec<u64> = (0..count).filter(|pair| (self.hits)(*pair)).collect();
        let contact = self.spec.config.contact;
        let record = |&pair: &u64| {
            // A record is the number, then the selected words, padded to a power of two.
            let full = expected(self.x1(pair), pair);
            let word = |index: usize| full[index / 2] >> (index % 2 * 32) & 0xffff_ffff;
            let mut words = vec![pair];
            for (asked, part) in [(contact.position, 0..3), (contact.normal, 3..6), (contact.depth, 6..7)] {
                words.extend(part.filter(|_| asked).map(word));
            }
            words.extend(contact.need_distance().then(|| word(7)));
            words.resize(words.len().next_power_of_two(), 0);
            words
        };
        let mut words: Vec<u64> = hits.iter().flat_map(record).collect();
        let line_words = self.spec.line_bits as usize / 32;
        words.resize(words.len().next_multiple_of(line_words), 0);
        let lines: Vec<Vec<u64>> =
            words.chunks(line_words).map(|line| line.chunks(2).map(|two| two[0] | two[1] << 32).collect()).collect();
        let fits = lines.len() as u64 <= room;
        assert_eq!(self.get("error"), if fits { 0 } else { 6 }, "{what}");
        assert_eq!(self.get("contacts"), hits.len() as u64, "{what}");
        assert!(self.reads.is_empty() && self.writes.is_empty());
        self.written.sort();
        let expected = (5000..).zip(lines).take(room as usize).collect::<Vec<_>>();
        assert!(self.written == expected, "{what}: {:x?}, not {expected:x?}", self.written);
    }
}

/// A different number for each pair.
pub fn mixed(pair: u64) -> u64 {
    (pair.wrapping_mul(2_654_435_761) ^ pair << 3) & 0x3fff_ffff
}

fn words(x1: u64, pair: u64) -> [u64; 8] {
    let mut words = [pair & 0xffff; 8];
    words[0] = x1;
    words
}

fn expected(x1: u64, pair: u64) -> [u64; 4] {
    let mut record = words(x1, pair);
    let hit = record[0] & 1;
    let flow = if hit == 0 { 1 } else { 3 - (record[0] >> 1 & 1) };
    record[7] = hit | flow << 1;
    std::array::from_fn(|index| record[2 * index] | record[2 * index + 1] << 32)
}
