#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Finds code that would take a new organization, feature or reference for one that it knows.

    scripts/checks/variants.py

Where code does something for one variant, the compiler has to name the place when another variant comes. So there is a
`match` with every variant, or a method of the type. A comparison (`==`, `matches!`), a catch-all arm (`_ =>`), and a view
of a design (`design.as_serial()`) whose None stands for all other organizations compile with a new variant and take it for
any other. The same is true of a question about a property of only one feature (`feature.mean().is_some()`, `find_map(SpatialFeature::mean)`),
a comparison of names, and a level that stands for a count of hits. This script prints each of them outside of tests, and
fails if there is one.

It ignores folders `tests`, `benches` and `examples`, files tests.rs, code after `#[cfg(test)]`, and comments.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TYPES = ("Organization", "Hardware", "FeatureKind", "ReferencePolicy", "IrrelevantRendering")
# These types are the results of methods of TYPES: a new variant of a type may need a new variant of these.
PROPERTY_TYPES = ("ArrayStructure", "ScoreUnit", "ScoreSource", "ReferenceWriteTime")
NAMES = rf"\b(?:{'|'.join(TYPES + PROPERTY_TYPES)})::[A-Z]\w*"
TESTS = re.compile(r"(^|/)(tests|benches|examples)/|(^|/)tests\.rs$")
COMPARISON = re.compile(rf"[!=]=\s*(?:\w+::)*{NAMES}|{NAMES}(?:\([^)]*\))?\s*[!=]=[^>]|matches!\([^;]*?{NAMES}")
# A design that must have that organization uses `.expect(..)`.
DESIGN_VIEW = re.compile(r"\.as_(?:pipelined|serial|raster)\(\)(?!\s*\.\s*(?:unwrap|expect)\()")
# Questions about a property of one feature, in place of a match on the feature.
FEATURE_QUESTION = re.compile(
    r"\.(?:mean|variance)\(\)\s*\.\s*is_(?:some|none)\b"
    r"|\bfind_map\(\s*(?:\|\w+\|\s*\w+\.|SpatialFeature::)(?:mean|variance)\b"
    r"|\b(?:kind|organization|reference|irrelevant)(?:\(\))?\s*\.\s*name\(\)\s*[!=]="
    r"|\b(?:entry|spatial|feature)\.level\.is_(?:some|none)\(\)"
)
# Files whose code is about one variant by purpose.
OWN_PURPOSE = {"crates/explore/src/studies/study/histogram.rs": "the study is about mad"}
# A constant such as FeatureKind::ALL is not a variant.
CONSTANT = re.compile(r"::[A-Z][A-Z_]+\b")


def without_comments(text):
    """Returns the text without comments, strings and tests, with the same number of lines."""
    text = text.split("#[cfg(test)]")[0]
    text = re.sub(r"//.*", "", text)
    return re.sub(r'"(?:\\.|[^"\\])*"', lambda literal: '""' + "\n" * literal[0].count("\n"), text)


def code(text):
    """Returns the text without comments, strings, tests, and constants of the types."""
    return CONSTANT.sub("", without_comments(text))


def arms(text, start):
    """Returns the patterns of the arms of the `match` whose `{` is at `start`, each with its place."""
    depth, pattern, place, patterns = 0, "", start + 1, []
    position = start
    while position < len(text):
        character = text[position]
        if depth == 1 and text.startswith("=>", position):
            blank = len(pattern) - len(pattern.lstrip())
            patterns.append((pattern.strip(), place + blank))
            position, pattern = past_arm(text, position + 2), ""
            place = position
            continue
        if character in "{([":
            depth += 1
        elif character in "})]":
            depth -= 1
            if depth == 0:
                return patterns
        if position != start:
            pattern += character
        position += 1
    return patterns


def past_arm(text, position):
    """Returns the end of the body of an arm that begins at `position`."""
    depth = 0
    while position < len(text):
        character = text[position]
        if character in "{([":
            depth += 1
        elif character in "})]":
            depth -= 1
            if depth < 0:
                return position
            if depth == 0 and character == "}" and not re.match(r"\s*(?:[,.?]|else\b)", text[position + 1 :]):
                return position + 1
        elif character == "," and depth == 0:
            return position + 1
        position += 1
    return position


def catch_alls(text):
    """Yields the places of `_ =>` in a match on one of the types."""
    for match in re.finditer(r"\bmatch\b[^{};]*\{", text):
        patterns = arms(text, match.end() - 1)
        if any(re.search(NAMES, pattern) for pattern, _ in patterns):
            yield from (place for pattern, place in patterns if re.fullmatch(r"[a-z_]\w*", pattern))


def variant_tests(text):
    """Returns the lines that would take a new variant for another one."""
    text = code(text)
    matches = [*COMPARISON.finditer(text), *DESIGN_VIEW.finditer(text), *FEATURE_QUESTION.finditer(text)]
    places = [match.start() for match in matches] + list(catch_alls(text))
    return sorted(text.count("\n", 0, place) + 1 for place in places)


def main():
    """Prints each place. The exit code is 1 if there is one."""
    count = 0
    for file in sorted(ROOT.glob("crates/**/*.rs")) + sorted(ROOT.glob("python/src/**/*.rs")) + sorted(ROOT.glob("web/engine/src/**/*.rs")):
        path = file.relative_to(ROOT).as_posix()
        if TESTS.search(path) or path in OWN_PURPOSE:
            continue
        text = file.read_text(encoding="utf-8")
        for line in variant_tests(text):
            print(f"{path}:{line}: takes a new variant for one that is known; match every variant, or ask the type")
            count += 1
    if count:
        sys.exit(f"variants: {count} places")


if __name__ == "__main__":
    main()
