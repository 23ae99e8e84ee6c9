// SPDX-License-Identifier: MIT OR Apache-2.0
// A job that returns only hits, over its line port: which lines are written, and their contents. The proof follows one
// symbolic pair, whose number and words are arbitrary constants. If the pair hits, its record is its number and words.
// The record's place follows those of the earlier pairs that hit. After the last record there are zeros. If there is
// not enough room for all lines, the lines beyond it are not written, all hits are counted, and the job ends with error
// 6.
//
// One job of up to three pairs, never aborted, over a link that answers in any order, at any time, without errors.
// line_port.sv checks the port's protocol.
//
// Defines: SCPUS, their number; PER_LINE, hits per line: 1 (number and words) or 2 (numbers only).
`default_nettype none

module hits_job (
  input wire        clk,
  // Inputs that are free in every cycle: the link's behaviour.
  input wire        rd_req_ready,
  input wire        rd_rsp_valid,
  input wire [5:0]  rd_rsp_tag,
  input wire [63:0] rd_rsp_data,
  input wire        wr_req_ready,
  input wire        wr_rsp_valid,
  input wire [5:0]  wr_rsp_tag
);
  // ---- the job and the followed pair: arbitrary constants ----
  (* anyconst *) wire [3:0]  epoch;
  (* anyconst *) wire [2:0]  count;
  (* anyconst *) wire [2:0]  room;
  (* anyconst *) wire [2:0]  followed;
  (* anyconst *) wire [31:0] words;

  reg [7:0] age = 8'd0;
  always @(posedge clk) age <= age + {7'd0, age != 8'hff};
  wire rst = age == 8'd0;

  // All other signals of the host and the link.
  wire       start = age == 8'd1;
  wire [2:0] destination_lines = room;
  wire       source = 1'b0;
  wire       destination = 1'b0;
  wire       mode = 1'b0;
  wire       watchdog = 1'b0;
  wire       abort_job = 1'b0;
  wire       rd_rsp_error = 1'b0;
  wire       wr_rsp_error = 1'b0;
  `include "dut.svh"

  // ---- the link: line n is requested with tag n, and answered later, once ----
  reg  [3:0] rd_waiting;
  reg  [3:0] wr_waiting;
  reg  [2:0] written;
  wire [3:0] rd_asks = rd_req_valid & rd_req_ready ? 4'd1 << rd_req_tag[1:0] : 4'd0;
  wire [3:0] wr_asks = wr_req_valid & wr_req_ready ? 4'd1 << wr_req_tag[1:0] : 4'd0;
  wire [3:0] rd_answers = rd_rsp_valid ? 4'd1 << rd_rsp_tag[1:0] : 4'd0;
  wire [3:0] wr_answers = wr_rsp_valid ? 4'd1 << wr_rsp_tag[1:0] : 4'd0;

  // ---- the kinds of pairs that were read: hit, invalid ----
  reg  [3:0] hits;
  reg  [3:0] invalids;
  reg  [1:0] came;
  wire       first_line = ~rd_rsp_tag[0];
  wire [1:0] now_hits = {rd_rsp_data[32], rd_rsp_data[0]};
  wire [1:0] now_invalids = {rd_rsp_data[33] & ~rd_rsp_data[32], rd_rsp_data[1] & ~rd_rsp_data[0]};
  always @(posedge clk) begin
    rd_waiting <= rst ? 4'd0 : (rd_waiting & ~rd_answers) | rd_asks;
    wr_waiting <= rst ? 4'd0 : (wr_waiting & ~wr_answers) | wr_asks;
    written <= rst ? 3'd0 : written + {2'd0, |wr_asks};
    came <= rst ? 2'd0 : came | {rd_rsp_valid & ~first_line, rd_rsp_valid & first_line};
    if (rd_rsp_valid & first_line) {hits[1:0], invalids[1:0]} <= {now_hits, now_invalids};
    if (rd_rsp_valid & ~first_line) {hits[3:2], invalids[3:2]} <= {now_hits, now_invalids};
  end
  always @* begin
    assume (count <= 3'd3 & followed < 3'd4);
    assume (~rd_rsp_valid | (rd_rsp_tag[5:2] == epoch & (rd_waiting & rd_answers) != 4'd0));
    assume (~wr_rsp_valid | (wr_rsp_tag[5:2] == epoch & (wr_waiting & wr_answers) != 4'd0));
    if (rd_rsp_valid & rd_rsp_tag[1:0] == {1'b0, followed[1]})
      assume ((followed[0] ? rd_rsp_data[63:32] : rd_rsp_data[31:0]) == words);
  end

  // ---- the expected results ----
  wire [3:0] of_job = (4'd1 << count) - 4'd1;
  wire [3:0] known = {came[1], came[1], came[0], came[0]};
  wire [3:0] job_hits = hits & of_job & known;
  wire [3:0] job_invalids = invalids & of_job & known;
  wire [3:0] before = job_hits & ((4'd1 << followed) - 4'd1);
  function [2:0] ones(input [3:0] bits);
    ones = {2'd0, bits[0]} + {2'd0, bits[1]} + {2'd0, bits[2]} + {2'd0, bits[3]};
  endfunction
  wire [2:0] total = ones(job_hits);
  wire [2:0] total_lines = `PER_LINE == 1 ? total : {1'b0, total[2:1]} + {2'd0, total[0]};
  wire [2:0] index = ones(before);
  wire [2:0] line_of_followed = `PER_LINE == 1 ? index : {1'b0, index[2:1]};
  wire       is_hit = job_hits[followed[1:0]];
`define OF_FOLLOWED (`PER_LINE == 1 ? wr_req_data : {32'd0, index[0] ? wr_req_data[63:32] : wr_req_data[31:0]})
  wire [63:0] record = `PER_LINE == 1 ? {24'd0, words[7:0], 29'd0, followed} : {61'd0, followed};
  wire       all_came = (came[0] | count == 3'd0) & (came[1] | count < 3'd3);

  always @* if (~rst) begin
    if (wr_req_valid) begin
      in_order: assert (wr_req_address == {55'd0, written});
      only_hits: assert (written < total_lines);
      has_room: assert (written < room);
      if (is_hit & written == line_of_followed) is_its_record: assert (`OF_FOLLOWED == record);
      if (`PER_LINE == 2 & all_came & total[0] & written == {1'b0, total[2:1]})
        rest_is_zero: assert (wr_req_data[63:32] == 32'd0);
    end
    if (done) begin
      done_acknowledged: assert (all_came & rd_waiting == 4'd0 & wr_waiting == 4'd0);
      all_written: assert (written == (total_lines < room ? total_lines : room));
      overflow_is_told: assert (error == (total_lines > room ? 4'd6 : 4'd0));
      all_counted: assert (contacts == {29'd0, total});
      invalid_counted: assert (invalid == {29'd0, ones(job_invalids)});
      first_is_right: assert (first_invalid == (job_invalids[0] ? 32'd0 : job_invalids[1] ? 32'd1
        : job_invalids[2] ? 32'd2 : 32'hffffffff));
    end
  end

  // ---- covers: the proof is not vacuous ----
  always @* if (~rst & done) begin
    whole_job: cover (count == 3'd3 & error == 4'd0 & job_hits == 4'b0101 & followed == 3'd2 & words == 32'h5a5a5a5b);
    overflow: cover (count == 3'd3 & error == 4'd6 & total == 3'd3 & written == 3'd1);
  end
endmodule

`default_nettype wire
