// SPDX-License-Identifier: MIT OR Apache-2.0
// What Lattice's CCU2C does as this repository uses it: two bits of a carry chain, each behind a look-up table of four
// inputs. For simulation in the primitive's place; written from its description, for tests.
`default_nettype none

module CCU2C #(
  parameter [15:0] INIT0 = 16'h0000,
  parameter [15:0] INIT1 = 16'h0000,
  parameter INJECT1_0 = "YES",
  parameter INJECT1_1 = "YES"
) (
  input wire CIN, A0, B0, C0, D0, A1, B1, C1, D1,
  output wire S0, S1, COUT
);

  // The whole table says whether the carry is passed on; its lowest four words, by A and B, what it is where it is not.
  wire passes_0 = INIT0[{D0, C0, B0, A0}];
  wire passes_1 = INIT1[{D1, C1, B1, A1}];
  wire carry_0 = passes_0 ? CIN : INIT0[{2'b00, B0, A0}];
  assign S0 = passes_0 ^ CIN;
  assign S1 = passes_1 ^ carry_0;
  assign COUT = passes_1 ? carry_0 : INIT1[{2'b00, B1, A1}];

  // Only chains whose carry goes from cell to cell are made of it here.
  initial begin
    if (INJECT1_0 != "NO" || INJECT1_1 != "NO") $fatal(1, "CCU2C: a carry that is injected");
  end

endmodule

`default_nettype wire
