#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Reads the register tables of cores on AXI with PeakRDL's SystemRDL compiler. REGISTERS.md and the C header must agree with it.

scripts/buses.sh calls this with the Python that has systemrdl-compiler. Differences are planted, too, and must be found.

FOVEATE   the program
"""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from systemrdl import RDLCompiler
from systemrdl.node import FieldNode, RegNode

FOVEATE = os.environ["FOVEATE"]
DESIGNS = {
    "preset raster": [],
    "means, 16 bits": ["frame={width=96,height=24,pixel_bits=16}", "render={irrelevant='mean',payload='raw'}", "spatial=[{feature='variance'}]"],
    "no thresholds": ["hardware.thresholds='constant'"],
}
# The words for access of the compiler, and those of the page.
ACCESS = {("r", None): "read", ("rw", None): "read, write", ("w", None): "write 1", ("rw", "woclr"): "read, write 1 to clear"}
# The differences that the check must find: file, text, and replacement.
CONTROLS = [
    ("REGISTERS.md", "| 0x100 | `edge_level`", "| 0x104 | `edge_level`"),
    ("REGISTERS.md", "| [1:1] | `wait` | read, write |", "| [1:1] | `wait` | read |"),
    ("REGISTERS.md", "| [7:7] | `frame_done` | read, write 1 to clear | 0x0 |", "| [7:7] | `frame_done` | read, write 1 to clear | 0x1 |"),
    ("software/foveate_registers.h", "#define FOVEATE_STATUS 0x024u", "#define FOVEATE_STATUS 0x028u"),
    ("software/foveate_registers.h", "#define FOVEATE_CONTROL_WAIT_SHIFT 1", "#define FOVEATE_CONTROL_WAIT_SHIFT 2"),
    ("software/foveate.rdl", "} skipped @ 0x03C;", "} skipped @ 0x044;"),
    ("software/foveate.rdl", "width[15:0]", "width[14:0]"),
    ("software/foveate.rdl", "} tick_rate @ 0x01C;", "} control2 @ 0x01C;"),
]


def rdl_fields(path):
    """Returns the fields that the compiler reads: register, field, address, bits, access, value after reset."""
    compiler = RDLCompiler()
    compiler.compile_file(str(path))
    fields = set()
    for register in compiler.elaborate().descendants():
        if not isinstance(register, RegNode):
            continue
        for field in register.children():
            assert isinstance(field, FieldNode)
            clears = field.get_property("onwrite")
            access = ACCESS[field.get_property("sw").name, clears and clears.name]
            place = (register.absolute_address, field.high, field.low)
            fields.add((register.inst_name, field.inst_name, *place, access, field.get_property("reset")))
    return fields


def page_fields(path):
    """Returns the fields of REGISTERS.md in the same form."""
    fields, register, address = set(), None, None
    for line in path.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) < 7 or not cells[3].startswith("`"):
            continue
        if cells[0]:
            address, register = int(cells[0], 16), cells[1].strip("`")
        high, low = map(int, cells[2].strip("[]").split(":"))
        fields.add((register, cells[3].strip("`"), address, high, low, cells[4], int(cells[5], 16) if cells[5] else None))
    return fields


def header_macros(path):
    """Returns the macros of the C header, as numbers."""
    matches = re.findall(r"^#define FOVEATE_(\w+) (?:0x([0-9A-F]+)u|(\d+))", path.read_text(), re.MULTILINE)
    return {name: int(hexadecimal, 16) if hexadecimal else int(decimal) for name, hexadecimal, decimal in matches}


def expected_macros(fields):
    """Returns the macros that the C header must have, without values other than constants."""
    expected = {}
    for register, field, address, high, low, _, _ in fields:
        name = register.upper() if field == "value" else f"{register}_{field}".upper()
        expected[register.upper()] = address
        expected[f"{name}_SHIFT"] = low
        expected[f"{name}_MASK"] = (1 << high + 1) - (1 << low)
    return expected


def differences(core):
    try:
        fields = rdl_fields(core / "software/foveate.rdl")
    except Exception as error:  # the compiler's own errors have no common class but this
        return [f"foveate.rdl is refused: {error}"]
    messages = [f"REGISTERS.md and foveate.rdl: {field}" for field in sorted(page_fields(core / "REGISTERS.md") ^ fields, key=str)]
    macros, expected = header_macros(core / "software/foveate_registers.h"), expected_macros(fields)
    values = {name for name in macros if name.endswith("_VALUE")}
    wrong_macros = [(name, value) for name, value in expected.items() if macros.get(name) != value]
    messages += [f"foveate_registers.h: {name} is {macros.get(name)}, expected {value}" for name, value in wrong_macros]
    messages += [f"foveate_registers.h: {name} is in no register" for name in macros.keys() - expected.keys() - values]
    resets = {(f"{r}_{f}" if f != "value" else r).upper() + "_VALUE": value for r, f, *_, value in fields}
    return messages + [f"foveate_registers.h: {name} is {macros[name]}" for name in values if resets.get(name) != macros[name]]


def main():
    failures = 0
    with tempfile.TemporaryDirectory() as temporary:
        for number, (name, keys) in enumerate(DESIGNS.items()):
            core = Path(temporary) / str(number)
            options = [part for key in ["hardware.interface='axi'", *keys] for part in ("--set", key)]
            subprocess.run([FOVEATE, "generate", "--preset", "raster", *options, "-o", core, "-q"], check=True)
            messages = differences(core)
            failures += len(messages)
            print(f"{name}: {len(page_fields(core / 'REGISTERS.md'))} fields, {messages or 'the compiler agrees'}", flush=True)
        core = Path(temporary) / "0"
        for file, original, replacement in CONTROLS:
            text = (core / file).read_text()
            assert text.count(original) == 1, f"{file}: `{original}` is there {text.count(original)} times"
            (core / file).write_text(text.replace(original, replacement))
            messages = differences(core)
            failures += not messages
            print(f"control: {file}: {'found' if messages else 'NOT FOUND'}: {replacement}", flush=True)
            (core / file).write_text(text)
    print(f"registers: {len(DESIGNS)} designs, {failures} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
