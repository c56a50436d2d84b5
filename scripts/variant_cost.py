#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Counts the files that one edits to add an organization or a feature.

    scripts/variant_cost.py [--check] [--list]

A file counts if its code, without comments, names a variant of the type: `Organization::Serial`, or `Serial`
where the type is defined or its variants are imported. Not counted are tests (folders `tests`, files tests.rs,
what follows `#[cfg(test)]`, the crate stress, whose cases are tests), benches and examples, and a variant's own
modules: files and folders of its name, and the crate array, the fast model of pipelined.

--check fails where a count is above its limit. --list names the files.
"""

import argparse
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# The most files that a new variant of a type may cost, and where the type is.
LIMITS = {"Organization": 12, "FeatureKind": 15}
CHOICES = {"Organization": "crates/design/src/choice.rs", "FeatureKind": "crates/camera/src/choice.rs"}
# Whole folders that belong to a variant although they have not its name.
OWN = {"crates/array/": "pipelined"}
TESTS = re.compile(r"(^|/)(tests|benches|examples)/|(^|/)tests\.rs$|^crates/stress/")


def variants(kind, choices):
    """The variants of a type, as {Variant: name in a configuration}, from its definition."""
    body = re.search(rf"\b{kind} {{(.*?)\n    }}", choices, re.S)
    if body is None:
        raise SystemExit(f"{CHOICES[kind]} has no `{kind}`; has the type another name now?")
    return dict(re.findall(r'^\s+(\w+) = "([\w-]+)",', body[1], re.M))


def code(text):
    """The text without comments and without its tests."""
    return re.sub(r"//.*", "", text.split("#[cfg(test)]")[0])


def is_own(path, names):
    """Whether a file belongs to one of the variants."""
    parts = Path(path).with_suffix("").parts
    return bool(names & set(parts)) or any(
        path.startswith(folder) and name in names for folder, name in OWN.items()
    )


def names_variant(kind, known, path, text):
    """Whether code names one of the variants."""
    alternatives = "|".join(known)
    if re.search(rf"\b{kind}::(?:{alternatives})\b", text):
        return True
    if re.search(rf"\buse [\w:]*{kind}::(?:\{{|\*)", text) or path in CHOICES.values():
        return re.search(rf"\b(?:{alternatives})\b", text) is not None
    return (
        re.search(rf"\bimpl {kind} {{", text) is not None
        and re.search(rf"\bSelf::(?:{alternatives})\b", text) is not None
    )


def cost(kind, root=ROOT):
    """The files that name a variant of a type, sorted."""
    known = variants(kind, (root / CHOICES[kind]).read_text(encoding="utf-8"))
    found = []
    for file in root.glob("crates/**/*.rs"):
        path = file.relative_to(root).as_posix()
        if TESTS.search(path) or is_own(path, set(known.values())):
            continue
        if names_variant(kind, known, path, code(file.read_text(encoding="utf-8"))):
            found.append(path)
    return sorted(found)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--check", action="store_true", help="fail above a limit")
    parser.add_argument("--list", action="store_true", help="name the files")
    args = parser.parse_args()
    above = False
    for kind, limit in LIMITS.items():
        files = cost(kind)
        print(f"{kind}: {len(files)} files name a variant, at most {limit}")
        if args.list or (args.check and len(files) > limit):
            print("".join(f"    {file}\n" for file in files), end="")
        above |= len(files) > limit
    if args.check and above:
        sys.exit("too many files know which variant it is; ask the design (crates/design/src/organization.rs, kind.rs)")


if __name__ == "__main__":
    main()
