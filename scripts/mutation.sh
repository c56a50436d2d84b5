#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Tests the vectors with mutants of the Verilog of all organizations: the co-simulation vectors must kill every mutant that is neither
# proven equivalent nor waived in mutation/survivors.txt with a reason. Any other survivor is an error, and so is an unused waiver.
# Installs missing tools.
#
#   scripts/mutation.sh              all mutants
#   scripts/mutation.sh --sample 20  20 mutants of each organization, short vectors
#   scripts/mutation.sh --help       all options
#
# FOVEATE         an executable to use instead of the debug build
# FOVEATE_YOSYS   another executable than the one in PATH
# JOBS            number of parallel jobs (default: number of processors)
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
-h | --help) sed -n '3,13s/^# \{0,1\}//p' "$0" && exec python3 scripts/checks/mutation --help ;;
esac
scripts/install_tools.sh
FOVEATE=$(scripts/checks/foveate.sh)
export FOVEATE
exec python3 scripts/checks/mutation "$@"
