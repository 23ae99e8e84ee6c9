//! Headers, and the signals of the port in a cycle.

use crate::link::Line;

/// The fields of a transmit header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// Lines, bits 98:93.
    pub lines: u32,
    /// Line address, bits 92:67 above bits 45:14.
    pub line: u64,
    /// Bit 66: virtual or physical.
    pub is_virtual: bool,
    /// Type, bits 55:52.
    pub kind: u32,
    /// Mdata, bits 13:0.
    pub mdata: u16,
    /// True if an unused bit is set.
    pub rest: bool,
}

impl Header {
    /// WrThru.
    pub(crate) const WRITE_THROUGH: u32 = 1;
    /// WrLine.
    pub(crate) const WRITE_LINE: u32 = 2;
    /// Rd.
    pub(crate) const READ: u32 = 4;
    /// WrFence.
    pub(crate) const WRITE_FENCE: u32 = 5;

    /// The header in the low 99 bits.
    pub fn from_bits(bits: u128) -> Self {
        let part = |low: u32, width: u32| (bits >> low) as u64 & ((1 << width) - 1);
        Self {
            lines: part(93, 6) as u32,
            line: part(67, 26) << 32 | part(14, 32),
            is_virtual: part(66, 1) == 1,
            kind: part(52, 4) as u32,
            mdata: part(0, 14) as u16,
            rest: part(56, 10) != 0 || part(46, 6) != 0 || bits >> 99 != 0,
        }
    }
}

/// The outputs of the AFU in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Transmit {
    /// A read's header.
    pub read: Option<u128>,
    /// A write's header and data.
    pub write: Option<(u128, Line)>,
    /// An interrupt.
    pub interrupt: bool,
}

/// The kinds of messages on receive channel 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Receive0 {
    /// A read's data.
    Read {
        /// 18 bits.
        header: u32,
        /// The line.
        data: Line,
    },
    /// A write's acknowledgement.
    Write {
        /// 18 bits.
        header: u32,
    },
    /// A CSR write.
    Config {
        /// 18 bits: the byte offset / 4 below the type.
        header: u32,
        /// The register's value.
        value: u32,
    },
}

/// The receive header that acknowledges a write.
pub(super) fn write_response(mdata: u16) -> u32 {
    1 << 14 | u32::from(mdata)
}

/// The receive header that comes with a read's data.
pub(super) fn read_response(mdata: u16) -> u32 {
    4 << 14 | u32::from(mdata)
}

/// The inputs of the AFU in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Receive {
    /// `spl_enable`.
    pub enable: bool,
    /// `spl_reset`.
    pub reset: bool,
    /// `spl_tx_rd_almostfull`.
    pub read_almostfull: bool,
    /// `spl_tx_wr_almostfull`.
    pub write_almostfull: bool,
    /// Channel 0.
    pub channel0: Option<Receive0>,
    /// Channel 1: the header of a write's acknowledgement.
    pub channel1: Option<u32>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_is_taken_apart() {
        let bits = 1 << 93 | 0x2AA_BBCC << 67 | 1 << 66 | 4 << 52 | 0x1234_5678 << 14 | 0x1FFF;
        let header = Header::from_bits(bits);
        let line = 0x2AA_BBCC << 32 | 0x1234_5678;
        assert_eq!(header, Header { lines: 1, line, is_virtual: true, kind: 4, mdata: 0x1FFF, rest: false });
        assert!(Header::from_bits(bits | 1 << 60).rest && Header::from_bits(bits | 1 << 50).rest);
    }
}
