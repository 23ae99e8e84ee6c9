// SPDX-License-Identifier: MIT OR Apache-2.0
// How a row enters the search, by induction: each row that is searched begins where fewer rows are inside than can be
// kept, and is launched once, in order, with the number of the rows before it. So no queue of rows overflows.
//
// The spheres and their boxes are free, and all other parts of the AFU are too.
//
// Assumed here: no more rows end than were launched (stage.sv, joined.sv: conserved); a job's sets stay as they
// are while it runs (begins.sv: sets_stay).
`default_nettype none

module entry (
  `include "inputs.svh"
);
  // From the last sphere of a row to its launch.
  localparam CYCLES = 9;
  localparam [11:0] KEPT = 16;

  `include "dut.svh"
  (* hierconn *) wire        \dut.control_begin_loader ;
  (* hierconn *) wire        \dut.control_run ;
  (* hierconn *) wire        \dut.control_has_others ;
  (* hierconn *) wire        \dut.row_ends ;
  (* hierconn *) wire        \dut.rows_launches ;
  (* hierconn *) wire [11:0] \dut.rows_launched_row ;
  (* hierconn *) wire        \dut.loader.goes ;
  (* hierconn *) wire        \dut.loader.may_go ;
  (* hierconn *) wire        \dut.loader.any_left ;
  (* hierconn *) wire        \dut.loader.counts_spheres ;
  (* hierconn *) wire        \dut.loader.any_lines_waiting ;
  (* hierconn *) wire        \dut.loader.row_begins ;
  (* hierconn *) wire        \dut.loader.is_searched ;
  (* hierconn *) wire  [3:0] \dut.loader.column_now ;
  (* hierconn *) wire [11:0] \dut.loader.row_now ;
  (* hierconn *) wire  [4:0] \dut.loader.rows_inside ;
  (* hierconn *) wire [31:0] \dut.loader.spheres_left ;
  (* hierconn *) wire        \dut.loader_all_ended ;

  wire begins = \dut.control_begin_loader ;
  wire searched = \dut.loader.is_searched ;
  wire [3:0] column = \dut.loader.column_now ;
  wire goes = \dut.loader.goes ;

  // Rows that began, were launched and have ended. The last sphere of a row on its way.
  reg              loading = 1'b0;
  reg [11:0]       began = 0;
  reg [11:0]       launched = 0;
  reg [11:0]       ended = 0;
  reg [CYCLES-1:0] way = 0;
  reg [11:0]       on_the_way;
  integer          at;
  always @* begin
    on_the_way = {11'd0, loading};
    for (at = 0; at < CYCLES; at = at + 1) on_the_way = on_the_way + {11'd0, way[at]};
  end
  // Whether the sets are those that the job began with.
  reg sets = 1'b1;
  reg same = 1'b1;
  reg after_reset = 1'b0;
  wire stays = same & (sets == \dut.control_has_others );
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    sets <= (rst | begins) ? \dut.control_has_others : sets;
    same <= ~rst & (begins | stays);
    began <= (rst | begins) ? 12'd0 : began + {11'd0, \dut.loader.row_begins };
    launched <= (rst | begins) ? 12'd0 : launched + {11'd0, \dut.rows_launches };
    ended <= (rst | begins) ? 12'd0 : ended + {11'd0, \dut.row_ends };
    way <= (rst | begins) ? 0 : {way[CYCLES-2:0], loading & goes & column == 15};
    loading <= ~rst & ~begins & (\dut.loader.row_begins | (loading & ~(goes & column == 15)));
  end

  always @* begin
    assume (after_reset | rst);
    assume (stays | begins | !\dut.control_run );
    assume (!(begins & \dut.control_run ));
    assume (!\dut.row_ends | launched != ended);
  end

  always @* if (after_reset & ~rst) begin
    launched_in_order: assert (!\dut.rows_launches | \dut.rows_launched_row == launched);
    launched_once: assert (\dut.rows_launches == way[CYCLES-1]);
    conserved: assert (began - launched == on_the_way);
    row_is_whole: assert (!stays | loading == (searched & column != 0));
    never_more: assert (\dut.loader.rows_inside <= KEPT);
    inside_is_right: assert ({7'd0, \dut.loader.rows_inside } == began - ended);
    none_ends_early: assert (launched - ended <= KEPT);
    row_is_right: assert (!(stays & searched) | \dut.loader.row_now == began - {11'd0, column != 0});
    none_before: assert (!stays | searched | began == 0);
    rows_let_it_go: assert (!(stays & \dut.control_run ) | \dut.loader.may_go == (column != 0 | !searched | \dut.loader.rows_inside < KEPT));
    some_are_left: assert (\dut.loader.counts_spheres | \dut.loader.any_left == (\dut.loader.spheres_left != 0));
    no_line_yet: assert (!(\dut.loader.counts_spheres & \dut.loader.any_lines_waiting ));
    whole_rows: assert (\dut.loader.spheres_left != 0 | column == 0);
    all_are_out: assert (!\dut.loader_all_ended | began == ended);
  end

  always @* begin
    as_many_as_can_be: cover (launched == 2 & ended == 1 & loading & way[1]);
  end
endmodule

`default_nettype wire
