#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Finds code that would take a new organization, feature or reference for one that it knows.

    scripts/checks/variants.py

Where code does something for one variant, the compiler has to name the place when another variant comes. So there is a
`match` with every variant, or a method of the type. A comparison (`==`, `matches!`), a catch-all arm (`_ =>`), and a view
of a design (`design.as_serial()`) whose None stands for all other organizations compile with a new variant and take it for
any other. So does a question for what only one feature has (`feature.mean().is_some()`, `find_map(SpatialFeature::mean)`),
a comparison of names, and a level that stands for a count of hits. This script prints each of them outside of tests, and
fails if there is one.

It ignores folders `tests`, `benches` and `examples`, files tests.rs, code after `#[cfg(test)]`, and comments.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TYPES = ("Organization", "Hardware", "FeatureKind", "ReferencePolicy", "IrrelevantRendering")
# The values of these methods have variants, too: a new variant of a type may need a new one of these.
ANSWERS = ("ArrayStructure", "ScoreUnit", "FeatureAccumulation", "ReferenceWriteTime")
NAMES = rf"\b(?:{'|'.join(TYPES + ANSWERS)})::[A-Z]\w*"
TESTS = re.compile(r"(^|/)(tests|benches|examples)/|(^|/)tests\.rs$")
COMPARISON = re.compile(rf"[!=]=\s*(?:\w+::)*{NAMES}|{NAMES}(?:\([^)]*\))?\s*[!=]=[^>]|matches!\([^;]*?{NAMES}")
# A design that must have that organization uses `.expect(..)`.
VIEW = re.compile(r"\.as_(?:pipelined|serial|raster)\(\)(?!\s*\.\s*(?:unwrap|expect)\()")
# Questions about a property of one feature, in place of a match on the feature.
PART = re.compile(
    r"\.(?:mean|variance)\(\)\s*\.\s*is_(?:some|none)\b"
    r"|\bfind_map\(\s*(?:\|\w+\|\s*\w+\.|SpatialFeature::)(?:mean|variance)\b"
    r"|\b(?:kind|organization|reference|irrelevant)(?:\(\))?\s*\.\s*name\(\)\s*[!=]="
    r"|\b(?:entry|spatial|feature)\.level\.is_(?:some|none)\(\)"
)
# Files whose code is about one variant by purpose.
OWN_PURPOSE = {"crates/studies/src/study/histogram.rs": "the study is about mad"}
# A constant such as FeatureKind::ALL is not a variant.
CONSTANT = re.compile(r"::[A-Z][A-Z_]+\b")


def without_comments(text):
    """Returns the text without comments, strings and tests, with the same number of lines."""
    text = text.split("#[cfg(test)]")[0]
    text = re.sub(r"//.*", "", text)
    return re.sub(r'"(?:\\.|[^"\\])*"', lambda found: '""' + "\n" * found[0].count("\n"), text)


def code(text):
    """Returns that text without constants of the types."""
    return CONSTANT.sub("", without_comments(text))


def arms(text, start):
    """Returns the patterns of the arms of the `match` whose `{` is at `start`, each with its place."""
    depth, pattern, place, found = 0, "", start + 1, []
    at = start
    while at < len(text):
        character = text[at]
        if depth == 1 and text.startswith("=>", at):
            blank = len(pattern) - len(pattern.lstrip())
            found.append((pattern.strip(), place + blank))
            at, pattern = past_arm(text, at + 2), ""
            place = at
            continue
        if character in "{([":
            depth += 1
        elif character in "})]":
            depth -= 1
            if depth == 0:
                return found
        if at != start:
            pattern += character
        at += 1
    return found


def past_arm(text, at):
    """Returns the end of the body of an arm that begins at `at`."""
    depth = 0
    while at < len(text):
        character = text[at]
        if character in "{([":
            depth += 1
        elif character in "})]":
            depth -= 1
            if depth < 0:
                return at
            if depth == 0 and character == "}" and not re.match(r"\s*(?:[,.?]|else\b)", text[at + 1 :]):
                return at + 1
        elif character == "," and depth == 0:
            return at + 1
        at += 1
    return at


def catch_alls(text):
    """Yields the places of `_ =>` in a match on one of the types."""
    for found in re.finditer(r"\bmatch\b[^{};]*\{", text):
        patterns = arms(text, found.end() - 1)
        if any(re.search(NAMES, pattern) for pattern, _ in patterns):
            yield from (place for pattern, place in patterns if re.fullmatch(r"[a-z_]\w*", pattern))


def open_tests(text):
    """Returns the lines that would take a new variant for another one."""
    text = code(text)
    found = [*COMPARISON.finditer(text), *VIEW.finditer(text), *PART.finditer(text)]
    places = [match.start() for match in found] + list(catch_alls(text))
    return sorted(text.count("\n", 0, place) + 1 for place in places)


def main():
    """Prints each place. The exit code is 1 if there is one."""
    count = 0
    for file in sorted(ROOT.glob("crates/**/*.rs")) + sorted(ROOT.glob("python/src/**/*.rs")):
        path = file.relative_to(ROOT).as_posix()
        if TESTS.search(path) or path in OWN_PURPOSE:
            continue
        text = file.read_text(encoding="utf-8")
        for line in open_tests(text):
            print(f"{path}:{line}: takes a new variant for one that is known; match every variant, or ask the type")
            count += 1
    if count:
        sys.exit(f"variants: {count} places")


if __name__ == "__main__":
    main()
