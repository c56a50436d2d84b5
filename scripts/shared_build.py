#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""After a build of the tests and of the Python package for tests: fails if the second compiled a crate of ours again.

    scripts/shared_build.py LOG    what scripts/python.sh has kept: target/wheels/build.log

The feature `as-tested` of the package turns on in libraries what tests turn on. If a test comes to want more of one, Cargo would
compile it and some twenty crates above it a second time, and nothing would say so.
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
