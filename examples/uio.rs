//! A driver for a board under Linux: the registers of the shell `axi` through a UIO device, and a buffer of udmabuf.
//!
//! **It is compiled and was never run on a board.** It needs `/dev/uioN` with the registers as map 0 and the interrupt,
//! and a udmabuf whose memory the master can reach:
//!
//! ```text
//! cargo run --example uio -- /dev/uio0 /dev/udmabuf0 build/manifest.json
//! ```
//!
//! The manifest is that of the folder that `afu rtl --shell axi` wrote. The udmabuf is opened with O_SYNC, so the
//! mapping is not cached, and nothing has to be flushed.

#[cfg(target_os = "linux")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    linux::main()
}

#[cfg(not(target_os = "linux"))]
fn main() {
    eprintln!("uio: UIO and udmabuf are Linux's");
}

#[cfg(target_os = "linux")]
mod linux {
    use std::fs::{self, File, OpenOptions};
    use std::io::{self, Read as _, Write as _};
    use std::num::NonZeroUsize;
    use std::ops::Range;
    use std::os::fd::AsFd as _;
    use std::os::unix::fs::OpenOptionsExt as _;
    use std::path::Path;
    use std::ptr::NonNull;
    use std::sync::atomic::{Ordering, fence};
    use std::time::Duration;

    use contact_afu::host::{Device, Expected, Hardware, Session, Workspace};
    use contact_afu::link::{Line, LinkModel};
    use contact_afu::query::PairRecord;
    use nix::libc::O_SYNC;
    use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
    use nix::sys::mman::{MapFlags, ProtFlags, mmap, munmap};

    /// Bytes of the registers' page.
    const REGISTERS: usize = 4096;

    /// Memory of a device, mapped. All accesses are volatile, and within its length.
    struct Mapped {
        start: NonNull<u32>,
        bytes: usize,
    }

    impl Mapped {
        fn new(file: &File, bytes: usize) -> io::Result<Self> {
            let length = NonZeroUsize::new(bytes).ok_or(io::ErrorKind::InvalidInput)?;
            let access = ProtFlags::PROT_READ | ProtFlags::PROT_WRITE;
            // SAFETY: a new mapping, which nothing else refers to. It is unmapped when this is dropped.
            let start = unsafe { mmap(None, length, access, MapFlags::MAP_SHARED, file, 0) }?;
            Ok(Self { start: start.cast(), bytes })
        }

        fn word(&self, offset: usize) -> NonNull<u32> {
            assert!(offset.is_multiple_of(4) && offset + 4 <= self.bytes, "offset {offset:#x} of {:#x}", self.bytes);
            // SAFETY: within the mapping, as checked; a mapping begins with a page, so words are aligned.
            unsafe { self.start.byte_add(offset) }
        }

        fn read(&self, offset: usize) -> u32 {
            // SAFETY: `word` is a word of the mapping.
            unsafe { self.word(offset).read_volatile() }
        }

        fn write(&mut self, offset: usize, value: u32) {
            // SAFETY: `word` is a word of the mapping.
            unsafe { self.word(offset).write_volatile(value) }
        }
    }

    impl Drop for Mapped {
        fn drop(&mut self) {
            // SAFETY: the mapping of `new`, which nobody uses any more.
            let _ = unsafe { munmap(self.start.cast(), self.bytes) };
        }
    }

    /// The accelerator and its buffer.
    struct Uio {
        interrupts: File,
        registers: Mapped,
        buffer: Mapped,
        /// The buffer's address, as the master puts it out.
        address: u64,
    }

    impl Uio {
        fn open(uio: &Path, udmabuf: &Path) -> io::Result<Self> {
            let interrupts = OpenOptions::new().read(true).write(true).open(uio)?;
            let registers = Mapped::new(&interrupts, REGISTERS)?;
            let name = udmabuf.file_name().unwrap_or_default();
            let attribute = |what: &str| fs::read_to_string(Path::new("/sys/class/u-dma-buf").join(name).join(what));
            let address = attribute("phys_addr")?;
            let address = u64::from_str_radix(address.trim().trim_start_matches("0x"), 16).map_err(io::Error::other)?;
            let bytes = attribute("size")?.trim().parse().map_err(io::Error::other)?;
            let memory = OpenOptions::new().read(true).write(true).custom_flags(O_SYNC).open(udmabuf)?;
            Ok(Self { registers, interrupts, buffer: Mapped::new(&memory, bytes)?, address })
        }
    }

    /// Orders accesses of memory and registers, for the master too. On Arm a fence of Rust orders them for CPUs alone:
    /// this is the barrier that Linux's drivers have.
    fn order() {
        #[cfg(target_arch = "aarch64")]
        // SAFETY: the instruction orders accesses and does nothing else.
        unsafe {
            std::arch::asm!("dmb osh", options(nostack, preserves_flags));
        }
        fence(Ordering::SeqCst);
    }

    impl Device for Uio {
        fn read_register(&self, offset: u32) -> io::Result<u32> {
            let value = self.registers.read(offset as usize);
            // Nothing is read from memory before the register that says it is there.
            order();
            Ok(value)
        }

        fn write_register(&mut self, offset: u32, value: u32) -> io::Result<()> {
            // What was written to memory is there before the register that starts its use.
            order();
            self.registers.write(offset as usize, value);
            Ok(())
        }

        fn buffer(&self) -> Range<u64> {
            self.address..self.address + self.buffer.bytes as u64
        }

        fn read_line(&self, offset: u64) -> Line {
            std::array::from_fn(|word| self.buffer.read(offset as usize + 4 * word))
        }

        fn write_line(&mut self, offset: u64, line: &Line) {
            for (number, word) in line.iter().enumerate() {
                self.buffer.write(offset as usize + 4 * number, *word);
            }
        }

        fn wait(&mut self, at_most: Duration) -> io::Result<()> {
            // UIO masks the interrupt when it came; a write of 1 lets the next one through.
            self.interrupts.write_all(&1_u32.to_ne_bytes())?;
            let milliseconds = u16::try_from(at_most.as_millis()).unwrap_or(u16::MAX).max(1);
            let mut waiting = [PollFd::new(self.interrupts.as_fd(), PollFlags::POLLIN)];
            if poll(&mut waiting, PollTimeout::from(milliseconds))? > 0 {
                self.interrupts.read_exact(&mut [0; 4])?;
            }
            Ok(())
        }
    }

    pub fn main() -> Result<(), Box<dyn std::error::Error>> {
        let arguments: Vec<String> = std::env::args().skip(1).collect();
        let [uio, udmabuf, manifest] = &arguments[..] else {
            return Err("usage: uio /dev/uioN /dev/udmabufN MANIFEST".into());
        };
        let config = contact_afu::config::read(Path::new(manifest))?;
        let device = Uio::open(Path::new(uio), Path::new(udmabuf))?;
        let expected = Expected::new(&config)?;
        let workspace = Workspace::in_buffer(expected.layout, device.buffer())?;
        let hardware = Hardware::new(device, LinkModel::ideal(), config.clock_mhz);
        let mut session = Session::new(hardware, workspace, expected);

        // The paper's seven steps, with two spheres that touch.
        let pairs = [PairRecord::from_spheres([0.0, 0.0, 0.0, 1.0], [1.5, 0.0, 0.0, 1.0])];
        let running = session.transaction().send(&pairs)?.start()?.confirm()?;
        let results = running.wait()?.retrieve()?.end()?;
        println!("{} contact, depth {}", results.hits, results.contacts[0].depth());
        Ok(())
    }
}
