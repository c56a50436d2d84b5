#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Finds source files of a crate that import each other in a circle.

    scripts/checks/circles.py

A file that imports a second one, which imports the first, can only be read together with it. Circles are allowed between a
module and those in its folder: parent and child are one thing. This prints every other circle, and fails if there is one.

An import is a `use`, or a path from `crate`. An import of an item that `pub use` re-exports counts as an import of the file that
defines the item. Comments and the code after `#[cfg(test)]` are ignored.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
USE = re.compile(r"\buse ([^;]+);")
PUBLIC_USE = re.compile(r"\bpub(?:\([a-z]+\))? use ([^;]+);")
PATH = re.compile(r"\bcrate((?:::\w+)+)")


def code(text):
    """Returns a text without its comments and tests."""
    return re.sub(r"//.*", "", text.split("#[cfg(test)]\nmod tests {")[0])


def paths(tree, before=()):
    """Returns the paths of a `use`, each as a tuple: `a::{b, c::d}` gives (a, b) and (a, c, d)."""
    tree_paths, part, depth = [], "", 0
    for character in tree + ",":
        depth += {"{": 1, "}": -1}.get(character, 0)
        if character != "," or depth:
            part += character
            continue
        start, brace, inside = part.strip().partition("{")
        names = tuple(name for name in start.split(" as ")[0].strip().split("::") if name)
        if brace:
            tree_paths += paths(inside.rpartition("}")[0], before + names)
        elif names:
            tree_paths.append(before + names)
        part = ""
    return tree_paths


class Crate:
    """The modules of a crate, each a tuple of names; () is the root."""

    def __init__(self, texts):
        self.texts = {module: code(text) for module, text in texts.items()}
        self.reexports = {}
        for module, text in self.texts.items():
            for tree in PUBLIC_USE.findall(text):
                for path in paths(tree):
                    if (target := self.absolute(module, path)) is not None:
                        self.reexports[(*module, path[-1])] = target

    def absolute(self, module, path):
        """Returns a path from the root of the crate, or None if it leads out of the crate."""
        if path[0] == "crate":
            return path[1:]
        if path[0] == "self":
            return module + path[1:]
        if path[0] == "super":
            up = len([name for name in path if name == "super"])
            return module[: len(module) - up] + path[up:]
        return module + path if module + path[:1] in self.texts else None

    def defining_module(self, path, steps=8):
        """Returns the module that defines the item at a path, following `pub use`."""
        for length in range(len(path), -1, -1):
            if path[:length] not in self.texts:
                continue
            target = self.reexports.get(path[: length + 1])
            if length < len(path) and target is not None and steps:
                return self.defining_module(target + path[length + 1 :], steps - 1)
            return path[:length]
        return None

    def imports(self, module):
        """Returns the modules that a module imports, except its parents and children."""
        text = self.texts[module]
        imported_paths = [self.absolute(module, path) for tree in USE.findall(text) for path in paths(tree)]
        imported_paths += [tuple(path.split("::")[1:]) for path in PATH.findall(text)]
        imported_modules = {self.defining_module(path) for path in imported_paths if path is not None} - {None}
        return {other for other in imported_modules if not is_related(module, other)}

    def circles(self):
        """Returns the sets of modules in which each module reaches all others."""
        edges = {module: self.imports(module) for module in self.texts}
        reached = {module: reachable_modules(edges, module) for module in edges}
        in_circle = {module for module in edges if module in reached[module]}
        sets = {frozenset(other for other in reached[module] if module in reached[other]) for module in in_circle}
        return [{module: edges[module] & members for module in members} for members in sets]


def is_related(module, other):
    """Returns whether two modules are the same, or one is in the folder of the other."""
    shorter = min(len(module), len(other))
    return bool(shorter) and module[:shorter] == other[:shorter] or not module or not other


def reachable_modules(edges, start):
    """Returns the modules that a module imports, directly and indirectly."""
    reached, pending = set(), [start]
    while pending:
        for other in edges[pending.pop()] - reached:
            reached.add(other)
            pending.append(other)
    return reached


def crate_at(folder):
    """Returns the crate whose sources are in a folder."""
    texts = {}
    for file in sorted(folder.rglob("*.rs")):
        names = file.relative_to(folder).with_suffix("").parts
        texts[names[:-1] if names[-1] in ("mod", "lib", "main") else names] = file.read_text()
    return Crate(texts)


def main():
    count = 0
    for folder in sorted((ROOT / "crates").glob("*/src")):
        for circle in crate_at(folder).circles():
            count += 1
            print(f"{folder.parent.name}: files import each other:")
            for module, others in sorted(circle.items()):
                print(f"    {'::'.join(module)} imports {', '.join(sorted('::'.join(other) for other in others))}")
    sys.exit(1 if count else 0)


if __name__ == "__main__":
    main()
