// SPDX-License-Identifier: MIT OR Apache-2.0
// The collector alone, by induction: every slot of the reorder memory is free, requested or filled, and never two of
// these. No tag is reused before its line has left. Lines leave in order, each exactly once. Requests are stable and in
// order.
//
// The link may send responses that were never requested. An abandoned request may still be on the port when the next
// job begins.
//
// Assumed here and proven elsewhere: nothing runs once the job is given up (credits.sv: nothing_runs); its epoch
// stays during a job (credits.sv: job_stays); a line is taken only when it was announced (credits.sv: takes_a_line).
`default_nettype none

module collector (
  input wire        clk,
  input wire        rst,
  input wire        start,
  input wire        run,
  input wire        given_up,
  input wire        ends,
  input wire [57:0] source,
  input wire [31:0] lines,
  input wire [3:0]  epoch,
  input wire        taken,
  input wire [1:0]  place,
  input wire        rd_req_ready,
  input wire        rd_rsp_valid,
  input wire [5:0]  rd_rsp_tag,
  input wire [31:0] rd_rsp_data,
  input wire        rd_rsp_error
);
  wire        rd_req_valid;
  wire [57:0] rd_req_address;
  wire [5:0]  rd_req_tag;
  wire        line_comes;
  wire [31:0] line;
  wire        idle;
  // As control tells it (credits.sv: drops_in_time).
  reg         was_reset = 1'b1;
  always @(posedge clk) was_reset <= rst;
  wire        drops = start | given_up | was_reset;
  wire        answered, responded;
  wire        unexpected = responded & ~answered;
  contact_afu_collector dut (
    .clk(clk), .rst(rst), .start(start), .run(run), .drops_requests(drops), .source(source), .lines(lines),
    .epoch(epoch), .taken(taken),
    .place(place), .rd_req_ready(rd_req_ready), .rd_rsp_valid(rd_rsp_valid), .rd_rsp_tag(rd_rsp_tag),
    .rd_rsp_data(rd_rsp_data), .rd_rsp_error(rd_rsp_error),
    .rd_req_valid(rd_req_valid), .rd_req_address(rd_req_address), .rd_req_tag(rd_req_tag),
    .line_comes(line_comes), .line(line), .answered(answered), .failed(), .responded(responded), .idle(idle)
  );
  (* hierconn *) wire        \dut.rd_req_spare_valid_copy_0 ;
  (* hierconn *) wire        \dut.rd_req_spare_valid_copy_1 ;
  (* hierconn *) wire        \dut.rd_req_spare_valid_copy_2 ;
  (* hierconn *) wire        \dut.lines_to_request_step ;
  (* hierconn *) wire [57:0] \dut.rd_req_spare_address ;
  (* hierconn *) wire [5:0]  \dut.rd_req_spare_tag ;
  (* hierconn *) wire        \dut.rd_req_of_job ;
  (* hierconn *) wire [2:0]  \dut.free ;
  (* hierconn *) wire        \dut.free_step ;
  (* hierconn *) wire        \dut.any_free ;
  (* hierconn *) wire        \dut.one_free ;
  (* hierconn *) wire [2:0]  \dut.outstanding ;
  (* hierconn *) wire        \dut.clears_marks ;
  (* hierconn *) wire [3:0]  \dut.came ;
  (* hierconn *) wire [1:0]  \dut.oldest ;
  (* hierconn *) wire        \dut.answered ;
  (* hierconn *) wire [3:0]  \dut.answers ;
  (* hierconn *) wire        \dut.is_current ;
  (* hierconn *) wire        \dut.is_response ;
  (* hierconn *) wire        \dut.is_awaited ;
  (* hierconn *) wire [1:0]  \dut.response_slot ;
  (* hierconn *) wire [3:0]  \dut.response_place ;
  (* hierconn *) wire        \dut.accepted ;
  (* hierconn *) wire [1:0]  \dut.accepted_slot ;
  (* hierconn *) wire [3:0]  \dut.asked ;
  (* hierconn *) wire [3:0]  \dut.awaited ;
  (* hierconn *) wire [1:0]  \dut.arrived_age ;
  (* hierconn *) wire        \dut.freed ;
  (* hierconn *) wire [1:0]  \dut.next_slot ;
  (* hierconn *) wire        \dut.may_ask_copy_0 ;
  (* hierconn *) wire        \dut.may_ask_copy_1 ;
  (* hierconn *) wire [31:0] \dut.lines_to_request ;
  (* hierconn *) wire        \dut.any_lines_to_request ;
  (* hierconn *) wire        \dut.one_lines_to_request ;
  (* hierconn *) wire [57:0] \dut.next_address ;

  reg        begun = 1'b0;
  reg        after_reset = 1'b0;
  reg        over = 1'b0;   // the job was given up or has ended
  reg        ran = 1'b0;
  reg        started = 1'b0;
  reg [57:0] job_source;
  reg [31:0] job_lines;
  reg [3:0]  job_epoch;
  reg [57:0] accepted;
  // The slots whose requests the link has accepted and not answered, now and two cycles ago, when the collector's marks are
  // made.
  reg [3:0]  waiting;
  reg [3:0]  waited;
  reg [3:0]  marked;
  reg [3:0]  asks_heard;
  reg [3:0]  asks_marked;
  reg [3:0]  answers_heard;
  reg [3:0]  answers_marked;
  wire mine = rd_rsp_valid & (begun | start) & (rd_rsp_tag[5:2] == epoch);
  // A request that an earlier job abandoned while it was on the port may still be there.
  reg        left;
  wire       asked = rd_req_valid & ~left;
  wire       spare = \dut.rd_req_spare_valid_copy_0 ;
  wire       may_ask = \dut.may_ask_copy_1 ;
  wire [3:0] asks = asked & rd_req_ready ? 4'd1 << rd_req_tag[1:0] : 4'd0;
  wire [3:0] answers = mine ? 4'd1 << rd_rsp_tag[1:0] : 4'd0;
  wire [3:0] on_port = (asked ? 4'd1 << rd_req_tag[1:0] : 4'd0) | (spare ? 4'd1 << \dut.rd_req_spare_tag [1:0] : 4'd0);
  wire [3:0] arriving = (waited & answers_heard) | (marked & answers_marked);
  wire [3:0] heard = \dut.is_current ? 4'd1 << \dut.response_slot : 4'd0;
  reg        surprised;
  // Lines that were announced and not taken, and the slot of the oldest.
  reg [2:0]  announced;
  reg [1:0]  head;
  wire       nothing = (on_port | waiting | arriving) == 4'd0 & ~rd_req_valid & ~\dut.answered & ~may_ask;
  reg        was_nothing;
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    over <= ~rst & ~start & (over | given_up | ends);
    ran <= run;
    started <= start;
    begun <= ~rst & (begun | start);
    if (start) begin
      job_source <= source;
      job_lines <= lines;
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
    left <= rd_req_valid & ~rd_req_ready & ~rst & (start | left);
    announced <= start ? 3'd0 : announced + {2'd0, line_comes} - {2'd0, taken};
    head <= start ? 2'd0 : head + {1'b0, taken};
    was_nothing <= nothing & ~rst;
  end

  always @* begin
    assume (after_reset | rst);
    assume (~run | (begun & ~start & ~given_up & ~over));
    assume (~start | ~given_up);
    assume (~ends | (~run & ~ran & nothing));
    assume (~start | ~ran);
    assume (~taken | (announced != 3'd0 & begun));
    if (begun & ~start & ~over) assume (epoch == job_epoch);
  end

  // A request that was made is counted one cycle later.
  wire [31:0] to_request = \dut.lines_to_request - {31'd0, \dut.lines_to_request_step };
  // A slot that is taken is counted a cycle late, and one that is freed in the next cycle.
  wire [2:0] free = \dut.free - {2'd0, \dut.free_step };
  wire [2:0] in_use = 3'd4 - free - {2'd0, \dut.freed };
  `include "slots.svh"

  // Filled slots: announced, known to be filled, about to be known, and heard in this cycle.
  wire [2:0] offers = announced + {2'd0, line_comes};
  wire [3:0] offered = slots(head, offers);
  // What is being cleared does not count.
  wire [3:0] cleared = {4{\dut.clears_marks }};
  wire [3:0] come = aged(\dut.came & ~cleared, \dut.oldest );
  wire [3:0] coming = aged(\dut.answered ? 4'd1 << \dut.arrived_age : 4'd0, \dut.oldest );
  wire [3:0] filled = offered | come | coming;
  wire [3:0] last_offered = 4'd1 << (\dut.oldest - 2'd1);
  always @* if (begun & ~start & ~given_up & ~over & ~rst & after_reset) begin
    never_more: assert (free <= 3'd4 & (~\dut.free_step | \dut.free != 3'd0));
    free_is_known: assert (\dut.any_free == (free != 3'd0) & \dut.one_free == (free == 3'd1));
    slots_in_order: assert (\dut.next_slot - head == in_use[1:0]);
    tags_in_order: assert ((~spare | (rd_req_valid & \dut.rd_req_spare_tag == {job_epoch, \dut.next_slot - 2'd1}))
      & (~asked | rd_req_tag[1:0] == \dut.next_slot - 2'd1 - {1'b0, spare}));
    offered_in_order: assert (\dut.oldest - head == offers[1:0] & offers <= 3'd4 & announced <= 3'd4);
    one_of_three: assert ((on_port & (waiting | arriving)) == 4'd0 & (waiting & arriving) == 4'd0
      & (filled & (on_port | waiting | arriving)) == 4'd0);
    come_once: assert ((offered & come) == 4'd0 & (offered & coming) == 4'd0 & (come & coming) == 4'd0);
    none_lost: assert ((on_port | waiting | arriving | filled) == slots(head, in_use));
    taken_is_reserved: assert (~\dut.freed | free != 3'd4);
    flags_are_right: assert (started | (\dut.any_lines_to_request == (to_request != 32'd0)
      & \dut.one_lines_to_request == (to_request == 32'd1)));
    asks_while_any: assert (~may_ask | (to_request != 32'd0 & free != 3'd0));
    counted: assert (\dut.outstanding + {2'd0, \dut.free_step } == ones(on_port | waiting | arriving) + {2'd0, \dut.answered });
    leftover_is_right: assert (~rd_req_valid | \dut.rd_req_of_job == ~left);
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
    only_filled: assert (~line_comes | ((on_port | waiting | arriving) & last_offered) == 4'd0);
    of_this_job: assert (~asked | rd_req_tag[5:2] == job_epoch);
    in_order: assert (\dut.next_address == job_source + accepted + {57'd0, asked} + {57'd0, spare});
    address: assert ((~asked | rd_req_address == job_source + accepted)
      & (~spare | \dut.rd_req_spare_address == \dut.next_address - 58'd1));
    each_once: assert (accepted + {57'd0, asked} + {57'd0, spare} + {26'd0, to_request} == {26'd0, job_lines});
  end

  reg        held = 1'b0;
  reg [63:0] was;
  always @(posedge clk) begin
    held <= rd_req_valid & ~rd_req_ready & ~rst;
    was <= {rd_req_address, rd_req_tag};
  end
  always @* if (begun & ~rst) begin
    copies_are_right: assert (\dut.rd_req_spare_valid_copy_1 == spare & \dut.rd_req_spare_valid_copy_2 == spare
      & \dut.may_ask_copy_0 == may_ask);
  end
  // Once the job is given up, only the request that stands on the port is left.
  always @* if (over & ~start & ~rst) begin
    nothing_follows: assert (~spare & ~may_ask & (~rd_req_valid | held));
  end
  always @* if (held & ~rst) begin
    stable: assert (rd_req_valid & {rd_req_address, rd_req_tag} == was);
  end
endmodule

`default_nettype wire
