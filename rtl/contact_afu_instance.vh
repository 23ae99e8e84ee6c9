// Instantiation template.
afu_top #(
  .SCPUS(32'd10)
) u_afu_top (
  .clk                  (clk),
  .reset_n              (reset_n),
  .spl_enable           (spl_enable),
  .spl_reset            (spl_reset),
  .spl_tx_rd_almostfull (spl_tx_rd_almostfull),
  .spl_tx_wr_almostfull (spl_tx_wr_almostfull),
  .spl_rx_rd_valid      (spl_rx_rd_valid),
  .spl_rx_wr_valid0     (spl_rx_wr_valid0),
  .spl_rx_cfg_valid     (spl_rx_cfg_valid),
  .spl_rx_intr_valid0   (spl_rx_intr_valid0),
  .spl_rx_umsg_valid    (spl_rx_umsg_valid),
  .spl_rx_hdr0          (spl_rx_hdr0),
  .spl_rx_data          (spl_rx_data),
  .spl_rx_wr_valid1     (spl_rx_wr_valid1),
  .spl_rx_intr_valid1   (spl_rx_intr_valid1),
  .spl_rx_hdr1          (spl_rx_hdr1),
  .afu_tx_rd_valid      (afu_tx_rd_valid),
  .afu_tx_rd_hdr        (afu_tx_rd_hdr),
  .afu_tx_wr_valid      (afu_tx_wr_valid),
  .afu_tx_intr_valid    (afu_tx_intr_valid),
  .afu_tx_wr_hdr        (afu_tx_wr_hdr),
  .afu_tx_data          (afu_tx_data)
);
