// SPDX-License-Identifier: MIT OR Apache-2.0
// A decider, by induction: each candidate of a share is decided once, with the spheres of its own places, and each
// share is answered once, in order. Neither of its two queues overflows, though nobody asks them for room. What the
// kernel says is free in every cycle, and so is what stands at the outputs of the queues (queue.sv: in_order).
//
// Assumed here, and proven of fork and join: a share has a candidate (joined.sv: first_is_asked); an answer is taken only
// where there is one (joined.sv: all_have_answered, first_is_taken); no more shares wait for that than there are places
// for steps (undecided.sv: few_shares).
//
// Defines: TO_ANSWER, the cycles from a candidate to its decision; UNDECIDED, the places for steps.
`default_nettype none

module decider (
  `include "inputs.svh"
);
  localparam CYCLES = `TO_ANSWER;
  localparam DEPTH = `UNDECIDED;

  `include "dut.svh"
  (* hierconn *) wire        \dut.shares_valid ;
  (* hierconn *) wire [27:0] \dut.shares_oldest ;
  (* hierconn *) wire        \dut.takes ;
  (* hierconn *) wire        \dut.active ;
  (* hierconn *) wire  [7:0] \dut.walked_bit ;
  (* hierconn *) wire  [7:0] \dut.rest ;
  (* hierconn *) wire        \dut.is_last ;
  (* hierconn *) wire [19:0] \dut.about ;
  (* hierconn *) wire [14:0] \dut.place_in_table ;
  (* hierconn *) wire  [3:0] \dut.row_in_hand ;
  (* hierconn *) wire  [3:0] \dut.place_in_row ;
  (* hierconn *) wire  [6:0] \dut.shares.waiting ;
  (* hierconn *) wire  [5:0] \dut.shares.head ;
  (* hierconn *) wire  [5:0] \dut.shares.tail ;
  (* hierconn *) wire  [6:0] \dut.answers.waiting ;
  (* hierconn *) wire  [5:0] \dut.answers.head ;
  (* hierconn *) wire  [5:0] \dut.answers.tail ;
  (* hierconn *) wire        \dut.kernel_hit ;
  (* hierconn *) wire        \dut.is_fresh ;
  (* hierconn *) wire  [7:0] \dut.hits_so_far ;
  (* hierconn *) wire        \dut.answer_comes ;
  (* hierconn *) wire  [7:0] \dut.answer_put ;

  function [3:0] ones(input [7:0] bits);
    integer place;
    begin
      ones = 0;
      for (place = 0; place < 8; place = place + 1) ones = ones + {3'd0, bits[place]};
    end
  endfunction
  function [2:0] number_of(input [7:0] hot);
    integer place;
    begin
      number_of = 0;
      for (place = 0; place < 8; place = place + 1) if (hot[place]) number_of = place;
    end
  endfunction

  // The share in hand: where its spheres are, and the candidates that are not on their way yet.
  reg         hand = 1'b0;
  reg  [7:0]  hand_left;
  reg [19:0]  hand_about;
  reg  [3:0]  hand_waits;
  wire [7:0]  lowest = hand_left & (8'd0 - hand_left);
  wire        leaves = hand & hand_left == lowest;
  // Candidates on their way to a decision, the newest first.
  reg [CYCLES-1:0] way = 0;
  reg [CYCLES-1:0] way_last;
  reg [7:0]        way_bit[0:CYCLES-1];
  wire             decided = way[CYCLES-1];
  wire [7:0]       hit = \dut.kernel_hit ? way_bit[CYCLES-1] : 8'd0;
  // The hits of a share that is not decided to its end, and the answer to one that is.
  reg [7:0] so_far;
  reg       is_begun = 1'b0;
  reg       comes = 1'b0;
  reg [7:0] right;
  wire [7:0] right_now = is_begun ? so_far | hit : hit;
  reg [6:0] shares_in = 0;
  reg [6:0] answers = 0;
  reg [6:0] inside;
  // Shares that were put and whose answers were not taken, and where they are: in the first queue, between the queues
  // or in the second one.
  reg [8:0] undecided = 0;
  wire [8:0] somewhere = {2'd0, \dut.shares.waiting } + {8'd0, \dut.shares_valid } + {2'd0, inside}
      + {2'd0, \dut.answers.waiting } + {8'd0, answer_valid};
  integer   at;
  integer   on;
  always @* begin
    inside = {6'd0, hand} + {6'd0, comes};
    for (at = 0; at < CYCLES; at = at + 1) inside = inside + {6'd0, way[at] & way_last[at]};
  end

  reg after_reset = 1'b0;
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    hand <= ~rst & ~start & (\dut.takes | (hand & ~leaves));
    hand_left <= \dut.takes ? \dut.shares_oldest [7:0] : hand_left & ~lowest;
    hand_waits <= \dut.takes ? 4'd0 : hand_waits + {3'd0, hand};
    if (\dut.takes ) hand_about <= \dut.shares_oldest [27:8];
    way <= (rst | start) ? 0 : {way[CYCLES-2:0], hand};
    way_last <= {way_last[CYCLES-2:0], leaves};
    way_bit[0] <= lowest;
    for (on = 1; on < CYCLES; on = on + 1) way_bit[on] <= way_bit[on-1];
    if (decided) so_far <= right_now;
    is_begun <= ~rst & ~start & (decided ? ~way_last[CYCLES-1] : is_begun);
    comes <= ~rst & ~start & decided & way_last[CYCLES-1];
    right <= right_now;
    shares_in <= (rst | start) ? 7'd0 : shares_in + {6'd0, \dut.takes };
    answers <= (rst | start) ? 7'd0 : answers + {6'd0, \dut.answer_comes };
    undecided <= (rst | start) ? 9'd0 : undecided + {8'd0, put} - {8'd0, take_answer};
  end

  always @* begin
    assume (after_reset | rst);
    assume (!\dut.shares_valid | \dut.shares_oldest [7:0] != 0);
    assume (!take_answer | answer_valid);
    assume (undecided + {8'd0, put} <= DEPTH);
  end

  always @* if (after_reset & ~rst) begin
    share_in_hand: assert (\dut.active == hand & (!hand | \dut.walked_bit == lowest));
    rest_in_hand: assert (!hand | \dut.rest == (hand_left & ~lowest));
    last_in_hand: assert (!hand | \dut.is_last == (hand_left == lowest));
    places_in_hand: assert (!hand | \dut.about == hand_about);
    some_are_left: assert (!hand | hand_left != 0);
    first_sphere: assert (!hand | \dut.place_in_table == {hand_about[11:0], number_of(lowest)});
    second_sphere: assert (!hand | {\dut.row_in_hand , \dut.place_in_row } == hand_about[19:12]);
    answered_once: assert (\dut.answer_comes == comes);
    answer_is_right: assert (!comes | \dut.answer_put == right);
    fresh_is_right: assert (\dut.is_fresh == !is_begun & (!is_begun | \dut.hits_so_far == so_far));
    conserved: assert (shares_in - answers == inside);
    takes_at_once: assert (\dut.takes == (\dut.shares_valid & (!hand | leaves)));
    none_is_lost: assert (undecided == somewhere);
    shares_fit: assert (!(put & \dut.shares.waiting == DEPTH));
    shares_in_place: assert (\dut.shares.tail == \dut.shares.head + \dut.shares.waiting [5:0]);
    answers_fit: assert (!(\dut.answer_comes & \dut.answers.waiting == DEPTH));
    answers_in_place: assert (\dut.answers.tail == \dut.answers.head + \dut.answers.waiting [5:0]);
    // A share is in hand for a cycle per candidate.
    oldest_leaves: assert (!\dut.active | hand_waits + ones(\dut.walked_bit | \dut.rest ) <= 8);
  end

  always @* begin
    answers_in_a_row: cover (answers == 3 & comes & hand & decided & shares_in == 6);
  end
endmodule

`default_nettype wire
