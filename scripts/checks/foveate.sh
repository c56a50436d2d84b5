#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Prints the path of the executable that the scripts of verification use: FOVEATE, if it is set, or the debug build, which is made if
# it is missing. After a build of all tests set FOVEATE: for the executable alone Cargo chooses other features of some libraries, and
# would compile nearly all crates above these again.
set -euo pipefail
cd "$(dirname "$0")/../.."
if [ -n "${FOVEATE:-}" ]; then
    realpath -e "$FOVEATE" || { echo "FOVEATE names no executable: $FOVEATE" >&2 && exit 2; }
    exit
fi
cargo build --locked --quiet --package foveate >&2
realpath "${CARGO_TARGET_DIR:-target}/debug/foveate"
