#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Runs every check: format, clippy, documentation, unit, property, golden, command line, RTL lint, co-simulation, a sample of
# proofs and of mutants. Installs what is missing.
#
# A missing tool fails (FOVEATE_REQUIRE_TOOLS=1). Real images and video are used where FOVEATE_DATA names their folder.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }

step "tools"
scripts/install_tools.sh
export FOVEATE_REQUIRE_TOOLS=1
step "format"
cargo fmt --all --check
step "clippy"
cargo clippy --workspace --all-targets --locked --quiet -- -D warnings
step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked --quiet
step "a small set of proofs (scripts/formal.sh is the whole)"
scripts/formal.sh --quick
step "a sample of the lint matrix (scripts/lint.sh is the whole)"
scripts/lint.sh --quick
step "a sample of mutants (scripts/mutation.sh is the whole)"
scripts/mutation.sh --sample 10
step "tests"
cargo test --workspace --locked --quiet --doc
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cargo test --workspace --locked --lib --bins --tests | tee "$log"
awk '/^test result:/ { passed += $4; failed += $6 } END { print passed " passed, " failed " failed" }' "$log"
