//! A generated AFU in the crate's own evaluator, with an ideal link; and lines laid out independently of the crate's
//! layout.

use contact_afu::afu::{Afu, Spec};
use contact_afu::config::{Config, Results};
use contact_afu::hdl::Evaluator;
use contact_afu::kernel::narrow;
use contact_afu::link::Line;
use contact_afu::query::{ContactRecord, Fields};

/// Packs records into lines. Each record is padded to a power of two.
fn lines(records: impl IntoIterator<Item = Vec<u8>>) -> Vec<Line> {
    let mut bytes = Vec::new();
    for mut record in records {
        record.resize(record.len().next_power_of_two(), 0);
        bytes.extend(record);
    }
    bytes.resize(bytes.len().next_multiple_of(64), 0);
    let word = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().unwrap());
    bytes.chunks(64).map(|line| std::array::from_fn(|i| word(&line[4 * i..4 * i + 4]))).collect()
}

/// A word as it is stored in memory.
fn bytes(config: &Config, word: u32, is_number: bool) -> Vec<u8> {
    let format = config.record.format();
    let short = if is_number { narrow(word, format) } else { word };
    short.to_le_bytes()[..format.width() as usize / 8].to_vec()
}

/// The source lines. If all spheres have the same radius, the fourth and the eighth word of a pair are missing.
fn source(config: &Config, pairs: &[[u32; 8]]) -> Vec<Line> {
    let words = |pair: &[u32; 8]| {
        let there = (0..8).filter(|word| config.radius.is_none() || word % 4 != 3);
        there.flat_map(|word| bytes(config, pair[word], true)).collect()
    };
    lines(pairs.iter().map(words))
}

/// The destination lines if every pair has a record.
pub fn destination(config: &Config, contacts: &[ContactRecord]) -> Vec<Line> {
    let fields = config.contact;
    if fields == Fields::HIT && config.results == Results::All {
        let byte = |eight: &[ContactRecord]| {
            eight.iter().enumerate().fold(0, |byte, (bit, contact)| byte | u8::from(contact.is_contact()) << bit)
        };
        return lines(contacts.chunks(8).map(|eight| vec![byte(eight)]));
    }
    let any = fields != Fields::HIT;
    let record = |(number, contact): (u32, &ContactRecord)| {
        let mut record = if config.results == Results::Hits { number.to_le_bytes().to_vec() } else { vec![] };
        for (asked, words) in [(fields.position, 0..3), (fields.normal, 3..6), (fields.depth, 6..7), (any, 7..8)] {
            record.extend(words.filter(|_| asked).flat_map(|word| bytes(config, contact.0[word], word < 7)));
        }
        record
    };
    let is_there = |(_, contact): &(u32, &ContactRecord)| config.results == Results::All || contact.is_contact();
    lines((0..).zip(contacts).filter(is_there).map(record))
}

/// The destination lines of a job at the line port, where each request is answered in the next cycle.
pub fn at_the_line_port(config: &Config, pairs: &[[u32; 8]]) -> Vec<Line> {
    let source = source(config, pairs);
    let afu = Afu::generate(Spec::from(config.clone())).unwrap();
    let mut run = Evaluator::new(afu.top(), &[("SCPUS", config.scpus)]).unwrap();
    run.reset();
    let pin = |run: &Evaluator, name: &str| run.pin(name).unwrap();
    let set = |run: &mut Evaluator, name: &str, value: u64| run.write(pin(run, name), value);
    let get = |run: &mut Evaluator, name: &str| run.read(pin(run, name));
    if config.results == Results::Hits {
        set(&mut run, "destination_lines", 1000);
    }
    for (name, value) in [("count", pairs.len() as u64), ("start", 1), ("rd_req_ready", 1), ("wr_req_ready", 1)] {
        set(&mut run, name, value);
    }
    let mut written = vec![];
    for _ in 0..50_000 {
        if get(&mut run, "done") == 1 {
            assert_eq!(get(&mut run, "error"), 0, "{config:?}");
            return written;
        }
        let reads = get(&mut run, "rd_req_valid") == 1;
        let (line, read_tag) = (get(&mut run, "rd_req_address"), get(&mut run, "rd_req_tag"));
        let writes = get(&mut run, "wr_req_valid") == 1;
        let (at, write_tag) = (get(&mut run, "wr_req_address"), get(&mut run, "wr_req_tag"));
        if writes {
            assert_eq!(at, written.len() as u64, "lines are written in order");
            let (mut data, from) = ([0; 8], pin(&run, "wr_req_data"));
            run.read_words(from, &mut data);
            written.push(std::array::from_fn(|i| (data[i / 2] >> (i % 2 * 32)) as u32));
        }
        run.step();
        set(&mut run, "start", 0);
        set(&mut run, "rd_rsp_valid", reads.into());
        set(&mut run, "wr_rsp_valid", writes.into());
        if reads {
            let data: Vec<u64> =
                source[line as usize].chunks(2).map(|two| u64::from(two[0]) | u64::from(two[1]) << 32).collect();
            set(&mut run, "rd_rsp_tag", read_tag);
            let to = pin(&run, "rd_rsp_data");
            run.write_words(to, &data);
        }
        set(&mut run, "wr_rsp_tag", write_tag);
    }
    panic!("{config:?}: the job does not end");
}
