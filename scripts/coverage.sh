#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Line and toggle coverage of the Verilog under the vectors of `foveate cosim`, per module, over a few designs, and what the
# vectors never reach. The vectors are those that co-simulation gives to Icarus; they are replayed in Verilator. A serial
# design is an array of 3x2 regions.
# What docs/verification.md explains is listed in scripts/coverage_holes.txt; any other hole is an error. Installs what is missing.
#
#   scripts/coverage.sh [--quick]
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
-h | --help) sed -n '3,8s/^# \{0,1\}//p' "$0" && exit 0 ;;
'' | --quick) ;;
*) echo "coverage: unknown option $1; see scripts/coverage.sh --help" >&2 && exit 2 ;;
esac
scripts/install_tools.sh
foveate=$(scripts/foveate.sh)
target=$(realpath "${CARGO_TARGET_DIR:-target}")
work=$target/coverage
rm -rf "$work"
mkdir -p "$work"

# Verilator's own main does not write coverage in every version.
cat >"$work/main.cpp" <<'END'
#include "Vreplay.h"
#include "verilated.h"
#include "verilated_cov.h"
#include <memory>
int main(int argc, char** argv) {
    const auto context = std::make_unique<VerilatedContext>();
    context->commandArgs(argc, argv);
    const auto top = std::make_unique<Vreplay>(context.get());
    while (!context->gotFinish()) {
        top->eval();
        if (!top->eventsPending()) break;
        context->time(top->nextTimeSlot());
    }
    top->final();
    context->coveragep()->write("coverage.dat");
}
END

edge="{feature='edge',level=100,min_score=5}"
corner="{feature='corner',level=20,min_score=3}"
all="[$edge,$corner,{feature='mad',min_score=4},{feature='variance',min_score=30}]"
fraction="{feature='mad',min_score=4,mean_fraction_bits=2}"
serial="--level rcm --grid 3x2 --set hardware.organization='serial'"
names=(paper all)
settings=("paper" "paper --set denoise.filter='none' --set temporal.reference='last-sent' --set spatial=$all")
if [ "${1:-}" != --quick ]; then
    names+=(shared raw odd large serial_sent serial_all serial_none serial_shared serial_raster serial_block)
    settings+=(
        "paper --set region.neighborhood='shared' --set spatial=[$corner,$edge] --set decision.combine='all'"
        "paper --set render.payload='raw' --set render.irrelevant='hold' --set spatial=$all"
        "bare --set region.size=5 --set frame.pixel_bits=10 --set spatial=$all"
        "bare --set region.size=17 --set temporal.reference='last-sent'"
        "paper $serial --set region.size=4 --set temporal.reference='last-sent' --set hardware.fold=2"
        "paper $serial --set region.size=4 --set spatial=$all"
        "bare $serial --set region.size=5 --set temporal.reference='last-sent' --set hardware.feed='raster' --set spatial=[$corner]"
        "paper $serial --set region.size=4 --set region.neighborhood='shared' --set temporal.reference='last-sent' --set hardware.fold=2"
        "paper $serial --set region.size=5 --set region.neighborhood='shared' --set hardware.feed='raster' --set hardware.fold=4"
        "bare $serial --set region.size=16 --set frame.pixel_bits=10 --set hardware.fold=4 --set spatial=[$edge,$fraction] --set render.payload='raw'"
    )
fi
for index in "${!names[@]}"; do
    name=${names[index]}
    read -ra words <<<"${settings[index]}"
    export KEEP=$work/$name
    mkdir -p "$KEEP"
    echo "$name: foveate cosim --preset ${words[*]}"
    FOVEATE_CACHE=off FOVEATE_IVERILOG=$PWD/scripts/keeping/iverilog FOVEATE_VVP=$PWD/scripts/keeping/vvp \
        "$foveate" cosim --simulator iverilog --preset "${words[@]}" --replay "$work/replay" --quiet | sed -n 1p
    (
        cd "$KEEP"
        top=rpu_replay
        [[ $name != serial* ]] || top=rcm_replay
        mapfile -t files < <(find . -name '*.v' | sort)
        verilator --cc --exe --build --timing --top-module "$top" --prefix Vreplay --Mdir build --coverage-line --coverage-toggle \
            -Wno-fatal -Wno-lint -Wno-style --x-assign unique --x-initial unique "${files[@]}" "$work/main.cpp" >build.log 2>&1 ||
            { tail -5 build.log >&2 && exit 3; }
        build/Vreplay +vectors=vectors.hex +verilator+rand+reset+2 >run.log
        grep -q '^PASS' run.log || { echo "coverage: the replay of $name does not pass, see $KEEP/run.log" >&2 && exit 1; }
    )
done
exec python3 scripts/coverage.py "$work" "${names[@]}"
