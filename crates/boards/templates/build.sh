#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# {= banner =}
#
# Makes {= bitstream =} of {= title =}:
# synthesizes with Yosys, places and routes with nextpnr from several seeds, and packs the fastest result.
#
#   sh build.sh [SEEDS]
#
# SEEDS is the number of seeds, 1 by default. Exit code 1: the design does not fit, is too slow, or a tool fails; 2: bad usage;
# 3: a tool is missing.
# YOSYS, NEXTPNR, PACK   programs to use in place of those that are found

seeds=${1:-1}
cd "$(dirname "$0")" || exit 2
case $seeds in
'' | *[!0-9]* | 0*) echo "\`$seeds\` seeds are none; use a number from 1 on" >&2 && exit 2 ;;
esac

# Prints the first of these programs that exists, beginning with the one that the user asked for.
find_tool() {
    for name in "$@"; do
        [ -n "$name" ] && command -v "$name" && return
    done
    shift
    echo "none of these programs is there: $*; {= install =}" >&2
    exit 3
}
yosys=$(find_tool "${YOSYS:-}" {= yosys =}) || exit
nextpnr=$(find_tool "${NEXTPNR:-}" {= nextpnr =}) || exit
pack=$(find_tool "${PACK:-}" {= pack =}) || exit

# Runs a program with its output in a log, and shows the errors of a program that failed.
run() {
    log=$1
    shift
    "$@" >"$log" 2>&1 && return
    grep '^ERROR' "$log" >&2 || tail -n 20 "$log" >&2
    echo "$1 failed; its log is $log" >&2
    exit 1
}

# Lists the files that this script makes. Any other file of the folder was not made by it.
made() {
    for file in build/yosys.log build/board.json build/seed[0-9]*.* build/clocks build/sorted build/pack.log build/report.json \
        build/packed {= bitstream =}; do
        [ ! -f "$file" ] || echo "$file"
    done
}
# Lists these files at every exit, so that Foveate may replace them.
list() {
    [ -f .foveate ] && command -v sha256sum >/dev/null || return
    made | while read -r file; do sha256sum "$file"; done >>.foveate
}
made | while read -r file; do rm "$file"; done
mkdir -p build || exit 2
trap list EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM
run build/yosys.log "$yosys" -Q -T -s build.ys
seed=1
: >build/clocks
while [ "$seed" -le "$seeds" ]; do
    # shellcheck disable=SC2046,SC2086 # words of their own
    run "build/seed$seed.log" "$nextpnr" {= arguments =} --timing-allow-fail --json build/board.json \
        --seed "$seed" --report "build/seed$seed.json" {= write_arguments =}
    # The last line of each clock is used, because the lines before are not of the routed design. The core and the sensor have
    # separate clocks.
    tac "build/seed$seed.log" | sed -n "s/.*Max frequency for clock *'\([^']*\)': *\([0-9.]*\) MHz.*/\1 \2/p" | awk '!seen[$1]++' >"build/seed$seed.clocks"
    core=$(awk '!/pclk/ && !/clk_i/ { print $2 }' "build/seed$seed.clocks" | head -n 1)
    [ -n "$core" ] || core=$(awk '!/pclk/ { print $2 }' "build/seed$seed.clocks" | head -n 1)
    pixels=$(awk '/pclk/ { print $2 }' "build/seed$seed.clocks" | head -n 1)
    echo "${core:-0} ${pixels:-0} $seed" >>build/clocks
    seed=$((seed + 1))
done
sort -n build/clocks >build/sorted
worst=$(head -n 1 build/sorted)
# Packs the core with the fastest clock among those whose other clock is fast enough, or else the one with the fastest
# clock.
best=$(awk '$1 >= {= core_mhz =} && $2 >= {= pclk_mhz =}' build/sorted | tail -n 1)
fast=${best:+yes}
[ -n "$best" ] || best=$(tail -n 1 build/sorted)
median=$(sed -n "$(((seeds + 1) / 2))p" build/sorted)
seed=${best##* }
run build/pack.log "$pack" {= pack_arguments =}
cp "build/seed$seed.json" build/report.json
echo "$best" >build/packed
echo "clock of the core: ${best%% *} MHz (seed $seed, packed), median ${median%% *}, worst ${worst%% *} of $seeds seeds; {= core_mhz =} needed"
pixels=${best#* }
echo "clock of the sensor: ${pixels%% *} MHz; {= pclk_mhz =} needed"
[ -n "$fast" ] || { echo "too slow: {= bitstream =} may not work" >&2 && exit 1; }
