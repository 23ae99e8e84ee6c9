// SPDX-License-Identifier: MIT OR Apache-2.0
// Credits of the whole accelerator, by induction, for a host and a link that do anything at all. A pair enters only
// when there is room for its result, every pair that entered comes out once, and all the room is accounted for. This is
// about counts, not data.
//
// The induction is longer than the pipeline, so it needs no invariant about the pipeline's contents.
//
// If only hits come back, a pair's room is free again when the pair is known to be no hit, or when its hit has left the
// backlog. So the backlog never overflows, and no hit is lost between the sieve and the packer.
//
// Assumed here and proven elsewhere: the collector announces no more lines than it has slots for (collector.sv:
// offered_in_order).
//
// Defines: LATENCY, that of an SCPU; LINES, the lines that the dispatcher can store; SCPUS, their number; EVERY_OTHER,
// for an interval of 2; THREE, for 3 SCPUs at that interval; PER_LINE, the hits per line if only hits come back;
// GATHERS, if that is more than one.
`default_nettype none

module credits (
  // Inputs that are free in every cycle.
  `include "inputs.svh"
);
`ifdef PER_LINE
  localparam CAPACITY = `CAPACITY;
`else
  localparam CAPACITY = 2 * `LINES;
`endif
  localparam ROOM_BITS = $clog2(CAPACITY) + 1;
  // Cycles from the count of pairs that enter to their results behind the last slot. An SCPU that takes a pair in every
  // cycle has one register more before it.
`ifdef EVERY_OTHER
  localparam RANKS = `LATENCY + `SCPUS + 2;
`else
  localparam RANKS = `LATENCY + `SCPUS + 3;
`endif

  `include "dut.svh"
  (* hierconn *) wire                       \dut.control.begin_job ;
  (* hierconn *) wire                       \dut.control.begin_collector ;
  (* hierconn *) wire                       \dut.control.begin_feeder ;
  (* hierconn *) wire                       \dut.control.begin_credits ;
  (* hierconn *) wire                       \dut.control.begin_packer ;
  (* hierconn *) wire                       \dut.control.begin_dispatcher ;
  (* hierconn *) wire [57:0]                \dut.control.job_destination ;
  (* hierconn *) wire [3:0]                 \dut.control.job_epoch ;
  (* hierconn *) wire                       \dut.control.given_up ;
  (* hierconn *) wire                       \dut.control.drops_requests ;
  (* hierconn *) wire                       \dut.control.busy_copy_1 ;
  (* hierconn *) wire                       \dut.control.busy_copy_2 ;
  (* hierconn *) wire                       \dut.control.run ;
  (* hierconn *) wire                       \dut.control.running ;
  (* hierconn *) wire                       \dut.control.draining ;
  (* hierconn *) wire                       \dut.control.filled_heard ;
  (* hierconn *) wire                       \dut.control.waits_to_begin ;
  (* hierconn *) wire                       \dut.control.completes ;
  (* hierconn *) wire [31:0]                \dut.control.job_lines ;
  (* hierconn *) wire                       \dut.control.last_place ;
  (* hierconn *) wire                       \dut.credits.may_enter ;
  (* hierconn *) wire                       \dut.credits.filled ;
  (* hierconn *) wire                       \dut.credits.all_emerged ;
  (* hierconn *) wire [ROOM_BITS-1:0]       \dut.credits.room ;
  (* hierconn *) wire [ROOM_BITS-1:0]       \dut.credits.room_change ;
  (* hierconn *) wire [ROOM_BITS-1:0]       \dut.credits.pairs_inside ;
  (* hierconn *) wire [1:0]                 \dut.feeder.entered ;
  (* hierconn *) wire [1:0]                 \dut.slots_leaves_out ;
  (* hierconn *) wire                       \dut.feeder.taken ;
  (* hierconn *) wire                       \dut.collector.line_comes ;
  (* hierconn *) wire [2:0]                 \dut.feeder.lines_waiting ;
  (* hierconn *) wire                       \dut.feeder.line_ready ;
  (* hierconn *) wire                       \dut.feeder.two_lines_ready ;
  (* hierconn *) wire                       \dut.feeder.last_line_ready ;
  (* hierconn *) wire                       \dut.feeder.any_lines_waiting ;
  (* hierconn *) wire                       \dut.feeder.one_lines_waiting ;
  (* hierconn *) wire                       \dut.feeder.lines_waiting_step ;
  (* hierconn *) wire                       \dut.feeder.lines_left_step ;
  (* hierconn *) wire                       \dut.feeder.holds_1 ;
  (* hierconn *) wire [31:0]                \dut.feeder.lines_left ;
  (* hierconn *) wire                       \dut.feeder.any_lines_left ;
  (* hierconn *) wire                       \dut.feeder.one_lines_left ;
  (* hierconn *) wire                       \dut.feeder.in_hand ;
  (* hierconn *) wire                       \dut.feeder.place ;
  (* hierconn *) wire                       \dut.feeder.last ;
  (* hierconn *) wire [6:0]                 \dut.feeder.turn ;
  (* hierconn *) wire [$clog2(`LINES):0]    \dut.dispatcher.stored ;
  (* hierconn *) wire                       \dut.dispatcher.take ;
  (* hierconn *) wire                       \dut.dispatcher.stored_step ;
  (* hierconn *) wire                       \dut.dispatcher.any_stored ;
  (* hierconn *) wire                       \dut.dispatcher.one_stored ;
`ifdef PER_LINE
  (* hierconn *) wire [1:0]                 \dut.sieve.group_here ;
  (* hierconn *) wire [1:0]                 \dut.sieve.hits_rank_0 ;
  (* hierconn *) wire [1:0]                 \dut.sieve.dropped_pairs ;
  (* hierconn *) wire [31:0]                \dut.sieve.emerged ;
  (* hierconn *) wire [31:0]                \dut.sieve.contact_count ;
  (* hierconn *) wire                       \dut.sieve.clears_counts ;
  // Counted one cycle later.
  (* hierconn *) wire [1:0]                 \dut.sieve.contacts_now ;
  (* hierconn *) wire [ROOM_BITS-1:0]       \dut.backlog.stored ;
  (* hierconn *) wire [ROOM_BITS-1:0]       \dut.backlog.readable ;
  (* hierconn *) wire                       \dut.backlog.head_bank ;
  (* hierconn *) wire                       \dut.backlog.tail_bank ;
  (* hierconn *) wire [ROOM_BITS-3:0]       \dut.backlog.head_row_0 ;
  (* hierconn *) wire [ROOM_BITS-3:0]       \dut.backlog.head_row_1 ;
  (* hierconn *) wire [ROOM_BITS-3:0]       \dut.backlog.row_after_head_0 ;
  (* hierconn *) wire [ROOM_BITS-3:0]       \dut.backlog.row_after_head_1 ;
  (* hierconn *) wire [ROOM_BITS-3:0]       \dut.backlog.tail_row_0 ;
  (* hierconn *) wire [ROOM_BITS-3:0]       \dut.backlog.tail_row_1 ;
  (* hierconn *) wire [`PER_LINE-1:0]       \dut.backlog.group_out ;
  // Pairs that have left the slots and are not counted yet.
  wire [1:0]  uncounted = \dut.sieve.group_here ;
  wire [31:0] emerged = \dut.sieve.emerged ;
`ifdef GATHERS
  // Lines between the backlog and the dispatcher, including the one being assembled.
  (* hierconn *) wire                       \dut.packer.place ;
  (* hierconn *) wire                       \dut.packer.went ;
  (* hierconn *) wire                       \dut.packer.comes ;
  (* hierconn *) wire                       \dut.packer.line_valid ;
  wire [2:0]  gathered = {2'd0, \dut.packer.place } + \dut.packer.went + \dut.packer.comes + \dut.packer.line_valid ;
`else
  wire [2:0]  gathered = 3'd0;
`endif
`else
  (* hierconn *) wire                       \dut.packer.place ;
  (* hierconn *) wire                       \dut.packer.line_valid ;
  (* hierconn *) wire                       \dut.packer.flushes ;
  (* hierconn *) wire                       \dut.packer.went ;
  (* hierconn *) wire                       \dut.packer.comes ;
  (* hierconn *) wire [31:0]                \dut.packer.emerged ;
  (* hierconn *) wire [1:0]                 \dut.packer.group_here ;
  (* hierconn *) wire [1:0]                 \dut.packer.group_before ;
  wire [2:0]  gathered = 3'd0;
  wire [1:0]  uncounted = \dut.packer.group_here ;
  // Counted one cycle later.
  wire [31:0] emerged = \dut.packer.emerged + {30'd0, \dut.packer.group_before };
`endif

  // Expected positions of groups of pairs, which advance by one rank per cycle, and the number of pairs in them.
  reg [2*RANKS+1:0] ranks;
  reg after_reset = 1'b0;
  reg was_reset;
  reg begun = 1'b0;
  // The job began one cycle ago; the feeder's flags know its lines one cycle later.
  reg began;
  // The number of the job's pairs, how many of its lines became ready (counted one cycle later), how many pairs have
  // entered, and whether all had come out one cycle ago.
  reg [31:0] job_count;
  reg [31:0] readied;
  reg [32:0] entered;
  reg all_out;
  // Whether a job ran one cycle ago, two, three.
  reg [2:0] ran = 3'd0;
  // Where the job that was asked for last writes, and its epoch.
  reg [61:0] asked;
  reg completed = 1'b0;
  always @(posedge clk) begin
    after_reset <= after_reset | rst;
    was_reset <= rst;
    begun <= ~rst & (begun | \dut.control.begin_job );
    began <= \dut.control.begin_job ;
    if (start & ~busy) job_count <= count;
    if (start & ~busy) asked <= {destination, epoch};
    readied <= \dut.control.begin_job ? 32'd0 : readied + {31'd0, \dut.feeder.lines_left_step };
    entered <= \dut.control.begin_job ? 33'd0 : entered + {31'd0, \dut.feeder.entered };
    all_out <= ~\dut.control.begin_job & emerged == job_count;
    ran <= rst ? 3'd0 : {ran[1:0], \dut.control.run };
    completed <= \dut.control.completes & ~rst;
    ranks <= rst ? {2 * RANKS + 2{1'b0}} : {ranks[2*RANKS-1:0], \dut.feeder.entered };
  end
  integer rank;
  reg [7:0] inside;
  always @* begin
    inside = 8'd0;
    for (rank = 0; rank < RANKS; rank = rank + 1) inside = inside + {6'd0, ranks[2*rank +: 2]};
  end
  // Those that came out one cycle ago are still counted as inside.
  wire [7:0] counted_inside = inside + {6'd0, ranks[2*RANKS +: 2]};
  wire [1:0] leaves = \dut.slots_leaves_out ;

  wire [ROOM_BITS-1:0] next_room = \dut.credits.room + \dut.credits.room_change ;
  wire [31:0] job_lines = {1'b0, job_count[31:1]} + {31'd0, job_count[0]};
  // Lines that are not ready yet; one that became ready is counted one cycle later.
  wire [31:0] unready = \dut.feeder.lines_left - {31'd0, \dut.feeder.lines_left_step };
  // Pairs in lines that became ready. The job's last line counts as two pairs until it is taken, even if it holds one.
  wire [31:0] all_readied = readied + {31'd0, \dut.feeder.lines_left_step };
  wire last_taken = unready == 32'd0 & ~\dut.feeder.line_ready ;
  wire [32:0] pairs_readied = {all_readied, 1'b0} - {32'd0, last_taken & ~\dut.control.last_place };
  // Of them, those that the feeder has not issued yet.
  wire [1:0] lines_ready = {1'b0, \dut.feeder.line_ready } + {1'b0, \dut.feeder.two_lines_ready };
  wire [1:0] in_hand = \dut.feeder.in_hand ? 2'd1 + {1'b0, \dut.feeder.last } - {1'b0, \dut.feeder.place } : 2'd0;

  // Lines that wait for the feeder, and that wait to be written. One that went is counted a cycle late.
  wire [2:0] lines_waiting = \dut.feeder.lines_waiting - {2'd0, \dut.feeder.lines_waiting_step };
  wire [$clog2(`LINES):0] lines_stored = \dut.dispatcher.stored - \dut.dispatcher.stored_step ;

  always @* assume (after_reset | rst);
  // The collector announces no more lines than it has slots (collector.sv: offered_in_order).
  always @* assume (~\dut.collector.line_comes | \dut.feeder.lines_waiting < 3'd4);
  always @* if (after_reset & ~rst) begin
    comes_out: assert (~\dut.credits.filled | (leaves != 2'b10 & {1'b0, leaves[0]} + {1'b0, leaves[1]} == ranks[2*RANKS-1 -: 2]));
    inside_is_right: assert (\dut.credits.pairs_inside == counted_inside);
    nothing_before_it_is_filled: assert ((\dut.credits.filled | counted_inside == 8'd0)
      & (\dut.credits.filled & \dut.control.filled_heard | ~begun));
    waits_or_runs: assert (~(\dut.control.run & \dut.control.waits_to_begin )
      & (\dut.control.running | ~(\dut.control.run | \dut.control.waits_to_begin )));
    one_or_other: assert (~(\dut.control.running & \dut.control.draining ));
    busy_is_right: assert ({3{\dut.control.running | \dut.control.draining }}
      == {busy, \dut.control.busy_copy_1 , \dut.control.busy_copy_2 });
    drops_in_time: assert (\dut.control.drops_requests == (\dut.control.begin_job | \dut.control.given_up | was_reset));
    nothing_runs: assert (~\dut.control.given_up
      | ~(\dut.control.running | \dut.control.run | \dut.control.begin_job ));
    only_in_a_job: assert (\dut.feeder.entered == 2'd0 | (ran[2] & begun));
    runs_without_error: assert (~\dut.control.running | error == 4'd0);
    complete_is_good: assert (~completed | error == 4'd0 | error == 4'd6);
    begins_first: assert (~\dut.control.run | begun);
    begins_rested: assert (~\dut.control.begin_job | ~ran[0]);
    begins_empty: assert (~\dut.control.begin_job | (busy & counted_inside == 8'd0 & \dut.feeder.entered == 2'd0));
    idle_is_empty: assert (busy | (counted_inside == 8'd0 & \dut.feeder.entered == 2'd0));
    job_stays: assert (~busy | {\dut.control.job_destination , \dut.control.job_epoch } == asked);
    lines_are_right: assert (~busy | \dut.control.job_lines == job_lines);
    last_is_right: assert (~(begun | busy) | \dut.control.last_place == ~job_count[0]);
    takes_a_line: assert (\dut.feeder.lines_waiting <= 3'd4
      & \dut.feeder.any_lines_waiting == (lines_waiting != 3'd0)
      & \dut.feeder.one_lines_waiting == (lines_waiting == 3'd1)
      & \dut.feeder.lines_waiting_step == \dut.feeder.lines_left_step
      & (\dut.feeder.line_ready | ~\dut.feeder.two_lines_ready )
      & (~\dut.feeder.lines_left_step | \dut.feeder.lines_waiting != 3'd0));
    begins_everywhere: assert ({5{\dut.control.begin_job }} == {\dut.control.begin_collector ,
      \dut.control.begin_feeder , \dut.control.begin_credits , \dut.control.begin_packer ,
      \dut.control.begin_dispatcher });
  end
  always @* if (begun & ~\dut.control.begin_job & ~rst) begin
    knows_what_is_stored: assert (\dut.dispatcher.any_stored == (lines_stored != 0)
      & \dut.dispatcher.one_stored == (lines_stored == 1));
    sends_a_line: assert ((~\dut.dispatcher.stored_step | \dut.dispatcher.stored != 0)
      & (~\dut.dispatcher.take | \dut.dispatcher.stored != \dut.dispatcher.stored_step ));
    turn_is_an_scpu: assert (\dut.feeder.turn < `SCPUS);
    flags_are_right: assert (began | (\dut.feeder.any_lines_left == (unready != 32'd0)
      & \dut.feeder.one_lines_left == (unready == 32'd1)));
    knows_the_last: assert ((~\dut.feeder.last_line_ready | unready == 32'd0)
      & (\dut.feeder.last_line_ready | ~\dut.feeder.line_ready | unready != 32'd0));
    knows_what_it_holds: assert (~\dut.feeder.in_hand | ((\dut.feeder.last | ~\dut.feeder.place )
      & \dut.feeder.holds_1 == (\dut.feeder.last & ~\dut.feeder.place )));
    only_last_is_short: assert (~\dut.feeder.in_hand | \dut.feeder.last | last_taken);
    readies_once: assert ((~\dut.feeder.lines_left_step | \dut.feeder.lines_left != 32'd0)
      & readied <= job_lines & \dut.feeder.lines_left == job_lines - readied);
    enters_once: assert (entered <= {1'b0, job_count} & pairs_readied == entered + {31'd0, \dut.feeder.entered }
      + {30'd0, lines_ready, 1'b0} + {31'd0, in_hand});
    comes_out_once: assert ({24'd0, inside} + {30'd0, uncounted} == entered[31:0] - emerged);
    all_come_out: assert (\dut.credits.all_emerged == all_out);
    room_is_seen: assert (~\dut.credits.may_enter | \dut.credits.room >= 8);
    never_negative: assert (\dut.feeder.entered <= next_room);
    lines_fit: assert (\dut.dispatcher.stored + gathered <= `LINES);
  end

`ifdef PER_LINE
  // The sieve's pairs of the previous cycle, each a hit or dropped, and the number of hits that have left the backlog.
  reg [1:0]  were_here;
  reg [31:0] left;
  // The count is cleared a cycle after the beginning.
  wire [31:0] hits_counted = \dut.sieve.clears_counts ? 32'd0 : \dut.sieve.contact_count ;
  wire [2:0] sifted = {1'b0, \dut.sieve.hits_rank_0 } + {1'b0, \dut.sieve.dropped_pairs };
  // Of the backlog's hits, those in the bank of the oldest, and those in the other bank.
  wire [ROOM_BITS-1:0] in_oldest_bank = (\dut.backlog.stored + 1'b1) / 2;
  wire [ROOM_BITS-1:0] in_other_bank = \dut.backlog.stored / 2;
  wire [ROOM_BITS-3:0] in_bank_0 = \dut.backlog.head_bank ? in_other_bank : in_oldest_bank;
  wire [ROOM_BITS-3:0] in_bank_1 = \dut.backlog.head_bank ? in_oldest_bank : in_other_bank;
  always @(posedge clk) begin
    were_here <= rst | \dut.control.begin_job ? 2'd0 : \dut.sieve.group_here ;
    left <= \dut.control.begin_job ? 32'd0 : left + \dut.backlog.group_out ;
  end
  always @* if (begun & ~\dut.control.begin_job & ~rst) begin
    each_is_sifted: assert (sifted == {1'b0, were_here});
    hits_add_up: assert ({3'd0, next_room} + inside + uncounted + sifted + \dut.backlog.stored + \dut.backlog.group_out
      == CAPACITY);
    no_hit_is_lost: assert (hits_counted + \dut.sieve.contacts_now == left + \dut.sieve.hits_rank_0
      + \dut.backlog.stored + \dut.backlog.group_out );
    backlog_fits: assert (\dut.backlog.stored <= CAPACITY);
    banks_in_turn: assert ((\dut.backlog.head_bank ^ \dut.backlog.tail_bank ) == \dut.backlog.stored [0]);
    rows_in_turn: assert (\dut.backlog.row_after_head_0 == \dut.backlog.head_row_0 + 1'b1
      & \dut.backlog.row_after_head_1 == \dut.backlog.head_row_1 + 1'b1);
    backlog_counts: assert (\dut.backlog.tail_row_0 - \dut.backlog.head_row_0 == in_bank_0
      & \dut.backlog.tail_row_1 - \dut.backlog.head_row_1 == in_bank_1);
    reads_what_is_there: assert (\dut.backlog.readable <= \dut.backlog.stored );
  end
`else
  // `flushed`: the packer has flushed its partial last line. `leaving`: lines between the packer and the link.
  reg flushed;
  always @(posedge clk) flushed <= ~\dut.control.begin_job & (flushed | \dut.packer.flushes );
  wire [ROOM_BITS-1:0] leaving = {1'b0, \dut.dispatcher.stored } + \dut.packer.went + \dut.packer.comes
    + \dut.packer.line_valid ;
  always @* if (begun & ~\dut.control.begin_job & ~rst) begin
    last_line_once: assert (~flushed | (emerged == job_count & ~\dut.packer.place ));
    places_add_up: assert ({4'd0, next_room} + inside + {7'd0, \dut.packer.place } + {3'd0, leaving, 1'b0}
      == CAPACITY + {7'd0, flushed});
    fits: assert (leaving - {3'd0, \dut.dispatcher.stored_step } <= `LINES);
  end
`endif

  // At an interval of 2 an SCPU takes pairs in every other cycle only, even if the feeder waits in between: a turn's phase
  // is that of its SCPU. Two SCPUs take theirs on one lane, each in a phase of its own. Of three, SCPUs 0 and 1 take
  // theirs in phase 0 and SCPU 2 in phase 1. Each hop of the chain is one cycle more.
`ifdef EVERY_OTHER
  (* hierconn *) wire \dut.slots[0].unit.takes ;
  (* hierconn *) wire \dut.slots[1].unit.takes ;
`ifdef THREE
  (* hierconn *) wire \dut.slots[2].unit.takes ;
  wire [2:0] takes = { \dut.slots[2].unit.takes , \dut.slots[1].unit.takes , \dut.slots[0].unit.takes };
  localparam BLOCK = 2;
`else
  localparam BLOCK = 1;
  wire [2:0] takes = {1'b0, \dut.slots[1].unit.takes , \dut.slots[0].unit.takes };
`endif
  (* hierconn *) wire \dut.feeder.turn_phase ;
  (* hierconn *) wire [6:0] \dut.feeder.turn_block ;
  (* hierconn *) wire \dut.feeder.turn_within ;
  (* hierconn *) wire \dut.feeder.block_is_last ;
  // The SCPU's number is counted one cycle after the block's.
  wire [7:0] turn_then = {1'b0, \dut.feeder.turn } + {6'd0, \dut.feeder.entered };
  wire [7:0] next_turn = turn_then >= `SCPUS ? turn_then - `SCPUS : turn_then;
  (* hierconn *) wire \dut.feeder.phase ;
  (* hierconn *) wire [1:0] \dut.feeder.carries ;
  localparam [2:0] ODD = BLOCK == 1 ? 3'b111 : 3'b001;
  always @* if (begun & ~\dut.control.begin_job & ~rst) begin
    phase_is_the_block_s: assert (\dut.feeder.turn_phase == \dut.feeder.turn_block [0]
      & \dut.feeder.block_is_last == (\dut.feeder.turn_block == (`SCPUS - 32'd1) / BLOCK));
    turn_is_the_block_s: assert (\dut.feeder.turn_within < BLOCK
      & \dut.feeder.turn_block * BLOCK + \dut.feeder.turn_within == next_turn);
    every_other_cycle: assert ((takes & (ODD ^ {3{\dut.feeder.phase }})) == 3'd0);
    one_lane_serves_two: assert (BLOCK == 2 | ~\dut.feeder.carries [1]);
  end
`endif
endmodule

`default_nettype wire
