// SPDX-License-Identifier: MIT OR Apache-2.0
// A simulation model of Lattice's MULT18X18D as this repository uses it: unsigned, with registered factors and product,
// and one clock. Written from the primitive's description, for tests.
`default_nettype none

module MULT18X18D #(
  parameter REG_INPUTA_CLK = "NONE",
  parameter REG_INPUTB_CLK = "NONE",
  parameter REG_OUTPUT_CLK = "NONE"
) (
  input wire A0, A1, A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, A12, A13, A14, A15, A16, A17,
  input wire B0, B1, B2, B3, B4, B5, B6, B7, B8, B9, B10, B11, B12, B13, B14, B15, B16, B17,
  input wire SIGNEDA, SIGNEDB, SOURCEA, SOURCEB, RST0, RST1, RST2, RST3, CE0, CE1, CE2, CE3, CLK0, CLK1, CLK2, CLK3,
  output wire P0, P1, P2, P3, P4, P5, P6, P7, P8, P9, P10, P11, P12, P13, P14, P15, P16, P17,
  output wire P18, P19, P20, P21, P22, P23, P24, P25, P26, P27, P28, P29, P30, P31, P32, P33, P34, P35
);

  wire [17:0] a = {A17, A16, A15, A14, A13, A12, A11, A10, A9, A8, A7, A6, A5, A4, A3, A2, A1, A0};
  wire [17:0] b = {B17, B16, B15, B14, B13, B12, B11, B10, B9, B8, B7, B6, B5, B4, B3, B2, B1, B0};
  reg [17:0] a_register, b_register;
  reg [35:0] product_register;

  wire [17:0] a_used = (REG_INPUTA_CLK == "CLK0") ? a_register : a;
  wire [17:0] b_used = (REG_INPUTB_CLK == "CLK0") ? b_register : b;
  wire [35:0] product = {18'd0, a_used} * {18'd0, b_used};

  always @(posedge CLK0) begin
    if (RST0) begin
      a_register <= 18'd0;
      b_register <= 18'd0;
      product_register <= 36'd0;
    end else if (CE0) begin
      a_register <= a;
      b_register <= b;
      product_register <= product;
    end
  end

  assign {P35, P34, P33, P32, P31, P30, P29, P28, P27, P26, P25, P24, P23, P22, P21, P20, P19, P18,
          P17, P16, P15, P14, P13, P12, P11, P10, P9, P8, P7, P6, P5, P4, P3, P2, P1, P0}
    = (REG_OUTPUT_CLK == "CLK0") ? product_register : product;

  // This model supports neither signed operands nor cascades, nor a second clock.
  wire unused = &{1'b0, SIGNEDA, SIGNEDB, SOURCEA, SOURCEB, RST1, RST2, RST3, CE1, CE2, CE3, CLK1, CLK2, CLK3};

endmodule

`default_nettype wire
