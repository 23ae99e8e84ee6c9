// SPDX-License-Identifier: MIT OR Apache-2.0
// @BENCH@
// a self-checking test bench of @TOP@, for any Verilog-2005 simulator. From the folder above:
//
//   iverilog -g2005 -o bench -s @BENCH@ -y . sim/@BENCH@.v
//   vvp -n bench
//
// The bench is host, SPL and memory: it resets the accelerator, writes its registers, waits for its identity, and runs a
// job of @COUNT@ @WHAT@ twice, the second time into results that nobody has written. It compares every line written with the
// reference kernel's, and ends with a line that begins with PASS or FAIL. Reads are answered in order after LATENCY
// cycles, writes on either channel, almost-full rises at random.
//
// All is four-state: what SPL does not drive is unknown, and no valid that the accelerator gives may be unknown, nor a
// bit of what it says is valid.
//
@FILES@

module @BENCH@;
@SIZES@
  // Lines, of 64 bytes: the device status memory is physical, the others are virtual.
  localparam [57:0] DSM = 58'h0_4800_0080;
  localparam [57:0] CONTEXT = 58'h1fc_48d1_8000;
  localparam [57:0] SOURCE = CONTEXT + 58'd2;
  localparam [57:0] DESTINATION = SOURCE + LINES;
  localparam [31:0] START_WORD = 32'h406cccff;

@STATE@

  // ---- what SPL gives ----
  reg reset_n = 1'b0;
  reg spl_enable = 1'b0;
  reg spl_reset = 1'b0;
  reg rd_almostfull = 1'b0;
  reg wr_almostfull = 1'b0;
  reg cfg_valid = 1'b0;
  reg [13:0] cfg_offset;
  reg [31:0] cfg_data;
  reg on_channel_1 = 1'b0;

  // ---- what the accelerator gives ----
  wire rd_valid;
  wire [98:0] rd_hdr;
  wire wr_valid;
  wire intr_valid;
  wire [98:0] wr_hdr;
  wire [511:0] wr_data;
  wire [57:0] rd_line = {rd_hdr[92:67], rd_hdr[45:14]};
  wire [57:0] wr_line = {wr_hdr[92:67], wr_hdr[45:14]};
  wire wr_is_fence = wr_hdr[55:52] == 4'd5;

  // ---- memory ----
  // In `source_lines`, the control memory comes before the @WHAT@.
  reg [511:0] pointers;
  reg [511:0] identity;
  reg [511:0] status;
  reg identified = 1'b0;
  reg ended = 1'b0;
  integer fences;

  // ---- answers: a pipe of LATENCY cycles each way ----
  reg [LATENCY-1:0] rd_pipe_valid = 0;
  reg [LATENCY-1:0] wr_pipe_valid = 0;
  reg [13:0] rd_pipe_mdata [0:LATENCY-1];
  reg [13:0] wr_pipe_mdata [0:LATENCY-1];
  reg [511:0] rd_pipe_data [0:LATENCY-1];
  wire rd_answer = rd_pipe_valid[LATENCY-1];
  wire wr_answer = wr_pipe_valid[LATENCY-1];
  wire channel_1 = on_channel_1 | rd_answer | cfg_valid;
  wire wr_answer_0 = wr_answer & ~channel_1;
  wire wr_answer_1 = wr_answer & channel_1;
  wire [17:0] rd_answer_hdr = {4'd4, rd_pipe_mdata[LATENCY-1]};
  wire [17:0] wr_answer_hdr = {4'd1, wr_pipe_mdata[LATENCY-1]};

  @TOP@@PARAMETERS@ afu (
    .clk                  (clk),
    .reset_n              (reset_n),
    .spl_enable           (spl_enable),
    .spl_reset            (spl_reset),
    .spl_tx_rd_almostfull (rd_almostfull),
    .spl_tx_wr_almostfull (wr_almostfull),
    .spl_rx_rd_valid      (rd_answer),
    .spl_rx_wr_valid0     (wr_answer_0),
    .spl_rx_cfg_valid     (cfg_valid),
    .spl_rx_intr_valid0   (1'b0),
    .spl_rx_umsg_valid    (1'b0),
    .spl_rx_hdr0          (rd_answer ? rd_answer_hdr : wr_answer_0 ? wr_answer_hdr : {4'dx, cfg_offset}),
    .spl_rx_data          (rd_answer ? rd_pipe_data[LATENCY-1] : {480'dx, cfg_data}),
    .spl_rx_wr_valid1     (wr_answer_1),
    .spl_rx_intr_valid1   (1'b0),
    .spl_rx_hdr1          (wr_answer_1 ? wr_answer_hdr : 18'dx),
    .afu_tx_rd_valid      (rd_valid),
    .afu_tx_rd_hdr        (rd_hdr),
    .afu_tx_wr_valid      (wr_valid),
    .afu_tx_intr_valid    (intr_valid),
    .afu_tx_wr_hdr        (wr_hdr),
    .afu_tx_data          (wr_data)
  );

  // ---- nothing unknown goes out ----
  reg checked = 1'b0;
  always @(posedge clk) if (checked) begin
    if (^{rd_valid, wr_valid, intr_valid} === 1'bx) fault("a valid is unknown");
    if (intr_valid !== 1'b0) fault("an interrupt");
    if (rd_valid === 1'b1 && ^rd_hdr === 1'bx) fault("a read's header is unknown");
    if (wr_valid === 1'b1 && ^wr_hdr === 1'bx) fault("a write's header is unknown");
    if (wr_valid === 1'b1 && !wr_is_fence && ^wr_data === 1'bx) fault("a write's data is unknown");
  end

  // ---- SPL and memory ----
  integer stage;
  always @(posedge clk) begin
    rd_pipe_valid <= {rd_pipe_valid[LATENCY-2:0], rd_valid === 1'b1};
    wr_pipe_valid <= {wr_pipe_valid[LATENCY-2:0], wr_valid === 1'b1 && !wr_is_fence};
    for (stage = 1; stage < LATENCY; stage = stage + 1) begin
      rd_pipe_mdata[stage] <= rd_pipe_mdata[stage-1];
      wr_pipe_mdata[stage] <= wr_pipe_mdata[stage-1];
      rd_pipe_data[stage] <= rd_pipe_data[stage-1];
    end
    rd_pipe_mdata[0] <= rd_hdr[13:0];
    wr_pipe_mdata[0] <= wr_hdr[13:0];
    rd_pipe_data[0] <= rd_line == CONTEXT ? pointers : source_lines[rd_line - SOURCE];
    if (rd_valid === 1'b1) begin
      if (rd_hdr[55:52] != 4'd4 || !rd_hdr[66]) fault("a read of another kind");
      if (rd_line != CONTEXT && (rd_line < SOURCE || rd_line >= DESTINATION)) fault("a read elsewhere");
    end
    if (wr_valid === 1'b1) begin
      if (wr_is_fence) fences <= fences + 1;
      else if (!wr_hdr[66]) begin
        if (wr_line == DSM) begin
          identity <= wr_data;
          identified <= 1'b1;
        end else if (wr_line - DSM >= 58'd64) fault("a write elsewhere");
      end else if (wr_line == CONTEXT + 58'd1) begin
        status <= wr_data;
        ended <= 1'b1;
      end else if (wr_line - DESTINATION < LINES) begin
        destination_lines[wr_line - DESTINATION] <= wr_data;
        written <= written + 1;
      end else fault("a write elsewhere");
    end
    rd_almostfull <= ($random(seed) & 3) == 0;
    wr_almostfull <= ($random(seed) & 3) == 0;
    on_channel_1 <= ($random(seed) & 1) == 0;
    cycles <= cycles + 1;
  end

  // ---- the host ----
  task csr(input [31:0] offset, input [31:0] value);
    begin
      cfg_valid <= 1'b1;
      cfg_offset <= offset[15:2];
      cfg_data <= value;
      @(posedge clk);
      cfg_valid <= 1'b0;
      cfg_offset <= 14'dx;
      cfg_data <= 32'dx;
      repeat (3) @(posedge clk);
    end
  endtask

  integer limit;

  task job(input [31:0] sequence);
    begin
      for (line = 0; line < LINES; line = line + 1) destination_lines[line] = 512'dx;
      written = 0;
      fences = 0;
      ended = 1'b0;
      // Dwords 5 to 0: watchdog, abort, sequence, mode, count, start word.
      source_lines[0] = {320'd0, 32'd10000, 32'd0, sequence, 32'd0, count, START_WORD};
      limit = cycles + 20 * count + 20000;
      while (!ended && cycles < limit) @(posedge clk);
      source_lines[0] = 512'd0;
      if (!ended) fault("no status");
      if (fences == 0) fault("no fence before the status");
      $display("done %b error %0d sequence %0d contacts %0d invalid %0d first %0d written %0d", status[0], status[11:8],
               status[63:32], status[95:64], status[127:96], $signed(status[159:128]), written);
      if (is_own) begin
        if (status[11:8] != 4'd0) fault("the job ended with an error");
        if (status[95:64] != 32'd@CONTACTS@) fault("another number of contacts");
        if (status[127:96] != 32'd@INVALID@) fault("another number of invalid @WHAT@");
        if (status[159:128] != 32'd@FIRST_INVALID@) fault("another first invalid number");
@CHECK_CANDIDATES@
        if (written != EXPECTED_LINES) fault("another number of lines");
        check_lines;
      end
      repeat (100) @(posedge clk);
    end
  endtask

@VERDICT@

  initial begin
@ARGUMENTS@
    if (!is_own && count != 32'd0) $readmemh(source_name, source_lines, 1, 1 + @LAST_LINE@);
    source_lines[0] = 512'd0;
    // Dwords 6 to 2: lines of a buffer, results, pairs, in byte addresses.
    pointers = {288'd0, LINES[31:0], DESTINATION, 6'd0, SOURCE, 6'd0, 64'd0};
    repeat (4) @(posedge clk);
    reset_n <= 1'b1;
    spl_reset <= 1'b1;
    @(posedge clk);
    checked <= 1'b1;
    repeat (16) @(posedge clk);
    spl_reset <= 1'b0;
    csr(32'h8a00, DSM[57:26]);
    csr(32'h8a04, {DSM[25:0], 6'd0});
    limit = cycles + 1000;
    while (!identified && cycles < limit) @(posedge clk);
    if (!identified) fault("no identity");
    $display("identity %h version %0d", identity[127:0], identity[159:128]);
    csr(32'h8a08, CONTEXT[57:26]);
    csr(32'h8a0c, {CONTEXT[25:0], 6'd0});
    spl_enable <= 1'b1;
    job(32'd1);
    job(32'd2);
@WRITE@
    if (faults == 0) $display("no fault");
    if (is_own) verdict;
    $finish;
  end
endmodule

`default_nettype wire
