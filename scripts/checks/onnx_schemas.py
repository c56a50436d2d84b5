#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Compares crates/network/src/reader/schemas.txt with the schemas of the packages onnx and onnxruntime.

    onnx_schemas.py             ends with 1 and the differences if the file does not agree with the packages
    onnx_schemas.py --write     writes it

A line of the file is an operator from a version on: its name, the version, how many inputs and outputs it has (`2..3`; `1..` has no end),
and its attributes as name:type, followed by `!` if a node must have it, or by =value if there is a default of one number or word. Versions
that change none of it have no line, and neither have those that ONNX withdrew. The operators are those that `foveate` supports. Needs onnx,
and onnxruntime for operators of com.microsoft; without onnxruntime these lines are taken as they are.
"""
import argparse
import difflib
import pathlib
import re
import sys

import numpy
from onnx import AttributeProto, defs

ROOT = pathlib.Path(__file__).resolve().parents[2]
FILE = ROOT / "crates/network/src/reader/schemas.txt"
OPERATORS = ROOT / "crates/network/src/reader/operators.rs"
CONTRIB = "com.microsoft."
# The oldest version of ONNX's operators that is read.
OLDEST = 7


def supported_operators():
    """Returns the names of the supported operators, with their domain if it is not that of ONNX."""
    return re.findall(r'^    \("([A-Za-z0-9.]+)", ', OPERATORS.read_text(), flags=re.M)


def count_text(least, most):
    """Returns the number of inputs or outputs in the form of the file."""
    return f"{least}.." if most > 1 << 30 else f"{least}..{most}"


def default_text(kind, value):
    """Returns a default of one number or word in the form of the file; an empty text for others."""
    match kind:
        case "FLOAT":
            return "=" + str(numpy.float32(value.f))
        case "INT":
            return f"={value.i}"
        case "STRING":
            return f"={value.s.decode()}"
    return ""


def attribute_text(name, kind, is_required, value):
    """Returns an attribute in the form of the file; `value` is the message of its default."""
    end = "!" if is_required else default_text(kind, value) if value.type != AttributeProto.UNDEFINED else ""
    return f"{name}:{kind}{end}"


def versioned_line(name, schema, attributes):
    """Returns a line without its version, and the version."""
    words = [count_text(schema.min_input, schema.max_input), count_text(schema.min_output, schema.max_output), *attributes]
    return schema.since_version, f"{name} {{}} {' '.join(words)}"


def changed_lines(lines):
    """Returns the lines that differ from the one before by more than the version."""
    return [text.format(since) for index, (since, text) in enumerate(lines) if index == 0 or lines[index - 1][1] != text]


def onnx_lines(names):
    """Returns the lines of the operators of ONNX: for each the version in force at the oldest one, and all later ones."""
    lines = []
    history = [schema for schema in defs.get_all_schemas_with_history() if schema.domain == "" and not schema.deprecated]
    for name in names:
        versions = sorted((schema for schema in history if schema.name == name), key=lambda schema: schema.since_version)
        if not versions:
            sys.exit(f"onnx knows no operator {name}")
        first = max((schema.since_version for schema in versions if schema.since_version <= OLDEST), default=OLDEST)
        lines += changed_lines([standard_line(name, schema) for schema in versions if schema.since_version >= first])
    return lines


def runtime_lines(names, old_lines):
    """Returns the lines of the operators of onnxruntime."""
    try:
        from onnxruntime.capi.onnxruntime_pybind11_state import get_all_operator_schema
    except ImportError:
        print("onnxruntime is not installed: the operators of com.microsoft are not compared", file=sys.stderr)
        return [line for line in old_lines if line.startswith(CONTRIB)]
    schemas = {CONTRIB + schema.name: schema for schema in get_all_operator_schema() if schema.domain == CONTRIB[:-1]}
    return [text for name in names for text in changed_lines([runtime_line(name, schemas[name])])]


def standard_line(name, schema):
    """Returns the line of a schema of onnx."""
    attributes = [
        attribute_text(key, attribute.type.name, attribute.required, attribute.default_value) for key, attribute in sorted(schema.attributes.items())
    ]
    return versioned_line(name, schema, attributes)


def runtime_line(name, schema):
    """Returns the line of a schema of onnxruntime, whose defaults are bytes of a message."""
    attributes = []
    for key, attribute in sorted(schema.attributes.items()):
        value = AttributeProto()
        value.ParseFromString(attribute._default_value)
        attributes.append(attribute_text(key, str(attribute.type).rsplit(".", maxsplit=1)[-1], attribute.required, value))
    return versioned_line(name, schema, attributes)


def main():
    parser = argparse.ArgumentParser(prog="onnx_schemas.py", description="Compares the lists of attributes with the schemas of ONNX.")
    parser.add_argument("--write", action="store_true", help="write the file instead")
    options = parser.parse_args()
    names = supported_operators()
    old_lines = FILE.read_text().splitlines() if FILE.exists() else []
    onnx_names = [name for name in names if not name.startswith(CONTRIB)]
    new_lines = onnx_lines(onnx_names) + runtime_lines([name for name in names if name.startswith(CONTRIB)], old_lines)
    if options.write:
        FILE.write_text("\n".join(new_lines) + "\n")
    elif new_lines != old_lines:
        print(*difflib.unified_diff(old_lines, new_lines, "schemas.txt", "onnx", lineterm="", n=0), sep="\n")
        sys.exit("schemas.txt differs from the packages; scripts/checks/onnx_schemas.py --write writes it")
    print(f"{len(names)} operators, {len(new_lines)} lines, as version {defs.onnx_opset_version()} of the ONNX operators has them")


if __name__ == "__main__":
    main()
