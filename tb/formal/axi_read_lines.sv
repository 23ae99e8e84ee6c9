// SPDX-License-Identifier: MIT OR Apache-2.0
// A read's whole way through the shell `axi`, bounded: every line comes back once, in order, with the tag that the core
// gave it and the two beats that memory gave for it. If memory refused either, the line comes with an error, and the
// registers get its address.
//
// The core asks when it likes. Memory takes addresses and gives beats when it likes, but none that nobody asked for.
// Of a beat four bits are free, and of an address those of two successive 4 KB. The other bits are zero: they take the
// same way through the same registers and memories, and with them free the proof does not end.
`default_nettype none

module axi_read_lines (
  input wire         clk,
  input wire         rst,
  input wire         rd_valid,
  input wire [6:0]   rd_address,
  input wire [7:0]   rd_tag,
  input wire         arready,
  input wire [3:0]   rdata,
  input wire [1:0]   rresp,
  input wire         rvalid
);
  wire         rd_ready;
  wire         arvalid;
  wire [63:0]  araddr;
  wire [7:0]   arlen;
  wire         rsp_valid;
  wire [7:0]   rsp_tag;
  wire [511:0] rsp_data;
  wire         rsp_error;
  wire         line_failed;
  wire [1:0]   failed_response;
  wire [57:0]  failed_address;
  wire         unasked;
  wire         rlast;
  axi_read dut (
    .clk(clk), .rst(rst), .rd_valid(rd_valid), .rd_address({51'd0, rd_address}), .rd_tag(rd_tag), .arready(arready),
    .rvalid(rvalid), .rdata({252'd0, rdata}), .rresp(rresp), .rlast(rlast), .rd_ready(rd_ready), .arvalid(arvalid),
    .araddr(araddr), .arlen(arlen), .rsp_valid(rsp_valid), .rsp_tag(rsp_tag), .rsp_data(rsp_data),
    .rsp_error(rsp_error), .failed(line_failed), .failed_response(failed_response), .failed_address(failed_address),
    .unasked(unasked), .idle()
  );

  // Any one line; lines that were asked for and came back; beats that memory was asked for, and gave.
  (* anyconst *) wire [4:0] chosen;
  reg [4:0]   accepted = 5'd0;
  reg [4:0]   responses = 5'd0;
  reg [5:0]   asked = 6'd0;
  reg [5:0]   given = 6'd0;
  // The beats, counted from 0, with which bursts end.
  reg [63:0]  ends = 64'd0;
  reg [7:0]   tag;
  reg [6:0]   address;
  reg [3:0]   low;
  reg [3:0]   high;
  reg         failed = 1'b0;
  reg         after_reset = 1'b0;
  assign rlast = ends[given];
  wire takes = arvalid & arready;
  wire [5:0] last_beat = asked + arlen[5:0];
  wire is_chosen = rsp_valid & responses == chosen;
  always @(posedge clk) begin
    after_reset <= 1'b1;
    if (rd_valid & rd_ready & ~rst) begin
      if (accepted == chosen) {tag, address} <= {rd_tag, rd_address};
      accepted <= accepted + 5'd1;
    end
    if (takes & ~rst) begin
      asked <= last_beat + 6'd1;
      ends[last_beat] <= 1'b1;
    end
    if (rvalid & ~rst) begin
      if (given == {chosen, 1'b0}) low <= rdata;
      if (given == {chosen, 1'b1}) high <= rdata;
      if (given[5:1] == chosen) failed <= failed | rresp[1];
      given <= given + 6'd1;
    end
    if (rsp_valid & ~rst) responses <= responses + 5'd1;
  end

  always @* begin
    // One reset, at the beginning.
    assume (rst == ~after_reset);
    assume (~rvalid | given != asked);
  end

  always @* if (~rst & after_reset) begin
    right_line: assert (~is_chosen | (rsp_tag == tag & rsp_data == {252'd0, high, 252'd0, low} & rsp_error == failed));
    right_failure: assert ((~line_failed | rsp_valid) & (~is_chosen | line_failed == failed)
      & (~is_chosen | ~line_failed | (failed_response[1] & failed_address == {51'd0, address})));
    after_its_beats: assert (~rsp_valid | {responses, 1'b1} < given);
    nothing_unasked: assert (~unasked);
  end
  // Two bursts of two lines, the second of which memory refuses.
  always @* begin
    comes_back: cover (rsp_valid & responses == 5'd3 & rsp_error);
  end
endmodule

`default_nettype wire
