//! The transport for boards: a driver with no more than `host::Device` asks runs whole sessions. Here the driver's
//! device is the Verilated shell, its registers and its memory.

use std::cell::RefCell;
use std::io;
use std::ops::Range;
use std::time::Duration;

use contact_afu::cosim::axi::Machine;
use contact_afu::host::{Device, Expected, Hardware, HostError, Session, Workspace};
use contact_afu::link::axi::Handshake;
use contact_afu::link::{Line, LinkModel};

use crate::bench::{Case, config, machine, model};

pub const BUFFER: Range<u64> = 0x3F90_1000..0x3F94_1000;
/// Cycles in a nap.
const NAP: u64 = 100;

/// A driver.
#[derive(Debug)]
pub struct Board<'a> {
    pub machine: RefCell<Machine<'a>>,
    pub waits: u32,
    /// True if the registers do not answer.
    pub is_gone: bool,
}

impl Device for Board<'_> {
    fn read_register(&self, offset: u32) -> io::Result<u32> {
        if self.is_gone {
            return Err(io::Error::other("no such device"));
        }
        self.machine.borrow_mut().read_register(offset).map_err(io::Error::other)
    }

    fn write_register(&mut self, offset: u32, value: u32) -> io::Result<()> {
        self.machine.get_mut().write_register(offset, value).map_err(io::Error::other)
    }

    fn buffer(&self) -> Range<u64> {
        BUFFER
    }

    fn read_line(&self, offset: u64) -> Line {
        let at = (BUFFER.start + offset) / 64;
        self.machine.borrow().memory().link().memory.get(at).copied().unwrap_or_default()
    }

    fn write_line(&mut self, offset: u64, line: &Line) {
        self.machine.get_mut().memory_mut().link_mut().memory.set((BUFFER.start + offset) / 64, line);
    }

    fn wait(&mut self, _at_most: Duration) -> io::Result<()> {
        self.waits += 1;
        self.machine.get_mut().advance(NAP).map_err(io::Error::other)
    }
}

#[test]
fn a_driver_of_six_methods_runs_sessions() {
    let config = config(2, 128);
    let model = model(&config);
    let afu = model.instance(3).unwrap();
    let board = Board { machine: RefCell::new(machine(&afu, "hostile", Handshake::Free, 3)), waits: 0, is_gone: false };
    let expected = Expected::new(&config).unwrap();
    let workspace = Workspace::in_buffer(expected.layout, BUFFER).unwrap();
    let hardware = Hardware::new(board, LinkModel::hostile(), 200.0);
    let mut session = Session::new(hardware, workspace, expected);
    for (count, seed) in [(301, 4), (1, 5), (2000, 6)] {
        let case = Case::random(count, seed);
        let ended =
            session.transaction().send(&case.pairs).unwrap().start().unwrap().confirm().unwrap().wait().unwrap();
        case.check(&ended.outcome(), &format!("{count} pairs"));
    }
    assert!(session.transport().device().waits > 10, "{} waits", session.transport().device().waits);
    // More than the buffer holds is refused before anything is written; a line outside it is nobody's.
    let refused = session.transaction().send(&Case::random(4200, 7).pairs).unwrap_err();
    assert!(matches!(refused, HostError::TooManyPairs { .. }), "{refused}");
    assert_eq!(contact_afu::host::Transport::line(session.transport(), BUFFER.end / 64), None);
}

/// The system's error comes with the register, and a host does not wait for a device that is gone.
#[test]
fn an_error_of_the_system_ends_a_session() {
    let config = config(2, 128);
    let model = model(&config);
    let afu = model.instance(3).unwrap();
    let board = Board { machine: RefCell::new(machine(&afu, "ideal", Handshake::Free, 3)), waits: 0, is_gone: true };
    let expected = Expected::new(&config).unwrap();
    let workspace = Workspace::in_buffer(expected.layout, BUFFER).unwrap();
    let mut session = Session::new(Hardware::new(board, LinkModel::ideal(), 200.0), workspace, expected);
    let error = session.transaction().send(&Case::random(1, 1).pairs).unwrap_err().to_string();
    assert_eq!(error, "the device: reading register 0xa0: no such device");
}
