// SPDX-License-Identifier: MIT OR Apache-2.0
// @BENCH@
// a self-checking test bench of @TOP@, for any Verilog-2005 simulator. From the folder above:
//
//   iverilog -g2005 -o bench -s @BENCH@ -y . sim/@BENCH@.v
//   vvp -n bench
//
// The bench is host and memory: it reads the identity, writes the registers, and runs a job of @COUNT@ @WHAT@ twice, the
// second time into results that nobody has written. It compares every line written with the reference kernel's, and ends
// with a line that begins with PASS or FAIL. Memory answers in order after LATENCY cycles at the earliest. Every READY
// and every VALID of the bench comes and goes at random.
//
// All is four-state: what memory does not drive is unknown, and no valid that the accelerator gives may be unknown, nor a
// bit of what it says is valid.
//
@FILES@

module @BENCH@;
@SIZES@
  localparam integer BUS = @BUS@;
  localparam integer BEATS = 512 / BUS;
  // Byte addresses. The @WHAT@ begin in the middle of 4 KB.
  localparam [63:0] SOURCE = 64'h0000_0001_0000_0b40;
  localparam [63:0] DESTINATION = 64'h0000_0002_0000_0000;

@STATE@
  reg rst_n = 1'b0;

  // ---- the host's side ----
  reg aw_valid = 1'b0;
  reg [11:0] aw_addr;
  wire aw_ready;
  reg w_valid = 1'b0;
  reg [31:0] w_data;
  wire w_ready;
  wire b_valid;
  wire [1:0] b_resp;
  reg b_ready = 1'b0;
  reg ar_valid = 1'b0;
  reg [11:0] ar_addr;
  wire ar_ready;
  wire r_valid;
  wire [31:0] r_data;
  wire [1:0] r_resp;
  reg r_ready = 1'b0;
  wire interrupt;

  // ---- memory's side ----
  wire gmem_awvalid;
  reg gmem_awready = 1'b0;
  wire [63:0] gmem_awaddr;
  wire [7:0] gmem_awlen;
  wire gmem_wvalid;
  reg gmem_wready = 1'b0;
  wire [BUS-1:0] gmem_wdata;
  wire [BUS/8-1:0] gmem_wstrb;
  wire gmem_wlast;
  reg gmem_bvalid = 1'b0;
  wire gmem_bready;
  wire gmem_arvalid;
  reg gmem_arready = 1'b0;
  wire [63:0] gmem_araddr;
  wire [7:0] gmem_arlen;
  reg gmem_rvalid = 1'b0;
  reg [BUS-1:0] gmem_rdata;
  reg gmem_rlast;
  wire gmem_rready;
  wire [2:0] gmem_awsize;
  wire [1:0] gmem_awburst;
  wire [3:0] gmem_awcache;
  wire [2:0] gmem_arsize;
  wire [1:0] gmem_arburst;
  wire [3:0] gmem_arcache;
  wire gmem_awid;
  wire gmem_awlock;
  wire [2:0] gmem_awprot;
  wire [3:0] gmem_awqos;
  wire gmem_arid;
  wire gmem_arlock;
  wire [2:0] gmem_arprot;
  wire [3:0] gmem_arqos;

  @TOP@@PARAMETERS@ afu (
    .ap_clk                (clk),
    .ap_rst_n              (rst_n),
    .s_axi_control_awvalid (aw_valid),
    .s_axi_control_awaddr  (aw_addr),
    .s_axi_control_awready (aw_ready),
    .s_axi_control_wvalid  (w_valid),
    .s_axi_control_wdata   (w_data),
    .s_axi_control_wstrb   (4'hf),
    .s_axi_control_wready  (w_ready),
    .s_axi_control_bvalid  (b_valid),
    .s_axi_control_bresp   (b_resp),
    .s_axi_control_bready  (b_ready),
    .s_axi_control_arvalid (ar_valid),
    .s_axi_control_araddr  (ar_addr),
    .s_axi_control_arready (ar_ready),
    .s_axi_control_rvalid  (r_valid),
    .s_axi_control_rdata   (r_data),
    .s_axi_control_rresp   (r_resp),
    .s_axi_control_rready  (r_ready),
    .interrupt             (interrupt),
    .m_axi_gmem_awvalid    (gmem_awvalid),
    .m_axi_gmem_awready    (gmem_awready),
    .m_axi_gmem_awid       (gmem_awid),
    .m_axi_gmem_awaddr     (gmem_awaddr),
    .m_axi_gmem_awlen      (gmem_awlen),
    .m_axi_gmem_awsize     (gmem_awsize),
    .m_axi_gmem_awburst    (gmem_awburst),
    .m_axi_gmem_awlock     (gmem_awlock),
    .m_axi_gmem_awcache    (gmem_awcache),
    .m_axi_gmem_awprot     (gmem_awprot),
    .m_axi_gmem_awqos      (gmem_awqos),
    .m_axi_gmem_wvalid     (gmem_wvalid),
    .m_axi_gmem_wready     (gmem_wready),
    .m_axi_gmem_wdata      (gmem_wdata),
    .m_axi_gmem_wstrb      (gmem_wstrb),
    .m_axi_gmem_wlast      (gmem_wlast),
    .m_axi_gmem_bvalid     (gmem_bvalid),
    .m_axi_gmem_bready     (gmem_bready),
    .m_axi_gmem_bid        (1'b0),
    .m_axi_gmem_bresp      (2'd0),
    .m_axi_gmem_arvalid    (gmem_arvalid),
    .m_axi_gmem_arready    (gmem_arready),
    .m_axi_gmem_arid       (gmem_arid),
    .m_axi_gmem_araddr     (gmem_araddr),
    .m_axi_gmem_arlen      (gmem_arlen),
    .m_axi_gmem_arsize     (gmem_arsize),
    .m_axi_gmem_arburst    (gmem_arburst),
    .m_axi_gmem_arlock     (gmem_arlock),
    .m_axi_gmem_arcache    (gmem_arcache),
    .m_axi_gmem_arprot     (gmem_arprot),
    .m_axi_gmem_arqos      (gmem_arqos),
    .m_axi_gmem_rvalid     (gmem_rvalid),
    .m_axi_gmem_rready     (gmem_rready),
    .m_axi_gmem_rid        (1'b0),
    .m_axi_gmem_rdata      (gmem_rdata),
    .m_axi_gmem_rresp      (2'd0),
    .m_axi_gmem_rlast      (gmem_rlast)
  );

  // ---- nothing unknown goes out ----
  reg checked = 1'b0;
  always @(posedge clk) if (checked) begin
    if (^{gmem_awvalid, gmem_wvalid, gmem_arvalid, b_valid, r_valid, interrupt} === 1'bx) fault("a valid is unknown");
    if (gmem_awvalid && ^{gmem_awaddr, gmem_awlen} === 1'bx) fault("a write address is unknown");
    if (gmem_arvalid && ^{gmem_araddr, gmem_arlen} === 1'bx) fault("a read address is unknown");
    if (gmem_wvalid && ^{gmem_wdata, gmem_wlast} === 1'bx) fault("written data are unknown");
    if (gmem_bready !== 1'b1 || gmem_rready !== 1'b1) fault("a response is refused");
    if (gmem_awsize != $clog2(BUS / 8) || gmem_arsize != $clog2(BUS / 8)) fault("beats of another size");
    if (gmem_awburst != 2'd1 || gmem_arburst != 2'd1) fault("bursts of another kind");
    if (gmem_awcache != 4'd3 || gmem_arcache != 4'd3) fault("other cache attributes");
    if ({gmem_awid, gmem_awlock, gmem_awprot, gmem_awqos} != 9'd0) fault("other write attributes");
    if ({gmem_arid, gmem_arlock, gmem_arprot, gmem_arqos} != 9'd0) fault("other read attributes");
  end

  // ---- memory: beats, queues of bursts, and the cycle in which each may be answered ----
  localparam integer MOST = 512;
  reg [BUS-1:0] source_beats [0:LINES*BEATS-1];
  reg [BUS-1:0] destination_beats [0:LINES*BEATS-1];
  reg [63:0] ar_queue [0:MOST-1];
  reg [7:0] ar_beats [0:MOST-1];
  integer ar_due [0:MOST-1];
  reg [63:0] aw_queue [0:MOST-1];
  reg [7:0] aw_beats [0:MOST-1];
  integer b_due [0:MOST-1];
  integer ar_tail = 0;
  integer ar_head = 0;
  integer ar_beat = 0;
  integer aw_tail = 0;
  integer aw_head = 0;
  integer w_beat = 0;
  integer b_tail = 0;
  integer b_head = 0;
  integer at;
  integer chance;
  // Beats of the channel W that came before their address.
  reg [BUS:0] w_queue [0:MOST-1];
  integer w_tail = 0;
  integer w_head = 0;

  function crosses(input [63:0] address, input [7:0] len);
    crosses = ({1'b0, address[11:0]} + (len + 13'd1) * (BUS / 8)) > 13'd4096;
  endfunction

  always @(posedge clk) begin
    chance = $random(seed);
    gmem_arready <= chance[1:0] != 2'd0 && ar_tail - ar_head < 8;
    gmem_awready <= chance[3:2] != 2'd0 && aw_tail - aw_head < 8;
    gmem_wready <= chance[5:4] != 2'd0 && w_tail - w_head < 8;
    if (gmem_arvalid && gmem_arready) begin
      if (gmem_araddr[5:0] != 6'd0) fault("a read of part of a line");
      if (crosses(gmem_araddr, gmem_arlen)) fault("a read across 4 KB");
      if (gmem_araddr < SOURCE || gmem_araddr + (gmem_arlen + 1) * (BUS / 8) > SOURCE + 64 * LINES) fault("a read elsewhere");
      ar_queue[ar_tail % MOST] = gmem_araddr;
      ar_beats[ar_tail % MOST] = gmem_arlen;
      ar_due[ar_tail % MOST] = cycles + LATENCY;
      ar_tail = ar_tail + 1;
    end
    gmem_rvalid <= 1'b0;
    gmem_rdata <= {BUS{1'bx}};
    gmem_rlast <= 1'bx;
    if (ar_head < ar_tail && ar_due[ar_head % MOST] <= cycles && chance[7:6] != 2'd0) begin
      at = (ar_queue[ar_head % MOST] - SOURCE) / (BUS / 8) + ar_beat;
      gmem_rvalid <= 1'b1;
      gmem_rdata <= source_beats[at];
      gmem_rlast <= ar_beat == ar_beats[ar_head % MOST];
      if (ar_beat == ar_beats[ar_head % MOST]) begin
        ar_beat = 0;
        ar_head = ar_head + 1;
      end else ar_beat = ar_beat + 1;
    end
    if (gmem_awvalid && gmem_awready) begin
      if (gmem_awaddr[5:0] != 6'd0) fault("a write of part of a line");
      if (crosses(gmem_awaddr, gmem_awlen)) fault("a write across 4 KB");
      if (gmem_awaddr < DESTINATION || gmem_awaddr + (gmem_awlen + 1) * (BUS / 8) > DESTINATION + 64 * LINES)
        fault("a write elsewhere");
      aw_queue[aw_tail % MOST] = gmem_awaddr;
      aw_beats[aw_tail % MOST] = gmem_awlen;
      aw_tail = aw_tail + 1;
    end
    if (gmem_wvalid && gmem_wready) begin
      if (gmem_wstrb != {(BUS / 8){1'b1}}) fault("bytes that are not written");
      w_queue[w_tail % MOST] = {gmem_wlast, gmem_wdata};
      w_tail = w_tail + 1;
    end
    if (aw_head < aw_tail && w_head < w_tail) begin
      at = (aw_queue[aw_head % MOST] - DESTINATION) / (BUS / 8) + w_beat;
      destination_beats[at] = w_queue[w_head % MOST][BUS-1:0];
      if (w_queue[w_head % MOST][BUS] != (w_beat == aw_beats[aw_head % MOST])) fault("WLAST at another beat");
      w_head = w_head + 1;
      if (w_beat == aw_beats[aw_head % MOST]) begin
        written = written + (w_beat + 1) / BEATS;
        w_beat = 0;
        aw_head = aw_head + 1;
        b_due[b_tail % MOST] = cycles + LATENCY;
        b_tail = b_tail + 1;
      end else w_beat = w_beat + 1;
    end
    gmem_bvalid <= 1'b0;
    if (b_head < b_tail && b_due[b_head % MOST] <= cycles && chance[9:8] != 2'd0) begin
      gmem_bvalid <= 1'b1;
      b_head = b_head + 1;
    end
    b_ready <= chance[10];
    r_ready <= chance[11];
    cycles <= cycles + 1;
  end

  // ---- the host ----
  reg address_first;
  task send_address(input [11:0] offset);
    begin
      aw_valid <= 1'b1;
      aw_addr <= offset;
      @(posedge clk);
      while (!aw_ready) @(posedge clk);
      aw_valid <= 1'b0;
      aw_addr <= 12'dx;
    end
  endtask

  task write_register(input [11:0] offset, input [31:0] written_value);
    begin
      // Now the address first, now the data.
      address_first = cycles[0];
      if (address_first) send_address(offset);
      w_valid <= 1'b1;
      w_data <= written_value;
      @(posedge clk);
      while (!w_ready) @(posedge clk);
      w_valid <= 1'b0;
      w_data <= 32'dx;
      if (!address_first) send_address(offset);
      while (!(b_valid && b_ready)) @(posedge clk);
      if (b_resp != 2'd0) fault("a register cannot be written");
      @(posedge clk);
    end
  endtask

  reg [31:0] value;
  task read_register(input [11:0] offset);
    begin
      ar_valid <= 1'b1;
      ar_addr <= offset;
      @(posedge clk);
      while (!ar_ready) @(posedge clk);
      ar_valid <= 1'b0;
      ar_addr <= 12'dx;
      while (!(r_valid && r_ready)) @(posedge clk);
      value = r_data;
      if (^value === 1'bx || r_resp != 2'd0) fault("a register cannot be read");
      @(posedge clk);
    end
  endtask

  integer limit;
  task job;
    begin
      for (line = 0; line < LINES * BEATS; line = line + 1) destination_beats[line] = {BUS{1'bx}};
      written = 0;
      write_register(12'h10, SOURCE[31:0]);
      write_register(12'h14, SOURCE[63:32]);
      write_register(12'h18, DESTINATION[31:0]);
      write_register(12'h1c, DESTINATION[63:32]);
      write_register(12'h20, count);
      write_register(12'h24, LINES);
      write_register(12'h28, 32'd0);
      write_register(12'h2c, 32'd10000);
@OTHERS@
      write_register(12'h04, 32'd1);
      write_register(12'h08, 32'd1);
      write_register(12'h00, 32'd1);
      limit = cycles + 20 * count + 20000;
      while (!interrupt && cycles < limit) @(posedge clk);
      if (!interrupt) fault("no interrupt");
      write_register(12'h0c, 32'd1);
      if (interrupt) fault("the interrupt stays");
      read_register(12'h00);
      if (value[3:0] != 4'b1110) fault("control does not say that the job has ended");
      read_register(12'h00);
      if (value[3:0] != 4'b0100) fault("a read does not clear ap_done");
      for (line = 0; line < LINES; line = line + 1)
        for (at = 0; at < BEATS; at = at + 1)
          destination_lines[line][at*BUS +: BUS] = destination_beats[line*BEATS+at];
      read_register(12'h40);
      $display("status %h", value);
      if (is_own) begin
        if (value != 32'd2) fault("the job ended with an error");
        read_register(12'h50);
        if (value != 32'd@CONTACTS@) fault("another number of contacts");
        read_register(12'h54);
        if (value != 32'd@INVALID@) fault("another number of invalid @WHAT@");
        read_register(12'h58);
        if (value != 32'd@FIRST_INVALID@) fault("another first invalid number");
@CHECK_CANDIDATES@
        if (written != EXPECTED_LINES) fault("another number of lines");
        check_lines;
      end
    end
  endtask

@VERDICT@

  initial begin
@ARGUMENTS@
    if (!is_own && count != 32'd0) $readmemh(source_name, source_lines, 0, @LAST_LINE@);
    for (line = 0; line < LINES; line = line + 1)
      for (at = 0; at < BEATS; at = at + 1) source_beats[line*BEATS+at] = source_lines[line][at*BUS +: BUS];
    repeat (4) @(posedge clk);
    checked <= 1'b1;
    repeat (16) @(posedge clk);
    rst_n <= 1'b1;
    @(posedge clk);
    read_register(12'h90);
    $display("version %0d of the map", value);
    job;
    job;
@WRITE@
    if (faults == 0) $display("no fault");
    if (is_own) verdict;
    $finish;
  end
endmodule

`default_nettype wire
