//! The accelerator as a component of IEEE 1685-2022 (IP-XACT), with the bus definitions that Xilinx's tools know.

use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};

use super::super::Afu;
use super::super::port::Declaration;
use super::super::shell::axi::map::{self, Access, CONTROL, Field, Register};
use super::logical;
use crate::config::Input;

type Xml = Writer<Vec<u8>>;

const NAMESPACE: &str = "http://www.accellera.org/XMLSchema/IPXACT/1685-2022";
/// The names of the interfaces, each the beginning of its ports' names.
const MASTER: &str = "m_axi_gmem";
const SLAVE: &str = "s_axi_control";
const CLOCK: &str = "ap_clk";
const RESET: &str = "ap_rst_n";
const INTERRUPT: &str = "interrupt";
/// The address space of the master, and the view and the file sets of the component.
const MEMORY: &str = "memory";
const RTL: &str = "rtl";
const CONSTRAINTS: &str = "constraints";

/// The text of component.xml.
pub(super) fn component(afu: &Afu) -> String {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    // A vector takes whatever is written.
    let _ = document(&mut xml, afu);
    String::from_utf8_lossy(&xml.into_inner()).into_owned() + "\n"
}

fn document(xml: &mut Xml, afu: &Afu) -> io::Result<()> {
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    // The command that made the file is in the description: a comment must not contain two hyphens.
    let note = " SPDX-License-Identifier: MIT OR Apache-2.0\n     Valid against the schema of IEEE 1685-2022. UNTESTED: no \
                Vivado has read this file;\n     package_xo.tcl packages the Verilog itself. ";
    xml.write_event(Event::Comment(BytesText::from_escaped(note)))?;
    let root = xml.create_element("ipxact:component").with_attribute(("xmlns:ipxact", NAMESPACE));
    root.write_inner_content(|xml| {
        let vlnv = afu.vlnv();
        for (name, value) in ["vendor", "library", "name", "version"].into_iter().zip(vlnv.split(':')) {
            text(xml, name, value)?;
        }
        let about = "Collision-detection accelerator behind an AXI4 master and an AXI4-Lite slave";
        text(xml, "description", &format!("{about}. {}", afu.origin()))?;
        group(xml, "busInterfaces", |xml| interfaces(xml, afu))?;
        group(xml, "addressSpaces", |xml| {
            group(xml, "addressSpace", |xml| {
                text(xml, "name", MEMORY)?;
                text(xml, "range", "'h10000000000000000")?;
                text(xml, "width", &afu.spec().config.bus.to_string())?;
                text(xml, "addressUnitBits", "8")
            })
        })?;
        group(xml, "memoryMaps", |xml| registers(xml, afu.spec().config.input))?;
        group(xml, "model", |xml| model(xml, afu))?;
        group(xml, "fileSets", |xml| file_sets(xml, afu))
    })?;
    Ok(())
}

/// An element with this content.
fn group(xml: &mut Xml, name: &str, content: impl FnOnce(&mut Xml) -> io::Result<()>) -> io::Result<()> {
    xml.create_element(format!("ipxact:{name}")).write_inner_content(content)?;
    Ok(())
}

/// An element with this text.
fn text(xml: &mut Xml, name: &str, text: &str) -> io::Result<()> {
    xml.create_element(format!("ipxact:{name}")).write_text_content(BytesText::new(text))?;
    Ok(())
}

/// A name with its value, as parameters have them.
fn parameter(xml: &mut Xml, name: &str, value: &str) -> io::Result<()> {
    let id = format!("{}_{}", name.to_lowercase(), value.to_lowercase().replace([':', '.'], "_"));
    xml.create_element("ipxact:parameter").with_attributes([("parameterId", id.as_str())]).write_inner_content(
        |xml| {
            text(xml, "name", name)?;
            text(
                xml,
                "value",
                &if value.bytes().all(|byte| byte.is_ascii_digit()) {
                    value.to_owned()
                } else {
                    format!("\"{value}\"")
                },
            )
        },
    )?;
    Ok(())
}

fn interfaces(xml: &mut Xml, afu: &Afu) -> io::Result<()> {
    let ports = afu.ports();
    let names: Vec<&str> = ports.inputs.iter().chain(&ports.outputs).map(|port| port.name).collect();
    let maps = |interface: &str| -> Vec<(String, String)> {
        names.iter().filter_map(|port| Some((logical(port, interface)?, (*port).to_owned()))).collect()
    };
    let one = |name: &str, port: &str| vec![(name.to_owned(), port.to_owned())];
    let buses = format!("{MASTER}:{SLAVE}");
    interface(xml, MASTER, ["interface", "aximm"], &maps(MASTER), Some(MEMORY), true, &[])?;
    interface(xml, SLAVE, ["interface", "aximm"], &maps(SLAVE), Some(SLAVE), false, &[])?;
    let clock = [("ASSOCIATED_BUSIF", buses.as_str()), ("ASSOCIATED_RESET", RESET)];
    interface(xml, CLOCK, ["signal", "clock"], &one("CLK", CLOCK), None, false, &clock)?;
    interface(xml, RESET, ["signal", "reset"], &one("RST", RESET), None, false, &[("POLARITY", "ACTIVE_LOW")])?;
    let interrupt = [("SENSITIVITY", "LEVEL_HIGH")];
    interface(xml, INTERRUPT, ["signal", "interrupt"], &one("INTERRUPT", INTERRUPT), None, true, &interrupt)
}

/// A bus interface of Xilinx' library `bus`, with its ports, what it reaches or what it holds, and its parameters.
fn interface(
    xml: &mut Xml,
    name: &str,
    [library, bus]: [&str; 2],
    ports: &[(String, String)],
    reference: Option<&str>,
    is_initiator: bool,
    parameters: &[(&str, &str)],
) -> io::Result<()> {
    let definition = |xml: &mut Xml, element: &str, name: &str| {
        let element = format!("ipxact:{element}");
        let vlnv = [("vendor", "xilinx.com"), ("library", library), ("name", name), ("version", "1.0")];
        xml.create_element(element).with_attributes(vlnv).write_empty().map(|_| ())
    };
    group(xml, "busInterface", |xml| {
        text(xml, "name", name)?;
        definition(xml, "busType", bus)?;
        group(xml, "abstractionTypes", |xml| {
            group(xml, "abstractionType", |xml| {
                definition(xml, "abstractionRef", &format!("{bus}_rtl"))?;
                group(xml, "portMaps", |xml| {
                    ports.iter().try_for_each(|(logical, physical)| {
                        group(xml, "portMap", |xml| {
                            group(xml, "logicalPort", |xml| text(xml, "name", logical))?;
                            group(xml, "physicalPort", |xml| text(xml, "name", physical))
                        })
                    })
                })
            })
        })?;
        let (mode, attribute) =
            if is_initiator { ("initiator", "addressSpaceRef") } else { ("target", "memoryMapRef") };
        let mode = xml.create_element(format!("ipxact:{mode}"));
        match reference {
            None => mode.write_empty()?,
            Some(reference) => mode.write_inner_content(|xml| {
                let element = xml.create_element(format!("ipxact:{attribute}"));
                element.with_attribute((attribute, reference)).write_empty().map(|_| ())
            })?,
        };
        if parameters.is_empty() {
            return Ok(());
        }
        group(xml, "parameters", |xml| parameters.iter().try_for_each(|(name, value)| parameter(xml, name, value)))
    })
}

/// The memory map of the slave: a register of 64 or 128 bits is words of 32 bits, as its bus sees them.
fn registers(xml: &mut Xml, input: Input) -> io::Result<()> {
    group(xml, "memoryMap", |xml| {
        text(xml, "name", SLAVE)?;
        group(xml, "addressBlock", |xml| {
            text(xml, "name", "registers")?;
            text(xml, "baseAddress", "0")?;
            text(xml, "range", "4096")?;
            text(xml, "width", "32")?;
            text(xml, "usage", "register")?;
            for register in map::registers(input) {
                for word in 0..register.words {
                    group(xml, "register", |xml| self::register(xml, &register, word))?;
                }
            }
            Ok(())
        })?;
        text(xml, "addressUnitBits", "8")
    })
}

fn register(xml: &mut Xml, register: &Register, word: u32) -> io::Result<()> {
    let Register { name, words, offset, access, meaning, fields, .. } = *register;
    let name = if words == 1 { name.to_owned() } else { format!("{name}_{word}") };
    text(xml, "name", &name)?;
    text(xml, "description", &meaning.replace('`', ""))?;
    text(xml, "addressOffset", &format!("'h{:x}", offset + 4 * word))?;
    text(xml, "size", "32")?;
    // What is written stays, except where the hardware has a say.
    let kept = access == Access::ReadWrite && fields.is_empty();
    text(xml, "volatile", if kept { "false" } else { "true" })?;
    let whole = [Field { low: 0, bits: 32, name: "value", meaning: "the value" }];
    let fields = if fields.is_empty() { &whole[..] } else { fields };
    fields.iter().try_for_each(|part| group(xml, "field", |xml| field(xml, register, part)))
}

fn field(xml: &mut Xml, register: &Register, field: &Field) -> io::Result<()> {
    text(xml, "name", field.name)?;
    text(xml, "description", &field.meaning.replace('`', ""))?;
    text(xml, "bitOffset", &field.low.to_string())?;
    text(xml, "bitWidth", &field.bits.to_string())?;
    // Of the control register software writes the start alone, and a read clears what ended.
    let is_start = field.low == 0;
    let is_control = *register == CONTROL;
    let is_read = register.access == Access::Read || (is_control && !is_start);
    let clears = is_control && (field.low == 1 || field.low == 3);
    group(xml, "fieldAccessPolicies", |xml| {
        group(xml, "fieldAccessPolicy", |xml| {
            text(xml, "access", if is_read { "read-only" } else { "read-write" })?;
            if register.access == Access::Toggle {
                text(xml, "modifiedWriteValue", "oneToToggle")?;
            }
            if clears {
                text(xml, "readAction", "clear")?;
            }
            Ok(())
        })
    })
}

fn model(xml: &mut Xml, afu: &Afu) -> io::Result<()> {
    group(xml, "views", |xml| {
        group(xml, "view", |xml| {
            text(xml, "name", RTL)?;
            text(xml, "envIdentifier", "verilogSource:any.tool:synthesis")?;
            text(xml, "componentInstantiationRef", RTL)
        })
    })?;
    group(xml, "instantiations", |xml| {
        group(xml, "componentInstantiation", |xml| {
            text(xml, "name", RTL)?;
            text(xml, "language", "Verilog")?;
            text(xml, "moduleName", &afu.top_name())?;
            // Behind deciders the number of SCPUs is fixed.
            if !afu.spec().config.has_deciders() {
                group(xml, "moduleParameters", |xml| parameter_scpus(xml, afu.spec().config.scpus))?;
            }
            [RTL, CONSTRAINTS]
                .into_iter()
                .try_for_each(|set| group(xml, "fileSetRef", |xml| text(xml, "localName", set)))
        })
    })?;
    let ports = afu.ports();
    group(xml, "ports", |xml| {
        let inputs = ports.inputs.iter().map(|port| (port, "in"));
        inputs
            .chain(ports.outputs.iter().map(|port| (port, "out")))
            .try_for_each(|(port, direction)| group(xml, "port", |xml| self::port(xml, port, direction)))
    })
}

fn parameter_scpus(xml: &mut Xml, scpus: u32) -> io::Result<()> {
    let attributes = [("parameterId", "SCPUS"), ("minimum", "1"), ("maximum", "64"), ("type", "int")];
    let attributes = attributes.into_iter().chain([("resolve", "user")]);
    xml.create_element("ipxact:moduleParameter").with_attributes(attributes).write_inner_content(|xml| {
        text(xml, "name", "SCPUS")?;
        text(xml, "value", &scpus.to_string())
    })?;
    Ok(())
}

fn port(xml: &mut Xml, port: &Declaration, direction: &str) -> io::Result<()> {
    text(xml, "name", port.name)?;
    text(xml, "description", &port.meaning)?;
    group(xml, "wire", |xml| {
        text(xml, "direction", direction)?;
        if port.bits == 1 {
            return Ok(());
        }
        group(xml, "vectors", |xml| {
            group(xml, "vector", |xml| {
                text(xml, "left", &(port.bits - 1).to_string())?;
                text(xml, "right", "0")
            })
        })
    })
}

fn file_sets(xml: &mut Xml, afu: &Afu) -> io::Result<()> {
    let verilog: Vec<String> = afu.verilog().into_iter().map(|(name, _)| name).collect();
    let constraints = [afu.spec().config.prefixed("contact_afu.xdc")];
    for (set, names) in [(RTL, &verilog[..]), (CONSTRAINTS, &constraints[..])] {
        group(xml, "fileSet", |xml| {
            text(xml, "name", set)?;
            names.iter().try_for_each(|name| {
                group(xml, "file", |xml| {
                    text(xml, "name", name)?;
                    if set == RTL {
                        return text(xml, "fileType", "verilogSource");
                    }
                    let kind = xml.create_element("ipxact:fileType").with_attribute(("user", "xdc"));
                    kind.write_text_content(BytesText::new("user")).map(|_| ())
                })
            })
        })?;
    }
    Ok(())
}
