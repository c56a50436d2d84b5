#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Measures line and toggle coverage of the Verilog under the vectors of `foveate cosim`, per module, over a few designs, and lists
# the points that the vectors never reach. The vectors are those that co-simulation gives to Icarus, replayed in Verilator. A serial
# design is an array of 3x2 regions, a raster core has 4x3 or more. Cores on AXI run as in `foveate cosim --level axi`.
# scripts/checks/coverage_holes.txt lists the holes that docs/verification.md explains; any other hole is an error. Installs missing tools.
#
#   scripts/coverage.sh            all designs
#   scripts/coverage.sh --quick    two of them
#   scripts/coverage.sh NAME...    some of them; unused explanations are not an error then
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
-h | --help) sed -n '3,10s/^# \{0,1\}//p' "$0" && exit 0 ;;
'' | --quick | [a-z]*) ;;
*) echo "coverage: unknown option $1; see scripts/coverage.sh --help" >&2 && exit 2 ;;
esac
scripts/install_tools.sh
foveate=$(scripts/checks/foveate.sh)
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
    // The sum of what instances count would say of a bit that is 1 in two of them that it moves.
    context->coveragep()->forcePerInstance(true);
    context->coveragep()->write("coverage.dat");
}
END

edge="{feature='edge',level=100,min_score=5}"
corner="{feature='corner',level=20,min_score=3}"
all=$(FOVEATE=$foveate python3 scripts/checks/features.py raster)
fraction="{feature='mad',min_score=4,mean_fraction_bits=2}"
serial="--level rcm --grid 3x2 --set hardware.organization='serial'"
raster="--level rcm --set hardware.organization='raster'"
deep="--set hardware.pipelining='deep'"
sync="--set hardware.sync=true"
switching="--set denoise.filter='switching3x3'"
binomial="--set denoise.filter='binomial3x3'"
means="--set render.irrelevant='mean'"
zones="--set zones={}"
axi="--level axi --set hardware.organization='raster' --set hardware.interface='axi'"
names=(paper all)
settings=("paper" "paper --set denoise.filter='none' --set temporal.reference='last-sent' --set spatial=$all")
if [ "${1:-}" != --quick ]; then
    names+=(shared raw odd large means serial_sent serial_all serial_none serial_shared serial_raster serial_block
        serial_means serial_deep serial_swift deep raster_plain raster_sums raster_sent raster_outside raster_single raster_mute raster_means
        array_sync serial_sync raster_sync switching binomial serial_switching serial_binomial serial_flow serial_flow_sent serial_flow_shared raster_switching raster_binomial
        axi axi_means axi_outside axi_odd array_zones array_zones_deep serial_zones serial_zones_deep raster_zones raster_zones_deep axi_zones)
    settings+=(
        "paper --set region.neighborhood='shared' --set spatial=[$corner,$edge] --set decision.combine='all'"
        "paper --set render.payload='raw' --set render.irrelevant='hold' --set spatial=$all"
        "bare --set region.size=5 --set frame.pixel_bits=10 --set spatial=$all"
        "bare --set region.size=17 --set temporal.reference='last-sent'"
        "paper $deep --rounds 4 --set region.size=6 --set render={irrelevant='mean',payload='raw'}"
        "paper $serial --set region.size=4 --set temporal.reference='last-sent' --set hardware.fold=2"
        "paper $serial --set region.size=4 --set spatial=$all"
        "bare $serial --set region.size=5 --set temporal.reference='last-sent' --set hardware.feed='raster' --set spatial=[$corner]"
        "paper $serial --set region.size=4 --set region.neighborhood='shared' --set temporal.reference='last-sent' --set hardware.fold=2"
        "paper $serial --set region.size=5 --set region.neighborhood='shared' --set hardware.feed='raster' --set hardware.fold=4"
        "bare $serial --set region.size=16 --set frame.pixel_bits=10 --set hardware.fold=4 --set spatial=[$edge,$fraction] --set render.payload='raw'"
        "paper $serial --set region.size=6 --set render={irrelevant='mean',payload='raw'} --set hardware.fold=4"
        "paper $serial $deep --set region.size=4 --set temporal.reference='last-sent' --set hardware.fold=2 --set spatial=$all"
        "bare $serial $deep --set region.size=5 --set hardware.fold=2 --set hardware.feed='raster' --set hardware.memory='block' --set spatial=[$corner,$fraction]"
        "paper $deep --rounds 4 --set temporal.reference='last-sent' --set spatial=$all"
        "paper $raster --grid 4x3 --set region.size=4"
        "paper $raster --grid 5x6 --rounds 6 --set region.size=5 --set denoise.filter='none' --set spatial=[$fraction,{feature='variance',min_score=30}] --set temporal.reference='last-sent'"
        "bare $raster --grid 8x3 $deep --set region={size=8,neighborhood='shared'} --set frame={width=222,height=222} --set hardware.pixels_per_clock=4 --set spatial=$all --set decision.combine='all' --set temporal.reference='last-sent' --set render={payload='raw',irrelevant='hold'}"
        "paper $raster --grid 8x2 --set region.size=8 --set frame={width=218,height=222} --set hardware.pixels_per_clock=4 --set hardware.store='external'"
        "bare $raster --grid 5x3 $deep --set region.size=5 --set frame={width=222,height=222} --set hardware.store='single-port' --set spatial=[$corner]"
        "bare $raster --grid 4x3 $deep --set region.size=6 --set frame={width=224,height=222} --set hardware.forward=false --set spatial=[{feature='mad',min_score=4}]"
        "paper $raster --grid 7x4 --rounds 2 --set region.size=12 --set frame={width=224,height=222} --set temporal.reference='last-sent' --set periphery.blocks=4 --set render={irrelevant='mean',payload='raw'}"
        "bare --level rcm --grid 3x2 --set region.size=4 $sync"
        "bare $serial --set region.size=4 --set hardware.feed='raster' $sync"
        "bare $raster --grid 5x2 --set region.size=4 --set frame={width=222,height=221} $sync"
        "bare $switching"
        "bare $binomial"
        "bare $serial --set region.size=4 $switching"
        "bare $serial --set region.size=4 $binomial"
        "bare $serial --set region.size=4 --set spatial=[{feature='flow',min_score=2}]"
        "paper $serial $deep --set region.size=5 --set temporal.reference='last-sent' --set hardware.fold=2 --set spatial=[$edge,{feature='flow',radius=3},{feature='surface'}]"
        "bare $serial --set region={size=6,neighborhood='shared'} --set hardware.feed='raster' --set spatial=[{feature='flow',radius=2,min_score=2}]"
        "bare $raster --grid 4x3 --set region.size=4 $switching"
        "bare $raster --grid 8x2 --set region.size=8 --set frame={width=218,height=222} --set hardware.pixels_per_clock=2 $binomial"
        "paper $axi --rounds 3 --set region.size=4 --set frame={width=24,height=16}"
        "bare $axi --rounds 3 --set region.size=4 --set frame={width=30,height=20,pixel_bits=10} --set hardware.pixels_per_clock=2 --set temporal.reference='last-sent' --set render={irrelevant='mean',payload='raw'} --set spatial=$all"
        "bare $axi --rounds 3 --set region.size=8 --set frame={width=32,height=16} --set hardware.store='external' --set hardware.thresholds='constant'"
        "bare $axi --rounds 3 --set region.size=5 --set frame={width=16,height=12} --set hardware.store='external' --set hardware.thresholds='constant'"
        "paper --level rcm --grid 3x2 --set region.size=4 $means --set spatial=$all $zones"
        "bare --level rcm --grid 3x2 $deep --rounds 4 --set region.size=5 --set temporal.reference='last-sent' --set spatial=[$edge,$fraction] $zones"
        "paper $serial --set region.size=4 --set hardware.fold=2 $means --set spatial=$all $zones"
        "bare $serial $deep --set region.size=5 --set hardware.feed='raster' --set temporal.reference='last-sent' --set spatial=[$edge,{feature='flow',radius=2}] $zones"
        "paper $raster --grid 5x4 --set region.size=4 $means --set spatial=$all $zones"
        "bare $raster --grid 8x4 $deep --set region.size=4 --set hardware.pixels_per_clock=2 --set temporal.reference='last-sent' --set spatial=[$corner,$fraction] $zones"
        "bare $axi --rounds 3 --set region.size=4 --set frame={width=32,height=20} $means --set spatial=[$edge,{feature='mad',min_score=4}] $zones"
    )
fi
chosen=()
for word in "$@"; do
    [[ $word != --* ]] || continue
    for index in "${!names[@]}"; do [ "${names[index]}" != "$word" ] || chosen+=("$index"); done
    [[ " ${names[*]} " == *" $word "* ]] || { echo "coverage: there is no design $word; there are ${names[*]}" >&2 && exit 2; }
done
[ ${#chosen[@]} -gt 0 ] || chosen=("${!names[@]}")
done_of=()
for index in "${chosen[@]}"; do
    name=${names[index]}
    done_of+=("$name")
    read -ra words <<<"${settings[index]}"
    export KEEP=$work/$name
    mkdir -p "$KEEP"
    echo "$name: foveate cosim --preset ${words[*]}"
    if [[ $name == axi* ]]; then
        # The program around the model is compiled into it, and each scene is a run of its own.
        FOVEATE_CACHE=off FOVEATE_VERILATOR=$PWD/scripts/checks/tool_wrappers/verilator FOVEATE_CXX=$PWD/scripts/checks/tool_wrappers/cxx \
            "$foveate" cosim --preset "${words[@]}" --replay "$work/replay" --quiet
        continue
    fi
    FOVEATE_CACHE=off FOVEATE_IVERILOG=$PWD/scripts/checks/tool_wrappers/iverilog FOVEATE_VVP=$PWD/scripts/checks/tool_wrappers/vvp \
        "$foveate" cosim --simulator iverilog --preset "${words[@]}" --replay "$work/replay" --quiet | sed -n 1p
    (
        cd "$KEEP"
        top=rpu_replay
        [[ $name != serial* && $name != raster* && $name != array* ]] || top=rcm_replay
        mapfile -t files < <(find . -name '*.v' | sort)
        verilator --cc --exe --build --timing --top-module "$top" --prefix Vreplay --Mdir build --coverage-line --coverage-toggle \
            -MAKEFLAGS OPT_FAST=-O0 -Wno-fatal -Wno-lint -Wno-style --x-assign unique --x-initial unique "${files[@]}" "$work/main.cpp" >build.log 2>&1 ||
            { tail -5 build.log >&2 && exit 3; }
        # Registers start at 0, because a constant with a random initial value may count as one that toggles.
        build/Vreplay +vectors=vectors.hex +verilator+rand+reset+0 >run.log
        grep -q '^PASS' run.log || { echo "coverage: the replay of $name does not pass, see $KEEP/run.log" >&2 && exit 1; }
    )
done
some=()
[ ${#done_of[@]} -eq ${#names[@]} ] || some=(--some)
exec python3 scripts/checks/coverage.py "$work" "${some[@]}" "${done_of[@]}"
