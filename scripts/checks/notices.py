#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Prints the licences of everything that is linked into the command, which must be passed on with copies of the program.

    scripts/checks/notices.py [TARGET]     by default x86_64-unknown-linux-gnu
"""
import collections
import json
import pathlib
import re
import subprocess
import sys

# Only files in the crate's own folder; licences in folders below belong to test data.
NAMES = re.compile(r"(?i)(license|licence|copying|notice|unlicense|copyright).*")


def linked_packages(metadata, name):
    """Returns the packages that are linked into the program `name`, without crates of tests and build scripts."""
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    packages = {package["id"]: package for package in metadata["packages"]}
    found_keys, pending = set(), [key for key, package in packages.items() if package["name"] == name]
    while pending:
        key = pending.pop()
        if key in found_keys:
            continue
        found_keys.add(key)
        for dependency in nodes[key]["deps"]:
            if any(kind["kind"] is None for kind in dependency["dep_kinds"]):
                pending.append(dependency["pkg"])
    return sorted((packages[key] for key in found_keys), key=lambda package: (package["name"], package["version"]))


def licence_texts(package):
    """Returns the texts of a package's licence files."""
    folder = pathlib.Path(package["manifest_path"]).parent
    files = sorted(file for file in folder.iterdir() if file.is_file() and NAMES.fullmatch(file.name))
    return [file.read_text(errors="replace").strip() for file in files]


def notices(packages):
    """Returns a list of the packages, then each text once, below the packages that have it."""
    lines = ["Licences of what is linked into foveate, beside its own and the Rust standard library (MIT OR Apache-2.0).", ""]
    packages_of_text = collections.defaultdict(list)
    for package in packages:
        label = f"{package['name']} {package['version']}"
        texts = licence_texts(package)
        note = "" if texts else f"; its package has no text of it, by {', '.join(package['authors']) or 'authors that it does not name'}"
        lines.append(f"{label}: {package['license'] or 'see below'}{note}")
        for text in texts:
            packages_of_text[text].append(label)
    for text, labels in packages_of_text.items():
        lines += ["", "-" * 80, ", ".join(labels), "", text]
    return "\n".join(lines)


def main(target="x86_64-unknown-linux-gnu"):
    command = ["cargo", "metadata", "--locked", "--format-version", "1", "--filter-platform", target]
    metadata = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
    others = [package for package in linked_packages(metadata, "foveate") if package["source"]]
    unlicensed = [package["name"] for package in others if not package["license"] and not licence_texts(package)]
    if unlicensed:
        sys.exit(f"notices: {', '.join(unlicensed)} say nothing of a licence")
    print(notices(others))


if __name__ == "__main__":
    main(*sys.argv[1:])
