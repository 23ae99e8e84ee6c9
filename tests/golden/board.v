// SPDX-License-Identifier: MIT OR Apache-2.0
// board
`default_nettype none

module board (
  input  wire       clk,
  input  wire       reset_n,
  input  wire       soft_reset,
  output wire [3:0] value,
  output wire [3:0] own_value
);

  // Resets this module; each instance has a register of its own.
  wire rst;

  // ---- state ----
  (* keep = "true", dont_merge *) reg in_reset_unit;
  reg [3:0] own;
  (* keep = "true", dont_merge *) reg in_reset;

  // ---- logic ----
  wire in_reset_next = ~reset_n | soft_reset;

  // ---- at the clock edge ----
  always @(posedge clk) begin
    if (rst) begin
      own <= 4'd9;
    end else begin
      own <= own + 4'd1;
    end
  end
  (* keep = "true" *) always @(posedge clk) begin
    in_reset_unit <= in_reset_next;
    in_reset <= in_reset_next;
  end

  counter unit (
    .clk   (clk),
    .rst   (in_reset_unit),
    .value (value)
  );

  assign rst = in_reset;
  assign own_value = own;

endmodule

`default_nettype wire
