# SPDX-License-Identifier: MIT OR Apache-2.0
"""Called by coverage.sh: adds up Verilator's coverage points per module and compares the holes (the points without coverage) with the explained ones.

A line of a leaf is one point, which is covered if one design covers it, because logic for a feature is idle in designs without
it. The same is true of a bit of a serial or raster leaf: one sequencer or core serves all features and feeds, and much of it is idle in
each design. It is also true of a bit of a leaf around a core on AXI; only these leaves count there, because the array inside has runs of
its own. Other bits are points of each design, because a bit may be the highest in one design and not in another, and so are the lines of
a rendered module, which differ between designs.
"""
import collections
import functools
import glob
import os
import re
import sys

WORK, NAMES = sys.argv[1], [name for name in sys.argv[2:] if name != "--some"]
HOLES = "scripts/checks/coverage_holes.txt"
RENDERED = ("rpu", "rcm", "rcm_axi", "axi_registers")
AXI_MODULES = ("rcm_axi", "axi_", "packet_")
QUICK = 2  # designs of `--quick`
# A bit has toggled when it rose and fell. All bits start at 0, so a bit that is 1 from reset on has risen.
MIN_COUNTS = {"line": 1, "toggle": 2}


def points(name):
    """Yields (kind, module, what) and the count of every point of the Verilog under test."""
    paths = sorted(glob.glob(os.path.join(WORK, name, "coverage*.dat")))
    for line in (line for path in paths for line in open(path, errors="replace")):
        match = re.match(r"C '(.*)' (\d+)$", line)
        if not match:
            continue
        fields = dict(part.split("\x02", 1) for part in match.group(1).split("\x01") if part)
        kind, _, module = fields["page"].partition("/")
        kind = {"v_line": "line", "v_branch": "line", "v_toggle": "toggle"}.get(kind)
        if kind and "rtl/" in fields["f"]:
            module = module.split("__")[0]
            if name.startswith("axi") and not module.startswith(AXI_MODULES):
                continue
            what = fields["o"] if kind == "toggle" else f"{fields['o']} {line_of(os.path.join(WORK, name, fields['f']), fields['l'])}"
            yield kind, module, what, int(match.group(2))


@functools.cache
def lines_of(path):
    return open(path).read().splitlines()


def line_of(path, number):
    """Returns the name of a line, which is its text, so that a reason still holds after the line has moved."""
    return f"{lines_of(path)[int(number) - 1].strip()}\n{number}"


def read_explanations():
    """Returns (pattern of the module, pattern of the signal or line, reason) for each line of the file of holes."""
    explanations = []
    for number, line in enumerate(open(HOLES), 1):
        if line.strip() and not line.startswith("#"):
            parts = [part.strip() for part in line.split(" | ")]
            if len(parts) != 3:
                sys.exit(f"coverage: {HOLES}:{number}: wants `module | pattern | reason`")
            explanations.append((parts[0], re.compile(parts[1]), parts[2]))
    return explanations


def main():
    # A module with several instances is covered if one of them is.
    max_counts = collections.defaultdict(int)
    designs_of_point = collections.defaultdict(list)
    for name in NAMES:
        for kind, module, what, count in points(name):
            is_leaf = module not in RENDERED
            is_merged = is_leaf and (kind == "line" or module.startswith(("serial_", "raster_", "axi_", "packet_")))
            design = None if is_merged else name
            point = kind, module, what, design
            max_counts[point] = max(max_counts[point], count)
            if name not in designs_of_point[point]:
                designs_of_point[point].append(name)
    covered, total = collections.Counter(), collections.Counter()
    holes = collections.defaultdict(lambda: collections.defaultdict(list))
    for (kind, module, what, design), count in max_counts.items():
        total[module, kind] += 1
        if count >= MIN_COUNTS[kind]:
            covered[module, kind] += 1
        else:
            signal = re.sub(r"\[\d+\]$|\n\d+$", "", what)
            place = design or " ".join(designs_of_point[kind, module, what, design])
            holes[kind, module, signal][place].append(what[len(signal):].strip())
    modules = sorted({module for module, _ in total})
    print(f"\n{'module':20} {'lines':>12} {'toggles':>14}")

    def share(keys):
        covered_count, total_count = sum(covered[key] for key in keys), sum(total[key] for key in keys)
        return f"{covered_count}/{total_count} {100 * covered_count / total_count:5.1f} %" if total_count else "-"

    for module in modules + [None]:
        rows = [[(m, kind) for m in modules if module in (m, None)] for kind in ("line", "toggle")]
        print(f"{module or 'all':20} {share(rows[0]):>16} {share(rows[1]):>20}")
    reasons, used_reasons, unexplained_count = read_explanations(), set(), 0
    print("\nholes:")
    for (kind, module, signal), places in sorted(holes.items()):
        reason = next((r for r in reasons if re.fullmatch(r[0], module) and r[1].fullmatch(signal)), None)
        used_reasons.add(reason)
        unexplained_count += reason is None
        place = ", ".join(f"{name} {''.join(bits)}".strip() for name, bits in places.items())
        print(f"  {'' if reason else 'NOT EXPLAINED '}{module} {kind} {signal} ({place}){': ' + reason[2] if reason else ''}")
    # A run of few designs may lack some explained holes.
    unused = [r for r in reasons if r not in used_reasons] if len(NAMES) > QUICK and "--some" not in sys.argv else []
    for module, pattern, _ in unused:
        print(f"{HOLES}: nothing needs `{module} | {pattern.pattern}`; remove it")
    print(f"{len(holes)} holes, {unexplained_count} not explained")
    sys.exit(1 if unexplained_count or unused else 0)


main()
