# SPDX-License-Identifier: MIT OR Apache-2.0
"""Called by lint.sh: generates the matrix, lints it in every tool, and prints the findings without a waiver."""
import collections
import concurrent.futures
import os
import re
import shutil
import subprocess
import sys
import time

from features import entries, entry, names

TARGET = os.path.abspath(os.environ.get("CARGO_TARGET_DIR", "target"))
WORK = os.path.join(TARGET, "lint")
FOVEATE = os.environ.get("FOVEATE", "foveate")
VERILATOR = os.environ.get("FOVEATE_VERILATOR", "verilator")
YOSYS = os.environ.get("FOVEATE_YOSYS", "yosys")
WAIVERS = "lint/waivers.txt"

# The lowest thresholds, which every size and depth accepts.
LOWEST = {"level": 0, "min_score": 0}
EDGE = "{feature='edge',level=1,min_score=1}"
CORNER = "{feature='corner',level=0,min_score=1}"
FRACTION = entry("mad", mean_fraction_bits=2, **LOWEST)
# Every feature alone, a mean with a fraction, two features that share a window, and all.
ALONE = {name: entry(name, **LOWEST) for name in names("raster")}
FEATURES = [*ALONE.values(), FRACTION, f"{EDGE},{CORNER}", entries("raster", **LOWEST)]
# Features that only serial designs have: alone, and all.
SERIAL_FEATURES = [
    *(entry(name, **LOWEST) for name in names("serial") if name not in ALONE),
    entries("serial", radius=3, **LOWEST),
]
# The filters with a window.
FILTERS = ["median3x3", "switching3x3", "binomial3x3"]
SIZES = [2, 3, 5, 8, 16, 20, 64]
DEPTHS = [1, 8, 10, 16]


def matrix():
    """Yields name and settings of each design. Sizes and depths have no common period with the choices."""
    for index, features in enumerate(FEATURES):
        for choice in range(8):
            size = SIZES[(index * 3 + choice) % len(SIZES)]
            depth = DEPTHS[(index + choice * 3 + choice // 4) % len(DEPTHS)]

            def pick(bit, off, on, choice=choice):
                return on if choice >> bit & 1 else off

            yield f"{index}{choice}_{size}x{size}_{depth}bit", [
                f"spatial=[{features}]",
                f"frame={{width={2 * size},height={size},pixel_bits={depth}}}",
                f"region={{size={size},neighborhood='{pick(0, 'isolated', 'shared')}'}}",
                f"denoise.filter='{pick(1, FILTERS[(index + choice) % len(FILTERS)], 'none')}'",
                f"temporal={{level=0,min_count=1,reference='{pick(2, 'previous', 'last-sent')}'}}",
                f"render={{payload='{pick((index + 1) % 3, 'denoised', 'raw')}',"
                f"irrelevant='{pick(index % 3, 'zero', 'hold')}'}}",
                f"hardware.thresholds='{pick((index + 2) % 3, 'runtime', 'constant')}'",
                # Every pair of the other choices occurs both plain and deep.
                f"hardware.pipelining='{'deep' if (index + choice.bit_count()) % 2 else 'plain'}'",
                f"hardware.sync={'true' if choice % 3 == 1 else 'false'}",
            ]


def mean_designs():
    """Yields designs that send block means: blocks of one pixel, sides that are no power of two, a second pass."""
    for name, size, blocks, features, more in [
        ("pixels", 4, 4, EDGE, "denoise.filter='median3x3'"),
        ("deep", 12, 2, f"{EDGE},{CORNER}", "hardware={pipelining='deep',thresholds='constant'}"),
        ("second", 6, 1, ALONE["mad"], "render={irrelevant='mean',payload='raw'}"),
        ("serial", 8, 4, EDGE, "hardware={organization='serial',fold=2}"),
        ("deep_serial", 5, 1, ALONE["mad"], "hardware={organization='serial',feed='raster',pipelining='deep'}"),
    ]:
        yield f"m_{name}_{size}x{size}", [
            f"spatial=[{features}]",
            f"frame={{width={2 * size},height={size}}}",
            f"region.size={size}",
            "temporal={level=0,min_count=1}",
            "render.irrelevant='mean'",
            f"periphery.blocks={blocks}",
            more,
        ]


def raster_mean_designs():
    """Yields raster designs that send means: blocks as wide as a word, a store outside, few rows of regions that wait."""
    for name, size, word, blocks, rows, features, more in [
        ("pixels", 4, 1, 4, 3, EDGE, "denoise.filter='median3x3'"),
        ("deep", 12, 2, 2, 2, f"{EDGE},{CORNER}", "hardware={pipelining='deep',thresholds='constant',store='external'}"),
        ("second", 6, 1, 1, 4, ALONE["mad"], "render={irrelevant='mean',payload='raw'}"),
    ]:
        yield f"rm_{name}_{size}x{size}", [
            f"spatial=[{features}]",
            f"frame={{width={max(4, -(-16 * word // size)) * size},height={rows * size - 1}}}",
            f"region.size={size}",
            "temporal={level=0,min_count=1}",
            "render.irrelevant='mean'",
            f"periphery.blocks={blocks}",
            more,
            "hardware.organization='raster'",
            f"hardware.pixels_per_clock={word}",
        ]


SERIAL_SIZES = [4, 5, 8, 16, 20, 63, 64]
RASTER_SHAPES = [(8, 1), (4, 2), (3, 1), (8, 4), (16, 2), (5, 1)]  # sides of regions and pixels of a word
FOLDS = [1, 2, 3, 6]


def serial_matrix():
    """Yields serial designs of 3x2 regions: folds with empty slots, feeds, distributed and block RAM."""
    for index, features in enumerate(FEATURES + SERIAL_FEATURES):
        for choice in range(4):
            number = 4 * index + choice
            size = SERIAL_SIZES[(index * 3 + choice) % len(SERIAL_SIZES)]
            depth = DEPTHS[(index + choice * 3 + choice // 2) % len(DEPTHS)]

            def pick(bit, off, on, number=number):
                return on if number * 5 >> bit & 1 else off

            yield f"s{index}{choice}_{size}x{size}_{depth}bit", [
                "hardware.organization='serial'",
                f"hardware.fold={FOLDS[(index + choice) % len(FOLDS)]}",
                f"hardware.feed='{pick(0, 'parallel', 'raster')}'",
                f"hardware.pipelining='{'deep' if (index + number.bit_count()) % 2 else 'plain'}'",
                f"hardware.thresholds='{pick(4, 'runtime', 'constant')}'",
                f"hardware.sync={'true' if number % 3 == 1 else 'false'}",
                f"spatial=[{features}]",
                f"frame={{width={3 * size},height={2 * size},pixel_bits={depth}}}",
                f"region={{size={size},neighborhood='{pick(1, 'isolated', 'shared')}'}}",
                f"denoise.filter='{pick(2, FILTERS[(index + choice) % len(FILTERS)], 'none')}'",
                f"temporal={{level=0,min_count=1,reference='{pick(3, 'last-sent', 'previous')}'}}",
                f"render={{payload='{pick(5, 'denoised', 'raw')}',irrelevant='{pick(6, 'zero', 'hold')}'}}",
            ]


def raster_matrix():
    """Yields raster designs of the smallest width: words, frames that fill no region, both pipelinings."""
    for index, features in enumerate(FEATURES):
        for choice in range(4):
            number = 4 * index + choice
            size, word = RASTER_SHAPES[(index * 2 + choice) % len(RASTER_SHAPES)]
            depth = DEPTHS[(index + choice * 3 + choice // 2) % len(DEPTHS)]
            columns, margin = max(4, -(-16 * word // size)), number % 2

            def pick(bit, off, on, number=number):
                return on if number * 5 >> bit & 1 else off

            yield f"r{index}{choice}_{size}x{size}_{depth}bit", [
                "hardware.organization='raster'",
                f"hardware.pixels_per_clock={word}",
                f"hardware.pipelining='{pick(0, 'plain', 'deep')}'",
                f"hardware.thresholds='{pick(4, 'runtime', 'constant')}'",
                f"hardware.sync={'true' if number % 3 == 1 else 'false'}",
                f"spatial=[{features}]",
                f"frame={{width={columns * size - margin},height={(1 + choice) * size - margin},pixel_bits={depth}}}",
                f"region={{size={size},neighborhood='{pick(1, 'isolated', 'shared')}'}}",
                f"denoise.filter='{pick(2, FILTERS[(index + choice) % len(FILTERS)], 'none')}'",
                f"temporal={{level=0,min_count=1,reference='{pick(3, 'last-sent', 'previous')}'}}",
                f"render={{payload='{pick(5, 'denoised', 'raw')}',irrelevant='{pick(6, 'zero', 'hold')}'}}",
            ]


def axi_matrix():
    """Yields cores on AXI: words of one and more pixels, lanes of 8 and 16 bits, parts of 16 and 32 bits, means, every store,
    and thresholds of both kinds."""
    for name, size, word, width, height, depth, features, more in [
        ("edge", 8, 1, 64, 40, 8, EDGE, ["hardware.sync=true"]),
        ("means", 5, 1, 83, 33, 10, EDGE, ["render={irrelevant='mean',payload='raw'}"]),
        ("blocks", 8, 2, 64, 32, 16, ALONE["variance"], ["render.irrelevant='mean'", "periphery.blocks=4", "temporal.reference='last-sent'"]),
        ("wide", 4, 4, 64, 40, 8, ALONE["variance"], ["hardware.thresholds='constant'", "hardware.store='external'"]),
        ("second", 4, 4, 130, 40, 12, ALONE["surface"], ["hardware.pipelining='deep'"]),
        ("short", 6, 1, 48, 17, 1, CORNER, ["hardware.store='single-port'"]),
    ]:
        yield f"a_{name}_{size}x{size}_{depth}bit", [
            f"spatial=[{features}]",
            f"frame={{width={width},height={height},pixel_bits={depth}}}",
            f"region.size={size}",
            "temporal={level=0,min_count=1}",
            *more,
            "hardware.organization='raster'",
            f"hardware.pixels_per_clock={word}",
            "hardware.interface='axi'",
        ]


def run(command, cwd):
    result = subprocess.run(command, cwd=cwd, capture_output=True, text=True)
    return result.returncode, result.stdout + result.stderr


def lines_of(text, pattern):
    return [line for line in text.splitlines() if re.search(pattern, line)]


def verilator(files, cwd, top):
    code, text = run([VERILATOR, "--lint-only", "-Wall", "--top-module", top, *files], cwd)
    return code, lines_of(text, r"^%(Warning|Error)(?!: Exiting)"), text


def iverilog(files, cwd, top):
    # The output is a file, because Icarus makes it executable: as root it would change the mode of /dev/null.
    code, text = run(["iverilog", "-g2005", "-Wall", "-s", top, "-o", "lint.vvp", *files], cwd)
    return code, [line for line in text.splitlines() if line.strip()], text


def yosys(files, cwd, top):
    script = f"read_verilog {' '.join(files)}; hierarchy -check -top {top}; proc; check -assert"
    code, text = run([YOSYS, "-p", script], cwd)
    return code, lines_of(text, r"^(Warning|ERROR)"), text


SLANG = """
import sys
from pyslang.driver import Driver
driver = Driver()
driver.addStandardArgs()
words = "slang --std=1364-2005 -Weverything --color-diagnostics=false --top " + " ".join(sys.argv[1:])
if not (driver.parseCommandLine(words) and driver.processOptions() and driver.parseAllSources()):
    sys.exit(1)
compilation = driver.createCompilation()
driver.reportCompilation(compilation, True)
driver.runAnalysis(compilation)
sys.exit(0 if driver.reportDiagnostics(True) else 1)
"""


def slang(files, cwd, top):
    code, text = run([sys.executable, "-c", SLANG, top, *files], cwd)
    return code, lines_of(text, r": (warning|error): "), text


TOPS = ["rcm", "rcm_axi"]
TOOLS = {"verilator": verilator, "iverilog": iverilog, "yosys": yosys, "slang": slang}


def read_waivers():
    """Returns (tool, pattern, reason, may be unused) for each line `tool | pattern | reason`."""
    waivers = []
    for number, line in enumerate(open(WAIVERS), 1):
        if not line.strip() or line.startswith("#"):
            continue
        parts = [part.strip() for part in line.split(" | ")]
        tool = parts[0].rstrip("?")
        if len(parts) != 3 or tool not in TOOLS:
            sys.exit(f"lint: {WAIVERS}:{number}: wants `tool | pattern | reason`, tool one of {', '.join(TOOLS)}")
        waivers.append((tool, re.compile(parts[1]), parts[2], parts[0].endswith("?")))
    return waivers


def check(name, settings):
    """Returns the findings of all tools in a design."""
    folder = os.path.join(WORK, name)
    shutil.rmtree(folder, ignore_errors=True)
    command = [FOVEATE, "generate", "--preset", "bare", "--output", folder]
    for setting in settings:
        command += ["--set", setting]
    code, text = run(command, None)
    if code != 0:
        return [("foveate", text.strip())]
    tops = [top for top in TOPS if os.path.exists(os.path.join(folder, f"{top}.f"))]
    return [finding for top in tops for finding in check_top(folder, top)]


def check_top(folder, top):
    """Returns the findings of all tools below a top of a core."""
    files = open(os.path.join(folder, f"{top}.f")).read().split()
    findings = []
    for tool, lint in TOOLS.items():
        code, lines, text = lint(files, folder, top)
        findings += [(tool, line) for line in lines]
        if code != 0 and not lines:
            findings.append((tool, f"exit code {code}: {text.strip()[-400:]}"))
    return findings


def main():
    start = time.monotonic()
    os.makedirs(WORK, exist_ok=True)
    quick = "--quick" in sys.argv
    matrices = (matrix(), mean_designs(), serial_matrix(), raster_matrix(), raster_mean_designs(), axi_matrix())
    designs = [design for matrix_designs in matrices for design in list(matrix_designs)[:: 15 if quick else 1]]
    waivers = read_waivers()
    used, finding_count = collections.Counter(), 0
    jobs = int(os.environ.get("JOBS", os.cpu_count() or 1))
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for (name, _), findings in zip(designs, pool.map(lambda design: check(*design), designs), strict=True):
            for tool, line in findings:
                waiver = next((e for e in waivers if e[0] == tool and e[1].search(line)), None)
                if waiver:
                    used[waiver] += 1
                else:
                    finding_count += 1
                    print(f"{name}: {tool}: {line}", flush=True)
    unused = [] if quick else [waiver for waiver in waivers if not used[waiver] and not waiver[3]]
    for tool, pattern, *_ in unused:
        print(f"{WAIVERS}: nothing needs `{tool} | {pattern.pattern}`; remove it")
    print(f"{len(designs)} designs in {len(TOOLS)} tools: {finding_count} findings, {sum(used.values())} waived by {len(used)} of"
          f" {len(waivers)} waivers, {time.monotonic() - start:.0f} s")
    sys.exit(1 if finding_count or unused else 0)


main()
