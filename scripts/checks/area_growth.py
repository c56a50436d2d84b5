#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Finds modules that grow with the frame but should not: memory that is kept out of block RAM, logic for every region.

    scripts/checks/area_growth.py            every design
    scripts/checks/area_growth.py DESIGN...  some of them, such as 'serial parallel'
    scripts/checks/area_growth.py --quick    one design, which has most of the modules
    scripts/checks/area_growth.py -v         also prints the area of each module

Each design is generated for a small and a large frame, and synthesized by Yosys up to the mapping of memories, module by module.
The counts are close to LUTs: bits of the outputs of logic cells, and LUTs of distributed RAM. Numbers of words and regions
get wider with the frame, so a module may grow to a little more than twice; one made of block RAM may grow with each block.

FOVEATE         an executable to use instead of the debug build (scripts/checks/foveate.sh)
FOVEATE_YOSYS   another executable than that in PATH
JOBS            number of parallel jobs (default: number of processors)
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import features

SOURCES = pathlib.Path(__file__).resolve().parents[2]
YOSYS = os.environ.get("FOVEATE_YOSYS", "yosys")
RASTER = ["hardware.organization='raster'"]
DEEP = "hardware.pipelining='deep'"
SENT = "temporal.reference='last-sent'"
MEDIAN = "denoise.filter='median3x3'"
FLOW = "spatial=[{feature='edge'},{feature='flow',radius=3}]"
# Small regions, so that few pixels have many of them.
RASTER_SIZES = [["region.size=4", "frame={width=128,height=96}"], ["region.size=4", "frame={width=512,height=512}"]]
# Lanes and RPUs must not grow; the array of them grows with the frame.
SERIAL_SIZES = [["frame={width=64,height=64}"], ["frame={width=256,height=256}"]]
DESIGNS = [
    # Name, keys, and the keys of the small frame and of the large one; @all is every feature. The first design is the quick set.
    ("raster last-sent deep", [*RASTER, SENT, DEEP], RASTER_SIZES),
    ("raster external no forwarding", [*RASTER, MEDIAN, "hardware.store='external'", "hardware.forward=false"], RASTER_SIZES),
    ("raster last-sent raw", [*RASTER, SENT, MEDIAN, "render.payload='raw'"], RASTER_SIZES),
    ("raster last-sent ultra", [*RASTER, SENT, "hardware.store='ultra'"], RASTER_SIZES),
    ("raster block deep", [*RASTER, MEDIAN, DEEP], RASTER_SIZES),
    ("raster single-port deep", [*RASTER, DEEP, "hardware.store='single-port'"], RASTER_SIZES),
    ("raster external deep 4", [*RASTER, DEEP, "hardware.store='external'", "hardware.pixels_per_clock=4"], RASTER_SIZES),
    ("raster all features", [*RASTER, "spatial=@all", SENT], RASTER_SIZES),
    ("raster all features deep", [*RASTER, "spatial=@all", DEEP, "hardware.store='external'"], RASTER_SIZES),
    ("raster means deep 2", [*RASTER, DEEP, "render.irrelevant='mean'", "hardware.pixels_per_clock=2", "hardware.store='external'"], RASTER_SIZES),
    ("serial parallel", ["hardware.organization='serial'", "hardware.fold=1"], SERIAL_SIZES),
    ("serial raster feed", ["hardware.organization='serial'", "hardware.fold=4", "hardware.feed='raster'"], SERIAL_SIZES),
    ("serial last-sent deep", ["hardware.organization='serial'", "hardware.fold=4", SENT, DEEP], SERIAL_SIZES),
    ("serial flow", ["hardware.organization='serial'", "hardware.fold=4", FLOW, SENT], SERIAL_SIZES),
    ("pipelined", [], SERIAL_SIZES),
    ("pipelined last-sent deep", [SENT, DEEP], SERIAL_SIZES),
]
QUICK = 1
# Number of LUTs of each cell of distributed RAM.
MEMORY_LUTS = {"RAM32M": 4, "RAM32M16": 8, "RAM64M": 4, "RAM64M8": 8, "RAM128X1D": 4, "RAM256X1D": 8, "RAM32X1D": 2, "RAM64X1D": 2}
BLOCKS = {"RAMB18E2": 1, "RAMB36E2": 2, "URAM288": 8}
# Cells without logic: wires and flip-flops.
WIRES = ("$dff", "$sdff", "$adff", "$slice", "$concat", "$_DFF", "$_SDFF", "$_NOT_", "FD")
# A module of one instance per region, whose size is the number of regions.
ARRAYS = {"rcm", "serial_array"}
# The leaf that is a memory of a raster core.
MEMORY = "raster_memory"
FACTOR, MARGIN, PER_BLOCK = 2, 64, 60


def source_of(name, module):
    """Returns the name in the source of a module whose name parameters have changed."""
    return module["attributes"].get("hdlname", name).lstrip("\\").split(" ")[-1]


def blocks_in(module):
    """Returns the number of 18-Kbit blocks of a module without its instances."""
    return sum(BLOCKS.get(cell["type"], 0) for cell in module["cells"].values())


def module_areas(text):
    """Returns the area of each module of the source, the largest of its instances: logic, and 18-Kbit blocks."""
    boxes = ("blackbox", "whitebox")
    modules = json.loads(text)["modules"].items()
    modules = {name: module for name, module in modules if not any(box in module["attributes"] for box in boxes)}
    areas = {}
    for name, module in modules.items():
        logic, blocks = 0, blocks_in(module)
        for cell in module["cells"].values():
            kind = cell["type"]
            if kind in modules:
                # The selection between memories grows with their number.
                if source_of(kind, modules[kind]) == MEMORY:
                    blocks += blocks_in(modules[kind])
            elif kind in BLOCKS or kind.startswith(WIRES):
                continue
            elif kind in MEMORY_LUTS:
                logic += MEMORY_LUTS[kind]
            else:
                logic += max((len(bits) for port, bits in cell["connections"].items() if cell["port_directions"].get(port) == "output"), default=0)
        source = source_of(name, module)
        previous = areas.get(source, (0, 0))
        areas[source] = max(previous, (logic, blocks))
    return areas


def synthesize(foveate, keys, frame):
    """Returns the areas of the modules of a design for a frame."""
    with tempfile.TemporaryDirectory() as folder:
        command = [foveate, "generate", "--preset", "bare", "-o", "core", "--quiet"]
        every = f"[{features.entries('raster')}]"
        command += [word for key in [*keys, *frame] for word in ("--set", key.replace("@all", every))]
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
        files = pathlib.Path(folder, "core/rcm.f").read_text().split()
        script = "".join(f"read_verilog core/{name}\n" for name in files)
        script += "synth_xilinx -family xcup -run begin:map_ffram -top rcm\nopt_clean\nwrite_json out.json\n"
        pathlib.Path(folder, "run.ys").write_text(script)
        subprocess.run([YOSYS, "-q", "run.ys"], cwd=folder, check=True, capture_output=True)
        return module_areas(pathlib.Path(folder, "out.json").read_text())


def growth_lines(small, large):
    """Yields a line for each module that grows more than it should."""
    for module in sorted(large):
        if module in ARRAYS:
            continue
        small_area, small_blocks = small.get(module, (0, 0))
        large_area, large_blocks = large[module]
        limit = FACTOR * small_area + MARGIN + PER_BLOCK * max(0, large_blocks - small_blocks)
        if large_area > limit:
            yield f"{module} takes {large_area} of logic for the large frame and {small_area} for the small one, more than {limit}"


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    options.add_argument("--quick", action="store_true")
    options.add_argument("designs", nargs="*", metavar="DESIGN")
    options.add_argument("-v", "--verbose", action="store_true")
    options = options.parse_args()
    foveate = subprocess.run([SOURCES / "scripts/checks/foveate.sh"], capture_output=True, text=True, check=True).stdout.strip()
    unknown = set(options.designs) - {name for name, *_ in DESIGNS}
    if unknown:
        sys.exit(f"area growth: there is no design {sorted(unknown)[0]!r}; there are: {', '.join(name for name, *_ in DESIGNS)}")
    designs = DESIGNS[:QUICK] if options.quick else [design for design in DESIGNS if not options.designs or design[0] in options.designs]
    jobs = [(keys, frame) for _, keys, frames in designs for frame in frames]
    failed = False
    with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS", os.cpu_count()))) as pool:
        areas = pool.map(lambda job: synthesize(foveate, *job), jobs)
        for name, *_ in designs:
            small, large = next(areas), next(areas)
            lines = list(growth_lines(small, large))
            failed |= bool(lines)
            print(f"{name}: {len(large)} modules, {'; '.join(lines) or 'none grows'}", flush=True)
            if options.verbose:
                for module in sorted(large):
                    print(f"  {module}: {small.get(module)} {large[module]}")
    if failed:
        sys.exit("area growth: a module grows with the frame; look at it with `foveate estimate` at both sizes")


if __name__ == "__main__":
    main()
