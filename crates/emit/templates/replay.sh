#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# {= banner =}
#
# Replays the recorded vectors through {% if has_rpu %}`{= before =}rpu` and {% endif %}`{= before =}rcm` and compares every output at every clock.
#
#   sh tb/replay.sh [all|{% if has_rpu %}rpu|{% endif %}rcm] [iverilog|verilator] [waves]
#
# `waves` writes {% if has_rpu %}{= before =}rpu.vcd or {% endif %}{= before =}rcm.vcd where the command is run. Exit code 0: every bench says PASS; 1: one
# says FAIL, or INCOMPLETE because its vectors do not show everything; 2: a bench cannot be built or run.

which=${1:-all}
simulator=${2:-{= simulator =}}
waves=${3:+waves}
here=$(pwd)
cd "$(dirname "$0")/.." || exit 2
build=$(mktemp -d) || exit 2
trap 'rm -rf "$build"' EXIT

replay() {
    top={= before =}$1
    dump=${waves:++waves=$here/$top.vcd}
    mkdir -p "$build/$top" || return 2
    case $simulator in
    iverilog)
        iverilog -g2005 -s "${top}_replay" -o "$build/$top/simulation" -f "$top.f" "tb/${top}_replay.v" || return 2
        vvp -n "$build/$top/simulation" "+vectors=tb/${top}_vectors.hex" ${dump:+"$dump"} >"$build/$top/log" 2>&1
        ;;
    verilator)
        # Registers start at random, so that one which reset forgets does not start at 0 by chance.
        verilator --binary --timing --top-module "${top}_replay" --Mdir "$build/$top" \
            -Wno-fatal -Wno-lint -Wno-style ${waves:+--trace} \
            --x-assign unique --x-initial unique -f "$top.f" "tb/${top}_replay.v" >"$build/$top/build.log" 2>&1 ||
            { cat "$build/$top/build.log" && return 2; }
        "$build/$top/V${top}_replay" +verilator+rand+reset+2 +verilator+seed+1 \
            "+vectors=tb/${top}_vectors.hex" ${dump:+"$dump"} >"$build/$top/log" 2>&1
        ;;
    *)
        echo "unknown simulator \`$simulator\`; use iverilog or verilator" >&2
        return 2
        ;;
    esac
    grep '^\(MISMATCH\|PASS\|FAIL\|INCOMPLETE\)' "$build/$top/log" | sed "s/^/$1: /"
    grep -q '^PASS' "$build/$top/log" && return 0
    grep -q '^\(FAIL\|INCOMPLETE\)' "$build/$top/log" && return 1
    cat "$build/$top/log"
    return 2
}

case $which in
all) tops='{% if has_rpu %}rpu {% endif %}rcm' ;;
{% if has_rpu %}rpu | {% endif %}rcm) tops=$which ;;
*)
    echo "unknown module \`$which\`; use all{% if has_rpu %}, rpu{% endif %} or rcm" >&2
    exit 2
    ;;
esac
worst=0
for top in $tops; do
    replay "$top"
    code=$?
    [ "$code" -le "$worst" ] || worst=$code
done
exit "$worst"
