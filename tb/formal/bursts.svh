// SPDX-License-Identifier: MIT OR Apache-2.0
// The bursts of one direction of the shell `axi`, the same for reads and writes. The harness declares `accepts`: the
// core's line `asked` is taken in this cycle.
  (* hierconn *) wire        \dut.burst_closes ;
  (* hierconn *) wire        \dut.burst_open ;
  (* hierconn *) wire        \dut.burst_full ;
  (* hierconn *) wire [57:0] \dut.burst_first ;
  (* hierconn *) wire [1:0]  \dut.burst_more ;
  (* hierconn *) wire        \dut.line_waiting ;
  (* hierconn *) wire        \dut.second_waiting ;
  (* hierconn *) wire        \dut.line_ready ;
  (* hierconn *) wire [58:0] \dut.waiting_line ;
  (* hierconn *) wire [58:0] \dut.second_line ;
  (* hierconn *) wire [57:0] \dut.next_line ;

  // The number of any one line, and its address; lines that the core asked for, and those whose bursts were closed.
  (* anyconst *) wire [15:0] chosen;
  reg [57:0] address;
  reg [15:0] accepted = 16'd0;
  reg [15:0] closed = 16'd0;
  reg        after_reset = 1'b0;
  wire [57:0] first = \dut.burst_first ;
  wire [15:0] more = {14'd0, \dut.burst_more };
  wire [57:0] last = first + {42'd0, more};
  wire [15:0] lines_open = \dut.burst_open ? more + 16'd1 : 16'd0;
  wire [57:0] within = {42'd0, chosen - closed};
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    if (accepts & accepted == chosen) address <= asked;
    accepted <= rst ? 16'd0 : accepted + {15'd0, accepts};
    closed <= rst ? 16'd0 : closed + (\dut.burst_closes ? lines_open : 16'd0);
  end

  always @* begin
    assume (after_reset | rst);
    // No more lines than this number can count.
    assume (accepted < 16'hfff0);
  end

  // The two lines that may wait, each with whether it follows the line before it.
  wire [57:0] oldest = \dut.waiting_line [58:1];
  wire [57:0] second = \dut.second_line [58:1];
  wire        is_oldest = \dut.line_waiting & chosen == closed + lines_open;
  wire        is_second = \dut.second_waiting & chosen == closed + lines_open + 16'd1;
  wire        after_oldest = ~\dut.second_waiting & \dut.line_waiting ;
  // Every line is in the burst that is open, waits for it, or was in one before, in order.
  wire lines_in_order =
    accepted == closed + lines_open + {15'd0, \dut.line_waiting } + {15'd0, \dut.second_waiting }
    & closed <= accepted & accepted < 16'hfff1
    & (\dut.burst_open ? \dut.burst_full == (&\dut.burst_more ) : ~\dut.burst_closes )
    & ~(\dut.second_waiting & (~\dut.line_waiting | \dut.line_ready ))
    & (~(\dut.burst_open & \dut.line_waiting & \dut.waiting_line [0]) | (oldest == last + 58'd1 & oldest[5:0] != 6'd0))
    & (~(\dut.second_waiting & \dut.second_line [0]) | (second == oldest + 58'd1 & second[5:0] != 6'd0))
    & (~\dut.second_waiting | \dut.next_line == second + 58'd1)
    & (~after_oldest | \dut.next_line == oldest + 58'd1)
    & (~\dut.burst_open | \dut.line_waiting | \dut.next_line == last + 58'd1)
    & (chosen < closed | chosen >= closed + lines_open | address == first + within)
    & (~is_oldest | address == oldest) & (~is_second | address == second);
  // The open burst ends within its 4 KB.
  wire open_within_a_page = ~\dut.burst_open | {1'b0, first[5:0]} + more[6:0] < 7'd64;
