// SPDX-License-Identifier: MIT OR Apache-2.0
// The accelerator over its line port, for yosys-smtbmc: the behaviour of link and host is assumed, that of the
// accelerator is asserted. To check data, the proof follows one symbolic pair, whose number and words are arbitrary
// constants.
//
// The link answers requests in any order and at any time, with or without an error. It may also send responses to jobs
// from before the last reset or abandoned by the watchdog, and responses that were never requested, with any tag and
// any data. An abandoned request that is on the port stays there, and does not belong to the next job. The host resets,
// starts and aborts at any time; each job's epoch differs from that of the job before.
//
// Defines: SCPUS, their number; PAIRS, the maximum number of pairs of a job (1 to 15); PROMPT, the maximum number of
// cycles for which the link leaves a request or a response waiting, so that each job must end within BOUND cycles;
// ONE_JOB, for a single job, in the cycle after a single reset.
`default_nettype none

module line_port (
  input wire        clk,
  // Inputs that are free in every cycle: the behaviour of host and link.
  input wire        rst,
  input wire        start,
  input wire [3:0]  epoch,
  input wire [3:0]  count,
  input wire        mode,
  input wire [4:0]  watchdog,
  input wire        abort_job,
  input wire        rd_req_ready,
  input wire        rd_rsp_valid,
  input wire [5:0]  rd_rsp_tag,
  input wire [31:0] rd_rsp_data,
  input wire        rd_rsp_error,
  input wire        wr_req_ready,
  input wire        wr_rsp_valid,
  input wire [5:0]  wr_rsp_tag,
  input wire        wr_rsp_error
);
  // ---- the job and the followed pair: arbitrary constants ----
  (* anyconst *) wire [4:0]  source;
  (* anyconst *) wire [4:0]  destination;
  (* anyconst *) wire [3:0]  followed;
  (* anyconst *) wire [15:0] words;
  wire [3:0]  followed_line = {1'b0, followed[3:1]};

  `include "dut.svh"
  (* hierconn *) wire \dut.control.begin_job ;
  (* hierconn *) wire \dut.control.run ;

  // ---- the state of the job ----
  reg [7:0] age = 8'd0;
  always @(posedge clk) age <= age + {7'd0, age != 8'hff};

  wire accept = start & ~busy & ~rst;
  reg        known = 1'b0;   // a job was accepted since the last reset
  reg [3:0]  job_epoch;
  reg [3:0]  job_count;
  wire [3:0] epoch_now = accept ? epoch : job_epoch;
  reg        ever = 1'b0;
  reg [3:0]  last_epoch;
  wire [3:0] lines = {1'b0, job_count[3:1]} + {3'd0, job_count[0]};
  always @(posedge clk) begin
    if (rst) known <= 1'b0;
    else if (accept) known <= 1'b1;
    if (accept) begin
      job_epoch <= epoch;
      job_count <= count;
      last_epoch <= epoch;
      ever <= 1'b1;
    end
  end

  // ---- requests of this job, and which of them await a response ----
  reg [3:0]  rd_lines;
  reg [3:0]  wr_lines;
  reg [3:0]  rd_waiting;
  reg [3:0]  wr_waiting;
  reg        followed_waiting;
  reg [1:0]  followed_tag;
  reg        rd_left = 1'b0;
  reg        wr_left = 1'b0;
  wire       gave_up = done & error == 4'd4;
  wire       rd_asked = rd_req_valid & ~rd_left & ~gave_up;
  wire       wr_asked = wr_req_valid & ~wr_left & ~gave_up;
  always @(posedge clk) begin
    rd_left <= rd_req_valid & ~rd_req_ready & ~rst & (gave_up | rd_left);
    wr_left <= wr_req_valid & ~wr_req_ready & ~rst & (gave_up | wr_left);
  end
  wire rd_accepted = rd_asked & rd_req_ready & ~rst;
  wire wr_accepted = wr_asked & wr_req_ready & ~rst;
  wire [3:0] rd_asks = rd_accepted ? (4'd1 << rd_req_tag[1:0]) : 4'd0;
  wire [3:0] wr_asks = wr_accepted ? (4'd1 << wr_req_tag[1:0]) : 4'd0;
  wire rd_mine = rd_rsp_valid & (known | accept) & (rd_rsp_tag[5:2] == epoch_now);
  wire wr_mine = wr_rsp_valid & (known | accept) & (wr_rsp_tag[5:2] == epoch_now);
  wire [3:0] rd_answered = rd_mine ? (4'd1 << rd_rsp_tag[1:0]) : 4'd0;
  wire [3:0] wr_answered = wr_mine ? (4'd1 << wr_rsp_tag[1:0]) : 4'd0;
  // A response arrived that was never requested, while the job ran and early enough to be reported.
  wire surprise = (rd_mine & (rd_waiting & rd_answered) == 4'd0) | (wr_mine & (wr_waiting & wr_answered) == 4'd0);
  reg [5:0] surprised;
  always @(posedge clk)
    surprised <= rst | accept ? 6'd0
      : {surprised[5] | (surprised[4] & ~done), surprised[3:2], surprised[1] & \dut.control.run ,
         surprised[0] & ~\dut.control.begin_job , surprise};
  wire follows = rd_accepted & (rd_lines == followed_line);
  always @(posedge clk) begin
    if (rst | accept) begin
      rd_lines <= 4'd0;
      wr_lines <= 4'd0;
      rd_waiting <= 4'd0;
      wr_waiting <= 4'd0;
      followed_waiting <= 1'b0;
    end else begin
      rd_lines <= rd_lines + {3'd0, rd_accepted};
      wr_lines <= wr_lines + {3'd0, wr_accepted};
      rd_waiting <= (rd_waiting & ~rd_answered) | rd_asks;
      wr_waiting <= (wr_waiting & ~wr_answered) | wr_asks;
      followed_waiting <= follows | (followed_waiting & ~(rd_mine & (rd_rsp_tag[1:0] == followed_tag)));
    end
    if (follows) followed_tag <= rd_req_tag[1:0];
  end

  // ---- assumptions about host and link ----
  always @* begin
    if (age == 8'd0) assume (rst);
    assume (count <= `PAIRS);
    assume (followed <= `PAIRS);
    if (accept & ever) assume (epoch != last_epoch);
    // The followed pair's line holds its words.
    if (rd_mine & ~rd_rsp_error & followed_waiting & (rd_rsp_tag[1:0] == followed_tag))
      assume ((followed[0] ? rd_rsp_data[31:16] : rd_rsp_data[15:0]) == words);
`ifdef ONE_JOB
    assume (rst == (age == 8'd0));
    assume (start == (age == 8'd1));
`endif
  end

  // ---- assertions about the accelerator ----
  wire [15:0] written = followed[0] ? wr_req_data[31:16] : wr_req_data[15:0];
  always @* if (age != 8'd0 & ~rst) begin
    // Requests belong to this job and are in order of lines, each once. No tag is reused while it awaits a response.
    if (rd_asked) begin
      rd_in_job: assert (busy & known);
      rd_in_order: assert (rd_req_address == {53'd0, source} + {54'd0, rd_lines} & rd_lines < lines);
      rd_tag_free: assert (rd_req_tag[5:2] == job_epoch & ((rd_waiting >> rd_req_tag[1:0]) & 4'd1) == 4'd0);
    end
    if (wr_asked) begin
      wr_in_job: assert (busy & known);
      wr_in_order: assert (wr_req_address == {53'd0, destination} + {54'd0, wr_lines} & wr_lines < lines);
      wr_tag_free: assert (wr_req_tag[5:2] == job_epoch & ((wr_waiting >> wr_req_tag[1:0]) & 4'd1) == 4'd0);
      if (wr_lines == followed_line)
        wr_data: assert (written == (followed < job_count ? words : 16'd0));
    end
    // The end of the job.
    if (done) begin
      done_known: assert (known & ~busy);
      done_acknowledged: assert (error == 4'd4 | (rd_waiting == 4'd0 & wr_waiting == 4'd0));
      if (error == 4'd0) begin
        surprise_is_told: assert (~surprised[5]);
        done_all: assert (rd_lines == lines & wr_lines == lines);
        if (followed < job_count) begin
          done_counts: assert (~words[0] | contacts != 32'd0);
          done_invalid: assert (~(words[1] & ~words[0]) | (invalid != 32'd0 & first_invalid <= {28'd0, followed}));
          done_first: assert (first_invalid != {28'd0, followed} | (words[1] & ~words[0]));
        end
      end
    end
  end

  // A request is stable until it is accepted.
  reg        rd_held = 1'b0;
  reg        wr_held = 1'b0;
  reg [63:0] rd_was;
  reg [95:0] wr_was;
  always @(posedge clk) begin
    rd_held <= rd_req_valid & ~rd_req_ready & ~rst;
    wr_held <= wr_req_valid & ~wr_req_ready & ~rst;
    rd_was <= {rd_req_address, rd_req_tag};
    wr_was <= {wr_req_address, wr_req_tag, wr_req_data};
  end
  always @* if (age != 8'd0 & ~rst) begin
    if (rd_held) rd_stable: assert (rd_req_valid & {rd_req_address, rd_req_tag} == rd_was);
    if (wr_held) wr_stable: assert (wr_req_valid & {wr_req_address, wr_req_tag, wr_req_data} == wr_was);
  end

`ifdef PROMPT
  // ---- a prompt link, and a bounded time to the end ----
  reg [3:0] rd_refused;
  reg [3:0] wr_refused;
  reg [7:0] taken;
  always @(posedge clk) begin
    rd_refused <= rst | rd_req_ready ? 4'd0 : rd_refused + 4'd1;
    wr_refused <= rst | wr_req_ready ? 4'd0 : wr_refused + 4'd1;
    taken <= rst | ~busy ? 8'd0 : taken + 8'd1;
  end
  always @* if (age != 8'd0) begin
    assume (rd_refused < `PROMPT | rd_req_ready);
    assume (wr_refused < `PROMPT | wr_req_ready);
    if (~rst) ends: assert (taken <= `BOUND);
  end
  genvar slot;
  generate
    for (slot = 0; slot < 4; slot = slot + 1) begin : prompt
      reg [3:0] rd_age;
      reg [3:0] wr_age;
      always @(posedge clk) begin
        rd_age <= rd_waiting[slot] ? rd_age + 4'd1 : 4'd0;
        wr_age <= wr_waiting[slot] ? wr_age + 4'd1 : 4'd0;
      end
      always @* if (age != 8'd0 & ~rst & ~accept) begin
        if (rd_waiting[slot] & rd_age >= `PROMPT) assume (rd_answered[slot]);
        if (wr_waiting[slot] & wr_age >= `PROMPT) assume (wr_answered[slot]);
      end
    end
  endgenerate
`endif

  // ---- covers: the proof is not vacuous ----
  always @* if (age != 8'd0 & ~rst & done & error == 4'd0) begin
    whole_job: cover (job_count == `PAIRS);
    odd_job: cover (job_count == `PAIRS - 1 & followed == job_count - 1 & words == 16'h5a5a);
  end
endmodule

`default_nettype wire
