// SPDX-License-Identifier: MIT OR Apache-2.0
// The reads of the shell `axi` alone, by induction: an address is stable until it is taken, a burst has whole lines and
// does not cross 4 KB, and every line that the core asks for is asked of memory once, in order.
//
// Memory may take addresses when it likes, and give beats that nobody asked for.
`default_nettype none

module axi_reads (
  input wire         clk,
  input wire         rst,
  input wire         rd_valid,
  input wire [57:0]  rd_address,
  input wire [7:0]   rd_tag,
  input wire         arready,
  input wire [255:0] rdata,
  input wire [1:0]   rresp,
  input wire         rlast,
  input wire         rvalid
);
  wire        rd_ready;
  wire        arvalid;
  wire [63:0] araddr;
  wire [7:0]  arlen;
  axi_read dut (
    .clk(clk), .rst(rst), .rd_valid(rd_valid), .rd_address(rd_address), .rd_tag(rd_tag), .arready(arready),
    .rvalid(rvalid), .rdata(rdata), .rresp(rresp), .rlast(rlast), .rd_ready(rd_ready), .arvalid(arvalid),
    .araddr(araddr), .arlen(arlen), .rsp_valid(), .rsp_tag(), .rsp_data(), .rsp_error(), .failed(),
    .failed_response(), .failed_address(), .idle()
  );
  (* hierconn *) wire        \dut.burst_closes ;
  (* hierconn *) wire        \dut.burst_open ;
  (* hierconn *) wire [57:0] \dut.burst_first ;
  (* hierconn *) wire [1:0]  \dut.burst_more ;
  (* hierconn *) wire        \dut.line_waiting ;
  (* hierconn *) wire        \dut.line_follows ;
  (* hierconn *) wire [57:0] \dut.waiting_line ;
  (* hierconn *) wire [57:0] \dut.next_line ;
  (* hierconn *) wire [4:0]  \dut.lines_expected ;
  (* hierconn *) wire        \dut.complete ;

  // The number of any one line, and its address; lines that the core asked for, and those whose bursts were closed.
  (* anyconst *) wire [15:0] chosen;
  reg [57:0] address;
  reg [15:0] accepted = 16'd0;
  reg [15:0] closed = 16'd0;
  reg [15:0] completed = 16'd0;
  reg        after_reset = 1'b0;
  reg        held = 1'b0;
  reg [71:0] was;
  wire       accepts = rd_valid & rd_ready;
  wire [57:0] first = \dut.burst_first ;
  wire [15:0] more = {14'd0, \dut.burst_more };
  wire [57:0] last = first + {42'd0, more};
  wire [15:0] lines_open = \dut.burst_open ? more + 16'd1 : 16'd0;
  wire [57:0] within = {42'd0, chosen - closed};
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    if (accepts & accepted == chosen) address <= rd_address;
    accepted <= rst ? 16'd0 : accepted + {15'd0, accepts};
    closed <= rst ? 16'd0 : closed + (\dut.burst_closes ? lines_open : 16'd0);
    completed <= rst ? 16'd0 : completed + {15'd0, \dut.complete };
    held <= arvalid & ~arready & ~rst;
    was <= {araddr, arlen};
  end

  always @* begin
    assume (after_reset | rst);
    // No more lines than this number can count.
    assume (accepted < 16'hfff0);
  end

  always @* if (~rst & after_reset) begin
    whole_lines: assert (~arvalid | (araddr[5:0] == 6'd0 & arlen[0] & arlen[7:3] == 5'd0));
    within_a_page: assert ((~arvalid | {1'b0, araddr[11:6]} + {1'b0, arlen[7:1]} < 8'd64)
      & (~\dut.burst_open | {1'b0, first[5:0]} + more[6:0] < 7'd64));
    never_more: assert (\dut.lines_expected <= 5'd16 & {11'd0, \dut.lines_expected } == accepted - completed);
    in_order: assert (accepted == closed + lines_open + {15'd0, \dut.line_waiting }
      & closed <= accepted & accepted < 16'hfff1
      & (~(\dut.burst_open & \dut.line_waiting & \dut.line_follows )
         | (\dut.waiting_line == last + 58'd1 & \dut.waiting_line [5:0] != 6'd0))
      & (~\dut.line_waiting | \dut.next_line == \dut.waiting_line + 58'd1)
      & (~\dut.burst_open | \dut.line_waiting | \dut.next_line == last + 58'd1)
      & (chosen < closed | chosen >= closed + lines_open | address == first + within)
      & (~\dut.line_waiting | chosen != closed + lines_open | address == \dut.waiting_line ));
  end
  always @* if (held & ~rst) begin
    stable: assert (arvalid & {araddr, arlen} == was);
  end
endmodule

`default_nettype wire
