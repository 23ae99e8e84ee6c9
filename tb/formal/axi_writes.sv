// SPDX-License-Identifier: MIT OR Apache-2.0
// The writes of the shell `axi` alone, by induction: addresses and beats are stable until they are taken, a burst has
// whole lines, does not cross 4 KB, and has its WLAST at its last beat. A burst's lines are all there before its
// address is put out, and every line is written once, in order.
//
// Memory may take addresses and beats when it likes, in any order, and give responses that nobody waits for.
`default_nettype none

module axi_writes (
  input wire         clk,
  input wire         rst,
  input wire         wr_valid,
  input wire [57:0]  wr_address,
  input wire [7:0]   wr_tag,
  input wire [511:0] wr_data,
  input wire         awready,
  input wire         wready,
  input wire         bvalid,
  input wire [1:0]   bresp
);
  wire         wr_ready;
  wire         awvalid;
  wire [63:0]  awaddr;
  wire [7:0]   awlen;
  wire         wvalid;
  wire [255:0] wdata;
  wire         wlast;
  axi_write dut (
    .clk(clk), .rst(rst), .wr_valid(wr_valid), .wr_address(wr_address), .wr_tag(wr_tag), .wr_data(wr_data),
    .awready(awready), .wready(wready), .bvalid(bvalid), .bresp(bresp), .wr_ready(wr_ready), .awvalid(awvalid),
    .awaddr(awaddr), .awlen(awlen), .wvalid(wvalid), .wdata(wdata), .wlast(wlast), .rsp_valid(), .rsp_tag(),
    .rsp_error(), .failed(), .failed_response(), .failed_address(), .idle()
  );
  wire         accepts = wr_valid & wr_ready;
  wire [57:0]  asked = wr_address;
`include "bursts.svh"
  (* hierconn *) wire        \dut.next_burst ;
  (* hierconn *) wire [1:0]  \dut.next_burst_more ;
  (* hierconn *) wire        \dut.burst_leaves ;
  (* hierconn *) wire        \dut.burst_begins_to_leave ;
  (* hierconn *) wire        \dut.line_fetched ;
  (* hierconn *) wire        \dut.line_present ;
  (* hierconn *) wire        \dut.leaving_is_last ;
  (* hierconn *) wire        \dut.beat_leaves ;
  (* hierconn *) wire        \dut.beat_number ;
  (* hierconn *) wire [1:0]  \dut.lines_left ;
  (* hierconn *) wire [3:0]  \dut.head ;
  (* hierconn *) wire [3:0]  \dut.behind_head ;
  (* hierconn *) wire [3:0]  \dut.tail ;

  reg [15:0] left = 16'd0;         // lines that were taken out of the memory
  reg        aw_held = 1'b0;
  reg        w_held = 1'b0;
  reg [71:0] aw_was;
  reg [256:0] w_was;
  // AWLEN of the next burst, of the one whose lines are taken out of the memory, and of the one whose line is present.
  reg [7:0]  next_length;
  reg [7:0]  length;
  reg [7:0]  present_length;
  // Lines that were taken out of the memory before, in the burst that is taken out now and in that of the present line.
  reg [6:0]  lines = 7'd0;
  reg [6:0]  lines_before;
  // Beats that have left, of the burst whose beats leave.
  reg [7:0]  beats = 8'd0;
  reg        is_last;
  wire [15:0] leaving = \dut.burst_leaves ? {14'd0, \dut.lines_left } + 16'd1 : 16'd0;
  wire [15:0] waiting = \dut.next_burst ? {14'd0, \dut.next_burst_more } + 16'd1 : 16'd0;
  wire        is_whole = \dut.leaving_is_last ;
  always @(posedge clk) begin
    left <= rst ? 16'd0 : left + {15'd0, \dut.line_fetched };
    if (\dut.burst_closes ) next_length <= {5'd0, \dut.burst_more , 1'b1};
    if (\dut.burst_begins_to_leave ) length <= next_length;
    lines <= rst | \dut.burst_begins_to_leave ? 7'd0 : lines + {6'd0, \dut.line_fetched };
    if (\dut.line_fetched ) begin
      lines_before <= lines;
      present_length <= length;
    end
    if (\dut.beat_leaves ) is_last <= beats == present_length;
    beats <= rst | (\dut.beat_leaves & beats == present_length) ? 8'd0 : beats + {7'd0, \dut.beat_leaves };
    aw_held <= awvalid & ~awready & ~rst;
    aw_was <= {awaddr, awlen};
    w_held <= wvalid & ~wready & ~rst;
    w_was <= {wdata, wlast};
  end

  always @* if (~rst & after_reset) begin
    whole_lines: assert (~awvalid | (awaddr[5:0] == 6'd0 & awlen[0] & awlen[7:3] == 5'd0));
    within_a_page: assert ((~awvalid | {1'b0, awaddr[11:6]} + {1'b0, awlen[7:1]} < 8'd64) & open_within_a_page);
    in_order: assert (lines_in_order & ~(\dut.burst_closes & (awvalid | \dut.next_burst )));
    all_are_there: assert (closed == left + leaving + waiting & left <= closed & \dut.behind_head == \dut.head + 4'd1
      & \dut.head == left[3:0] & \dut.tail == accepted[3:0]);
    last_is_last: assert ((~wvalid | wlast == is_last)
      & (~\dut.next_burst | next_length == {5'd0, \dut.next_burst_more , 1'b1})
      & (~\dut.burst_leaves | (length == {lines + {5'd0, \dut.lines_left }, 1'b1} & lines <= length[7:1]))
      & (\dut.line_present | ~\dut.beat_number ));
    // A present line continues its burst, which ends with it or goes on in the memory.
    every_beat_leaves: assert (\dut.line_present
      ? beats == {lines_before, \dut.beat_number } & present_length[0] & lines_before <= present_length[7:1]
        & is_whole == (lines_before == present_length[7:1])
        & (is_whole ? ~\dut.burst_leaves | lines == 7'd0
          : \dut.burst_leaves & lines == lines_before + 7'd1 & length == present_length)
      : beats == (\dut.burst_leaves ? {lines, 1'b0} : 8'd0)
        & (~\dut.burst_leaves | lines == 7'd0 | present_length == length));
  end
  always @* if (aw_held & ~rst) begin
    address_is_stable: assert (awvalid & {awaddr, awlen} == aw_was);
  end
  always @* if (w_held & ~rst) begin
    data_are_stable: assert (wvalid & {wdata, wlast} == w_was);
  end
endmodule

`default_nettype wire
