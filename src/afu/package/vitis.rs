//! The script that packages the accelerator as a Vitis kernel.

use std::fmt::Write as _;

use super::super::Afu;
use super::super::shell::axi::map::{self, Access, registers};

/// The text of package_xo.tcl.
pub(super) fn script(afu: &Afu) -> String {
    let (top, list) = (afu.top_name(), super::super::file_list(&afu.spec().config));
    let mut out = format!(
        "# SPDX-License-Identifier: MIT OR Apache-2.0
# Packages {top} as a Vitis RTL kernel, {top}.xo, in the folder in which Vivado runs:
#
#   vivado -mode batch -source FOLDER/package_xo.tcl
#
# UNTESTED: no Vivado has run this script. It follows UG1393 and Xilinx's own examples of RTL kernels.
#
# {}

set source_folder [file dirname [file normalize [info script]]]
set packaged_folder [file normalize ./{top}_ip]

create_project -force -in_memory {top}_packager
set list [open [file join $source_folder {list}]]
foreach line [split [read $list] \\n] {{
  if {{$line ne \"\" && ![string match \"//*\" $line]}} {{ add_files -norecurse [file join $source_folder $line] }}
}}
close $list
set_property top {top} [current_fileset]
update_compile_order -fileset sources_1

ipx::package_project -root_dir $packaged_folder -vendor contact-afu -library afu -name {top} -version 1.0 \\
  -taxonomy /UserIP -import_files -force
set core [ipx::current_core]
set_property sdx_kernel true $core
set_property sdx_kernel_type rtl $core
set_property vitis_drc {{ctrl_protocol ap_ctrl_hs}} $core
set_property ipi_drc {{ignore_freq_hz true}} $core
ipx::associate_bus_interfaces -busif m_axi_gmem -clock ap_clk $core
ipx::associate_bus_interfaces -busif s_axi_control -clock ap_clk $core

# The registers of ap_ctrl_hs, and the arguments. What the kernel only reports is not an argument: a host reads it by
# its offset in REGISTERS.md.
set map [ipx::get_memory_maps s_axi_control -of_objects $core]
if {{$map eq \"\"}} {{
  set map [ipx::add_memory_map s_axi_control $core]
  set_property slave_memory_map_ref s_axi_control [ipx::get_bus_interfaces s_axi_control -of_objects $core]
}}
set block [lindex [ipx::get_address_blocks -of_objects $map] 0]
if {{$block eq \"\"}} {{ set block [ipx::add_address_block registers $map] }}
proc kernel_register {{block name offset bits {{master \"\"}}}} {{
  set register [ipx::add_register $name $block]
  set_property address_offset $offset $register
  set_property size $bits $register
  if {{$master ne \"\"}} {{
    set_property value $master [ipx::add_register_parameter ASSOCIATED_BUSIF $register]
  }}
}}
",
        afu.origin(),
    );
    let control = [
        (map::CONTROL, "CTRL"),
        (map::GLOBAL_INTERRUPT_ENABLE, "GIER"),
        (map::INTERRUPT_ENABLE, "IP_IER"),
        (map::INTERRUPT_STATUS, "IP_ISR"),
    ];
    for (register, name) in control {
        let _ = writeln!(out, "kernel_register $block {name} {:#05x} 32", register.offset);
    }
    let is_argument = |register: &map::Register| {
        (map::SOURCE.offset..map::STATUS.offset).contains(&register.offset) && register.access == Access::ReadWrite
    };
    for register in registers(afu.spec().config.input).filter(is_argument) {
        let master = if register.words > 1 { " m_axi_gmem" } else { "" };
        let _ = writeln!(
            out,
            "kernel_register $block {} {:#05x} {}{master}",
            register.name,
            register.offset,
            32 * register.words
        );
    }
    out + &format!(
        "
ipx::create_xgui_files $core
ipx::update_checksums $core
ipx::check_integrity -kernel $core
ipx::save_core $core
package_xo -force -xo_path {top}.xo -kernel_name {top} -ip_directory $packaged_folder -ctrl_protocol ap_ctrl_hs
"
    )
}
