// SPDX-License-Identifier: MIT OR Apache-2.0
// A test bench for contact_afu that needs no Rust: any Verilog-2005 simulator will do.
//
//   iverilog -g2005 -o bench -s contact_afu_tb tb/contact_afu_tb.v rtl/*.v
//   vvp bench +source=source.hex +destination=destination.hex +count=1000 +seed=1
//
// source.hex holds the source lines, 128 hexadecimal digits each, word 0 rightmost; the destination lines are written
// the same way. The link answers in order, after LATENCY cycles, and refuses requests at random.
`timescale 1ns / 1ps
`default_nettype none

module contact_afu_tb;
  parameter [31:0] SCPUS = 32'd10;
  parameter integer LINES = 4096;
  parameter integer LATENCY = 7;
  localparam [57:0] SOURCE = 58'h1000;
  localparam [57:0] DESTINATION = 58'h200000;

  reg clk = 1'b0;
  always #5 clk = ~clk;

  reg rst = 1'b1;
  reg start = 1'b0;
  reg [31:0] count;
  integer seed;
  integer file;
  integer line;
  integer cycles;
  reg [8*256-1:0] source_name;
  reg [8*256-1:0] destination_name;
  reg [511:0] source_lines [0:LINES-1];
  reg [511:0] destination_lines [0:LINES-1];
  integer written;

  reg rd_req_ready;
  wire rd_req_valid;
  wire [57:0] rd_req_address;
  wire [9:0] rd_req_tag;
  wire rd_rsp_valid;
  wire [9:0] rd_rsp_tag;
  wire [511:0] rd_rsp_data;
  reg wr_req_ready;
  wire wr_req_valid;
  wire [57:0] wr_req_address;
  wire [9:0] wr_req_tag;
  wire [511:0] wr_req_data;
  wire wr_rsp_valid;
  wire [9:0] wr_rsp_tag;
  wire busy;
  wire done;
  wire [3:0] error;
  wire [31:0] contacts;
  wire [31:0] invalid;
  wire [31:0] first_invalid;
  wire [63:0] cycles_busy;
  wire [63:0] cycles_input;
  wire [63:0] cycles_output;
  wire [63:0] capability;

  contact_afu #(
    .SCPUS(SCPUS)
  ) afu (
    .clk            (clk),
    .rst            (rst),
    .start          (start),
    .source         (SOURCE),
    .destination    (DESTINATION),
    .count          (count),
    .mode           (4'd0),
    .epoch          (4'd1),
    .watchdog       (32'd10000),
    .abort_job      (1'b0),
    .rd_req_ready   (rd_req_ready),
    .rd_rsp_valid   (rd_rsp_valid),
    .rd_rsp_tag     (rd_rsp_tag),
    .rd_rsp_data    (rd_rsp_data),
    .rd_rsp_error   (1'b0),
    .wr_req_ready   (wr_req_ready),
    .wr_rsp_valid   (wr_rsp_valid),
    .wr_rsp_tag     (wr_rsp_tag),
    .wr_rsp_error   (1'b0),
    .busy           (busy),
    .done           (done),
    .error          (error),
    .contacts       (contacts),
    .invalid        (invalid),
    .first_invalid  (first_invalid),
    .cycles_busy    (cycles_busy),
    .cycles_input   (cycles_input),
    .cycles_output  (cycles_output),
    .capability     (capability),
    .rd_req_valid   (rd_req_valid),
    .rd_req_address (rd_req_address),
    .rd_req_tag     (rd_req_tag),
    .wr_req_valid   (wr_req_valid),
    .wr_req_address (wr_req_address),
    .wr_req_tag     (wr_req_tag),
    .wr_req_data    (wr_req_data)
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
      destination_lines[wr_req_address - DESTINATION] <= wr_req_data;
      written <= written + 1;
    end
    rd_req_ready <= ($random(seed) & 3) != 0;
    wr_req_ready <= ($random(seed) & 3) != 0;
    cycles <= cycles + 1;
  end

  initial begin
    if (!$value$plusargs("source=%s", source_name)) source_name = "source.hex";
    if (!$value$plusargs("destination=%s", destination_name)) destination_name = "destination.hex";
    if (!$value$plusargs("count=%d", count)) count = 32'd0;
    if (!$value$plusargs("seed=%d", seed)) seed = 1;
    rd_req_ready = 1'b0;
    wr_req_ready = 1'b0;
    written = 0;
    cycles = 0;
    if (count != 32'd0) $readmemh(source_name, source_lines, 0, (count + 1) / 2 - 1);
    repeat (4) @(posedge clk);
    rst <= 1'b0;
    repeat (2) @(posedge clk);
    start <= 1'b1;
    @(posedge clk);
    start <= 1'b0;
    @(posedge clk);
    while (done !== 1'b1 && cycles < 1000000) @(posedge clk);
    file = $fopen(destination_name, "w");
    for (line = 0; line < written; line = line + 1) $fwrite(file, "%h\n", destination_lines[line]);
    $fclose(file);
    $display("done %b error %0d contacts %0d invalid %0d written %0d cycles %0d", done, error, contacts, invalid, written,
             cycles_busy);
    $finish;
  end
endmodule

`default_nettype wire
