// SPDX-License-Identifier: MIT OR Apache-2.0
// board
`default_nettype none

module board (
  input  wire       clk,
  input  wire       reset_n,
  input  wire       soft_reset,
  output wire [3:0] value
);

  // Resets all that is below.
  wire rst;

  // ---- state ----
  reg in_reset;

  // ---- at the clock edge ----
  always @(posedge clk) begin
    in_reset <= ~reset_n | soft_reset;
  end

  counter unit (
    .clk   (clk),
    .rst   (rst),
    .value (value)
  );

  assign rst = in_reset;

endmodule

`default_nettype wire
