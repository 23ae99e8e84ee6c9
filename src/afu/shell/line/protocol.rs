//! The protocol of the line port, for PORTS.md.

use std::fmt::Write as _;

use crate::afu::{Afu, EPOCH_BITS, JobError};
use crate::config::{Input, Results};

/// The protocol of a job on the line port, with its timing.
pub(super) fn protocol(afu: &Afu) -> String {
    let spec = afu.spec();
    let (inputs, data) = match (spec.config.input, spec.config.results) {
        (Input::Spheres, _) => ("`destination`, `destination_lines`, `others`", "spheres"),
        (Input::Direct, Results::Hits) => ("`destination`, `destination_lines`", "pairs"),
        (Input::Direct, Results::All) => ("`destination`", "pairs"),
    };
    let timing = if spec.config.input == Input::Direct { waves(afu) } else { String::new() };
    let slot_bits = spec.max_outstanding.ilog2();
    let reset = if spec.reset.active_low { "`rst_n` low" } else { "`rst` high" };
    let kind = if spec.reset.asynchronous { "acts without a clock edge" } else { "is sampled at the rising edge" };
    format!(
        "
## Sampling

Everything is sampled at the rising edge of `clk`, at the end of its cycle. Reset is {reset}; it {kind}. The table \
has the levels in reset; `contacts`, `invalid` and `first_invalid` have theirs from its second cycle on.

- `start` is taken in a cycle in which `busy` is low, and with it `source`, {inputs}, `count`, `mode`, `epoch` and `watchdog`. In \
         other cycles these may have any level.
- `abort_job` is sampled in every cycle of a job.
- A request is made in a cycle in which its `valid` and `ready` are both high. Until then `valid` stays high, and address, tag \
         and data stay as they are. `ready` may be high before `valid`, and may depend on it.
- A response is taken in every cycle in which its `valid` is high, from the cycle after its request on, at the earliest. Tag, \
         data and error of a response that is not valid may have any level.
- A response with the job's epoch that no request waits for ends the job with error {}.
- With error {} the job gives up what is outstanding. A request that stands on the port then stays there, as it is, until it is \
         accepted: memory may still be read or written once where that job's lines are. A reset withdraws it.
- A tag is the job's `epoch` in bits {}:{slot_bits}, and a number of 0 to {} below. At most {} reads and {} writes are outstanding.

## A job

1. Reset the AFU once. Put the {data} into memory from line `source` on.
2. While `busy` is low, raise `start` for one cycle. The AFU reads each source line once, in order; memory may answer in any order.
3. It writes each destination line once, in order, from line `destination` on.
4. `done` rises after the last write was acknowledged. Until the next start `error`, `contacts`, `invalid`, `first_invalid` and \
         the cycle counters stay as they are.

{}",
        JobError::Response.code(),
        JobError::Watchdog.code(),
        slot_bits + EPOCH_BITS - 1,
        spec.max_outstanding - 1,
        spec.max_outstanding,
        spec.max_outstanding,
        timing,
    )
}

/// A job of one pair, cycle by cycle.
fn waves(afu: &Afu) -> String {
    let (timing, layout, config) = (afu.timing(), afu.layout(), &afu.spec().config);
    let request = timing.start + timing.request;
    let flush = if layout.contacts_per_line() > 1 { timing.flush } else { 0 };
    let through = [timing.collect, timing.feed, timing.scpu, timing.chain, timing.pack, flush, timing.dispatch];
    let through: u32 = through.iter().sum();
    let end = timing.acknowledge + timing.done;
    let write = match (config.results, config.interval) {
        (Results::Hits, _) => "some cycles after A".to_owned(),
        (_, 1) => format!("A + {through}"),
        (_, interval) => format!("A + {through} to A + {}", through + interval - 1),
    };
    let columns = ["0", "1", "..", "R", "R+1", "..", "A", "A+1", "..", "W", "W+1", "..", "B", "B+1", "..", "D", "D+1"];
    let rows: [(&str, &[&str]); 9] = [
        ("start", &["0"]),
        ("busy", &["1", "R", "R+1", "A", "A+1", "W", "W+1", "B", "B+1", ".."]),
        ("rd_req_valid", &["R"]),
        ("rd_req_ready", &["R"]),
        ("rd_rsp_valid", &["A"]),
        ("wr_req_valid", &["W"]),
        ("wr_req_ready", &["W"]),
        ("wr_rsp_valid", &["B"]),
        ("done", &["D", "D+1"]),
    ];
    let mut out = format!(
        "## Timing

A job of one pair in contact: `#` is high, `_` is low, for the whole cycle.

```text
{:<13}",
        "cycle"
    );
    for column in columns {
        let _ = write!(out, "{column:>5}");
    }
    for (name, high) in rows {
        let _ = write!(out, "\n{name:<13}");
        for column in columns {
            let sign = if high.contains(&column) { '#' } else { '_' };
            out += &format!(" {}", sign.to_string().repeat(4));
        }
    }
    let _ = write!(
        out,
        "
```

- R = {request}: the first read request.
- A is the memory's: its answer, R + 1 at the earliest.
- W = {write}: the write request.
- B is the memory's: its acknowledgement, W + 1 at the earliest.
- D = B + {end}: the job has ended.

A job that is started in the first {} cycles after a reset begins after them: until then, delay lines are being filled.
",
        timing.fill
    );
    out
}
