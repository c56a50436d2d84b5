#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# Replays the recorded vectors through `{= top =}`.
#
#   ./replay.sh [iverilog|verilator] [waves]
#
# `waves` writes waves.fst (waves.vcd with Verilator). Exit code 0: no mismatch; 1: a mismatch; 2: the simulation cannot be
# built or does not end.

cd "$(dirname "$0")" || exit 2
simulator=${1:-{= simulator =}}
waves=${2:+waves}
build=$(mktemp -d) || exit 2
trap 'rm -rf "$build"' EXIT

set --{% for file in files %} \
    {= file =}{% endfor %}

# The exit code of a simulator says no more than the verdict in its log.
case $simulator in
iverilog)
    iverilog -g2005 -s {= bench =} -o "$build/simulation" "$@" {= bench_file =} || exit 2
    vvp -n "$build/simulation" ${waves:+-fst} +vectors={= vectors_file =} \
        ${waves:++waves=waves.fst} >"$build/log" 2>&1
    ;;
verilator)
    # Registers start at random values. So a register that a reset forgets does not start at 0 by chance.
    verilator --binary --timing --top-module {= bench =} --Mdir "$build" \
        -Wno-fatal -Wno-lint -Wno-style ${waves:+--trace} \
        --x-assign unique --x-initial unique "$@" {= bench_file =} >"$build/log" 2>&1 ||
        { cat "$build/log" && exit 2; }
    "$build/V{= bench =}" +verilator+rand+reset+2 +verilator+seed+{= seed =} \
        +vectors={= vectors_file =} ${waves:++waves=waves.vcd} >"$build/log" 2>&1
    ;;
*)
    echo "unknown simulator \`$simulator\`; use iverilog or verilator" >&2
    exit 2
    ;;
esac

# Foveate may replace the listed files.
for made in waves.fst waves.vcd; do
    if [ -n "$waves" ] && [ -f "$made" ] && [ -f .foveate ]; then sha256sum "$made" >>.foveate; fi
done
cat "$build/log"
grep -q '^PASS' "$build/log" && exit 0
grep -q '^FAIL' "$build/log" && exit 1
exit 2
