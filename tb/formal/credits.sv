// SPDX-License-Identifier: MIT OR Apache-2.0
// Credits of the whole accelerator, by induction, for a host and a link that do anything at all: a pair enters only when
// its result has a place, every pair that entered comes out once, and the places are all accounted for. Counts, not data.
//
// The induction is longer than the pipeline, so that it needs no word about what is inside it.
//
// Defines: LATENCY, of an SCPU; LINES, lines the dispatcher keeps.
`default_nettype none

module credits (
  input wire        clk,
  input wire        rst,
  input wire        start,
  input wire [57:0] source,
  input wire [57:0] destination,
  input wire [31:0] count,
  input wire [3:0]  mode,
  input wire [3:0]  epoch,
  input wire [31:0] watchdog,
  input wire        abort_job,
  input wire        rd_req_ready,
  input wire        rd_rsp_valid,
  input wire [5:0]  rd_rsp_tag,
  input wire [31:0] rd_rsp_data,
  input wire        rd_rsp_error,
  input wire        wr_req_ready,
  input wire        wr_rsp_valid,
  input wire [5:0]  wr_rsp_tag,
  input wire        wr_rsp_error
);
  localparam CAPACITY = 2 * `LINES;
  localparam RANKS = `LATENCY + 3;

  wire busy;
  wire [3:0] error;
  wire rd_req_valid;
  wire wr_req_valid;
  contact_afu #(.SCPUS(32'd2)) dut (
    .clk(clk), .rst(rst),
    .start(start), .source(source), .destination(destination), .count(count), .mode(mode), .epoch(epoch),
    .watchdog(watchdog), .abort_job(abort_job),
    .rd_req_ready(rd_req_ready), .rd_rsp_valid(rd_rsp_valid), .rd_rsp_tag(rd_rsp_tag), .rd_rsp_data(rd_rsp_data),
    .rd_rsp_error(rd_rsp_error),
    .wr_req_ready(wr_req_ready), .wr_rsp_valid(wr_rsp_valid), .wr_rsp_tag(wr_rsp_tag), .wr_rsp_error(wr_rsp_error),
    .busy(busy), .done(), .error(error), .contacts(), .invalid(), .first_invalid(),
    .cycles_busy(), .cycles_input(), .cycles_output(), .capability(),
    .rd_req_valid(rd_req_valid), .rd_req_address(), .rd_req_tag(),
    .wr_req_valid(wr_req_valid), .wr_req_address(), .wr_req_tag(), .wr_req_data()
  );
  (* hierconn *) wire                       \dut.control.begin_job ;
  (* hierconn *) wire                       \dut.control.running ;
  (* hierconn *) wire                       \dut.control.draining ;
  (* hierconn *) wire                       \dut.control.completes ;
  (* hierconn *) wire [31:0]                \dut.control.job_count ;
  (* hierconn *) wire [31:0]                \dut.control.job_lines ;
  (* hierconn *) wire                       \dut.control.last_place ;
  (* hierconn *) wire                       \dut.control.may_enter ;
  (* hierconn *) wire [$clog2(`LINES)+1:0]  \dut.control.room ;
  (* hierconn *) wire [$clog2(`LINES)+1:0]  \dut.control.room_change ;
  (* hierconn *) wire [$clog2(`LINES)+1:0]  \dut.control.pairs_inside ;
  (* hierconn *) wire [1:0]                 \dut.control.entered ;
  (* hierconn *) wire [1:0]                 \dut.group_done ;
  (* hierconn *) wire                       \dut.feeder.take ;
  (* hierconn *) wire                       \dut.collector.line_valid ;
  (* hierconn *) wire [31:0]                \dut.feeder.lines_left ;
  (* hierconn *) wire                       \dut.feeder.any_lines_left ;
  (* hierconn *) wire                       \dut.feeder.one_lines_left ;
  (* hierconn *) wire                       \dut.feeder.in_hand ;
  (* hierconn *) wire                       \dut.feeder.place ;
  (* hierconn *) wire                       \dut.feeder.last ;
  (* hierconn *) wire [6:0]                 \dut.feeder.turn ;
  (* hierconn *) wire                       \dut.packer.place ;
  (* hierconn *) wire                       \dut.packer.line_valid ;
  (* hierconn *) wire                       \dut.packer.flushes ;
  (* hierconn *) wire                       \dut.packer.went ;
  (* hierconn *) wire                       \dut.packer.goes ;
  (* hierconn *) wire [31:0]                \dut.packer.emerged ;
  (* hierconn *) wire [$clog2(`LINES):0]    \dut.dispatcher.stored ;
  (* hierconn *) wire                       \dut.dispatcher.take ;
  (* hierconn *) wire                       \dut.dispatcher.line_left ;

  // Groups of pairs where they must be, each a rank further every cycle, and how many pairs that makes.
  reg [2*RANKS-1:0] ranks;
  reg after_reset = 1'b0;
  reg begun = 1'b0;
  reg flushed;
  reg ran = 1'b0;
  reg ran_before = 1'b0;
  reg completed = 1'b0;
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    begun <= ~rst & (begun | \dut.control.begin_job );
    ran <= \dut.control.running & ~rst;
    ran_before <= ran & ~rst;
    completed <= \dut.control.completes & ~rst;
    ranks <= rst ? {2 * RANKS{1'b0}} : {ranks[2*RANKS-3:0], \dut.control.entered };
    flushed <= ~\dut.control.begin_job & (flushed | \dut.packer.flushes );
  end
  integer rank;
  reg [7:0] inside;
  always @* begin
    inside = 8'd0;
    for (rank = 0; rank < RANKS; rank = rank + 1) inside = inside + {6'd0, ranks[2*rank +: 2]};
  end

  // Lines that have left the line in hand for the dispatcher's memory, or its memory for the link, and pairs that the
  // feeder still has to give.
  wire [$clog2(`LINES)+1:0] leaving = {1'b0, \dut.dispatcher.stored } + \dut.packer.went + \dut.packer.goes
    + \dut.packer.line_valid + \dut.dispatcher.line_left ;
  wire [$clog2(`LINES)+1:0] next_room = \dut.control.room + \dut.control.room_change ;
  wire [33:0] in_lines = \dut.feeder.lines_left == 32'd0 ? 34'd0
    : {1'b0, \dut.feeder.lines_left , 1'b0} - {33'd0, ~\dut.control.last_place };
  wire [33:0] to_give = in_lines
    + (\dut.feeder.in_hand ? 34'd1 + {33'd0, \dut.feeder.last } - {33'd0, \dut.feeder.place } : 34'd0);

  always @* assume (after_reset | rst);
  always @* if (after_reset & ~rst) begin
    comes_out: assert (\dut.group_done == ranks[2*RANKS-1 -: 2]);
    inside_is_right: assert (\dut.control.pairs_inside == inside);
    one_or_other: assert (~(\dut.control.running & \dut.control.draining ));
    only_in_a_job: assert (\dut.control.entered == 2'd0 | (ran_before & begun));
    complete_is_good: assert (~completed | error == 4'd0);
    begins_first: assert (~busy | begun | \dut.control.begin_job );
    begins_rested: assert (~\dut.control.begin_job | ~ran);
    begins_empty: assert (~\dut.control.begin_job | (busy & inside == 8'd0 & \dut.control.entered == 2'd0));
    idle_is_empty: assert (busy | (inside == 8'd0 & \dut.control.entered == 2'd0));
    takes_a_line: assert (~\dut.feeder.take | \dut.collector.line_valid );
    sends_a_line: assert (~\dut.dispatcher.take | \dut.dispatcher.stored != 0);
  end
  always @* if (begun & ~\dut.control.begin_job & ~rst) begin
    turn_is_an_scpu: assert (\dut.feeder.turn < 7'd2);
    lines_are_right: assert (\dut.control.job_lines == {1'b0, \dut.control.job_count [31:1]} + {31'd0, \dut.control.job_count [0]}
      & \dut.control.last_place == ~\dut.control.job_count [0]);
    flags_are_right: assert (\dut.feeder.any_lines_left == (\dut.feeder.lines_left != 32'd0)
      & \dut.feeder.one_lines_left == (\dut.feeder.lines_left == 32'd1));
    only_last_is_short: assert (~\dut.feeder.in_hand | \dut.feeder.last | \dut.feeder.lines_left == 32'd0);
    each_once: assert (to_give + {26'd0, inside} + {32'd0, \dut.control.entered } + {2'd0, \dut.packer.emerged }
      == {2'd0, \dut.control.job_count });
    last_line_once: assert (~flushed | (\dut.packer.emerged == \dut.control.job_count & ~\dut.packer.place ));
    places_add_up: assert ({4'd0, next_room} + inside + {7'd0, \dut.packer.place } + {3'd0, leaving, 1'b0}
      == CAPACITY + {7'd0, flushed});
    room_is_seen: assert (~\dut.control.may_enter | \dut.control.room >= 8);
    never_negative: assert (\dut.control.entered <= next_room);
    fits: assert (leaving - {3'd0, \dut.dispatcher.line_left } <= `LINES);
  end
endmodule

`default_nettype wire
