#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# Plays the recorded traffic through `{= top =}` again, in Verilator.
#
#   ./replay.sh [waves]
#
# The output of the core goes into heard.txt; `waves` also writes waves.fst. Exit code 0: the output differs from the run with
# the mismatch; 1: it is the same; 2: the simulation cannot be built or does not end.

cd "$(dirname "$0")" || exit 2
build=$(mktemp -d) || exit 2
trap 'rm -rf "$build"' EXIT

set --{% for file in files %} \
    "$PWD"/{= file =}{% endfor %}

verilator --cc --exe --build -j 0 -CFLAGS -Og --no-timing --top-module {= top =} --prefix V{= top =} --Mdir "$build" \
    -Wno-fatal -Wno-lint -Wno-style --x-assign unique --x-initial unique ${1:+--trace-fst} \
    "$@" "$PWD/axi.cpp" >"$build/log" 2>&1 || { cat "$build/log" && exit 2; }
"$build/V{= top =}" {= seed =} waves.fst <traffic.txt >heard.txt
code=$?
# Foveate may replace the listed files.
for made in heard.txt waves.fst; do
    if [ -f "$made" ] && [ -f .foveate ]; then sha256sum "$made" >>.foveate; fi
done
[ "$code" = 0 ] || exit 2

if cmp -s heard.txt heard_then.txt; then
    echo "the same as in the run with the mismatch, which README.md names"
    exit 1
fi
echo "something else is heard than in the run with the mismatch: run \`foveate cosim\` again, which compares it with the model"
