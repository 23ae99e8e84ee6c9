// SPDX-License-Identifier: MIT OR Apache-2.0
// The fork in front of two deciders and the join behind them, as they stand in the AFU that takes spheres, by
// induction. A step asks those deciders that have a candidate of it. The oldest step leaves when each decider that it
// asked has answered, and takes one answer of each of these. Each of its hits leaves once, in order, and is counted
// once; a row ends once, behind its last hit.
//
// All other parts are free, and what stands at the outputs of queues is too: each gives what was put in, in order
// (queue.sv), and a decider answers its shares in order (decider.sv).
//
// Assumed here: of what leaves the queue of hits, what is proven of what is put in (put_is_right).
`default_nettype none

module joined (
  `include "inputs.svh"
);
  `include "dut.svh"
  (* hierconn *) wire        \dut.control_begin_hits ;
  (* hierconn *) wire        \dut.control_run ;
  (* hierconn *) wire        \dut.line_has_room ;
  (* hierconn *) wire        \dut.box_pairs_put ;
  (* hierconn *) wire  [7:0] \dut.box_pairs_share_0 ;
  (* hierconn *) wire  [7:0] \dut.box_pairs_share_1 ;
  (* hierconn *) wire        \dut.decider_0.put ;
  (* hierconn *) wire        \dut.decider_1.put ;
  (* hierconn *) wire        \dut.hits.put ;
  (* hierconn *) wire        \dut.hits.asks_0 ;
  (* hierconn *) wire        \dut.hits.asks_1 ;
  (* hierconn *) wire        \dut.decider_0_answer_valid ;
  (* hierconn *) wire        \dut.decider_1_answer_valid ;
  (* hierconn *) wire  [7:0] \dut.decider_0_answer ;
  (* hierconn *) wire  [7:0] \dut.decider_1_answer ;
  (* hierconn *) wire        \dut.take_answer_0 ;
  (* hierconn *) wire        \dut.take_answer_1 ;
  (* hierconn *) wire        \dut.hits.step_queue_valid ;
  (* hierconn *) wire [30:0] \dut.hits.step_queue_oldest ;
  (* hierconn *) wire        \dut.hits.step_leaves ;
  (* hierconn *) wire        \dut.hits.hits_have_room ;
  (* hierconn *) wire [15:0] \dut.hits.hits_of_step ;
  (* hierconn *) wire  [2:0] \dut.hits.step_put ;
  (* hierconn *) wire [28:0] \dut.hits.step_counted ;
  (* hierconn *) wire  [4:0] \dut.hits.hits_up_to_0 ;
  (* hierconn *) wire [15:0] \dut.hits.hits_put ;
  (* hierconn *) wire  [3:0] \dut.hits.beats_put ;
  (* hierconn *) wire        \dut.hits.hit_queue_valid ;
  (* hierconn *) wire [53:0] \dut.hits.hit_queue_oldest ;
  (* hierconn *) wire        \dut.hits.takes ;
  (* hierconn *) wire        \dut.hits.active ;
  (* hierconn *) wire  [3:0] \dut.hits.walked_bit ;
  (* hierconn *) wire  [3:0] \dut.hits.rest ;
  (* hierconn *) wire        \dut.hits.is_last ;
  (* hierconn *) wire [49:0] \dut.hits.about ;
  (* hierconn *) wire  [3:0] \dut.hits_carries ;
  (* hierconn *) wire [31:0] \dut.hits_record_0 ;
  (* hierconn *) wire [31:0] \dut.hits_record_1 ;
  (* hierconn *) wire [31:0] \dut.hits_record_2 ;
  (* hierconn *) wire [31:0] \dut.hits_record_3 ;
  (* hierconn *) wire        \dut.row_ends ;

`include "ones.svh"
  // A bit for each four hits.
  function [3:0] beats_of(input [4:0] hits);
    beats_of = {hits > 12, hits > 8, hits > 4, hits > 0};
  endfunction
  function [1:0] number_of(input [3:0] hot);
    number_of = {hot[3] | hot[2], hot[3] | hot[1]};
  endfunction

  // ---- The fork and the join ----
  wire        begins = \dut.control_begin_hits ;
  wire [30:0] oldest = \dut.hits.step_queue_oldest ;
  wire        leaves = \dut.hits.step_leaves ;
  wire [15:0] matrix = \dut.hits.hits_of_step ;
  wire        all_answered =
      (\dut.decider_0_answer_valid | ~oldest[0]) & (\dut.decider_1_answer_valid | ~oldest[1]);
  wire [15:0] joined_answers;
  genvar column;
  for (column = 0; column < 8; column = column + 1) begin
    assign joined_answers[2*column] = oldest[0] & \dut.decider_0_answer [column];
    assign joined_answers[2*column+1] = oldest[1] & \dut.decider_1_answer [column];
  end

  // Steps with hits, and those that end a row, as they are counted.
  localparam TO_PUT = 3;
  reg [TO_PUT-1:0] counting = 0;
  reg [28:0]       counting_about[0:TO_PUT-1];
  reg [15:0]       counting_hits[0:TO_PUT-1];
  wire [15:0]      hits_now = counting_hits[TO_PUT-1];
  wire [53:0]      item_put = {
    \dut.hits.step_counted , \dut.hits.hits_up_to_0 , \dut.hits.hits_put , \dut.hits.beats_put
  };

  // ---- The hits of a step ----
  // The step in hand: {own row, place, row, last, the number of hits, hits}.
  wire [53:0] item = \dut.hits.hit_queue_oldest ;
  reg         hand = 1'b0;
  reg  [49:0] hand_about;
  reg   [3:0] hand_left;
  reg   [2:0] hand_waits;
  wire  [3:0] lowest = hand_left & (4'd0 - hand_left);
  wire        step = hand & \dut.line_has_room ;
  wire        step_ends = step & hand_left == lowest;
  // Four hits at a time on their way, the newest first.
  localparam TO_CARRY = 5;
  reg [TO_CARRY-1:0] way = 0;
  reg [1:0]          way_beat[0:TO_CARRY];
  reg [49:0]         way_about[0:TO_CARRY];
  reg                ended = 1'b0;
  reg [3:0]          carried = 0;
  wire [4:0]         hits_in_all = ones(way_about[TO_CARRY-1][15:0]);
  wire [4:0]         of_beat = {1'b0, way_beat[TO_CARRY-1], 2'd0};
  wire [3:0]         right = way[TO_CARRY-1] ?
      {of_beat + 5'd3 < hits_in_all, of_beat + 5'd2 < hits_in_all, of_beat + 5'd1 < hits_in_all, of_beat < hits_in_all}
      : 4'd0;
  wire [49:0]        record_about = way_about[TO_CARRY];
  wire [15:0]        record_hits = record_about[15:0];
  wire [1:0]         record_beat = way_beat[TO_CARRY];
  // Any one of four hits side by side.
  (* anyconst *) wire [1:0] lane;
  wire [31:0] record =
      lane == 0 ? \dut.hits_record_0 : lane == 1 ? \dut.hits_record_1 : lane == 2 ? \dut.hits_record_2 : \dut.hits_record_3 ;
  wire [3:0]  place_of_hit = record[3:0];

  // Rows and hits, counted.
  reg [11:0] rows_in = 0;
  reg [11:0] rows_out = 0;
  reg [31:0] counted = 0;
  reg        ran = 1'b0;
  reg        started = 1'b0;
  reg        after_reset = 1'b0;
  integer    at;
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    ran <= ~rst & \dut.control_run ;
    started <= ~rst & (begins | started);
    counting <= (rst | begins) ? 0 : {counting[TO_PUT-2:0], leaves & (|joined_answers | oldest[2])};
    counting_about[0] <= oldest[30:2];
    counting_hits[0] <= joined_answers;
    for (at = 1; at < TO_PUT; at = at + 1) begin
      counting_about[at] <= counting_about[at-1];
      counting_hits[at] <= counting_hits[at-1];
    end
    hand <= ~rst & ~begins & (\dut.hits.takes | (hand & ~step_ends));
    hand_left <= \dut.hits.takes ? item[3:0] : step ? hand_left & ~lowest : hand_left;
    hand_waits <= \dut.hits.takes ? 3'd0 : hand_waits + {2'd0, step};
    if (\dut.hits.takes ) hand_about <= item[53:4];
    way <= (rst | begins) ? 0 : {way[TO_CARRY-2:0], step};
    ended <= ~rst & ~begins & step_ends & hand_about[21];
    carried <= (rst | begins) ? 4'd0 : right;
    rows_in <= (rst | begins) ? 12'd0 : rows_in + {11'd0, \dut.hits.takes & item[25]};
    rows_out <= (rst | begins) ? 12'd0 : rows_out + {11'd0, \dut.row_ends };
    counted <= (rst | begins) ? 32'd0 : counted + (ran ? {27'd0, ones({12'd0, \dut.hits_carries })} : 32'd0);
  end
  integer on;
  always @(posedge clk) begin
    way_beat[0] <= number_of(lowest);
    way_about[0] <= hand_about;
    for (on = 1; on <= TO_CARRY; on = on + 1) begin
      way_beat[on] <= way_beat[on-1];
      way_about[on] <= way_about[on-1];
    end
  end

  always @* begin
    assume (after_reset | rst);
    assume (!\dut.hits.hit_queue_valid | item[24:20] == ones(item[19:4]));
    assume (!\dut.hits.hit_queue_valid | item[3:0] == beats_of(item[24:20]));
    // begins.sv: not_while_another_runs.
    assume (!(begins & (\dut.control_run | ran)));
  end

  always @* if (after_reset & ~rst) begin
    step_is_told: assert (\dut.hits.put == \dut.box_pairs_put );
    first_is_asked: assert (\dut.decider_0.put == (\dut.hits.put & |\dut.box_pairs_share_0 ));
    second_is_asked: assert (\dut.decider_1.put == (\dut.hits.put & |\dut.box_pairs_share_1 ));
    asked_is_told: assert ({\dut.hits.asks_1 , \dut.hits.asks_0 } == {|\dut.box_pairs_share_1 , |\dut.box_pairs_share_0 });
    all_have_answered: assert (!leaves | (\dut.hits.step_queue_valid & all_answered & \dut.hits.hits_have_room ));
    leaves_at_once: assert (leaves | !(\dut.hits.step_queue_valid & all_answered & \dut.hits.hits_have_room ));
    first_is_taken: assert (\dut.take_answer_0 == (leaves & oldest[0]));
    second_is_taken: assert (\dut.take_answer_1 == (leaves & oldest[1]));
    answers_are_joined: assert (matrix == joined_answers);
    put_once: assert (\dut.hits.step_put [2] == counting[TO_PUT-1]);
    put_is_right: assert (!counting[TO_PUT-1]
                          | item_put == {counting_about[TO_PUT-1], ones(hits_now), hits_now, beats_of(ones(hits_now))});

    step_in_hand: assert (\dut.hits.active == hand & (!hand | \dut.hits.walked_bit == lowest));
    rest_in_hand: assert (!hand | \dut.hits.rest == (hand_left & ~lowest));
    last_in_hand: assert (!hand | \dut.hits.is_last == (hand_left == lowest));
    about_step: assert (!hand | \dut.hits.about == hand_about);
    hits_in_hand: assert (!hand | hand_about[20:16] == ones(hand_about[15:0]));
    takes_at_once: assert (\dut.hits.takes == (\dut.hits.hit_queue_valid & (!hand | step_ends)));
    hits_leave: assert (!\dut.hits.active
                        | {2'd0, hand_waits} + ones({12'd0, \dut.hits.walked_bit | \dut.hits.rest }) <= 4);
    each_hit_once: assert (\dut.hits_carries == right);
    hit_is_in_step: assert (!carried[lane] | record_hits[place_of_hit]);
    hits_in_order: assert (!carried[lane]
                           | ones(record_hits & ~(16'hFFFF << place_of_hit)) == {1'b0, record_beat, lane});
    numbers_are_right: assert (!carried[lane] | record[31:4] == {record_about[49:34], record_about[33:22]});
    row_ends_once: assert (\dut.row_ends == ended);
    conserved: assert (rows_in - rows_out == {11'd0, hand & hand_about[21]} + {11'd0, ended});
    contacts_counted_once: assert (!started | contacts == counted);
  end

  always @* if (after_reset & ~rst) begin
    a_step_with_many: cover (carried == 4'b0001 & record_beat == 2 & hand & !step & hand_left != 0 & rows_out == 1);
    two_asked: cover (leaves & oldest[1:0] == 2'b11 & counting[0] & !oldest[2]);
  end
endmodule

`default_nettype wire
