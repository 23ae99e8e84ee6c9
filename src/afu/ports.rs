//! PORTS.md: what a stranger needs to drive the AFU.

use std::fmt::Write as _;

use crate::config::{Results, Shell};

use super::{Afu, EPOCH_BITS, MAX_SCPUS, timing};

impl Afu {
    /// The text of PORTS.md.
    pub(super) fn ports(&self) -> String {
        let spec = self.spec();
        let mut out = format!(
            "# Ports of `{}`\n\nOne clock. {}All outputs are registered or functions of registers.\nA line is {} bits; word i \
             of a line is bits 32·i+31 to 32·i; addresses count lines.\n\n| port | direction | bits | in reset | meaning \
             |\n|---|---|---|---|---|\n",
            self.top_name(),
            self.scpus(),
            spec.line_bits
        );
        // A top that resets itself has its own reset.
        let held = self.top().reset.map(|_| ("reset_n", 0));
        for (output, width, name) in self.all_ports() {
            let direction = if output { "out" } else { "in" };
            let level = match self.top().at_reset(&name, held) {
                _ if !output || name == "capability" => String::new(),
                Some(value) if width > 4 && value == u128::MAX >> (128 - width) => "all ones".to_owned(),
                Some(value) => value.to_string(),
                None => "any".to_owned(),
            };
            let more = self.more(&name);
            let _ = writeln!(out, "| `{name}` | {direction} | {width} | {level} | {}{more} |", meaning(&name));
        }
        out += &match spec.config.shell {
            Shell::Spl2 => SPL2.to_owned(),
            _ => self.line_port(),
        };
        out + "\n" + &self.records()
    }

    /// Which numbers of SCPUs there can be.
    fn scpus(&self) -> String {
        let spec = self.spec();
        let mut out = format!("`SCPUS` (1 to {MAX_SCPUS}) is a Verilog parameter. ");
        if let Some(multiple) = spec.full_rate().filter(|multiple| *multiple < MAX_SCPUS) {
            let _ = write!(
                out,
                "{multiple} SCPUs at interval {} take a full line of pairs per cycle; above {multiple} the number built is \
                 rounded down to a multiple of {multiple}. ",
                spec.config.interval
            );
        }
        out
    }

    /// How a job goes on the line port, and when.
    fn line_port(&self) -> String {
        let spec = self.spec();
        let hits = spec.config.results == Results::Hits;
        let inputs = if hits { "`destination`, `destination_lines`" } else { "`destination`" };
        let slot_bits = spec.max_outstanding.ilog2();
        let reset = if spec.reset.active_low { "`rst_n` low" } else { "`rst` high" };
        let kind = if spec.reset.asynchronous { "acts without a clock edge" } else { "is sampled at the rising edge" };
        format!(
            "
## Sampling

Everything is sampled at the rising edge of `clk`, at the end of its cycle. Reset is {reset}; it {kind}.

- `start` is taken in a cycle in which `busy` is low, and with it `source`, {inputs}, `count`, `mode`, `epoch` and `watchdog`. In \
             other cycles these may have any level.
- `abort_job` is sampled in every cycle of a job.
- A request is made in a cycle in which its `valid` and `ready` are both high. Until then `valid` stays high, and address, tag \
             and data stay as they are. `ready` may be high before `valid`, and may depend on it.
- A response is taken in every cycle in which its `valid` is high, from the cycle after its request on, at the earliest. Tag, \
             data and error of a response that is not valid may have any level.
- A response with the job's epoch that no request waits for ends the job with error 7.
- With error 4 the job gives up what is outstanding. A request that stands on the port then stays there, as it is, until it is \
             accepted: memory may still be read or written once where that job's lines are. A reset withdraws it.
- A tag is the job's `epoch` in bits {}:{slot_bits}, and a number of 0 to {} below. At most {} reads and {} writes are outstanding.

## A job

1. Reset the AFU once. Put the pairs into memory from line `source` on.
2. While `busy` is low, raise `start` for one cycle. The AFU reads each source line once, in order; memory may answer in any order.
3. It writes each destination line once, in order, from line `destination` on.
4. `done` rises after the last write was acknowledged. Until the next start `error`, `contacts`, `invalid`, `first_invalid` and \
             the cycle counters stay as they are.

{}",
            slot_bits + EPOCH_BITS - 1,
            spec.max_outstanding - 1,
            spec.max_outstanding,
            spec.max_outstanding,
            self.waves(),
        )
    }

    /// A job of one pair, cycle by cycle.
    fn waves(&self) -> String {
        let (timing, layout, config) = (self.timing(), self.layout(), &self.spec().config);
        let request = timing.start + timing.request;
        let flush = if layout.contacts_per_line() > 1 { timing.flush } else { 0 };
        let through = [timing.collect, timing.feed, timing.scpu, timing.gather, timing.pack, flush, timing.dispatch];
        let through: u32 = through.iter().sum();
        let end = timing.acknowledge + timing.done;
        let write = match (config.results, config.interval) {
            (Results::Hits, _) => "some cycles after A".to_owned(),
            (_, 1) => format!("A + {through}"),
            (_, interval) => format!("A + {through} to A + {}", through + interval - 1),
        };
        let columns =
            ["0", "1", "..", "R", "R+1", "..", "A", "A+1", "..", "W", "W+1", "..", "B", "B+1", "..", "D", "D+1"];
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
"
        );
        out
    }

    /// All ports: whether it is an output, width and name.
    pub(super) fn all_ports(&self) -> Vec<(bool, u32, String)> {
        let reset = if self.spec().reset.active_low { "rst_n" } else { "rst" };
        let reset = self.top().has_reset_port().then(|| (false, 1, reset.to_owned()));
        let implied = [(false, 1, "clk".to_owned())].into_iter().chain(reset);
        let declared = self.top().ports.iter().map(|port| (port.output, port.width, port.name.clone()));
        implied.chain(declared).collect()
    }

    /// What a port means beyond [`meaning`] in an AFU that differs from the default one.
    fn more(&self, name: &str) -> String {
        let config = &self.spec().config;
        let of_hits = match name {
            "error" => ", 6 more lines of contacts than `destination_lines`",
            "capability" => ", 24 set: only contacts come back",
            "contacts" => ": as many records, each beginning with its pair's number",
            _ => "",
        };
        let hits = Some(of_hits.to_owned()).filter(|_| config.results == Results::Hits);
        let radius = config.radius.map(|radius| format!(", 25 set: every sphere's radius is {radius}"));
        let code = timing::record_code(config.record);
        let record = (code > 0).then(|| format!(", 27:26 are {code}: words of records are {}", config.record));
        let of_capability = [radius, record].into_iter().flatten().filter(|_| name == "capability");
        hits.into_iter().chain(of_capability).collect()
    }
}

/// Sampling and reset of the shell `spl2`.
const SPL2: &str = "
## Sampling

Everything is sampled at the rising edge of `clk`, at the end of its cycle. So are `reset_n`, \
`spl_reset` and `spl_enable`; each reset needs at least one cycle. The table has the levels after a cycle with `reset_n` low.

- A request stands for one cycle and is taken in it. In the second cycle after almost-full rises, and while it stays high, there \
is none: at most two requests come once it is high. SPL has room for four.
- A header or data whose valid is low may have any level.
- Responses are taken in every cycle in which their valid is high.

```text
cycle                      c  c+1  c+2  c+3  c+4  c+5
spl_tx_rd_almostfull    ____ #### #### #### ____ ____
afu_tx_rd_valid         #### #### #### ____ ____ ____
```

Registers, lines in memory and the steps of a job are in REGISTERS.md.
";

fn meaning(name: &str) -> &'static str {
    match name {
        "clk" => "clock",
        "rst" => "reset, active high; at least one cycle",
        "rst_n" => "reset, active low; at least one cycle",
        "start" => "one cycle high starts a job; ignored while busy",
        "source" => "line address of the first source line",
        "destination" => "line address of the first destination line",
        "destination_lines" => "lines there is room for at the destination; those beyond are not written",
        "count" => "pairs of the job; 0 is a job",
        "mode" => "0; anything else ends the job with error 5",
        "epoch" => "upper part of the job's tags: change it from job to job, so that late responses are known",
        "watchdog" => {
            "cycles without a response, while a request stands on the port or waits for its response, that end the job with \
             error 4; 0: never, but for an aborted or failed job, which ends after 65 536 such cycles"
        }
        "abort_job" => {
            "high ends the job with error 1, when every outstanding request has its response; `watchdog` says what ends it \
             if one never comes"
        }
        "busy" => "a job is running or ending",
        "done" => "the last job has ended; low from the next start on",
        "error" => {
            "how: 0 well, 1 aborted, 2 read error, 3 write error, 4 watchdog, 5 unknown mode, 7 a response that no request \
             waits for"
        }
        "contacts" => "contacts of the job so far",
        "invalid" => "invalid pairs of the job so far",
        "first_invalid" => "number of the first invalid pair, all ones if there is none",
        "cycles_busy" => "cycles of the job so far",
        "cycles_input" => "of these, cycles in which the SCPUs waited for pairs",
        "cycles_output" => "of these, cycles in which pairs waited for room for their results",
        "capability" => {
            "7:0 SCPUS, 15:8 interval, 19:16 fields (hit, depth, normal, position from bit 16 up), 43:32 SCPU latency"
        }
        "rd_req_valid" => "a read request; it stays as it is until ready",
        "rd_req_ready" => "the request is taken at this clock edge",
        "rd_req_address" => "line address to read",
        "rd_req_tag" => "epoch and slot; not used again before its response",
        "rd_rsp_valid" => "a read response, in any order; never refused",
        "rd_rsp_tag" => "the tag of its request",
        "rd_rsp_data" => "the line",
        "rd_rsp_error" => "the line could not be read: the job ends with error 2",
        "wr_req_valid" => "a write request; it stays as it is until ready",
        "wr_req_ready" => "the request is taken at this clock edge",
        "wr_req_address" => "line address to write",
        "wr_req_tag" => "epoch and slot; not used again before its response",
        "wr_req_data" => "the line",
        "wr_rsp_valid" => "a write acknowledgement, in any order; never refused",
        "wr_rsp_tag" => "the tag of its request",
        "wr_rsp_error" => "the line could not be written: the job ends with error 3",
        "reset_n" => "the system's reset, active low; at least one cycle",
        "spl_enable" => "low: everything but the registers rests, as in reset",
        "spl_reset" => "reset, active high: a job that runs is forgotten",
        "spl_tx_rd_almostfull" => "SPL's queue of reads is almost full: at most two reads follow",
        "spl_tx_wr_almostfull" => "SPL's queue of writes is almost full: at most two writes follow",
        "afu_tx_rd_valid" => "a read request, taken in this cycle",
        "afu_tx_rd_hdr" => "98:93 lines (1), 92:67 and 45:14 line address, 66 virtual, 55:52 type (4), 13:0 mdata",
        "afu_tx_wr_valid" => "a write request or a fence, taken in this cycle",
        "afu_tx_wr_hdr" => "as `afu_tx_rd_hdr`; type 2 a line, 5 a fence",
        "afu_tx_data" => "the line",
        "afu_tx_intr_valid" => "an interrupt: never",
        "spl_rx_rd_valid" => "a read response, in any order; never refused",
        "spl_rx_wr_valid0" | "spl_rx_wr_valid1" => "a write response, in any order, on both channels if need be",
        "spl_rx_cfg_valid" => "a CSR write: header 13:0 its byte offset / 4, data 31:0 its value",
        "spl_rx_hdr0" | "spl_rx_hdr1" => "17:14 type, 13:0 mdata of the request",
        "spl_rx_data" => "the line, or the register's value",
        "spl_rx_intr_valid0" | "spl_rx_intr_valid1" | "spl_rx_umsg_valid" => "not used",
        _ => "",
    }
}
