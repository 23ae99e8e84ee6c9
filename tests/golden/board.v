// SPDX-License-Identifier: MIT OR Apache-2.0
// board
`default_nettype none

module board (
  input  wire       clk,
  input  wire       reset_n,
  input  wire       soft_reset,
  output wire [3:0] value
);

  // ---- state ----
  (* keep = "true", dont_merge *) reg in_reset_unit;

  // ---- at the clock edge ----
  (* keep = "true" *) always @(posedge clk) begin
    in_reset_unit <= ~reset_n | soft_reset;
  end

  counter unit (
    .clk   (clk),
    .rst   (in_reset_unit),
    .value (value)
  );

endmodule

`default_nettype wire
