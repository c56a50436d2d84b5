#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Compares the cycles of systolic arrays in crates/network with those of SCALE-Sim 3.0, layer by layer, as a table in Markdown.

    compare_scalesim.py [NAME...] [--arrays ROWSxCOLUMNS...] [--dataflows ws os] [--crop]

Needs cargo and SCALE-Sim: `pip install scalesim==3.0.0 'numpy<2.4'`, best in a virtual environment whose Python runs this script. (SCALE-Sim 3.0.0
fails with NumPy 2.4.) It steps through every address, so all layers take a quarter of an hour. SCALE-Sim knows no padding, so the inputs of
the layers are padded here. A layer with groups stands here as one of them. SCALE-Sim rounds up how often a kernel that strides fits into the
input; --crop removes the inputs at the ends that no kernel covers, so that there is nothing to round.
"""
import argparse
import contextlib
import csv
import os
import subprocess
import tempfile

from scalesim.scale_sim import scalesim

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
# Name, input height and width with padding, kernel height and width, input channels, filters, stride.
LAYERS = [
    ("alexnet_conv1", 227, 227, 11, 11, 3, 96, 4),
    ("alexnet_conv2", 31, 31, 5, 5, 48, 128, 1),
    ("alexnet_conv3", 15, 15, 3, 3, 256, 384, 1),
    ("alexnet_conv4", 15, 15, 3, 3, 192, 192, 1),
    ("alexnet_conv5", 15, 15, 3, 3, 192, 128, 1),
    ("resnet18_conv1", 230, 230, 7, 7, 3, 64, 2),
    ("resnet18_conv2", 58, 58, 3, 3, 64, 64, 1),
    ("resnet18_conv3_1", 58, 58, 3, 3, 64, 128, 2),
    ("resnet18_conv3_short", 56, 56, 1, 1, 64, 128, 2),
    ("resnet18_conv3_2", 30, 30, 3, 3, 128, 128, 1),
    ("resnet18_conv4_1", 30, 30, 3, 3, 128, 256, 2),
    ("resnet18_conv4_short", 28, 28, 1, 1, 128, 256, 2),
    ("resnet18_conv4_2", 16, 16, 3, 3, 256, 256, 1),
    ("resnet18_conv5_1", 16, 16, 3, 3, 256, 512, 2),
    ("resnet18_conv5_short", 14, 14, 1, 1, 256, 512, 2),
    ("resnet18_conv5_2", 9, 9, 3, 3, 512, 512, 1),
    ("resnet18_fc", 1, 1, 1, 1, 512, 1000, 1),
    # SCALE-Sim takes a name with DP for a depthwise layer, and runs each channel as a layer of its own.
    ("depthwise_DP", 16, 16, 3, 3, 8, 1, 1),
]
TOPOLOGY = "Layer name, IFMAP Height, IFMAP Width, Filter Height, Filter Width, Channels, Num Filter, Strides,"
# Bandwidth is calculated and not limited, so the run has no stalls.
CONFIG = """[general]
run_name = run
[run_presets]
InterfaceBandwidth = CALC
UseRamulatorTrace = False
[architecture_presets]
ArrayHeight = {rows}
ArrayWidth = {columns}
ifmapsramszkB = 1024
filtersramszkB = 1024
ofmapsramszkB = 1024
IfmapOffset = 0
FilterOffset = 10000000
OfmapOffset = 20000000
Dataflow = {dataflow}
Bandwidth = 10
ReadRequestBuffer = 512
WriteRequestBuffer = 512
[layout]
IfmapCustomLayout = False
FilterCustomLayout = False
IfmapSRAMBankBandwidth = 10
IfmapSRAMBankNum = 10
IfmapSRAMBankPort = 2
FilterSRAMBankBandwidth = 10
FilterSRAMBankNum = 10
FilterSRAMBankPort = 2
[sparsity]
SparsitySupport = false
SparseRep = ellpack_block
OptimizedMapping = false
BlockSize = 8
RandomNumberGeneratorSeed = 40
"""


def scalesim_cycles(layer, rows, columns, dataflow):
    """Returns SCALE-Sim's number of the last cycle; for a depthwise layer the sum over its channels, each of which is a run."""
    with tempfile.TemporaryDirectory() as folder:
        config, layout, topology = (os.path.join(folder, name) for name in ("scale.cfg", "layout.csv", "topology.csv"))
        settings = CONFIG.format(rows=rows, columns=columns, dataflow=dataflow)
        for path, text in ((config, settings), (layout, "Layer name,\n"), (topology, topology_text([layer]))):
            with open(path, "w") as file:
                file.write(text)
        with open(os.devnull, "w") as nothing, contextlib.redirect_stdout(nothing):
            scalesim(save_disk_space=True, verbose=False, config=config, topology=topology, layout=layout).run_scale(top_path=folder)
        with open(os.path.join(folder, "run", "COMPUTE_REPORT.csv")) as file:
            runs = list(csv.DictReader(file, skipinitialspace=True))
    stalls = sum(int(run["Stall Cycles"]) for run in runs)
    assert stalls == 0, f"{layer[0]}: SCALE-Sim stalls for {stalls} cycles"
    return sum(int(run["Total Cycles"]) for run in runs)


def model_cycles(layers, rows, columns, dataflow):
    """Returns the model's cycles by layer, counted as SCALE-Sim counts them."""
    with tempfile.TemporaryDirectory() as folder:
        topology = os.path.join(folder, "topology.csv")
        with open(topology, "w") as file:
            file.write(topology_text(layers))
        command = ["cargo", "run", "--quiet", "--locked", "-p", "foveate-network", "--example", "cycles", "--"]
        run = subprocess.run([*command, dataflow, str(rows), str(columns), topology], cwd=ROOT, check=True, capture_output=True, text=True)
    return {name: int(cycles) for name, cycles in csv.reader(run.stdout.splitlines())}


def topology_text(layers):
    """Writes a topology in the format of SCALE-Sim."""
    return "\n".join([TOPOLOGY, *(", ".join(map(str, layer)) + "," for layer in layers)]) + "\n"


def crop(layer):
    """Returns a layer without the inputs at its ends that no kernel covers."""
    name, height, width, kernel_height, kernel_width, channels, filters, stride = layer
    height -= (height - kernel_height) % stride
    width -= (width - kernel_width) % stride
    return (name, height, width, kernel_height, kernel_width, channels, filters, stride)


def main():
    parser = argparse.ArgumentParser(prog="compare_scalesim.py", description="Cycles of systolic arrays beside those of SCALE-Sim 3.0.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="layers; by default all")
    parser.add_argument("--arrays", nargs="+", default=["32x32"], metavar="ROWSxCOLUMNS", help="%(default)s")
    parser.add_argument("--dataflows", nargs="+", choices=["ws", "os"], default=["ws", "os"])
    parser.add_argument("--crop", action="store_true", help="take off inputs that no kernel sees")
    options = parser.parse_args()
    layers = [layer for layer in LAYERS if not options.names or layer[0] in options.names]
    if not layers:
        parser.error(f"no layer of that name; there are {', '.join(layer[0] for layer in LAYERS)}")
    if options.crop:
        layers = [crop(layer) for layer in layers]
    columns = [f"{dataflow} SCALE-Sim | {dataflow} model | ratio" for dataflow in options.dataflows]
    print("\n".join([f"| array | layer | {' | '.join(columns)} |", f"| --- | --- |{' ---: |' * 3 * len(columns)}"]))
    for array in options.arrays:
        rows, columns = map(int, array.split("x"))
        models = {dataflow: model_cycles(layers, rows, columns, dataflow) for dataflow in options.dataflows}
        for layer in layers:
            pairs = [(scalesim_cycles(layer, rows, columns, dataflow), models[dataflow][layer[0]]) for dataflow in options.dataflows]
            cells = " | ".join(f"{cycles:,} | {model:,} | {model / cycles:.4f}" for cycles, model in pairs)
            print(f"| {array} | {layer[0]} | {cells} |", flush=True)


if __name__ == "__main__":
    main()
