#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Lints generated Verilog in four tools over a matrix of designs: verilator -Wall, iverilog -Wall, yosys check, slang -Weverything.
# A finding without a waiver in lint/waivers.txt is an error, and so is an unused waiver. Installs missing tools.
#
#   scripts/lint.sh             every design of the matrix
#   scripts/lint.sh --quick     every fifteenth design of each matrix
#
# FOVEATE                            an executable to use instead of the debug build
# FOVEATE_VERILATOR, FOVEATE_YOSYS   other executables than those in PATH
# JOBS                               number of parallel jobs (default: number of processors)
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
-h | --help) sed -n '3,12s/^# \{0,1\}//p' "$0" && exit 0 ;;
'' | --quick) ;;
*) echo "lint: unknown option $1; see scripts/lint.sh --help" >&2 && exit 2 ;;
esac
scripts/install_tools.sh
tools=$(scripts/python_tools.sh --quick)
FOVEATE=$(scripts/checks/foveate.sh)
export FOVEATE
exec "$tools/python" scripts/checks/lint.py "$@"
