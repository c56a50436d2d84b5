#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Makes the bitstream of every board that open tools know, from nothing, and writes what it takes and reaches as a table:
# docs/data/boards.csv. Takes about an hour on two processors. Installs what is missing from PyPI.
#
#   scripts/boards.sh            all of them
#   scripts/boards.sh NAME...    these; prints their rows
#
# FOVEATE   the program (default: built here)
# SEEDS     how often each is placed (default: 5)
set -euo pipefail
cd "$(dirname "$0")/.."

PATH=$PATH:$(scripts/python_tools.sh --boards)
export PATH
FOVEATE=${FOVEATE:-$(scripts/foveate.sh)}
export FOVEATE
exec scripts/boards.py "$@"
