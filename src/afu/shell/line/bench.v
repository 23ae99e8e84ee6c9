// SPDX-License-Identifier: MIT OR Apache-2.0
// @BENCH@
// a self-checking test bench of @TOP@, for any Verilog-2005 simulator. From the folder above:
//
//   iverilog -g2005 -o bench -s @BENCH@ -y . sim/@BENCH@.v
//   vvp -n bench
//
// It sends @COUNT@ pairs through the AFU, compares every line written with the reference kernel's, and ends with a line that
// begins with PASS or FAIL. The memory answers in order, after LATENCY cycles, and refuses requests at random.
//
@FILES@

module @BENCH@;
@SIZES@
  localparam [57:0] SOURCE = 58'h1000;
  localparam [57:0] DESTINATION = 58'h200000;

@STATE@

  reg rst = 1'b1;
  reg start = 1'b0;

  reg rd_req_ready;
  wire rd_rsp_valid;
  wire [9:0] rd_rsp_tag;
  wire [511:0] rd_rsp_data;
  reg wr_req_ready;
  wire wr_rsp_valid;
  wire [9:0] wr_rsp_tag;
@OUTPUTS@

  @TOP@ #(
    .SCPUS(SCPUS)
  ) afu (
@PORTS@
  );

  // Requests that were taken travel through a pipe of LATENCY cycles and come back as responses.
  reg [LATENCY-1:0] rd_pipe_valid = 0;
  reg [LATENCY-1:0] wr_pipe_valid = 0;
  reg [9:0] rd_pipe_tag [0:LATENCY-1];
  reg [9:0] wr_pipe_tag [0:LATENCY-1];
  reg [511:0] rd_pipe_data [0:LATENCY-1];
  integer stage;
  assign rd_rsp_valid = rd_pipe_valid[LATENCY-1];
  assign rd_rsp_tag = rd_pipe_tag[LATENCY-1];
  assign rd_rsp_data = rd_pipe_data[LATENCY-1];
  assign wr_rsp_valid = wr_pipe_valid[LATENCY-1];
  assign wr_rsp_tag = wr_pipe_tag[LATENCY-1];

  always @(posedge clk) begin
    rd_pipe_valid <= {rd_pipe_valid[LATENCY-2:0], rd_req_valid & rd_req_ready};
    wr_pipe_valid <= {wr_pipe_valid[LATENCY-2:0], wr_req_valid & wr_req_ready};
    for (stage = 1; stage < LATENCY; stage = stage + 1) begin
      rd_pipe_tag[stage] <= rd_pipe_tag[stage-1];
      wr_pipe_tag[stage] <= wr_pipe_tag[stage-1];
      rd_pipe_data[stage] <= rd_pipe_data[stage-1];
    end
    rd_pipe_tag[0] <= rd_req_tag;
    wr_pipe_tag[0] <= wr_req_tag;
    rd_pipe_data[0] <= source_lines[rd_req_address - SOURCE];
    if (wr_req_valid & wr_req_ready) begin
      if (wr_req_address - DESTINATION >= LINES) fault("a write elsewhere");
      destination_lines[wr_req_address - DESTINATION] <= wr_req_data;
      written <= written + 1;
    end
    rd_req_ready <= ($random(seed) & 3) != 0;
    wr_req_ready <= ($random(seed) & 3) != 0;
    cycles <= cycles + 1;
  end

@VERDICT@

  initial begin
@ARGUMENTS@
    rd_req_ready = 1'b0;
    wr_req_ready = 1'b0;
    if (!is_own && count != 32'd0) $readmemh(source_name, source_lines, 0, (count - 1) / @PER_LINE@);
    repeat (4) @(posedge clk);
    rst <= 1'b0;
    repeat (2) @(posedge clk);
    start <= 1'b1;
    @(posedge clk);
    start <= 1'b0;
    @(posedge clk);
    while (done !== 1'b1 && cycles < 1000000) @(posedge clk);
@WRITE@
    $display("done %b error %0d contacts %0d invalid %0d written %0d cycles %0d", done, error, contacts, invalid, written,
             cycles_busy);
    if (is_own) begin
      if (done !== 1'b1) fault("the job did not end");
      if (error !== 4'd0) fault("the job ended with an error");
      if (contacts !== 32'd@CONTACTS@) fault("another number of contacts");
      if (invalid !== 32'd@INVALID@) fault("another number of invalid pairs");
      if (first_invalid !== 32'd@FIRST_INVALID@) fault("another first invalid pair");
      if (written != EXPECTED_LINES) fault("another number of lines");
      check_lines;
      verdict;
    end
    $finish;
  end
endmodule

`default_nettype wire
