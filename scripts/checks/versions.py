#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Checks that all files name the version of Cargo.toml, and that published crates have all the files that they need.

    scripts/checks/versions.py                  on every commit
    scripts/checks/versions.py --print          prints the version
    scripts/checks/versions.py --release [TAG]  also checks a release: a dated section of the changelog, that date in CITATION.cff,
                                         the repository's address, and the tag, if there is one
"""
import datetime
import pathlib
import re
import sys

import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
LICENSES = ("LICENSE-APACHE", "LICENSE-MIT")


def citation_value(text, key):
    """Returns the value of a key at the left margin of CITATION.cff, or None."""
    match = re.search(rf'^{key}: *"?([^"\n]*?)"? *$', text, re.MULTILINE)
    return match and match[1]


def newest_section(changelog):
    """Returns the newest section of the changelog: its title, its date or None, and its text."""
    match = re.search(r"^## \[([^\]]+)\](?: - (\S+))?\n(.*?)(?=^## \[|\Z)", changelog, re.MULTILINE | re.DOTALL)
    return match.groups() if match else (None, None, "")


def disagreements(manifest, pyproject, citation, changelog):
    """Yields each place that names another version than the manifest of the workspace."""
    version = manifest["workspace"]["package"]["version"]
    for name, dependency in manifest["workspace"]["dependencies"].items():
        if isinstance(dependency, dict) and "path" in dependency and dependency.get("version") != f"={version}":
            yield f'Cargo.toml: {name} is of version {dependency.get("version")}; it has to be "={version}"'
    if "version" not in pyproject["project"].get("dynamic", []):
        yield "pyproject.toml: the version has to be dynamic, so that maturin takes that of Cargo.toml"
    if citation_value(citation, "version") != version:
        yield f"CITATION.cff: version is {citation_value(citation, 'version')}; it has to be {version}"
    title, _, _ = newest_section(changelog)
    if title not in ("Unreleased", version):
        yield f"CHANGELOG.md: the newest section is [{title}]; it has to be [Unreleased] or [{version}]"


def release_problems(manifest, citation, changelog, tag=None):
    """Yields the problems that keep this commit from being a release."""
    package = manifest["workspace"]["package"]
    version = package["version"]
    title, date, text = newest_section(changelog)
    if title != version:
        yield f"CHANGELOG.md: the newest section is [{title}]; name it [{version}] - {datetime.date.today()}"
    elif not re.fullmatch(r"\d{4}-\d\d-\d\d", date or ""):
        yield f"CHANGELOG.md: section [{version}] is of {date}; a day like {datetime.date.today()} has to stand there"
    elif citation_value(citation, "date-released") != date:
        yield f"CITATION.cff: date-released is {citation_value(citation, 'date-released')}; the changelog says {date}"
    if not re.search(r"^- ", text, re.MULTILINE):
        yield f"CHANGELOG.md: section [{title}] says nothing"
    if not package.get("repository"):
        yield "Cargo.toml: [workspace.package] has no repository; `cargo binstall` looks for archives below it"
    if tag not in (None, f"v{version}"):
        yield f"the tag is {tag}; it has to be v{version}"


def missing_files(folder):
    """Yields the files that a published crate must have in its folder, and lacks."""
    package = tomllib.loads((folder / "Cargo.toml").read_text())["package"]
    if package.get("publish") is False:
        return
    if not package.get("description"):
        yield f"{folder.name}: no description in its manifest"
    for name in LICENSES:
        if not (folder / name).is_file():
            yield f"{folder.name}: no {name}; ln -s ../../{name} crates/{folder.name}/"
    for file in sorted(folder.rglob("*")):
        if file.is_symlink() and not file.resolve().is_relative_to(folder.resolve().parent.parent):
            yield f"{file}: a link that leads out of the project, whose target would be published"


def main(arguments):
    manifest, pyproject = (tomllib.loads((ROOT / name).read_text()) for name in ("Cargo.toml", "pyproject.toml"))
    citation, changelog = ((ROOT / name).read_text() for name in ("CITATION.cff", "CHANGELOG.md"))
    problems = list(disagreements(manifest, pyproject, citation, changelog))
    for folder in sorted((ROOT / "crates").iterdir()):
        if (folder / "Cargo.toml").is_file():
            problems += missing_files(folder)
    match arguments:
        case []:
            pass
        case ["--print"]:
            print(manifest["workspace"]["package"]["version"])
            return
        case ["--release", *tag] if len(tag) < 2:
            problems += release_problems(manifest, citation, changelog, *tag)
        case _:
            sys.exit(f"versions: unknown arguments {' '.join(arguments)}; see the head of scripts/checks/versions.py")
    if problems:
        sys.exit("\n".join(problems))


if __name__ == "__main__":
    main(sys.argv[1:])
