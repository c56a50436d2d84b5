# SPDX-License-Identifier: MIT OR Apache-2.0
"""Compares the output of a command with that of its page."""
import re

# The parts of a line that differ between runs or machines, each with the words around it, and the text that is compared in its place.
CHANGING = [
    # foveate cosim
    (re.compile(r"\d+\.\d s(?= (vectors|build|run)\b)"), "<time> s"),
    (re.compile(r"Verilator 5\.\d+ \d{4}-\d\d-\d\d rev \([^)]*\)"), "Verilator <version>"),
    # foveate infer: if masks take longer than they save, it does not say when they would save.
    (re.compile(r"\d+\.\d\d ms per frame, \d+\.\d\d ms of it for masks"), "<time> ms per frame, <time> ms of it for masks"),
    (re.compile(r"; whole \d+\.\d\d ms(; faster than that as long as at most \d+\.\d % of the blocks are computed)?$"), "; whole <time> ms"),
]
# Lines of a page that stand for any number of others.
LEFT_OUT = "..."


def normalized(line):
    """Returns a line with a fixed text in place of each part that differs between runs."""
    line = line.rstrip()
    for pattern, place in CHANGING:
        line = pattern.sub(place, line)
    return line


def equal_line_count(part, printed):
    """Returns how many lines at the beginning of a part equal the printed ones."""
    pairs = zip(part, printed, strict=False)
    return next((number for number, (line, other) in enumerate(pairs) if line != other), min(len(part), len(printed)))


def difference(expected, printed):
    """Returns the number, from 0, of the first line that differs from the page, and the difference; None without a difference."""
    expected, printed = [normalized(line) for line in expected], [normalized(line) for line in printed]
    next_line, start, parts = 0, 0, []
    for number in [*(n for n, line in enumerate(expected) if line == LEFT_OUT), len(expected)]:
        parts.append((start, expected[start:number]))
        start = number + 1
    for index, (start, part) in enumerate(parts):
        is_last = index == len(parts) - 1
        if index == 0:
            places = [0]
        elif is_last:
            places = [max(next_line, len(printed) - len(part))]
        else:
            places = list(range(next_line, len(printed) + 1))
        best_place = max(places, key=lambda best_place: equal_line_count(part, printed[best_place:]))
        same = equal_line_count(part, printed[best_place:])
        if same < len(part):
            is_known = same > 0 or len(places) == 1
            found = printed[best_place + same] if is_known and best_place + same < len(printed) else None
            return start + same, f"prints `{found}`" if found is not None else "does not print this line"
        next_line = best_place + len(part)
    if next_line < len(printed):
        return max(len(expected) - 1, 0), f"prints more behind this line: `{printed[next_line]}`"
    return None


def is_refusal(expected):
    """Returns whether a page shows that a command fails: the program by its message, a bench by its last word."""
    return any(line.startswith(("foveate: ", "FAIL ")) and not line.startswith("foveate: warning: ") for line in expected)
