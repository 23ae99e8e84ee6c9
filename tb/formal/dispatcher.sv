// SPDX-License-Identifier: MIT OR Apache-2.0
// The dispatcher alone, by induction: its memory never overflows, and no tag is reused before its acknowledgement. No
// acknowledgement is lost or counted twice. Requests are stable and in order of lines.
//
// The link may send responses that were never requested. An abandoned request may still be on the port when the next
// job begins.
//
// Assumed here and proven elsewhere: a line arrives only when there is room for it (credits.sv: fits).
`default_nettype none

module dispatcher (
  input wire        clk,
  input wire        rst,
  input wire        start,
  input wire        run,
  input wire [57:0] destination,
  input wire [3:0]  epoch,
  input wire        line_valid,
  input wire [31:0] line,
  input wire        wr_req_ready,
  input wire        wr_rsp_valid,
  input wire [5:0]  wr_rsp_tag,
  input wire        wr_rsp_error
);
  localparam [$clog2(`LINES):0] LINES = `LINES;

  wire        wr_req_valid;
  wire [57:0] wr_req_address;
  wire [5:0]  wr_req_tag;
  wire [31:0] wr_req_data;
  wire        idle;
  wire        unexpected;
  wire        empty;
  contact_afu_dispatcher dut (
    .clk(clk), .rst(rst), .start(start), .run(run), .destination(destination), .epoch(epoch),
    .line_valid(line_valid), .line(line),
    .wr_req_ready(wr_req_ready), .wr_rsp_valid(wr_rsp_valid), .wr_rsp_tag(wr_rsp_tag), .wr_rsp_error(wr_rsp_error),
    .wr_req_valid(wr_req_valid), .wr_req_address(wr_req_address), .wr_req_tag(wr_req_tag), .wr_req_data(wr_req_data),
    .line_left(), .answered(), .failed(), .unexpected(unexpected), .idle(idle), .empty(empty)
  );
  (* hierconn *) wire [$clog2(`LINES):0]   \dut.stored ;
  (* hierconn *) wire [$clog2(`LINES)-1:0] \dut.head ;
  (* hierconn *) wire [$clog2(`LINES)-1:0] \dut.tail ;
  (* hierconn *) wire        \dut.ready ;
  (* hierconn *) wire        \dut.take ;
  (* hierconn *) wire        \dut.may_send ;
  (* hierconn *) wire        \dut.read_valid ;
  (* hierconn *) wire [2:0]  \dut.reserved ;
  (* hierconn *) wire [3:0]  \dut.came ;
  (* hierconn *) wire [1:0]  \dut.oldest ;
  (* hierconn *) wire        \dut.answered ;
  (* hierconn *) wire [3:0]  \dut.awaited ;
  (* hierconn *) wire        \dut.leftover_request ;
  (* hierconn *) wire [1:0]  \dut.arrived_age ;
  (* hierconn *) wire [1:0]  \dut.next_slot ;
  (* hierconn *) wire [2:0]  \dut.outstanding ;
  (* hierconn *) wire [57:0] \dut.next_address ;

  // A job has begun since the last reset; its destination and epoch.
  reg        begun = 1'b0;
  reg        after_reset = 1'b0;
  reg        ran = 1'b0;
  reg [57:0] job_destination;
  reg [3:0]  job_epoch;
  reg [57:0] accepted;
  reg [3:0]  waiting;
  wire mine = wr_rsp_valid & begun & ~start & (wr_rsp_tag[5:2] == job_epoch);
  // A request that an earlier job abandoned while it was on the port may still be there.
  reg        left;
  wire       asked = wr_req_valid & ~left;
  wire [3:0] asks = asked & wr_req_ready ? 4'd1 << wr_req_tag[1:0] : 4'd0;
  wire [3:0] answers = mine ? 4'd1 << wr_rsp_tag[1:0] : 4'd0;
  wire [3:0] on_port = asked ? 4'd1 << wr_req_tag[1:0] : 4'd0;
  reg        surprised;
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    ran <= run;
    begun <= ~rst & (begun | start);
    if (start) begin
      job_destination <= destination;
      job_epoch <= epoch;
    end
    accepted <= start ? 58'd0 : accepted + {57'd0, |asks};
    waiting <= start ? 4'd0 : (waiting & ~answers) | asks;
    surprised <= mine & run & (waiting & answers) == 4'd0;
    left <= wr_req_valid & ~wr_req_ready & ~rst & (start | left);
  end

  always @* begin
    assume (after_reset | rst);
    assume (~run | (begun & ~start));
    assume (~start | ~ran);
    if (begun & ~start) assume (epoch == job_epoch);
    assume (~line_valid | (begun & ~start & (\dut.stored != LINES | \dut.take )));
  end

  `include "slots.svh"
  wire [3:0] come = aged(\dut.came , \dut.oldest );
  wire [3:0] coming = aged(\dut.answered ? 4'd1 << \dut.arrived_age : 4'd0, \dut.oldest );
  wire [3:0] busy = on_port | waiting | come | coming;
  always @* if (begun & ~start & ~rst & after_reset) begin
    fifo_fits: assert (\dut.stored <= LINES);
    fifo_counts: assert (\dut.tail - \dut.head == \dut.stored [$clog2(`LINES)-1:0]);
    ready_is_right: assert (\dut.ready == (\dut.stored != 0));
    tag_free: assert ((on_port & waiting) == 4'd0 & (~asked | wr_req_tag[5:2] == job_epoch));
    never_more: assert (\dut.reserved <= 3'd4);
    slots_in_order: assert (\dut.next_slot - \dut.oldest == \dut.reserved [1:0]);
    slots_are_right: assert (busy == slots(\dut.oldest , \dut.reserved ));
    come_once: assert (((on_port | waiting) & (come | coming)) == 4'd0 & (come & coming) == 4'd0);
    none_lost: assert (\dut.outstanding == {2'd0, on_port[0] | waiting[0]} + {2'd0, on_port[1] | waiting[1]}
      + {2'd0, on_port[2] | waiting[2]} + {2'd0, on_port[3] | waiting[3]} + {2'd0, \dut.answered });
    leftover_is_right: assert (\dut.leftover_request == left);
    awaited_is_right: assert (\dut.awaited == waiting);
    surprise_is_told: assert (unexpected == surprised);
    idle_is_right: assert (idle == ((on_port | waiting) == 4'd0 & ~wr_req_valid & ~\dut.answered & ~(\dut.may_send & \dut.read_valid )));
    sends_a_free_slot: assert (~\dut.may_send | \dut.reserved != 3'd4);
    in_order: assert (\dut.next_address == job_destination + accepted + {57'd0, asked});
    address: assert (~asked | wr_req_address == job_destination + accepted);
  end

  reg        held = 1'b0;
  reg [95:0] was;
  always @(posedge clk) begin
    held <= wr_req_valid & ~wr_req_ready & ~rst;
    was <= {wr_req_address, wr_req_tag, wr_req_data};
  end
  always @* if (held & ~rst) begin
    stable: assert (wr_req_valid & {wr_req_address, wr_req_tag, wr_req_data} == was);
  end
endmodule

`default_nettype wire
