//! Transactions: every wrong use, every state dropped, and the Verilated AFU compared with its model in software.

mod meddle;
mod software;
mod verilated;

use std::sync::LazyLock;

use contact_afu::config::{Config, Shell};
use contact_afu::host::{Expected, Session, Software, Transport, Workspace};
use contact_afu::kernel::Reference;
use contact_afu::link::LinkModel;
use contact_afu::pairs::Set;
use contact_afu::query::{ContactRecord, PairRecord};

fn config() -> Config {
    Config { shell: Shell::Spl2, ..Config::default() }
}

fn expected() -> Expected {
    static EXPECTED: LazyLock<Expected> = LazyLock::new(|| Expected::new(&config()).unwrap());
    *EXPECTED
}

fn session<T: Transport>(device: T, pages: u64) -> Session<T> {
    Session::new(device, Workspace::new(expected().layout, pages, 7).unwrap(), expected())
}

fn software() -> Software {
    Software::new(&config(), LinkModel::ideal()).unwrap()
}

/// Pairs of every flow, including invalid ones.
fn pairs(count: u64) -> Vec<PairRecord> {
    Set::Random(count).pairs(5)
}

fn contacts(pairs: &[PairRecord]) -> Vec<ContactRecord> {
    Reference::new(config().profile.format(), config().contact).run_all(pairs)
}
