//! The ports of the `spl2` shell.

use crate::cosim::error::SimulationError;
use crate::cosim::instance::Instance;
use crate::cosim::port::{Port, Wide};
use crate::link::spl2::{Receive, Receive0, Transmit};

/// Bits of a transmit header.
const TX_HEADER_BITS: u32 = 99;
/// Bits of a receive header.
const RX_HEADER_BITS: u32 = 18;

/// The AFU's ports, fetched once.
#[derive(Debug)]
pub(super) struct Ports<'a> {
    reset_n: Port<'a>,
    spl_enable: Port<'a>,
    spl_reset: Port<'a>,
    rd_almostfull: Port<'a>,
    rd_valid: Port<'a>,
    rd_hdr: Wide<'a, 4>,
    wr_almostfull: Port<'a>,
    wr_valid: Port<'a>,
    intr_valid: Port<'a>,
    wr_hdr: Wide<'a, 4>,
    data: Wide<'a, 16>,
    rx_rd_valid: Port<'a>,
    rx_wr_valid0: Port<'a>,
    rx_cfg_valid: Port<'a>,
    rx_intr_valid0: Port<'a>,
    rx_umsg_valid: Port<'a>,
    rx_hdr0: Port<'a>,
    rx_data: Wide<'a, 16>,
    rx_wr_valid1: Port<'a>,
    rx_intr_valid1: Port<'a>,
    rx_hdr1: Port<'a>,
}

fn bits(words: [u32; 4]) -> u128 {
    words.iter().rev().fold(0, |bits, &word| bits << 32 | u128::from(word))
}

impl<'a> Ports<'a> {
    pub(super) fn new(afu: &'a Instance) -> Result<Self, SimulationError> {
        Ok(Self {
            reset_n: afu.input("reset_n", 1)?,
            spl_enable: afu.input("spl_enable", 1)?,
            spl_reset: afu.input("spl_reset", 1)?,
            rd_almostfull: afu.input("spl_tx_rd_almostfull", 1)?,
            rd_valid: afu.output("afu_tx_rd_valid", 1)?,
            rd_hdr: afu.wide_output_of("afu_tx_rd_hdr", TX_HEADER_BITS)?,
            wr_almostfull: afu.input("spl_tx_wr_almostfull", 1)?,
            wr_valid: afu.output("afu_tx_wr_valid", 1)?,
            intr_valid: afu.output("afu_tx_intr_valid", 1)?,
            wr_hdr: afu.wide_output_of("afu_tx_wr_hdr", TX_HEADER_BITS)?,
            data: afu.wide_output("afu_tx_data")?,
            rx_rd_valid: afu.input("spl_rx_rd_valid", 1)?,
            rx_wr_valid0: afu.input("spl_rx_wr_valid0", 1)?,
            rx_cfg_valid: afu.input("spl_rx_cfg_valid", 1)?,
            rx_intr_valid0: afu.input("spl_rx_intr_valid0", 1)?,
            rx_umsg_valid: afu.input("spl_rx_umsg_valid", 1)?,
            rx_hdr0: afu.input("spl_rx_hdr0", RX_HEADER_BITS)?,
            rx_data: afu.wide_input("spl_rx_data")?,
            rx_wr_valid1: afu.input("spl_rx_wr_valid1", 1)?,
            rx_intr_valid1: afu.input("spl_rx_intr_valid1", 1)?,
            rx_hdr1: afu.input("spl_rx_hdr1", RX_HEADER_BITS)?,
        })
    }

    pub(super) fn system_reset(&self, active: bool) {
        self.reset_n.set((!active).into());
        for never in [self.rx_intr_valid0, self.rx_intr_valid1, self.rx_umsg_valid] {
            never.set(0);
        }
    }

    /// What the AFU transmits in this cycle.
    #[inline]
    pub(super) fn transmit(&self) -> Transmit {
        Transmit {
            read: self.rd_valid.is_high().then(|| bits(self.rd_hdr.get())),
            write: self.wr_valid.is_high().then(|| (bits(self.wr_hdr.get()), self.data.get())),
            interrupt: self.intr_valid.is_high(),
        }
    }

    /// What the AFU receives in this cycle. Without a valid, headers and data keep what they had: nobody may look.
    #[inline]
    pub(super) fn receive(&self, receive: &Receive) {
        self.spl_enable.set(receive.enable.into());
        self.spl_reset.set(receive.reset.into());
        self.rd_almostfull.set(receive.read_almostfull.into());
        self.wr_almostfull.set(receive.write_almostfull.into());
        let (mut read, mut write, mut config) = (false, false, false);
        match &receive.channel0 {
            None => {}
            Some(Receive0::Read { header, data }) => {
                read = true;
                self.rx_hdr0.set((*header).into());
                self.rx_data.set(data);
            }
            Some(Receive0::Write { header }) => {
                write = true;
                self.rx_hdr0.set((*header).into());
            }
            Some(Receive0::Config { header, value }) => {
                config = true;
                self.rx_hdr0.set((*header).into());
                let mut line = self.rx_data.get();
                line[0] = *value;
                self.rx_data.set(&line);
            }
        }
        self.rx_rd_valid.set(read.into());
        self.rx_wr_valid0.set(write.into());
        self.rx_cfg_valid.set(config.into());
        self.rx_wr_valid1.set(receive.channel1.is_some().into());
        if let Some(header) = receive.channel1 {
            self.rx_hdr1.set(header.into());
        }
    }
}
