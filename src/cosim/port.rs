//! Ports as memory: an address is fetched once, and then read and written directly.

use std::cell::Cell;
use std::slice;

/// A port. It borrows its [`Instance`](super::Instance).
#[derive(Clone, Copy, Debug)]
pub struct Port<'a> {
    memory: Memory<'a>,
    mask: u64,
}

/// Verilator keeps a port in the smallest unsigned integer that holds it. A port of more than 64 bits is in words of 32
/// bits, the least significant first.
#[derive(Clone, Copy, Debug)]
enum Memory<'a> {
    U8(&'a Cell<u8>),
    U16(&'a Cell<u16>),
    U32(&'a Cell<u32>),
    U64(&'a Cell<u64>),
    /// The words, and the number of bits in the last one.
    Words(&'a [Cell<u32>], u32),
}

impl<'a> Port<'a> {
    /// # Safety
    /// `address` belongs to a Verilated port of `bits` bits, is valid for 'a and is used by one thread.
    pub(super) unsafe fn new(address: *mut std::ffi::c_void, bits: u32) -> Self {
        // SAFETY: as the caller promises, with Verilator's types of ports (CData, SData, IData, QData, VlWide).
        let memory = unsafe {
            match bits {
                0..=8 => Memory::U8(&*address.cast()),
                9..=16 => Memory::U16(&*address.cast()),
                17..=32 => Memory::U32(&*address.cast()),
                33..=64 => Memory::U64(&*address.cast()),
                _ => {
                    let cells = slice::from_raw_parts(address.cast(), bits.div_ceil(32) as usize);
                    Memory::Words(cells, u32::MAX >> (31 - (bits - 1) % 32))
                }
            }
        };
        Self { memory, mask: u64::MAX >> (64 - bits.clamp(1, 64)) }
    }

    /// The port's value. Of a port with more than 64 bits, the low 64.
    #[inline]
    pub fn get(self) -> u64 {
        match self.memory {
            Memory::U8(cell) => cell.get().into(),
            Memory::U16(cell) => cell.get().into(),
            Memory::U32(cell) => cell.get().into(),
            Memory::U64(cell) => cell.get(),
            Memory::Words(..) => {
                let [low, high] = self.words();
                u64::from(high) << 32 | u64::from(low)
            }
        }
    }

    /// True if any bit is set.
    #[inline]
    pub fn is_high(self) -> bool {
        self.get() != 0
    }

    /// Sets the port, for the next evaluation, to the low bits of `value`.
    #[inline]
    pub fn set(self, value: u64) {
        let masked = value & self.mask;
        match self.memory {
            Memory::U8(cell) => cell.set(masked as u8),
            Memory::U16(cell) => cell.set(masked as u16),
            Memory::U32(cell) => cell.set(masked as u32),
            Memory::U64(cell) => cell.set(masked),
            Memory::Words(..) => self.set_words(&[value as u32, (value >> 32) as u32]),
        }
    }

    /// The port's value in words of 32 bits, the least significant first; zero beyond the port.
    #[inline]
    pub fn words<const WORDS: usize>(self) -> [u32; WORDS] {
        let mut words = [0; WORDS];
        match self.memory {
            Memory::Words(cells, _) => words.iter_mut().zip(cells).for_each(|(word, cell)| *word = cell.get()),
            _ => {
                let value = self.get();
                words.iter_mut().zip([value as u32, (value >> 32) as u32]).for_each(|(word, part)| *word = part);
            }
        }
        words
    }

    /// Sets the port, for the next evaluation, to words of 32 bits, the least significant first. Missing words are
    /// zero.
    #[inline]
    pub fn set_words(self, words: &[u32]) {
        let word = |index: usize| words.get(index).copied().unwrap_or(0);
        match self.memory {
            Memory::Words(cells, last) => {
                cells.iter().enumerate().for_each(|(index, cell)| cell.set(word(index)));
                cells.last().inspect(|cell| cell.set(cell.get() & last));
            }
            _ => self.set(u64::from(word(1)) << 32 | u64::from(word(0))),
        }
    }
}
