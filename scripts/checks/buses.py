#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Cores on AXI in Icarus, between sources, sinks and masters of cocotbext-axi (tb/cocotb).

Each design is generated and simulated, and its packets are decoded. The screen of a receiver must be that of `simulate` for the
incoming frames as the core repairs them. scripts/buses.sh calls this with the Python that has cocotb.

  scripts/buses.sh            all designs, and faults that the tests must find
  scripts/buses.sh --quick    the first design
"""

import filecmp
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

from cocotb_tools.runner import get_runner

ROOT = Path(__file__).resolve().parents[2]
FOVEATE = os.environ["FOVEATE"]
BENCHES = ROOT / "tb/cocotb"
# The smallest frames in which all situations occur.
DESIGNS = {
    "edges": {"frame": "{width=64,height=40}"},
    "means": {
        "frame": "{width=48,height=48,pixel_bits=10}",
        "spatial": "[{feature='variance'}]",
        "denoise.filter": "'none'",
        "render": "{irrelevant='mean',payload='raw'}",
        "hardware.pixels_per_clock": "2",
    },
    "small regions": {
        "frame": "{width=68,height=37}",
        "region.size": "4",
        "spatial": "[{feature='mad'}]",
        "temporal.reference": "'last-sent'",
    },
}
# If regions may be dropped, the screen of a receiver is not that of `simulate`, so only packets are checked.
MAY_DROP = {"sink_that_stops"}
# In these tests a reset or a restart comes before the frames that are compared.
FIRST_NUMBER = {"not_enabled": 2}
# The faults that the tests must find: module, text, replacement, and the test.
CONTROLS = [
    ("packet_writer", "wire step = !valid_o || ready_i;", "wire step = 1'b1;", "clean_video"),
    ("axi_video", "first_word ? COPY : FILL", "COPY", "damaged_video"),
    ("packet_regions", "ends = take && last_i && !abort_i", "ends = take && last_i", "sink_that_stops"),
    ("axi_registers", "wstrb_i[0]) interrupt_enable_eol_early_q", "1'b1) interrupt_enable_eol_early_q", "register_storm"),
    ("packet_frames", "            first_q     <= 1'b1;\n", "", "reset_in_the_middle"),
    ("rcm_axi", "late = !enable || ", "late = ", "not_enabled"),
]


def foveate(*arguments, check=True):
    result = subprocess.run([FOVEATE, *map(str, arguments)], capture_output=True, text=True)
    if check and result.returncode != 0:
        sys.exit(f"foveate {' '.join(map(str, arguments))}: {result.stderr}")
    return result


def registers(core):
    """Returns names and addresses of the registers in REGISTERS.md."""
    text = (core / "REGISTERS.md").read_text()
    return {name: int(address, 16) for address, name in re.findall(r"^\| (0x[0-9A-F]+) \| `(\w+)`", text, re.MULTILINE)}


def generate(folder, settings):
    core = folder / "core"
    options = [part for key, value in settings.items() for part in ("--set", f"{key}={value}")]
    foveate("generate", "--preset", "raster", "--set", "hardware.interface='axi'", *options, "-o", core, "-q")
    design = (core / "design.toml").read_text()

    def number(key):
        return int(re.search(rf"^{key} = (\d+)", design, re.MULTILINE)[1])

    properties = {"width": number("width"), "height": number("height"), "bits": number("pixel_bits")}
    properties |= {"lanes": number("pixels_per_clock"), "registers": registers(core)}
    # The decisions of a frame come some lines after its last pixel, so a test waits this number of clocks for them.
    properties["quiet"] = properties["width"] * number("size") * 3 + 1000
    (folder / "core.json").write_text(json.dumps(properties))
    return core


def run_tests(folder, core, test=None):
    """Runs all tests or one in Icarus. Returns whether each passed, by its name."""
    sources = [core / line for line in (core / "rcm_axi.f").read_text().split()]
    runner = get_runner("icarus")
    log = folder / "log.txt"
    runner.build(
        sources=sources, hdl_toplevel="rcm_axi", build_dir=folder / "build", build_args=["-g2005"], timescale=("1ns", "1ps"), log_file=log
    )
    paths = {"FOVEATE_CORE": folder / "core.json", "FOVEATE_OUT": folder / "out", "PYTHONPATH": BENCHES}
    environment = {name: str(path) for name, path in paths.items()} | {"COCOTB_LOG_LEVEL": "WARNING"}
    results = runner.test(
        hdl_toplevel="rcm_axi", test_module="test_axi", test_dir=BENCHES, build_dir=folder / "build", extra_env=environment, log_file=log,
        results_xml=str(folder / "results.xml"), testcase=test,
    )
    cases = ElementTree.parse(results).iter("testcase")
    return {case.get("name"): case.find("failure") is None and case.find("error") is None for case in cases}


def frame_difference(folder, core):
    """Compares the received frames with those of `simulate`. Returns the difference, if any."""
    config = core / "design.toml"
    decoded_folder, simulated_folder = folder / "seen", folder / "sim"
    decoded = foveate("decode", folder / "packets.bin", "-c", config, "-o", decoded_folder, "-q", check=False)
    losses = (decoded_folder / "losses.csv").read_text() if (decoded_folder / "losses.csv").is_file() else ""
    if folder.name in MAY_DROP:
        kinds = {line.split(",")[0] for line in losses.splitlines()[1:]}
        return None if kinds <= {"dropped-region", "dropped-row"} else f"losses: {kinds}"
    # The numbers of a stream after a restart include frames without packets.
    if decoded.returncode != 0 and folder.name not in FIRST_NUMBER:
        return decoded.stderr
    foveate("simulate", folder / "frames", "-c", config, "-o", simulated_folder, "-q")
    for name in ("active.npy", "srs.npy", "trs.npy"):
        if not filecmp.cmp(decoded_folder / name, simulated_folder / name, shallow=False):
            return f"{name} differs"
    decoded_frames = sorted((decoded_folder / "rendered").iterdir())
    expected_frames = sorted((simulated_folder / "rendered").iterdir())
    if len(decoded_frames) != len(expected_frames):
        return f"{len(decoded_frames)} frames, expected {len(expected_frames)}"
    differs = [frame.name for frame, expected in zip(decoded_frames, expected_frames, strict=True) if not filecmp.cmp(frame, expected, shallow=False)]
    return f"rendered frames differ: {differs}" if differs else None


def count_missed_faults(settings):
    """Plants each fault of CONTROLS. Returns the number of faults that no test found."""
    missed = 0
    for module, before, after, test in CONTROLS:
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            core = generate(folder, settings)
            path = core / f"rtl/{module}.v"
            text = path.read_text()
            assert text.count(before) == 1, f"{module}: `{before}` is there {text.count(before)} times"
            path.write_text(text.replace(before, after))
            found = not run_tests(folder, core, test)[test] or frame_difference(folder / "out" / test, core) is not None
            missed += not found
            print(f"control: {module}: {'found' if found else 'NOT FOUND'} by {test}", flush=True)
    return missed


def main():
    quick = "--quick" in sys.argv[1:]
    designs = dict(list(DESIGNS.items())[:1]) if quick else DESIGNS
    failures = 0
    for name, settings in designs.items():
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            core = generate(folder, settings)
            outcome = run_tests(folder, core)
            for test, passed in outcome.items():
                problem = frame_difference(folder / "out" / test, core) if passed else "failed"
                failures += problem is not None
                print(f"{name}: {test}: {problem or 'ok'}", flush=True)
            if not all(outcome.values()):
                print((folder / "log.txt").read_text(), file=sys.stderr)
    if not quick:
        failures += count_missed_faults(DESIGNS["edges"])
    print(f"{len(designs)} designs, {failures} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
