//! The ports of the `spl2` shell.

use crate::afu::Spec;
use crate::afu::shell::spl2::{SplInputs, SplOutputs};
use crate::config::Config;
use crate::cosim::error::SimulationError;
use crate::cosim::instance::Instance;
use crate::cosim::port::Port;
use crate::link::Line;
use crate::link::spl2::{Receive, Receive0, Transmit};

/// The AFU's ports, fetched once.
#[derive(Debug)]
pub(super) struct Ports<'a> {
    inputs: SplInputs<Port<'a>>,
    outputs: SplOutputs<Port<'a>>,
}

fn bits(words: [u32; 4]) -> u128 {
    words.iter().rev().fold(0, |bits, &word| bits << 32 | u128::from(word))
}

impl<'a> Ports<'a> {
    pub(super) fn new(afu: &'a Instance) -> Result<Self, SimulationError> {
        // The widths are the same for every AFU.
        let spec = Spec::from(Config::default());
        Ok(Self {
            inputs: SplInputs::of(&spec).try_map(|port| afu.input(port.name, port.bits))?,
            outputs: SplOutputs::of(&spec).try_map(|port| afu.output(port.name, port.bits))?,
        })
    }

    pub(super) fn system_reset(&self, active: bool) {
        self.inputs.reset_n.set((!active).into());
        let SplInputs { spl_rx_intr_valid0, spl_rx_intr_valid1, spl_rx_umsg_valid, .. } = self.inputs;
        for never in [spl_rx_intr_valid0, spl_rx_intr_valid1, spl_rx_umsg_valid] {
            never.set(0);
        }
    }

    /// The AFU's outputs in this cycle.
    #[inline]
    pub(super) fn transmit(&self) -> Transmit {
        let afu = &self.outputs;
        Transmit {
            read: afu.afu_tx_rd_valid.is_high().then(|| bits(afu.afu_tx_rd_hdr.words())),
            write: afu.afu_tx_wr_valid.is_high().then(|| (bits(afu.afu_tx_wr_hdr.words()), afu.afu_tx_data.words())),
            interrupt: afu.afu_tx_intr_valid.is_high(),
        }
    }

    /// Sets the AFU's inputs in this cycle. Without a valid, headers and data keep their old values, which the AFU must
    /// ignore.
    #[inline]
    pub(super) fn receive(&self, receive: &Receive) {
        let spl = &self.inputs;
        spl.spl_enable.set(receive.enable.into());
        spl.spl_reset.set(receive.reset.into());
        spl.spl_tx_rd_almostfull.set(receive.read_almostfull.into());
        spl.spl_tx_wr_almostfull.set(receive.write_almostfull.into());
        let (mut read, mut write, mut config) = (false, false, false);
        match &receive.channel0 {
            None => {}
            Some(Receive0::Read { header, data }) => {
                read = true;
                spl.spl_rx_hdr0.set((*header).into());
                spl.spl_rx_data.set_words(data);
            }
            Some(Receive0::Write { header }) => {
                write = true;
                spl.spl_rx_hdr0.set((*header).into());
            }
            Some(Receive0::Config { header, value }) => {
                config = true;
                spl.spl_rx_hdr0.set((*header).into());
                let mut line: Line = spl.spl_rx_data.words();
                line[0] = *value;
                spl.spl_rx_data.set_words(&line);
            }
        }
        spl.spl_rx_rd_valid.set(read.into());
        spl.spl_rx_wr_valid0.set(write.into());
        spl.spl_rx_cfg_valid.set(config.into());
        spl.spl_rx_wr_valid1.set(receive.channel1.is_some().into());
        if let Some(header) = receive.channel1 {
            spl.spl_rx_hdr1.set(header.into());
        }
    }
}
