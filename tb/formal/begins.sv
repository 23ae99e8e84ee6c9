// SPDX-License-Identifier: MIT OR Apache-2.0
// What the search assumes of the control: a job begins later than a cycle after the last one or a reset, all parts at
// the same time, and its sets stay as they are while it runs. By induction, for any host and link.
`default_nettype none

module begins (
  `include "inputs.svh"
);
  `include "dut.svh"
  (* hierconn *) wire \dut.busy_copy_1 ;
  (* hierconn *) wire \dut.begin_job ;
  (* hierconn *) wire \dut.running ;
  (* hierconn *) wire \dut.draining ;
  (* hierconn *) wire \dut.waits_to_begin ;
  (* hierconn *) wire \dut.completes ;

  reg ran = 1'b1;
  reg sets = 1'b0;
  reg after_reset = 1'b0;
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    ran <= rst | run;
    sets <= begin_loader ? has_others : sets;
  end
  always @* assume (after_reset | rst);

  always @* if (after_reset & ~rst) begin
    not_while_another_runs: assert (!(begin_loader & (run | ran)));
    together: assert ({begin_collector, begin_deciders, begin_hits, begin_packer, begin_dispatcher} == {5{begin_loader}});
    begins_as_one: assert (\dut.begin_job == begin_loader);
    busy_as_one: assert (\dut.busy_copy_1 == busy);
    runs_while_busy: assert (busy | !(run | begin_loader | \dut.running | \dut.draining | \dut.waits_to_begin ));
    runs_or_drains: assert (!\dut.draining | !\dut.running );
    waits_before: assert (!\dut.waits_to_begin | (\dut.running & !run & !begin_loader));
    completes_at_the_end: assert (!\dut.completes | run);
    runs_to_its_end: assert (!run | \dut.running );
    sets_stay: assert (!run | has_others == sets);
  end
endmodule

`default_nettype wire
