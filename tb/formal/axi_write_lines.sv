// SPDX-License-Identifier: MIT OR Apache-2.0
// A write's whole way through the shell `axi`, bounded: every line leaves once, in order, in two beats, and is
// acknowledged once, in order, with the tag that the core gave it, after memory's response to its burst, and with an
// error if that was one. With the first line of such a burst the registers get its address.
//
// The core writes when it likes. Memory takes addresses and beats when it likes, and answers whole bursts in order.
// Of a beat four bits are free, and of an address those of two successive 4 KB. The other bits are zero: they take the
// same way through the same registers and memories, and with them free the proof does not end.
`default_nettype none

module axi_write_lines (
  input wire       clk,
  input wire       rst,
  input wire       wr_valid,
  input wire [6:0] wr_address,
  input wire [7:0] wr_tag,
  input wire [7:0] wr_data,
  input wire       awready,
  input wire       wready,
  input wire       bvalid,
  input wire [1:0] bresp
);
  wire         wr_ready;
  wire         awvalid;
  wire [63:0]  awaddr;
  wire [7:0]   awlen;
  wire         wvalid;
  wire [255:0] wdata;
  wire         wlast;
  wire         rsp_valid;
  wire [7:0]   rsp_tag;
  wire         rsp_error;
  wire         burst_failed;
  wire [1:0]   failed_response;
  wire [57:0]  failed_address;
  wire         unasked;
  axi_write dut (
    .clk(clk), .rst(rst), .wr_valid(wr_valid), .wr_address({51'd0, wr_address}), .wr_tag(wr_tag),
    .wr_data({252'd0, wr_data[7:4], 252'd0, wr_data[3:0]}), .awready(awready), .wready(wready), .bvalid(bvalid),
    .bresp(bresp), .wr_ready(wr_ready), .awvalid(awvalid), .awaddr(awaddr), .awlen(awlen), .wvalid(wvalid),
    .wdata(wdata), .wlast(wlast), .rsp_valid(rsp_valid), .rsp_tag(rsp_tag), .rsp_error(rsp_error),
    .failed(burst_failed), .failed_response(failed_response), .failed_address(failed_address), .unasked(unasked),
    .idle()
  );

  // Any one line; lines that the core wrote, that are acknowledged, and whose bursts memory has answered.
  (* anyconst *) wire [4:0] chosen;
  reg [4:0]  accepted = 5'd0;
  reg [4:0]  responses = 5'd0;
  reg [4:0]  answered = 5'd0;
  // Lines in bursts whose address was taken, and beats that were taken; the lines with which bursts end.
  reg [4:0]  addressed = 5'd0;
  reg [5:0]  beats = 6'd0;
  reg [31:0] ends = 32'd0;
  reg [7:0]  line;
  reg [7:0]  tag;
  reg [6:0]  address;
  reg        failed = 1'b0;
  reg        after_reset = 1'b0;
  wire takes = awvalid & awready;
  wire [4:0] last_line = addressed + awlen[5:1];
  // The burst that a response answers ends with the first such line from `answered` on; it has at most four.
  wire [1:0] more = ends[answered] ? 2'd0 : ends[answered + 5'd1] ? 2'd1 : ends[answered + 5'd2] ? 2'd2 : 2'd3;
  wire [4:0] answers = answered + {3'd0, more} + 5'd1;
  wire is_chosen = rsp_valid & responses == chosen;
  wire begins = chosen == 5'd0 | ends[chosen - 5'd1];
  always @(posedge clk) begin
    after_reset <= 1'b1;
    if (wr_valid & wr_ready & ~rst) begin
      if (accepted == chosen) {line, tag, address} <= {wr_data, wr_tag, wr_address};
      accepted <= accepted + 5'd1;
    end
    if (takes & ~rst) begin
      addressed <= last_line + 5'd1;
      ends[last_line] <= 1'b1;
    end
    if (wvalid & wready & ~rst) beats <= beats + 6'd1;
    if (bvalid & ~rst) begin
      answered <= answers;
      if (answered <= chosen & chosen < answers) failed <= bresp[1];
    end
    if (rsp_valid & ~rst) responses <= responses + 5'd1;
  end

  always @* begin
    // One reset, at the beginning.
    assume (rst == ~after_reset);
    assume (~bvalid | (answers <= addressed & {answers, 1'b0} <= beats & answered != addressed));
  end

  always @* if (~rst & after_reset) begin
    right_beats: assert (~wvalid | beats[5:1] != chosen | wdata == {252'd0, beats[0] ? line[7:4] : line[3:0]});
    right_acknowledgement: assert (~is_chosen | (rsp_tag == tag & rsp_error == failed));
    right_failure: assert ((~burst_failed | rsp_valid) & (~is_chosen | burst_failed == (begins & failed))
      & (~is_chosen | ~burst_failed | (failed_response[1] & failed_address == {51'd0, address})));
    answered_before: assert (~rsp_valid | responses < answered);
    nothing_unasked: assert (~unasked);
  end
  // Four lines, the last of which memory could not write.
  always @* begin
    comes_back: cover (rsp_valid & responses == 5'd3 & rsp_error);
  end
endmodule

`default_nettype wire
