#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Proves the properties in formal/ of the Verilog with SymbiYosys, and checks that the same proofs fail for faults injected into the
# Verilog. Installs missing tools.
#
#   scripts/formal.sh             everything
#   scripts/formal.sh --quick     a small set, for every change, with the Yosys in PATH instead of that from PyPI
#   scripts/formal.sh NAME...     some of formal/NAME.sby
#   scripts/formal.sh --list      lists the proofs
#
# FOVEATE   an executable to use instead of the debug build
# JOBS      number of parallel jobs (default: number of processors)
set -euo pipefail
cd "$(dirname "$0")/.."
set=()
for option in "$@"; do
    case $option in
    -h | --help) sed -n '3,12s/^# \{0,1\}//p' "$0" && exit 0 ;;
    --quick) set=(--quick) ;;
    --list) exec python3 scripts/checks/formal.py "$@" ;;
    esac
done
scripts/install_tools.sh
tools=$(scripts/python_tools.sh "${set[@]}")
FOVEATE=$(scripts/checks/foveate.sh)
export FOVEATE
exec env PATH="$tools:$PATH" python3 scripts/checks/formal.py "$@"
