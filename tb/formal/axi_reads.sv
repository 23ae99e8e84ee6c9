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
  wire        accepts = rd_valid & rd_ready;
  wire [57:0] asked = rd_address;
`include "bursts.svh"
  (* hierconn *) wire [4:0]  \dut.lines_expected ;
  (* hierconn *) wire        \dut.any_lines_expected ;
  (* hierconn *) wire        \dut.complete ;

  reg [15:0] completed = 16'd0;
  reg        held = 1'b0;
  reg [71:0] was;
  always @(posedge clk) begin
    completed <= rst ? 16'd0 : completed + {15'd0, \dut.complete };
    held <= arvalid & ~arready & ~rst;
    was <= {araddr, arlen};
  end

  always @* if (~rst & after_reset) begin
    whole_lines: assert (~arvalid | (araddr[5:0] == 6'd0 & arlen[0] & arlen[7:3] == 5'd0));
    within_a_page: assert ((~arvalid | {1'b0, araddr[11:6]} + {1'b0, arlen[7:1]} < 8'd64) & open_within_a_page);
    never_more: assert (\dut.lines_expected <= 5'd16 & {11'd0, \dut.lines_expected } == accepted - completed
      & \dut.any_lines_expected == (accepted != completed) & ~(\dut.line_ready & \dut.lines_expected [4]));
    in_order: assert (lines_in_order & ~(\dut.burst_closes & arvalid));
  end
  always @* if (held & ~rst) begin
    stable: assert (arvalid & {araddr, arlen} == was);
  end
endmodule

`default_nettype wire
