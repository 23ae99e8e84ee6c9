// SPDX-License-Identifier: MIT OR Apache-2.0
// How many shares a decider has, by induction, in the AFU that takes spheres: each share that was put and not answered
// belongs to a step of its own in the queue of steps, which never overflows. So a decider never has more shares than
// that queue has places. What deciders answer is free in every cycle, and so is when.
//
// Any one step is looked at first (CHOSEN): its number is that of the shares before it, and those since are no more than
// the steps since. Then that is assumed of the oldest one, whose number is that of the answers that were taken.
//
// Assumed here: box against box puts a step only 8 cycles after there was room (stage.sv: each_step_once); all parts
// begin together (begins.sv: together).
//
// Defines: UNDECIDED, the places for steps; CHOSEN.
`default_nettype none

module undecided (
  `include "inputs.svh"
);
  localparam DEPTH = `UNDECIDED;
  localparam SLACK = 8;

  `include "dut.svh"
  // steps_bit_0, steps_bit_1: whether the steps in the memory of their queue ask each decider.
  `include "words.svh"
  (* hierconn *) wire        \dut.control_begin_loader ;
  (* hierconn *) wire        \dut.control_begin_deciders ;
  (* hierconn *) wire        \dut.control_begin_hits ;
  (* hierconn *) wire        \dut.steps_have_room ;
  (* hierconn *) wire        \dut.box_pairs_put ;
  (* hierconn *) wire        \dut.decider_0.put ;
  (* hierconn *) wire        \dut.decider_1.put ;
  (* hierconn *) wire        \dut.take_answer_0 ;
  (* hierconn *) wire        \dut.take_answer_1 ;
  (* hierconn *) wire        \dut.hits.step_queue.put ;
  (* hierconn *) wire        \dut.hits.step_queue.reads ;
  (* hierconn *) wire        \dut.hits.step_queue.oldest_valid ;
  (* hierconn *) wire [30:0] \dut.hits.step_queue.oldest ;
  (* hierconn *) wire  [6:0] \dut.hits.step_queue.waiting ;
  (* hierconn *) wire  [5:0] \dut.hits.step_queue.head ;
  (* hierconn *) wire  [5:0] \dut.hits.step_queue.tail ;

  wire       begins = \dut.control_begin_hits ;
  wire       valid = \dut.hits.step_queue.oldest_valid ;
  wire [6:0] waiting = \dut.hits.step_queue.waiting ;
  wire [5:0] head = \dut.hits.step_queue.head ;
  wire [5:0] tail = \dut.hits.step_queue.tail ;
  wire [7:0] inside = {1'b0, waiting} + {7'd0, valid};

  // Steps that box against box may have made, and that do not stand in the queue yet.
  reg [SLACK-1:0] way = 0;
  reg [7:0]       inside_before = 0;
  reg [7:0]       coming;
  integer         stage;
  always @* begin
    coming = 0;
    for (stage = 0; stage < SLACK; stage = stage + 1) coming = coming + {7'd0, way[stage]};
  end

  // Any one of both deciders: the shares that it got, those whose answers were taken, and what it was asked by the step
  // at the queue's output, and by those in the queue's memory.
  (* anyconst *) wire which;
  wire        put = which ? \dut.decider_1.put : \dut.decider_0.put ;
  wire        take = which ? \dut.take_answer_1 : \dut.take_answer_0 ;
  wire        asked = which ? \dut.hits.step_queue.oldest [1] : \dut.hits.step_queue.oldest [0];
  wire [DEPTH-1:0] asks = which ? steps_bit_1 : steps_bit_0;
  reg   [7:0] shares = 0;
  reg   [7:0] taken = 0;
  wire  [7:0] not_taken = shares - taken;

  reg after_reset = 1'b0;
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    way <= (rst | begins) ? 0 : {way[SLACK-2:0], \dut.steps_have_room };
    inside_before <= (rst | begins) ? 8'd0 : inside;
    shares <= (rst | begins) ? 8'd0 : shares + {7'd0, put};
    taken <= (rst | begins) ? 8'd0 : taken + {7'd0, take};
  end

  // A step has a number: that of the shares before it.
`ifdef CHOSEN
  // Any place of the memory, and the one behind it.
  (* anyconst *) wire [5:0] chosen;
  wire  [5:0] behind = chosen + 6'd1;
  wire  [5:0] before = chosen - head;
  wire        holds = {1'b0, before} < waiting;
  reg   [7:0] number;
  reg   [7:0] number_behind;
  wire  [7:0] next = tail == behind ? shares : number_behind;
  wire  [7:0] shares_since = shares - number;
  wire  [7:0] steps_since = {1'b0, waiting} - {2'd0, before};
  always @(posedge clk) if (\dut.hits.step_queue.put ) begin
    if (tail == chosen) number <= shares;
    if (tail == behind) number_behind <= shares;
  end
`else
  reg   [7:0] number[0:DEPTH-1];
  wire  [5:0] behind = head + 6'd1;
  wire  [7:0] first = waiting == 0 ? shares : number[head];
  wire  [7:0] next = tail == behind ? shares : number[behind];
  wire  [7:0] shares_since = shares - first;
  always @(posedge clk) if (\dut.hits.step_queue.put ) number[tail] <= shares;
`endif

  always @* begin
    assume (after_reset | rst);
    assume (!\dut.box_pairs_put | way[SLACK-1]);
    assume ({\dut.control_begin_loader , \dut.control_begin_deciders } == {2{begins}});
`ifndef CHOSEN
    // What is proven of any place holds for that of the oldest step: step_for_step, no_more_than_steps.
    assume (waiting == 0 | next == first + {7'd0, asks[head]});
    assume (waiting == 0 | shares_since <= {1'b0, waiting});
`endif
  end

  always @* if (after_reset & ~rst) begin
    steps_fit: assert (!(\dut.hits.step_queue.put & waiting == DEPTH));
    room_is_right: assert (!\dut.steps_have_room | inside_before + SLACK < DEPTH - 1);
    bounded: assert (inside <= inside_before + 1);
    enough: assert (inside + coming <= DEPTH);
    in_place: assert (tail == head + waiting[5:0]);
`ifdef CHOSEN
    // The next number is that of a step and what it asks.
    step_for_step: assert (!holds | next == number + {7'd0, asks[chosen]});
    // No more shares came since a step than steps.
    no_more_than_steps: assert (!holds | shares_since <= steps_since);
`else
    oldest_first: assert (first == taken + {7'd0, valid & asked});
    // What decider.sv assumes.
    few_shares: assert (not_taken + {7'd0, put} <= DEPTH);
`endif
  end

`ifndef CHOSEN
  always @* if (after_reset & ~rst) begin
    many_shares: cover (not_taken == 12 & waiting == 13 & !asked & valid);
  end
`endif
endmodule

`default_nettype wire
