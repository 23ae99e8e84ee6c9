// SPDX-License-Identifier: MIT OR Apache-2.0
// top
// a counter, a delay line, a memory and a chain
//
// contact-afu test
`default_nettype none

module top #(
  parameter [31:0] SCPUS = 32'd10 // 1 to 64
) (
  input  wire        clk,
  input  wire        rst,
  input  wire        enable,
  input  wire [11:0] data,
  output reg  [11:0] stored,
  output reg  [11:0] late,
  output reg  [11:0] later,
  output wire [6:0]  result,
  output wire        last
);

  // Elaboration fails here if SCPUS is out of range.
  generate
    if ((SCPUS < 32'd1) || (SCPUS > 32'd64)) begin : SCPUS_out_of_range
      SCPUS_must_be_1_to_64 failed ();
    end
  endgenerate

  // SCPUS up to 4, and the whole 4s of it above that.
  localparam [31:0] SCPUS_IN_FOURS = (SCPUS > 32'd4) ? (SCPUS / 32'd4) * 32'd4 : SCPUS;

  // Places of the newest and of the oldest word in the delay lines of 6 cycles.
  reg [2:0] newest_of_6;
  initial newest_of_6 = 3'd0;
  reg [2:0] oldest_of_6;
  initial oldest_of_6 = 3'd1;
  always @(posedge clk) begin
    newest_of_6 <= oldest_of_6;
    oldest_of_6 <= (oldest_of_6 == 3'd5) ? 3'd0 : (oldest_of_6 + 3'd1);
  end

  // Places of the newest and of the oldest word in the delay lines of 9 cycles.
  reg [3:0] newest_of_9;
  initial newest_of_9 = 4'd0;
  reg [3:0] oldest_of_9;
  initial oldest_of_9 = 4'd1;
  always @(posedge clk) begin
    newest_of_9 <= oldest_of_9;
    oldest_of_9 <= (oldest_of_9 == 4'd8) ? 4'd0 : (oldest_of_9 + 4'd1);
  end

  // Places of the newest and of the oldest word in the delay lines of 16 cycles.
  reg [3:0] newest_of_16;
  initial newest_of_16 = 4'd0;
  reg [3:0] oldest_of_16;
  initial oldest_of_16 = 4'd1;
  always @(posedge clk) begin
    newest_of_16 <= oldest_of_16;
    oldest_of_16 <= oldest_of_16 + 4'd1;
  end

  // ---- memories ----
  (* ram_style = "distributed", ramstyle = "MLAB, no_rw_check" *)
  reg [11:0] store [0:11];

  // ---- state ----
  reg [3:0] position;
  (* ram_style = "distributed", ramstyle = "MLAB, no_rw_check" *)
  reg [11:0] late_line [0:8];
  (* ram_style = "distributed", ramstyle = "MLAB, no_rw_check" *)
  reg [11:0] later_line [0:5];
  (* ram_style = "distributed", ramstyle = "MLAB, no_rw_check" *)
  reg [11:0] data_d73_line [0:15];
  reg [11:0] data_d73;
  (* ram_style = "distributed", ramstyle = "MLAB, no_rw_check" *)
  reg [11:0] data_d57_line [0:15];
  reg [11:0] data_d57;
  (* ram_style = "distributed", ramstyle = "MLAB, no_rw_check" *)
  reg [11:0] data_d41_line [0:15];
  reg [11:0] data_d41;
  (* ram_style = "distributed", ramstyle = "MLAB, no_rw_check" *)
  reg [11:0] data_d25_line [0:15];
  reg [11:0] data_d25;

  // ---- outputs of instances ----
  wire [(SCPUS_IN_FOURS+1)*7-1:0] slots_result_chain;

  // ---- logic ----
  wire wrapped = position == 4'd11;
  assign last = SCPUS[6:0] == data[6:0];

  // ---- at the clock edge ----
  always @(posedge clk) begin
    stored <= store[position];
    late_line[newest_of_9] <= data;
    late <= late_line[oldest_of_9];
    later_line[newest_of_6] <= data_d73;
    later <= later_line[oldest_of_6];
    data_d73_line[newest_of_16] <= data_d57;
    data_d73 <= data_d73_line[oldest_of_16];
    data_d57_line[newest_of_16] <= data_d41;
    data_d57 <= data_d57_line[oldest_of_16];
    data_d41_line[newest_of_16] <= data_d25;
    data_d41 <= data_d41_line[oldest_of_16];
    data_d25_line[newest_of_16] <= late;
    data_d25 <= data_d25_line[oldest_of_16];
    if (enable) store[position] <= data;
  end
  always @(posedge clk) begin
    if (rst) begin
      position <= 4'd0;
    end else begin
      if (enable) position <= wrapped ? 4'd0 : (position + 4'd1);
    end
  end

  // A chain of SCPUS_IN_FOURS copies of slot: each passes on what it gets, a register a copy.
  assign slots_result_chain[6:0] = 7'd0;
  assign result = slots_result_chain[SCPUS_IN_FOURS*7 +: 7];
  genvar slots_number;
  generate
    for (slots_number = 0; slots_number < SCPUS_IN_FOURS; slots_number = slots_number + 1) begin : slots
      localparam [31:0] NUMBER = slots_number;
      slot unit (
        .clk        (clk),
        .index      (NUMBER[6:0]),
        .chosen     (data[6:0]),
        .value      (data[11:5]),
        .result_in  (slots_result_chain[slots_number*7 +: 7]),
        .result_out (slots_result_chain[(slots_number+1)*7 +: 7])
      );
    end
  endgenerate

endmodule

`default_nettype wire
