//! The C ABI of `tb/harness.h`, with its function pointers checked once.

use std::ffi::{CStr, c_char, c_int};

/// Bindings of `tb/harness.h`, made by bindgen.
#[allow(non_camel_case_types, missing_docs, dead_code, clippy::all)]
pub(super) mod raw {
    include!(concat!(env!("OUT_DIR"), "/harness.rs"));
}

/// A model's functions. All of them are present, and of the ABI that this crate was built for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Api {
    pub trace: u32,
    pub rtl_sha256: &'static str,
    pub create: unsafe extern "C" fn(u64) -> *mut raw::afu_instance,
    pub destroy: unsafe extern "C" fn(*mut raw::afu_instance),
    pub ports: unsafe extern "C" fn(*mut raw::afu_instance, *mut u32) -> *const raw::afu_port,
    pub evaluate: unsafe extern "C" fn(*mut raw::afu_instance) -> c_int,
    pub clock: unsafe extern "C" fn(*mut raw::afu_instance, u32, u64) -> c_int,
    pub trace_open: unsafe extern "C" fn(*mut raw::afu_instance, *const c_char, u64) -> c_int,
    pub trace_close: unsafe extern "C" fn(*mut raw::afu_instance) -> c_int,
    pub error: unsafe extern "C" fn(*mut raw::afu_instance) -> *const c_char,
}

impl Api {
    /// Reads a model's table; `None` if it is of another ABI or incomplete.
    ///
    /// # Safety
    /// `table` is null or was returned by a model's `afu_model`, and that model is never unloaded.
    pub(super) unsafe fn read(table: *const raw::afu_table) -> Option<Self> {
        // SAFETY: as the caller promises. `abi` is the first field in every version of the ABI, and only it is read
        // before it is compared.
        unsafe {
            if table.is_null() || (*table).abi != raw::AFU_ABI {
                return None;
            }
            let table = &*table;
            Some(Self {
                trace: table.trace,
                rtl_sha256: CStr::from_ptr(table.rtl_sha256).to_str().ok()?,
                create: table.create?,
                destroy: table.destroy?,
                ports: table.ports?,
                evaluate: table.evaluate?,
                clock: table.clock?,
                trace_open: table.trace_open?,
                trace_close: table.trace_close?,
                error: table.error?,
            })
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_committed_bindings_are_what_bindgen_writes() {
        let made = include_str!(concat!(env!("OUT_DIR"), "/harness.rs"));
        assert_eq!(made, include_str!("../../tb/harness.rs"), "copy the new one from OUT_DIR to tb/harness.rs");
    }
}
