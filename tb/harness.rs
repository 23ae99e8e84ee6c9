pub const AFU_ABI: u32 = 2;
pub const AFU_INPUT: u32 = 0;
pub const AFU_OUTPUT: u32 = 1;
pub const AFU_TRACE_OFF: u32 = 0;
pub const AFU_TRACE_VCD: u32 = 1;
pub const AFU_TRACE_FST: u32 = 2;
pub const AFU_WAVEFORM: i32 = -2;
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct afu_port {
    pub name: *const ::std::os::raw::c_char,
    pub bits: u32,
    pub direction: u32,
    pub address: *mut ::std::os::raw::c_void,
}
#[repr(C)]
#[derive(Debug)]
pub struct afu_instance {
    _unused: [u8; 0],
}
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct afu_table {
    pub abi: u32,
    pub trace: u32,
    pub rtl_sha256: *const ::std::os::raw::c_char,
    pub create: ::std::option::Option<
        unsafe extern "C" fn(seed: u64) -> *mut afu_instance,
    >,
    pub destroy: ::std::option::Option<unsafe extern "C" fn(arg1: *mut afu_instance)>,
    pub ports: ::std::option::Option<
        unsafe extern "C" fn(arg1: *mut afu_instance, count: *mut u32) -> *const afu_port,
    >,
    pub evaluate: ::std::option::Option<
        unsafe extern "C" fn(arg1: *mut afu_instance) -> ::std::os::raw::c_int,
    >,
    pub clock: ::std::option::Option<
        unsafe extern "C" fn(
            arg1: *mut afu_instance,
            port: u32,
            cycles: u64,
        ) -> ::std::os::raw::c_int,
    >,
    pub trace_open: ::std::option::Option<
        unsafe extern "C" fn(
            arg1: *mut afu_instance,
            path: *const ::std::os::raw::c_char,
            half_period_ps: u64,
        ) -> ::std::os::raw::c_int,
    >,
    pub trace_close: ::std::option::Option<
        unsafe extern "C" fn(arg1: *mut afu_instance) -> ::std::os::raw::c_int,
    >,
    pub error: ::std::option::Option<
        unsafe extern "C" fn(arg1: *mut afu_instance) -> *const ::std::os::raw::c_char,
    >,
}
unsafe extern "C" {
    pub fn afu_model() -> *const afu_table;
}
