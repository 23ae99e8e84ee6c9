// SPDX-License-Identifier: MIT OR Apache-2.0
// The dispatcher alone, by induction: its memory never overflows, and no tag is reused before its acknowledgement. No
// acknowledgement is lost or counted twice. Requests are stable and in order of lines.
//
// The link may send responses that were never requested. An abandoned request may still be on the port when the next
// job begins.
//
// Assumed here and proven elsewhere: nothing runs once the job is given up (credits.sv: nothing_runs); destination and
// epoch stay as they are during a job (credits.sv: job_stays); a line arrives only when there is room for it
// (credits.sv: fits).
`default_nettype none

module dispatcher (
  input wire        clk,
  input wire        rst,
  input wire        start,
  input wire        run,
  input wire        given_up,
  input wire        ends,
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
  // As control tells it (credits.sv: drops_in_time).
  reg         was_reset = 1'b1;
  always @(posedge clk) was_reset <= rst;
  wire        drops = start | given_up | was_reset;
  wire        answered, responded;
  wire        unexpected = responded & ~answered;
  wire        empty;
  contact_afu_dispatcher dut (
    .clk(clk), .rst(rst), .start(start), .run(run), .drops_requests(drops), .destination(destination), .epoch(epoch),
    .line_valid(line_valid), .line(line),
    .wr_req_ready(wr_req_ready), .wr_rsp_valid(wr_rsp_valid), .wr_rsp_tag(wr_rsp_tag), .wr_rsp_error(wr_rsp_error),
    .wr_req_valid(wr_req_valid), .wr_req_address(wr_req_address), .wr_req_tag(wr_req_tag), .wr_req_data(wr_req_data),
    .line_left(), .answered(answered), .failed(), .responded(responded), .idle(idle), .empty(empty)
  );
  (* hierconn *) wire [$clog2(`LINES):0]   \dut.stored ;
  (* hierconn *) wire [$clog2(`LINES)-1:0] \dut.head ;
  (* hierconn *) wire [$clog2(`LINES)-1:0] \dut.tail ;
  (* hierconn *) wire        \dut.any_stored ;
  (* hierconn *) wire        \dut.one_stored ;
  (* hierconn *) wire        \dut.stored_step ;
  (* hierconn *) wire        \dut.goes ;
  (* hierconn *) wire        \dut.may_send ;
  (* hierconn *) wire        \dut.read_valid ;
  (* hierconn *) wire [2:0]  \dut.free ;
  (* hierconn *) wire        \dut.free_step ;
  (* hierconn *) wire        \dut.any_free ;
  (* hierconn *) wire        \dut.one_free ;
  (* hierconn *) wire        \dut.freed ;
  (* hierconn *) wire        \dut.clears_marks ;
  (* hierconn *) wire [3:0]  \dut.came ;
  (* hierconn *) wire [1:0]  \dut.oldest ;
  (* hierconn *) wire        \dut.answered ;
  (* hierconn *) wire [3:0]  \dut.awaited ;
  (* hierconn *) wire [3:0]  \dut.answers ;
  (* hierconn *) wire        \dut.is_current ;
  (* hierconn *) wire        \dut.is_response ;
  (* hierconn *) wire        \dut.is_awaited ;
  (* hierconn *) wire [1:0]  \dut.response_slot ;
  (* hierconn *) wire [3:0]  \dut.response_place ;
  (* hierconn *) wire        \dut.accepted ;
  (* hierconn *) wire [1:0]  \dut.accepted_slot ;
  (* hierconn *) wire [3:0]  \dut.asked ;
  (* hierconn *) wire        \dut.wr_req_of_job ;
  (* hierconn *) wire [1:0]  \dut.arrived_age ;
  (* hierconn *) wire [1:0]  \dut.wr_req_slot ;
  (* hierconn *) wire [2:0]  \dut.outstanding ;

  // A job has begun since the last reset; its destination and epoch.
  reg        begun = 1'b0;
  reg        after_reset = 1'b0;
  reg        over = 1'b0;   // the job was given up or has ended
  reg        ran = 1'b0;
  reg [57:0] job_destination;
  reg [3:0]  job_epoch;
  reg [57:0] accepted;
  // The slots whose requests the link has accepted and not answered, now and two cycles ago, when the dispatcher's marks are
  // made.
  reg [3:0]  waiting;
  reg [3:0]  waited;
  reg [3:0]  marked;
  reg [3:0]  asks_heard;
  reg [3:0]  asks_marked;
  reg [3:0]  answers_heard;
  reg [3:0]  answers_marked;
  wire mine = wr_rsp_valid & (begun | start) & (wr_rsp_tag[5:2] == epoch);
  // A request that an earlier job abandoned while it was on the port may still be there.
  reg        left;
  wire       asked = wr_req_valid & ~left;
  wire [3:0] asks = asked & wr_req_ready ? 4'd1 << wr_req_tag[1:0] : 4'd0;
  wire [3:0] answers = mine ? 4'd1 << wr_rsp_tag[1:0] : 4'd0;
  wire [3:0] on_port = asked ? 4'd1 << wr_req_tag[1:0] : 4'd0;
  wire [3:0] arriving = (waited & answers_heard) | (marked & answers_marked);
  wire [3:0] heard = \dut.is_current ? 4'd1 << \dut.response_slot : 4'd0;
  reg        surprised;
  wire       nothing = (on_port | waiting | arriving) == 4'd0 & ~wr_req_valid & ~\dut.answered & ~\dut.goes ;
  reg        was_nothing;
  reg        started = 1'b0;
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    over <= ~rst & ~start & (over | given_up | ends);
    ran <= run;
    started <= start;
    begun <= ~rst & (begun | start);
    if (start) begin
      job_destination <= destination;
      job_epoch <= epoch;
    end
    accepted <= start ? 58'd0 : accepted + {57'd0, |asks};
    waiting <= start ? 4'd0 : (waiting & ~answers) | asks;
    waited <= start ? 4'd0 : waiting;
    marked <= start ? 4'd0 : waited;
    asks_heard <= start ? 4'd0 : asks;
    asks_marked <= start ? 4'd0 : asks_heard;
    answers_heard <= rst ? 4'd0 : answers;
    answers_marked <= rst | start ? 4'd0 : answers_heard;
    surprised <= ~start & ~rst & run & answers_marked != 4'd0 & (marked & answers_marked) == 4'd0;
    left <= wr_req_valid & ~wr_req_ready & ~rst & (start | left);
    was_nothing <= nothing & ~rst;
  end

  always @* begin
    assume (after_reset | rst);
    assume (~run | (begun & ~start & ~given_up & ~over));
    assume (~start | ~given_up);
    assume (~ends | (~run & ~ran & nothing));
    assume (~start | ~ran);
    if (begun & ~start & ~over) assume (epoch == job_epoch & destination == job_destination);
    assume (~line_valid | (begun & ~start & (\dut.stored != LINES | \dut.stored_step )));
  end

  // A line that has left the memory is still counted for one cycle.
  wire [$clog2(`LINES):0] stored = \dut.stored - \dut.stored_step ;
  `include "slots.svh"
  // What is being cleared does not count.
  wire [3:0] cleared = {4{\dut.clears_marks }};
  wire [3:0] come = aged(\dut.came & ~cleared, \dut.oldest );
  wire [3:0] coming = aged(\dut.answered ? 4'd1 << \dut.arrived_age : 4'd0, \dut.oldest );
  // The slot of the next line. The port has the job's first slot, address and epoch once no earlier request is there.
  wire [1:0] next_slot = \dut.wr_req_of_job ? \dut.wr_req_slot + {1'b0, asked} : 2'd0;
  // A slot that is taken is counted a cycle late, and one that is freed in the next cycle.
  wire [2:0] free = \dut.free - {2'd0, \dut.free_step };
  wire [2:0] in_use = 3'd4 - free - {2'd0, \dut.freed };
  wire [3:0] busy = on_port | waiting | arriving | come | coming;
  always @* if (begun & ~start & ~given_up & ~over & ~rst & after_reset) begin
    fifo_fits: assert (\dut.stored <= LINES & (~\dut.stored_step | \dut.stored != 0));
    fifo_counts: assert (\dut.tail - \dut.head == stored[$clog2(`LINES)-1:0]);
    stored_is_known: assert (\dut.any_stored == (stored != 0) & \dut.one_stored == (stored == 1));
    free_is_known: assert (\dut.any_free == (free != 3'd0) & \dut.one_free == (free == 3'd1));
    tag_free: assert ((on_port & (waiting | arriving)) == 4'd0 & (waiting & arriving) == 4'd0
      & (~asked | wr_req_tag[5:2] == job_epoch));
    never_more: assert (free <= 3'd4 & (~\dut.free_step | \dut.free != 3'd0));
    slots_in_order: assert (next_slot - \dut.oldest == in_use[1:0]);
    slots_are_right: assert (busy == slots(\dut.oldest , in_use) & (~\dut.freed | free != 3'd4));
    come_once: assert (((on_port | waiting | arriving) & (come | coming)) == 4'd0 & (come & coming) == 4'd0);
    none_lost: assert (\dut.outstanding + {2'd0, \dut.free_step } == ones(on_port | waiting | arriving) + {2'd0, \dut.answered });
    leftover_is_right: assert (~wr_req_valid | \dut.wr_req_of_job == ~left);
    decoded: assert (~\dut.is_current | \dut.response_place == heard);
    clears_in_time: assert (\dut.clears_marks == started);
    awaited_is_right: assert ((\dut.awaited & ~cleared) == marked & (\dut.asked & ~cleared) == asks_marked
      & (\dut.answers & ~cleared) == answers_marked
      & heard == answers_heard & \dut.is_response == (answers_marked != 4'd0)
      & \dut.is_awaited == ((\dut.awaited & \dut.answers & ~cleared) != 4'd0)
      & waited == ((marked & ~answers_marked) | asks_marked) & waiting == ((waited & ~answers_heard) | asks_heard)
      & (\dut.accepted ? 4'd1 << \dut.accepted_slot : 4'd0) == asks_heard);
    surprise_is_told: assert (unexpected == surprised);
    idle_is_right: assert (started | idle == was_nothing);
    sends_a_free_slot: assert (~\dut.may_send | free != 3'd0);
    address: assert (~\dut.wr_req_of_job | wr_req_address == job_destination + accepted);
    of_this_job: assert (~\dut.wr_req_of_job | wr_req_tag[5:2] == job_epoch);
    begins_in_time: assert (\dut.wr_req_of_job | ((left | started) & accepted == 58'd0));
  end

  reg        held = 1'b0;
  reg [95:0] was;
  always @(posedge clk) begin
    held <= wr_req_valid & ~wr_req_ready & ~rst;
    was <= {wr_req_address, wr_req_tag, wr_req_data};
  end
  // Once the job is given up, only the request that stands on the port is left.
  always @* if (over & ~start & ~rst) begin
    nothing_follows: assert (~\dut.may_send & (~wr_req_valid | held));
  end
  always @* if (held & ~rst) begin
    stable: assert (wr_req_valid & {wr_req_address, wr_req_tag, wr_req_data} == was);
  end
endmodule

`default_nettype wire
