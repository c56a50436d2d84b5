#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""After a build of the tests: fails if the build of the Python package for tests (scripts/python.sh) compiles a crate again.

The feature `as-tested` of the package turns on in libraries what tests turn on. If a test comes to want more of one, Cargo would
compile it and some twenty crates above it a second time, and nothing would say so.
"""
import json
import subprocess
import sys

PACKAGE = "foveate-python"
build = ["cargo", "build", "--locked", "--quiet", "--package", PACKAGE, "--features", "as-tested", "--message-format", "json"]
messages = subprocess.run(build, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
built = [message for message in map(json.loads, messages) if message["reason"] == "compiler-artifact" and not message["fresh"]]
# These follow the interpreter that is found, and nothing else is above them.
OWN = {"_foveate", "numpy", "pyo3", "pyo3_ffi", "build-script-build"}
again = sorted({message["target"]["name"] for message in built} - OWN)
if again:
    sys.exit(f"{PACKAGE} is built with other features than the tests are, and compiles {len(again)} crates again: {', '.join(again)}\n"
             "Add to `as-tested` in python/Cargo.toml what a test turns on: `cargo tree --edges features --invert CRATE` shows it.")
