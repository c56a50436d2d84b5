#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Cores on AXI in Icarus, between sources, sinks and masters of cocotbext-axi; see the head of scripts/buses.py. Installs what it
# needs, but for Icarus and Rust.
#
#   scripts/buses.sh            all designs, and faults that the tests must find
#   scripts/buses.sh --quick    the first
#
# FOVEATE   the program (default: built here)
set -euo pipefail
cd "$(dirname "$0")/.."

tools=$(scripts/python_tools.sh --buses)
FOVEATE=${FOVEATE:-$(scripts/foveate.sh)}
export FOVEATE
exec "$tools/python" scripts/buses.py "$@"
