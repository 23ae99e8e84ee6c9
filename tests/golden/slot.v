// SPDX-License-Identifier: MIT OR Apache-2.0
// slot
// adds its own number to the value where it is chosen, else passes on
`default_nettype none

module slot (
  input  wire       clk,
  input  wire [6:0] index,
  input  wire [6:0] chosen,
  input  wire [6:0] value,
  input  wire [6:0] result_in,
  output reg  [6:0] result_out
);

  // ---- logic ----
  wire [6:0] sum = index + value;

  // ---- at the clock edge ----
  always @(posedge clk) begin
    result_out <= (index == chosen) ? sum : result_in;
  end

endmodule

`default_nettype wire
