// SPDX-License-Identifier: MIT OR Apache-2.0
// The AXI4-Lite slave of the shell `axi`, by induction: responses are stable until they are taken, every write has one
// response and every read its data once, and no response comes that nobody waits for.
//
// The host may do whatever AXI4-Lite allows, in any order, with any patience.
`default_nettype none

module axi_lite (
  input wire clk,
  input wire rst
`include "inputs.svh"
);
`include "dut.svh"

  // Addresses and data of writes, and addresses of reads, that were taken and not answered.
  reg [1:0]  addresses = 2'd0;
  reg [1:0]  data = 2'd0;
  reg [1:0]  reads = 2'd0;
  reg        after_reset = 1'b0;
  reg        b_held = 1'b0;
  reg        r_held = 1'b0;
  reg [33:0] r_was;
  wire takes_address = s_axi_control_awvalid & s_axi_control_awready;
  wire takes_data = s_axi_control_wvalid & s_axi_control_wready;
  wire takes_read = s_axi_control_arvalid & s_axi_control_arready;
  wire answers = s_axi_control_bvalid & s_axi_control_bready;
  wire reads_out = s_axi_control_rvalid & s_axi_control_rready;
  (* hierconn *) wire \dut.write_address_held ;
  (* hierconn *) wire \dut.write_data_held ;
  (* hierconn *) wire \dut.read_busy ;
  (* hierconn *) wire \dut.register_read ;
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    addresses <= rst ? 2'd0 : addresses + {1'b0, takes_address} - {1'b0, answers};
    data <= rst ? 2'd0 : data + {1'b0, takes_data} - {1'b0, answers};
    reads <= rst ? 2'd0 : reads + {1'b0, takes_read} - {1'b0, reads_out};
    b_held <= s_axi_control_bvalid & ~s_axi_control_bready & ~rst;
    r_held <= s_axi_control_rvalid & ~s_axi_control_rready & ~rst;
    r_was <= {s_axi_control_rdata, s_axi_control_rresp};
  end

  always @* assume (after_reset | rst);

  always @* if (~rst & after_reset) begin
    one_response: assert (addresses == {1'b0, \dut.write_address_held } + {1'b0, s_axi_control_bvalid}
      & data == {1'b0, \dut.write_data_held } + {1'b0, s_axi_control_bvalid});
    data_once: assert (reads == {1'b0, \dut.read_busy }
      & reads == {1'b0, \dut.register_read } + {1'b0, s_axi_control_rvalid});
    is_okay: assert (s_axi_control_bresp == 2'd0 & s_axi_control_rresp == 2'd0);
  end
  always @* if (b_held & ~rst) begin
    response_is_stable: assert (s_axi_control_bvalid);
  end
  always @* if (r_held & ~rst) begin
    data_are_stable: assert (s_axi_control_rvalid & {s_axi_control_rdata, s_axi_control_rresp} == r_was);
  end
endmodule

`default_nettype wire
