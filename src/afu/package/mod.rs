//! Packages of the generated folder for the tools of others: what FuseSoC, IP-XACT readers, Vitis and LiteX want beside
//! the Verilog.

mod ipxact;
mod litex;
mod vitis;

use std::fmt;

use super::Afu;
use crate::config::Shell;

/// A package.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Package {
    /// The FuseSoC core, which every folder has.
    Fusesoc,
    /// `component.xml` of IEEE 1685-2022, and a script that makes a Vitis kernel in Vivado.
    Ipxact,
    /// A module of LiteX.
    Litex,
}

impl fmt::Display for Package {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Fusesoc => "fusesoc",
            Self::Ipxact => "ipxact",
            Self::Litex => "litex",
        })
    }
}

/// A package is for another shell.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("package {package} of shell {shell}: only shell axi has buses that it can describe; use --shell axi")]
pub struct PackageError {
    package: Package,
    shell: Shell,
}

impl Package {
    /// Checks that an accelerator with this shell can have the package.
    ///
    /// # Errors
    /// Returns an error if the package is for another shell.
    pub fn check(self, shell: Shell) -> Result<(), PackageError> {
        match self == Self::Fusesoc || shell == Shell::Axi {
            true => Ok(()),
            false => Err(PackageError { package: self, shell }),
        }
    }

    /// The files of the package that a folder has only with it: path and text.
    pub(super) fn files(self, afu: &Afu) -> Vec<(String, String)> {
        let named = |name: &str| afu.spec().config.prefixed(name);
        match self {
            Self::Fusesoc => Vec::new(),
            Self::Ipxact => vec![
                ("component.xml".to_owned(), ipxact::component(afu)),
                ("package_xo.tcl".to_owned(), vitis::script(afu)),
            ],
            Self::Litex => vec![(named("contact_afu_litex.py"), litex::module(afu))],
        }
    }
}

/// The name of a port without its interface: `AWADDR` of `m_axi_gmem_awaddr`.
fn logical(port: &str, interface: &str) -> Option<String> {
    Some(port.strip_prefix(interface)?.strip_prefix('_')?.to_uppercase())
}
