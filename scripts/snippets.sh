#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Runs the documents: on every page of docs/ and in README.md that has a block of Python, the indented lines that start with
# `foveate ` and the blocks themselves, in the order of the page, as they stand, in a folder of its own that holds what a reader
# has (see `given` in snippets.py). Then it reads tables with difficult names with every reader that people use. The blocks have the
# Python package and what its tests have, see python.sh.
#
# FOVEATE            an executable to use instead of the debug build
# FOVEATE_PACKAGE    where python.sh has installed the package, instead of building it
set -euo pipefail
cd "$(dirname "$0")/.."
tools=$(scripts/python.sh)
FOVEATE=$(scripts/foveate.sh)
export FOVEATE
exec "$tools/python" scripts/snippets.py "$@"
