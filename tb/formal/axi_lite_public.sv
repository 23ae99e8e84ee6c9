// SPDX-License-Identifier: MIT OR Apache-2.0
// The AXI4-Lite slave of the shell `axi` under a property set that others wrote: `faxil_slave` of ZipCPU's wb2axip, whose
// file the user gives (docs/verification.md). It assumes a host that keeps the rules, and asserts those of the slave: no
// valid after a reset, responses stable until taken, none unasked, no error, and each within 12 cycles.
//
// What is asserted here makes that inductive: its counts are those of the slave. Faults are found without it.
`default_nettype none

module axi_lite_public (
  input wire clk,
  input wire rst
`include "inputs.svh"
);
`include "dut.svh"

  wire [1:0] reads;
  wire [1:0] data;
  wire [1:0] addresses;
  faxil_slave #(
    .C_AXI_DATA_WIDTH(32),
    .C_AXI_ADDR_WIDTH(12),
    .F_OPT_BRESP(1'b0),
    .F_OPT_RRESP(1'b0),
    .F_LGDEPTH(2),
    .F_AXI_MAXWAIT(12),
    .F_AXI_MAXDELAY(12),
    // Nothing is known before the reset, and a host may be as slow as it likes.
    .F_OPT_INITIAL(1'b0),
    .F_AXI_MAXRSTALL(0)
  ) properties (
    .i_clk(clk),
    .i_axi_reset_n(~rst),
    .i_axi_awvalid(s_axi_control_awvalid),
    .i_axi_awready(s_axi_control_awready),
    .i_axi_awaddr(s_axi_control_awaddr),
    .i_axi_awprot(3'd0),
    .i_axi_wvalid(s_axi_control_wvalid),
    .i_axi_wready(s_axi_control_wready),
    .i_axi_wdata(s_axi_control_wdata),
    .i_axi_wstrb(s_axi_control_wstrb),
    .i_axi_bvalid(s_axi_control_bvalid),
    .i_axi_bready(s_axi_control_bready),
    .i_axi_bresp(s_axi_control_bresp),
    .i_axi_arvalid(s_axi_control_arvalid),
    .i_axi_arready(s_axi_control_arready),
    .i_axi_araddr(s_axi_control_araddr),
    .i_axi_arprot(3'd0),
    .i_axi_rvalid(s_axi_control_rvalid),
    .i_axi_rready(s_axi_control_rready),
    .i_axi_rdata(s_axi_control_rdata),
    .i_axi_rresp(s_axi_control_rresp),
    .f_axi_rd_outstanding(reads),
    .f_axi_wr_outstanding(data),
    .f_axi_awr_outstanding(addresses)
  );

`ifndef ONLY_PUBLIC
  (* hierconn *) wire \dut.write_address_held ;
  (* hierconn *) wire \dut.write_data_held ;
  (* hierconn *) wire \dut.read_busy ;
  (* hierconn *) wire \dut.register_read ;
  reg after_reset = 1'b0;
  always @(posedge clk) after_reset <= after_reset | rst;
  always @* assume (after_reset | rst);
  always @* if (~rst & after_reset) begin
    one_response: assert (addresses == {1'b0, \dut.write_address_held } + {1'b0, s_axi_control_bvalid}
      & data == {1'b0, \dut.write_data_held } + {1'b0, s_axi_control_bvalid});
    data_once: assert (reads == {1'b0, \dut.read_busy }
      & reads == {1'b0, \dut.register_read } + {1'b0, s_axi_control_rvalid});
  end
`endif
endmodule

`default_nettype wire
