// SPDX-License-Identifier: MIT OR Apache-2.0
// A simulation model of Lattice's CCU2C as this repository uses it: two bits of a carry chain, each behind a four-input
// look-up table. Written from the primitive's description, for tests.
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

  // The whole table decides whether the carry is propagated. If it is not, the lowest four entries, indexed by A and B,
  // give the carry.
  wire passes_0 = INIT0[{D0, C0, B0, A0}];
  wire passes_1 = INIT1[{D1, C1, B1, A1}];
  wire carry_0 = passes_0 ? CIN : INIT0[{2'b00, B0, A0}];
  assign S0 = passes_0 ^ CIN;
  assign S1 = passes_1 ^ carry_0;
  assign COUT = passes_1 ? carry_0 : INIT1[{2'b00, B1, A1}];

  // This model supports only chains whose carry passes from cell to cell.
  initial begin
    if (INJECT1_0 != "NO" || INJECT1_1 != "NO") $fatal(1, "CCU2C: a carry that is injected");
  end

endmodule

`default_nettype wire
