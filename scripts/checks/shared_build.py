#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Fails if the build of the Python package for tests compiled one of our crates again, after a build of the tests.

    scripts/checks/shared_build.py LOG    the log of scripts/python.sh: target/wheels/build.log

The feature `as-tested` of the package turns on the same features of libraries as the tests do. If a test needs another feature, Cargo
would compile that library and some twenty crates above it a second time without a message.
"""
import re
import sys

PACKAGE = "foveate-python"
with open(sys.argv[1], encoding="utf-8") as log:
    compiled = set(re.findall(r"^\s*Compiling (\S+) v", log.read(), re.MULTILINE))
again = sorted(name for name in compiled - {PACKAGE} if name == "foveate" or name.startswith("foveate-"))
if again:
    sys.exit(f"{PACKAGE} is built with other features than the tests are, and compiles {len(again)} crates again: {', '.join(again)}\n"
             "Add to `as-tested` in python/Cargo.toml what a test turns on: `cargo tree --edges features --invert CRATE` shows it.")
