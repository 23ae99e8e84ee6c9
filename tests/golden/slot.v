// SPDX-License-Identifier: MIT OR Apache-2.0
// slot
// adds its own number to the value where it is chosen
`default_nettype none

module slot (
  input  wire       clk,
  input  wire [6:0] index,
  input  wire [6:0] chosen,
  input  wire [6:0] value,
  output reg  [6:0] result
);

  // ---- logic ----
  wire [6:0] sum = index + value;

  // ---- at the clock edge ----
  always @(posedge clk) begin
    result <= (index == chosen) ? sum : 7'd0;
  end

endmodule

`default_nettype wire
