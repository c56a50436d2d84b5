#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs the node tests and the light networks of the ONNX project through `foveate infer`, and compares the outputs.

    onnx_nodes.py [--only NAME...] [--table FILE] [--verbose]

Every test of an operator that `foveate` supports is written as a model and one .npy file for each input. Tests whose values no array of
plain numbers has (strings, sequences, BFLOAT16, 4 bits) are counted as refused. Prints for each operator how many of its tests were equal,
refused and different, with the tolerances of the tests, and ends with 1 if one was different that is not listed below, or ended in any other
way. Networks are compared with the outputs that lie beside them. Values of FLOAT16, which are computed with 32 bits, have a tolerance of
1e-3. --table writes the counts as CSV, with the attributes of each operator.

Needs onnx, and `foveate` on the path (or its path in FOVEATE).
"""
import argparse
import collections
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import warnings

import numpy as np
import onnx
from onnx.backend.test.case.node import collect_testcases

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCHEMAS = ROOT / "crates/network/src/reader/schemas.txt"
FOVEATE = os.environ.get("FOVEATE", "foveate")
STANDARD = ("", "ai.onnx")
# Exit code of input that is not supported, as `foveate` documents it.
REFUSED = 2
OUTCOMES = ["equal", "refused", "different"]
# With align_corners and a scale that gives no whole number of places, the tests divide by the number before it is rounded. onnxruntime and
# PyTorch divide by the rounded one, and so do we: networks come from there.
KNOWN = {"test_resize_downsample_scales_linear_align_corners", "test_resize_downsample_scales_cubic_align_corners"}


def supported_attributes():
    """Returns the attributes of every supported operator of ONNX, over all versions."""
    attributes = {}
    for line in SCHEMAS.read_text().splitlines():
        name, _, _, _, *attribute_words = line.split(" ")
        if "." not in name:
            names = attributes.setdefault(name, [])
            names += [word.split(":")[0] for word in attribute_words if word.split(":")[0] not in names]
    return attributes


def only_operator(model):
    """Returns the operator of a test of a single node, or None for other tests."""
    nodes = model.graph.node
    return nodes[0].op_type if len(nodes) == 1 and nodes[0].domain in STANDARD else None


def run(case, folder):
    """Returns the outcome of a test, and the reason."""
    (folder / "model.onnx").write_bytes(case.model.SerializeToString())
    inputs, expected = case.data_sets[0]
    words = [FOVEATE, "infer", "model.onnx"]
    for index, value in enumerate(inputs):
        if not isinstance(value, np.ndarray | np.generic) or value.dtype.kind not in "fiub":
            return "refused", f"input {index} is no array of numbers"
        np.save(folder / f"{index}.npy", np.asarray(value), allow_pickle=False)
        words.append(f"{index}.npy")
    if not inputs:
        return "refused", "it has no input"
    result = subprocess.run([*words, "-o", "out", "--force", "--json"], cwd=folder, capture_output=True, text=True)
    if result.returncode == REFUSED:
        return "refused", result.stderr.strip()
    if result.returncode != 0:
        return "different", f"exit code {result.returncode}: {result.stderr.strip()}"
    return compare(case, expected, folder)


def outputs(folder):
    """Returns the written outputs, in the order of the model."""
    descriptions = json.loads((folder / "out/inference.json").read_text(encoding="utf-8"))["outputs"]
    return [np.load(folder / "out" / output["file"]) for output in descriptions]


def compare(case, expected_outputs, folder):
    """Returns whether all outputs are those of the test."""
    narrow = (onnx.TensorProto.FLOAT16, onnx.TensorProto.BFLOAT16)
    is_narrow = any(expected.type.tensor_type.elem_type in narrow for expected in case.model.graph.output)
    relative, absolute = (max(case.rtol, 1e-3), max(case.atol, 1e-6)) if is_narrow else (case.rtol, case.atol)
    found_outputs = outputs(folder)
    if len(found_outputs) != len(expected_outputs):
        return "different", f"{len(found_outputs)} outputs instead of {len(expected_outputs)}"
    for output, expected in zip(found_outputs, map(np.asarray, expected_outputs), strict=True):
        if output.shape != expected.shape or output.dtype.kind != expected.dtype.kind:
            return "different", f"{output.dtype} {output.shape} instead of {expected.dtype} {expected.shape}"
        if not np.allclose(output.astype(np.float64), expected.astype(np.float64), relative, absolute, equal_nan=True):
            return "different", f"values {output.ravel()[:8]} instead of {expected.ravel()[:8]}"
    return "equal", ""


def run_light(path, folder):
    """Returns the largest difference of a light network's outputs from the expected ones, as a share of the largest value."""
    graph = onnx.load(path).graph
    constants = {constant.name for constant in graph.initializer}
    (picture,) = [value for value in graph.input if value.name not in constants]
    shape = [length.dim_value for length in picture.type.tensor_type.shape.dim]
    np.save(folder / "0.npy", (np.arange(np.prod(shape)).reshape(shape) / np.prod(shape)).astype(np.float32))
    subprocess.run([FOVEATE, "infer", path, "0.npy", "-o", "out", "--force", "--quiet"], cwd=folder, check=True)
    expected = onnx.load_tensor(str(path).replace(".onnx", "_output_0.pb"))
    expected = onnx.numpy_helper.to_array(expected)
    (output,) = outputs(folder)
    return float(np.abs(output - expected).max() / np.abs(expected).max())


def light_networks(folder):
    """Compares all light networks. Returns those that differ by more than 1e-3."""
    failed = []
    for path in sorted((pathlib.Path(onnx.__file__).parent / "backend/test/data/light").glob("*.onnx")):
        difference = run_light(path, folder)
        print(f"{path.stem}: largest difference {difference:.1e} of the largest value")
        if not difference < 1e-3:
            failed.append(f"{path.stem} differs by {difference:.1e}")
    return failed


def main():
    parser = argparse.ArgumentParser(prog="onnx_nodes.py", description="Runs the node tests of the ONNX project.")
    parser.add_argument("--only", nargs="*", metavar="NAME", help="operators or tests; by default all that are supported")
    parser.add_argument("--table", metavar="FILE", type=pathlib.Path, help="write the counts of every operator as CSV")
    parser.add_argument("--verbose", action="store_true", help="print why a test was refused")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    attributes, counts, failed, known = supported_attributes(), collections.defaultdict(collections.Counter), [], set()
    with tempfile.TemporaryDirectory() as folder:
        for case in collect_testcases(None):
            operator = only_operator(case.model)
            if operator not in attributes or options.only and not {operator, case.name} & set(options.only):
                continue
            outcome, reason = run(case, pathlib.Path(folder))
            counts[operator][outcome] += 1
            if outcome == "different" and case.name in KNOWN:
                known.add(case.name)
            elif outcome == "different":
                failed.append(f"{case.name}: {reason}")
            if options.verbose and outcome == "refused":
                print(f"{case.name}: {reason}")
        if not options.only:
            failed += [f"{name} is equal, but listed as different" for name in KNOWN - known]
            failed += light_networks(pathlib.Path(folder))
    for operator in sorted(counts):
        print(f"{operator}: " + ", ".join(f"{counts[operator][outcome]} {outcome}" for outcome in OUTCOMES if counts[operator][outcome]))
    total = sum(counts.values(), collections.Counter())
    print(f"onnx {onnx.__version__}, {sum(total.values())} tests of {len(counts)} operators: "
          + ", ".join(f"{total[outcome]} {outcome}" for outcome in OUTCOMES))
    if options.table:
        with options.table.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["operator", "attributes", *OUTCOMES])
            for operator, names in sorted(attributes.items()):
                writer.writerow([operator, " ".join(sorted(names)), *(counts[operator][outcome] for outcome in OUTCOMES)])
    if failed or not total:
        sys.exit("\n".join(failed) or "no test ran")


if __name__ == "__main__":
    main()
