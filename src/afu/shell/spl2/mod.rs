//! The shell of Intel HARP v1, as in the paper: the core behind SPL2's port, with the handshake in memory.
//!
//! `registers` answers CSR writes and `sequence` runs jobs. `transmit` passes requests to SPL's ports, and
//! `acknowledge` returns write responses. [`map`] has the registers and lines, and `document` tells people about them.

mod acknowledge;
mod document;
pub mod map;
mod port;
mod registers;
mod sequence;
mod top;
mod transmit;
mod words;

use std::sync::Arc;

use super::{BenchText, ShellDesign};
use crate::afu::port::{Ports, clock};
use crate::afu::{Afu, Spec};
use crate::config::Input;
use crate::hdl::{BuildErrors, Module};
pub use document::{job, markdown};
pub(crate) use port::{SplInputs, SplOutputs};

/// The shell.
#[derive(Debug)]
pub(super) struct Spl2;

impl ShellDesign for Spl2 {
    fn top_name(&self) -> &'static str {
        top::NAME
    }

    fn top(&self, spec: &Spec, core: &Arc<Module>) -> Result<Arc<Module>, BuildErrors> {
        top::afu_top(spec, core)
    }

    fn ports(&self, spec: &Spec) -> Ports {
        let inputs = [clock()].into_iter().chain(SplInputs::of(spec).list()).collect();
        Ports { inputs, outputs: SplOutputs::of(spec).list() }
    }

    fn held(&self) -> Option<(&'static str, u128)> {
        Some(("reset_n", 0))
    }

    fn protocol(&self, _afu: &Afu) -> String {
        PROTOCOL.to_owned()
    }

    fn bench(&self, afu: &Afu) -> BenchText {
        // An AFU that takes spheres has a field more in its status.
        let candidates = match afu.spec().config.input {
            Input::Direct => "",
            Input::Spheres => {
                "        if (status[415:384] != 32'd@CANDIDATES@) fault(\"another number of candidates\");\n"
            }
        };
        let text = include_str!("bench.v").replace("@CHECK_CANDIDATES@\n", candidates);
        BenchText { text, first_line: map::DATA_LINE as usize }
    }

    fn files(&self, afu: &Afu) -> Vec<(String, String)> {
        let (title, input) = (format!("# Registers and lines of `{}`", afu.top_name()), afu.spec().config.input);
        vec![("REGISTERS.md".to_owned(), format!("{title}\n\n{}\n{}", markdown(input), job(input)))]
    }
}

/// How the ports are used.
const PROTOCOL: &str = "
## Sampling

Everything is sampled at the rising edge of `clk`, at the end of its cycle. So are `reset_n`, \
`spl_reset` and `spl_enable`; each reset needs at least one cycle. The table has the levels after a cycle with `reset_n` low.

- A request stands for one cycle and is taken in it. In the second cycle after almost-full rises, and while it stays high, there \
is none: at most two requests come once it is high. SPL has room for four.
- A header or data whose valid is low may have any level.
- Responses are taken in every cycle in which their valid is high.

```text
cycle                      c  c+1  c+2  c+3  c+4  c+5
spl_tx_rd_almostfull    ____ #### #### #### ____ ____
afu_tx_rd_valid         #### #### #### ____ ____ ____
```

Registers, lines in memory and the steps of a job are in REGISTERS.md.
";
