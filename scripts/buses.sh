#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Tests cores on AXI with tools that are not ours: their register tables with the compiler of PeakRDL (scripts/checks/registers.py), and
# the cores in Icarus, between sources, sinks and masters of cocotbext-axi (scripts/checks/buses.py). Installs missing tools, except
# Icarus and Rust.
#
#   scripts/buses.sh            all designs, and faults that the tests must find
#   scripts/buses.sh --quick    the registers, and the first design
#
# FOVEATE   the program (default: built here)
set -euo pipefail
cd "$(dirname "$0")/.."

tools=$(scripts/python_tools.sh --buses)
FOVEATE=${FOVEATE:-$(scripts/checks/foveate.sh)}
export FOVEATE
"$tools/python" scripts/checks/registers.py
exec "$tools/python" scripts/checks/buses.py "$@"
