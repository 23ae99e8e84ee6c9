//! The words of the HARP v1 port: headers, types, and the fields of `mdata`.

use crate::hdl::{Graph, Signal};

/// Bits of a transmit header.
pub(super) const TX_HEADER_BITS: u32 = 99;
/// Bits of a receive header.
pub(super) const RX_HEADER_BITS: u32 = 18;
/// Bits of `mdata`; SPL uses the uppermost.
pub(super) const MDATA_BITS: u32 = 14;
/// Bits of `mdata` below the one that separates the shell's own requests from the core's.
pub(super) const NUMBER_BITS: u32 = 12;
/// Bits of the shell's epoch, whose low part is the core's.
pub(super) const SHELL_EPOCH_BITS: u32 = 6;

/// Types of requests.
#[derive(Clone, Copy)]
pub(super) enum Request {
    WriteLine = 2,
    Read = 4,
    WriteFence = 5,
}

/// A transmit header for one line: lines 98:93, address 92:67 and 45:14, virtual 66, type 55:52, mdata 13:0.
pub(super) fn header<'g>(
    graph: &'g Graph,
    request: Signal<'g>,
    is_virtual: Signal<'g>,
    address: Signal<'g>,
    mdata: Signal<'g>,
) -> Signal<'g> {
    let constant = |width, value| graph.constant(width, value);
    Signal::join(&[
        constant(6, 1),
        address.drop_low(32),
        is_virtual,
        constant(10, 0),
        request,
        constant(6, 0),
        address.low(32),
        mdata,
    ])
}

/// A type as its four bits.
pub(super) fn kind(graph: &Graph, request: Request) -> Signal<'_> {
    graph.constant(4, request as u128)
}

/// `mdata` of one of the shell's own requests.
pub(super) fn own_mdata<'g>(graph: &'g Graph, number: Signal<'g>) -> Signal<'g> {
    graph.constant(2, 0b01).concat(number)
}

/// `mdata` of one of the core's requests: the shell's epoch, and the slot that is the low part of the core's tag.
pub(super) fn core_mdata<'g>(epoch: Signal<'g>, slot: Signal<'g>) -> Signal<'g> {
    epoch.concat(slot).extend(MDATA_BITS)
}

/// True if a response's `mdata` belongs to a request of the core in this epoch.
pub(super) fn is_core_s<'g>(mdata: Signal<'g>, epoch: Signal<'g>, slot_bits: u32) -> Signal<'g> {
    let above = slot_bits + SHELL_EPOCH_BITS;
    mdata.slice(above, MDATA_BITS - above).is_zero() & mdata.slice(slot_bits, SHELL_EPOCH_BITS).equals(epoch)
}

/// True if a response's `mdata` belongs to the shell's own request of this number.
pub(super) fn is_own<'g>(mdata: Signal<'g>, number: Signal<'g>) -> Signal<'g> {
    mdata.drop_low(NUMBER_BITS).is(0b01) & mdata.low(NUMBER_BITS).equals(number)
}
