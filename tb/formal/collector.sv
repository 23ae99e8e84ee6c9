// SPDX-License-Identifier: MIT OR Apache-2.0
// The collector alone, by induction: every slot of the reorder memory is free, requested or filled, and never two of
// these. No tag is reused before its line has left. Lines leave in order, each exactly once. Requests are stable and in
// order.
//
// The link may send responses that were never requested. An abandoned request may still be on the port when the next
// job begins.
//
// Assumed here and proven elsewhere: a line is taken only when it is available (credits.sv: takes_a_line).
`default_nettype none

module collector (
  input wire        clk,
  input wire        rst,
  input wire        start,
  input wire        run,
  input wire [57:0] source,
  input wire [31:0] lines,
  input wire [3:0]  epoch,
  input wire        take,
  input wire        rd_req_ready,
  input wire        rd_rsp_valid,
  input wire [5:0]  rd_rsp_tag,
  input wire [31:0] rd_rsp_data,
  input wire        rd_rsp_error
);
  wire        rd_req_valid;
  wire [57:0] rd_req_address;
  wire [5:0]  rd_req_tag;
  wire        line_valid;
  wire [31:0] line;
  wire        idle;
  wire        unexpected;
  contact_afu_collector dut (
    .clk(clk), .rst(rst), .start(start), .run(run), .source(source), .lines(lines), .epoch(epoch), .take(take),
    .rd_req_ready(rd_req_ready), .rd_rsp_valid(rd_rsp_valid), .rd_rsp_tag(rd_rsp_tag), .rd_rsp_data(rd_rsp_data),
    .rd_rsp_error(rd_rsp_error),
    .rd_req_valid(rd_req_valid), .rd_req_address(rd_req_address), .rd_req_tag(rd_req_tag),
    .line_valid(line_valid), .line(line), .answered(), .failed(), .unexpected(unexpected), .idle(idle)
  );
  (* hierconn *) wire [2:0]  \dut.reserved ;
  (* hierconn *) wire [2:0]  \dut.outstanding ;
  (* hierconn *) wire [3:0]  \dut.came ;
  (* hierconn *) wire [1:0]  \dut.oldest ;
  (* hierconn *) wire        \dut.answered ;
  (* hierconn *) wire [3:0]  \dut.awaited ;
  (* hierconn *) wire        \dut.leftover_request ;
  (* hierconn *) wire [1:0]  \dut.arrived_age ;
  (* hierconn *) wire        \dut.two_valid ;
  (* hierconn *) wire        \dut.taken ;
  (* hierconn *) wire [1:0]  \dut.head ;
  (* hierconn *) wire [1:0]  \dut.next_slot ;
  (* hierconn *) wire        \dut.may_ask ;
  (* hierconn *) wire [31:0] \dut.lines_to_request ;
  (* hierconn *) wire [57:0] \dut.next_address ;

  reg        begun = 1'b0;
  reg        after_reset = 1'b0;
  reg        ran = 1'b0;
  reg [57:0] job_source;
  reg [31:0] job_lines;
  reg [3:0]  job_epoch;
  reg [31:0] accepted;
  reg [3:0]  waiting;
  wire mine = rd_rsp_valid & begun & ~start & (rd_rsp_tag[5:2] == job_epoch);
  // A request that an earlier job abandoned while it was on the port may still be there.
  reg        left;
  wire       asked = rd_req_valid & ~left;
  wire [3:0] asks = asked & rd_req_ready ? 4'd1 << rd_req_tag[1:0] : 4'd0;
  wire [3:0] answers = mine ? 4'd1 << rd_rsp_tag[1:0] : 4'd0;
  wire [3:0] on_port = asked ? 4'd1 << rd_req_tag[1:0] : 4'd0;
  reg        surprised;
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    ran <= run;
    begun <= ~rst & (begun | start);
    if (start) begin
      job_source <= source;
      job_lines <= lines;
      job_epoch <= epoch;
    end
    accepted <= start ? 32'd0 : accepted + {31'd0, |asks};
    waiting <= start ? 4'd0 : (waiting & ~answers) | asks;
    surprised <= mine & run & (waiting & answers) == 4'd0;
    left <= rd_req_valid & ~rd_req_ready & ~rst & (start | left);
  end

  always @* begin
    assume (after_reset | rst);
    assume (~run | (begun & ~start));
    assume (~start | ~ran);
    assume (~take | line_valid);
    if (begun & ~start) assume (epoch == job_epoch);
  end

  `include "slots.svh"

  // Filled slots: offered at the output, known to be filled, and about to be known.
  wire [2:0] offers = {1'b0, \dut.two_valid , line_valid & ~\dut.two_valid };
  wire [3:0] offered = slots(\dut.head , offers);
  wire [3:0] come = aged(\dut.came , \dut.oldest );
  wire [3:0] coming = aged(\dut.answered ? 4'd1 << \dut.arrived_age : 4'd0, \dut.oldest );
  wire [3:0] filled = offered | come | coming;
  always @* if (begun & ~start & ~rst & after_reset) begin
    never_more: assert (\dut.reserved <= 3'd4);
    slots_in_order: assert (\dut.next_slot - \dut.head + {1'b0, \dut.taken } == \dut.reserved [1:0]);
    offered_in_order: assert (\dut.oldest - \dut.head == offers[1:0] & (line_valid | ~\dut.two_valid ));
    one_of_three: assert ((on_port & waiting) == 4'd0 & (filled & (on_port | waiting)) == 4'd0);
    come_once: assert ((offered & come) == 4'd0 & (offered & coming) == 4'd0 & (come & coming) == 4'd0);
    none_lost: assert ((on_port | waiting | filled) == slots(\dut.head , \dut.reserved - {2'd0, \dut.taken }));
    taken_is_reserved: assert (~\dut.taken | \dut.reserved != 3'd0);
    asks_while_any: assert (~\dut.may_ask | (\dut.lines_to_request != 32'd0 & \dut.reserved != 3'd4));
    counted: assert (\dut.outstanding == {2'd0, on_port[0] | waiting[0]} + {2'd0, on_port[1] | waiting[1]}
      + {2'd0, on_port[2] | waiting[2]} + {2'd0, on_port[3] | waiting[3]} + {2'd0, \dut.answered });
    leftover_is_right: assert (\dut.leftover_request == left);
    awaited_is_right: assert (\dut.awaited == waiting);
    surprise_is_told: assert (unexpected == surprised);
    idle_is_right: assert (idle == ((on_port | waiting) == 4'd0 & ~rd_req_valid & ~\dut.answered & ~\dut.may_ask ));
    only_filled: assert (~line_valid | ~(on_port[\dut.head ] | waiting[\dut.head ]));
    of_this_job: assert (~asked | rd_req_tag[5:2] == job_epoch);
    in_order: assert (\dut.next_address == job_source + {26'd0, accepted} + {57'd0, asked});
    address: assert (~asked | rd_req_address == job_source + {26'd0, accepted});
    each_once: assert ({1'b0, accepted} + {32'd0, asked} + {1'b0, \dut.lines_to_request } == {1'b0, job_lines});
  end

  reg        held = 1'b0;
  reg [63:0] was;
  always @(posedge clk) begin
    held <= rd_req_valid & ~rd_req_ready & ~rst;
    was <= {rd_req_address, rd_req_tag};
  end
  always @* if (held & ~rst) begin
    stable: assert (rd_req_valid & {rd_req_address, rd_req_tag} == was);
  end
endmodule

`default_nettype wire
