// SPDX-License-Identifier: MIT OR Apache-2.0
// A queue of the search, by induction: it never overflows, if whoever puts words in makes a step only where `has_room`
// is set, and a step's word comes at most 8 cycles later, or never. What is taken is what was put in, in order (bounded).
//
// Defines: ORDER, for the order of words, which is proven by itself.
`default_nettype none

module queue (
  input wire        clk,
  input wire        rst,
  input wire        start,
  input wire        step,
  input wire        comes,
  input wire        taken,
  input wire [3:0]  content
);
  localparam DEPTH = 16;
  localparam SLACK = 8;

  // Steps whose words have not come yet. A stage of fewer cycles is this one with steps that wait no longer.
  reg [SLACK-1:0] way = 0;
  wire            put = way[SLACK-1] & comes;
  wire            valid;
  wire            has_room;
  wire [QUEUE_BITS-1:0] oldest;
  wire            take = valid & taken;
  localparam QUEUE_BITS = `QUEUE_BITS;
  `QUEUE dut (
    .clk(clk), .rst(rst), .start(start), .put(put), .take(take), .word({{(QUEUE_BITS-4){1'b0}}, content}),
    .valid(valid), .oldest(oldest), .has_room(has_room)
  );
  (* hierconn *) wire [4:0] \dut.waiting ;
  (* hierconn *) wire [3:0] \dut.head ;
  (* hierconn *) wire [3:0] \dut.tail ;
  wire [5:0] inside_now = {1'b0, \dut.waiting } + {5'd0, valid};

  integer stage;
  reg [5:0] coming;
  always @* begin
    coming = 0;
    for (stage = 0; stage < SLACK; stage = stage + 1) coming = coming + {5'd0, way[stage]};
  end

  reg       after_reset = 1'b0;
  reg [5:0] inside_before = 0;
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    way <= (rst | start) ? 0 : {way[SLACK-2:0], step & has_room};
    inside_before <= (rst | start) ? 0 : inside_now;
  end

  always @* begin
    assume (after_reset | rst);
  end

`ifdef ORDER
  // Any one word, by its number.
  (* anyconst *) wire [5:0] chosen;
  reg [5:0] came = 0;
  reg [5:0] went = 0;
  reg [3:0] kept;
  always @(posedge clk) begin
    came <= (rst | start) ? 0 : came + {5'd0, put};
    went <= (rst | start) ? 0 : went + {5'd0, take};
    if (put & came == chosen) kept <= content;
  end
  always @* if (after_reset & ~rst) begin
    in_order: assert (!(take & went == chosen) | (oldest[3:0] == kept & came != went));
    none_lost: assert (came - went == inside_now);
  end
`endif

  always @* if (after_reset & ~rst) begin
    never_full: assert (!(put & \dut.waiting == DEPTH));
    room_is_right: assert (!has_room | inside_before + SLACK < DEPTH - 1);
    counted: assert (\dut.tail == \dut.head + \dut.waiting [3:0]);
    bounded: assert (inside_now <= inside_before + 1);
    enough: assert (inside_now + coming <= DEPTH);
  end

  always @* begin
    is_full: cover (\dut.waiting >= 14);
  end
endmodule

`default_nettype wire
