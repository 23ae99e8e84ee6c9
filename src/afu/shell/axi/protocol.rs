//! The use of the ports, for PORTS.md.

use super::burst;
use crate::afu::Afu;

/// The protocol, with its timing.
pub(super) fn protocol(afu: &Afu) -> String {
    let spec = afu.spec();
    let (bus, number) = (spec.config.bus, burst::beats(spec));
    let beats = if number == 1 { "one beat".to_owned() } else { format!("{number} beats") };
    let (lines, outstanding) = (burst::most_lines(spec), spec.max_outstanding);
    format!(
        "
## Sampling

Everything is sampled at the rising edge of `ap_clk`, at the end of its cycle. So is `ap_rst_n`, which is held low for at
least 16 cycles; the valid signals are low from the second cycle on. The table has the levels in reset. Reset the interconnect together with the
accelerator: AXI has no way to take back what was asked for.

## The master `m_axi_gmem`

- A line of 64 bytes is {beats} of {bus} bits. Lines that follow each other are merged into INCR bursts of up to {lines} lines
  ({} beats). No burst crosses 4 KB. A burst starts at the address of a line, and has whole lines.
- A valid signal, with all that belongs to it, stays as it is until its ready, during an abort and a soft reset too.
- The data of a write burst are all there before its address is put out. W does not wait for AWREADY.
- `m_axi_gmem_rready` and `m_axi_gmem_bready` are always 1. At most {outstanding} lines are outstanding each way.
- There is one ID, 0. The core uses lines in order, so data that overtook others would only wait in the core; with one
  ID they wait in the interconnect, which needs no logic to sort them, and beats of bursts do not mix.
- Byte i of a line is bits 8·i+7 to 8·i of the line; beat k has bytes {}·k and above, as little-endian memory has them.
- AxCACHE is 3: memory is not cached for the accelerator. AxPROT is 0. Strobes are all ones.

A read of two beats, the first of which memory holds back, and a write of two beats. Memory may take as long as it likes
between the parts of each.

```text
cycle                 c  c+1  c+2  c+3  c+4  c+5
m_axi_gmem_arvalid  ____ #### #### ____ ____ ____
m_axi_gmem_arready  ____ ____ #### ____ ____ ____
m_axi_gmem_araddr   .... AAAA AAAA .... .... ....
m_axi_gmem_rvalid   ____ ____ ____ ____ #### ####
m_axi_gmem_rready   #### #### #### #### #### ####
m_axi_gmem_rdata    .... .... .... .... DDD0 DDD1
m_axi_gmem_rlast    .... .... .... .... ____ ####

m_axi_gmem_awvalid  ____ #### #### #### ____ ____
m_axi_gmem_awready  ____ ____ ____ #### ____ ____
m_axi_gmem_wvalid   ____ ____ #### #### #### ____
m_axi_gmem_wready   ____ ____ #### ____ #### ____
m_axi_gmem_wdata    .... .... DDD0 DDD1 DDD1 ....
m_axi_gmem_wlast    ____ ____ ____ #### #### ____
m_axi_gmem_bvalid   ____ ____ ____ ____ ____ ####
m_axi_gmem_bready   #### #### #### #### #### ####
```

## The slave `s_axi_control`

Address and data of a write may come in any order. One write and one read are handled at a time. Registers, the steps of a
job and the interrupt are in REGISTERS.md; `contact_afu_regs.h` has the same for C.

A write and a read, each with its response two cycles after the last that it waits for:

```text
cycle                    c  c+1  c+2  c+3
s_axi_control_awvalid  #### ____ ____ ____
s_axi_control_awready  #### ____ #### ####
s_axi_control_wvalid   #### ____ ____ ____
s_axi_control_wready   #### ____ #### ####
s_axi_control_bvalid   ____ ____ #### ____
s_axi_control_bready   #### #### #### ####

s_axi_control_arvalid  #### ____ ____ ____
s_axi_control_arready  #### ____ ____ ####
s_axi_control_rvalid   ____ ____ #### ____
s_axi_control_rready   #### #### #### ####
```
",
        lines * number,
        bus / 8,
    )
}
