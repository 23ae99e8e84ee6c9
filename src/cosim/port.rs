//! Ports as memory: an address fetched once, then plain reads and writes.

use std::cell::Cell;

/// A port of up to 64 bits. It borrows its [`Instance`](super::Instance).
#[derive(Clone, Copy, Debug)]
pub struct Port<'a> {
    memory: Memory<'a>,
    mask: u64,
}

/// Verilator keeps a scalar in the smallest unsigned integer that holds it.
#[derive(Clone, Copy, Debug)]
enum Memory<'a> {
    U8(&'a Cell<u8>),
    U16(&'a Cell<u16>),
    U32(&'a Cell<u32>),
    U64(&'a Cell<u64>),
}

impl<'a> Port<'a> {
    /// # Safety
    /// `address` is that of a Verilated scalar of `bits` (1 to 64) bits, valid for 'a and used by one thread.
    pub(super) unsafe fn new(address: *mut std::ffi::c_void, bits: u32) -> Self {
        // SAFETY: the caller's promise, and Verilator's sizes of scalars (CData, SData, IData, QData).
        let memory = unsafe {
            match bits {
                0..=8 => Memory::U8(&*address.cast()),
                9..=16 => Memory::U16(&*address.cast()),
                17..=32 => Memory::U32(&*address.cast()),
                _ => Memory::U64(&*address.cast()),
            }
        };
        Self { memory, mask: u64::MAX >> (64 - bits.clamp(1, 64)) }
    }

    /// The port's value.
    #[inline]
    pub fn get(self) -> u64 {
        match self.memory {
            Memory::U8(cell) => cell.get().into(),
            Memory::U16(cell) => cell.get().into(),
            Memory::U32(cell) => cell.get().into(),
            Memory::U64(cell) => cell.get(),
        }
    }

    /// Whether any bit is set.
    #[inline]
    pub fn is_high(self) -> bool {
        self.get() != 0
    }

    /// Sets the port, for the next evaluation, to the low bits of `value`.
    #[inline]
    pub fn set(self, value: u64) {
        let value = value & self.mask;
        match self.memory {
            Memory::U8(cell) => cell.set(value as u8),
            Memory::U16(cell) => cell.set(value as u16),
            Memory::U32(cell) => cell.set(value as u32),
            Memory::U64(cell) => cell.set(value),
        }
    }
}

/// A port of `WORDS` times 32 bits, the least significant word first. It borrows its [`Instance`](super::Instance).
#[derive(Clone, Copy, Debug)]
pub struct Wide<'a, const WORDS: usize> {
    words: &'a Cell<[u32; WORDS]>,
}

impl<const WORDS: usize> Wide<'_, WORDS> {
    /// # Safety
    /// `address` is that of a Verilated vector of `WORDS` words, valid for its lifetime and used by one thread.
    pub(super) unsafe fn new(address: *mut std::ffi::c_void) -> Self {
        // SAFETY: the caller's promise; VlWide is an array of 32-bit words.
        Self { words: unsafe { &*address.cast() } }
    }

    /// The port's value.
    #[inline]
    pub fn get(self) -> [u32; WORDS] {
        self.words.get()
    }

    /// Sets the port for the next evaluation.
    #[inline]
    pub fn set(self, words: &[u32; WORDS]) {
        self.words.set(*words);
    }
}
