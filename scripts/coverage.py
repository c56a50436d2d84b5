# SPDX-License-Identifier: MIT OR Apache-2.0
"""Called by coverage.sh: adds up Verilator's coverage points per module and compares the holes with those that are explained."""
import collections
import os
import re
import sys

WORK, NAMES = sys.argv[1], sys.argv[2:]
HOLES = "scripts/coverage_holes.txt"
# A bit has toggled when it rose and fell; a start at random counts as one change.
LEAST = {"line": 1, "toggle": 2}


def points(name):
    """(kind, module, what) and how often, of every point of the Verilog under test."""
    for line in open(os.path.join(WORK, name, "coverage.dat"), errors="replace"):
        match = re.match(r"C '(.*)' (\d+)$", line)
        if not match:
            continue
        fields = dict(part.split("\x02", 1) for part in match.group(1).split("\x01") if part)
        kind, _, module = fields["page"].partition("/")
        kind = {"v_line": "line", "v_branch": "line", "v_toggle": "toggle"}.get(kind)
        if kind and "rtl/" in fields["f"]:
            module = module.split("__")[0]
            what = fields["o"] if kind == "toggle" else f"line {fields['l']} {fields['o']}"
            yield kind, module, what, int(match.group(2))


def explained():
    """(module, pattern, reason) of each line `module | pattern | reason`."""
    found = []
    for number, line in enumerate(open(HOLES), 1):
        if line.strip() and not line.startswith("#"):
            parts = [part.strip() for part in line.split(" | ")]
            if len(parts) != 3:
                sys.exit(f"coverage: {HOLES}:{number}: wants `module | pattern | reason`")
            found.append((parts[0], re.compile(parts[1]), parts[2]))
    return found


def main():
    covered, total = collections.Counter(), collections.Counter()
    holes = collections.defaultdict(lambda: collections.defaultdict(list))
    for name in NAMES:
        # A module with several instances is covered where one of them is.
        best = collections.defaultdict(int)
        for kind, module, what, count in points(name):
            best[kind, module, what] = max(best[kind, module, what], count)
        for (kind, module, what), count in best.items():
            total[module, kind] += 1
            if count >= LEAST[kind]:
                covered[module, kind] += 1
            else:
                signal = re.sub(r"\[\d+\]$", "", what)
                holes[kind, module, signal][name].append(what[len(signal):])
    modules = sorted({module for module, _ in total})
    print(f"\n{'module':20} {'lines':>12} {'toggles':>14}")

    def share(keys):
        got, all_of = sum(covered[key] for key in keys), sum(total[key] for key in keys)
        return f"{got}/{all_of} {100 * got / all_of:5.1f} %" if all_of else "-"

    for module in modules + [None]:
        rows = [[(m, kind) for m in modules if module in (m, None)] for kind in ("line", "toggle")]
        print(f"{module or 'all':20} {share(rows[0]):>16} {share(rows[1]):>20}")
    reasons, used, bad = explained(), set(), 0
    print("\nholes:")
    for (kind, module, signal), places in sorted(holes.items()):
        reason = next((r for r in reasons if r[0] in (module, "*") and r[1].fullmatch(signal)), None)
        used.add(reason)
        bad += reason is None
        where = ", ".join(f"{name} {''.join(bits)}".strip() for name, bits in places.items())
        print(f"  {'' if reason else 'NOT EXPLAINED '}{module} {kind} {signal} ({where}){': ' + reason[2] if reason else ''}")
    print(f"{len(holes)} holes, {bad} not explained")
    sys.exit(1 if bad else 0)


main()
