// SPDX-License-Identifier: MIT OR Apache-2.0
// A stage of the search, by induction: it walks over the bits of each item, one per cycle where the queue behind has
// room, and what it finds goes there. Every item leaves once, and so does the token at the end of a row, in order.
// What the boxes of a step say is free in every cycle (`meets`), and so is every item.
//
// Assumed here, and proven of the stage before and of the queue between them: the number of a row is that of the
// tokens before it, so whatever is lost, doubled or overtaken shows in a number (in_order; queue.sv: in_order).
//
// Defines: STAGE_CYCLES, from a step to what it found; FOUND, the output with that; NUMBER, the output with the number
// of the step's bit, except for box against box; NEAR or BOX_PAIRS, for what these two alone have; ABOUT_BITS and
// ROW_AT, the bits of what stays the same for all steps of an item, and where the row is in it.
`default_nettype none

module stage (
  `include "inputs.svh"
);
  localparam CYCLES = `STAGE_CYCLES;

  `include "dut.svh"
  (* hierconn *) wire        \dut.active ;
  (* hierconn *) wire [15:0] \dut.walked_bit ;
  (* hierconn *) wire [15:0] \dut.rest ;
  (* hierconn *) wire        \dut.is_last ;
  (* hierconn *) wire [`ABOUT_BITS-1:0] \dut.about ;

`include "ones.svh"
  // As many bits, the lowest ones.
  function [15:0] first(input [4:0] number);
    first = ~(16'hFFFF << number);
  endfunction
  function [3:0] number_of(input [15:0] hot);
    integer place;
    begin
      number_of = 0;
      for (place = 0; place < 16; place = place + 1) if (hot[place]) number_of = place;
    end
  endfunction

  // The item in hand, as it was taken, and the bits of it that had no step yet.
  reg         hand = 1'b0;
  reg         hand_last;
  reg  [11:0] hand_row;
  reg  [15:0] hand_left;
  reg   [4:0] hand_waits;
  wire [15:0] lowest = hand_left & (16'd0 - hand_left);
  wire        step = hand & may_step;
  wire        leaves = step & hand_left == lowest;

  // Steps whose result did not come out yet, the newest first.
  reg [CYCLES-1:0] way = 0;
  reg [CYCLES-1:0] way_token;
  reg [CYCLES-1:0] way_empty;
  reg [3:0]        way_number[0:CYCLES-1];
  wire             comes = way[CYCLES-1];
  wire             token = way_token[CYCLES-1];
`ifdef BOX_PAIRS
  reg [15:0] hand_near;
  reg [15:0] way_near[0:CYCLES-1];
`endif

  // Tokens that came and went.
  reg [11:0] tokens_in = 0;
  reg [11:0] tokens_out = 0;
  reg [11:0] tokens_inside;
  integer    at;
  integer    on;
  always @* begin
    tokens_inside = {11'd0, hand & hand_last};
    for (at = 0; at < CYCLES; at = at + 1)
      tokens_inside = tokens_inside + {11'd0, way[at] & way_token[at]};
  end

  reg after_reset = 1'b0;
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    hand <= ~rst & ~start & (takes | (hand & ~leaves));
    hand_waits <= takes ? 5'd0 : hand_waits + {4'd0, hand & may_step};
    hand_left <= takes ? item_mask : step ? hand_left & ~lowest : hand_left;
    if (takes) begin
      hand_last <= item_last;
      hand_row <= item_row;
    end
    way <= (rst | start) ? 0 : {way[CYCLES-2:0], step};
    way_token <= {way_token[CYCLES-2:0], leaves & hand_last};
    way_empty <= {way_empty[CYCLES-2:0], hand_left == 0};
    way_number[0] <= number_of(lowest);
    for (on = 1; on < CYCLES; on = on + 1) way_number[on] <= way_number[on-1];
`ifdef BOX_PAIRS
    if (takes) hand_near <= item_near;
    way_near[0] <= hand_near;
    for (on = 1; on < CYCLES; on = on + 1) way_near[on] <= way_near[on-1];
`endif
    tokens_in <= (rst | start) ? 12'd0 : tokens_in + {11'd0, takes & item_last};
    tokens_out <= (rst | start) ? 12'd0 : tokens_out + {11'd0, put & last};
  end

  always @* begin
    assume (after_reset | rst);
    assume (!item_valid | item_row == tokens_in);
`ifdef BOX_PAIRS
    // near: turns_are_right.
    assume (!item_valid | item_mask == first(ones(item_near)));
`endif
  end

  always @* if (after_reset & ~rst) begin
    in_order: assert (!put | row == tokens_out);
    conserved: assert (tokens_in - tokens_out == tokens_inside);
    hand_is_right: assert (\dut.active == hand & (!hand | \dut.walked_bit == lowest));
    rest_in_hand: assert (!hand | \dut.rest == (hand_left & ~lowest));
    last_in_hand: assert (!hand | \dut.is_last == (hand_left == lowest));
    token_in_hand: assert (!hand | \dut.about [0] == hand_last);
    row_in_hand: assert (!hand | \dut.about [`ROW_AT+:12] == hand_row);
    hand_row_is_right: assert (!hand | hand_row == tokens_in - {11'd0, hand_last});
    each_step_once: assert (put == (comes & (token | `FOUND != 0)));
    token_is_last: assert (!put | last == token);
    none_without_bit: assert (!(put & way_empty[CYCLES-1]) | `FOUND == 0);
    takes_at_once: assert (!item_valid | takes | (hand & !leaves));
    takes_what_is_there: assert (!takes | item_valid);
    // An item is in hand for as many cycles as it has bits, at most, and one if it has none; those without room apart.
    oldest_leaves: assert (!\dut.active | hand_waits + ones(\dut.walked_bit | \dut.rest ) <= 16);
`ifdef NUMBER
    bits_in_order: assert (!put | way_empty[CYCLES-1] | `NUMBER == way_number[CYCLES-1]);
`endif
`ifdef NEAR
    turns_are_right: assert (!put | mask == first(ones(spheres)));
`endif
  end

`ifdef BOX_PAIRS
  // The sphere of a step is the next one of those that are near.
  wire [3:0]  turn = way_number[CYCLES-1];
  wire [15:0] near_now = way_near[CYCLES-1];
  // Candidates that left, as they are counted some cycles later.
  reg [31:0] left = 0;
  reg [4:0]  counted_1 = 0;
  reg [4:0]  counted_2 = 0;
  reg        started = 1'b0;
  reg        ran = 1'b1;
  always @(posedge clk) begin
    counted_1 <= (~rst & put & run) ? ones(`FOUND) : 5'd0;
    counted_2 <= rst ? 5'd0 : counted_1;
    left <= (rst | start) ? 32'd0 : left + {27'd0, counted_2};
    started <= ~rst & (start | started);
    ran <= rst | run;
  end
  always @* begin
    // begins.sv: not_while_another_runs.
    assume (!(start & (run | ran)));
  end
  always @* if (after_reset & ~rst) begin
    near_in_hand: assert (!hand | \dut.about [25+:16] == hand_near);
    next_near: assert (!put | `FOUND == 0 | (near_now[places] & ones(near_now & first({1'b0, places})) == {1'b0, turn}));
    counted_once: assert (!started | candidates == left);
  end
`endif

  // What was found in the first three rows.
  reg [2:0] found_in = 0;
  always @(posedge clk) begin
    if (rst | start) found_in <= 0;
    else if (put & |`FOUND & tokens_out < 3) found_in[tokens_out[1:0]] <= 1'b1;
  end
  always @* if (after_reset & ~rst) begin
    two_rows_inside: cover (put & last & hand & |(way[CYCLES-2:0] & way_token[CYCLES-2:0]));
    a_row_without: cover (tokens_out == 3 & found_in == 3'b101);
    waits_for_room: cover (hand & !may_step & hand_waits == 2 & item_valid);
  end
endmodule

`default_nettype wire
