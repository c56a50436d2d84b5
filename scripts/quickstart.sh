#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Runs all steps on one design: configuration, model on frames, Verilog, co-simulation, area. Installs missing tools.
#
#   scripts/quickstart.sh [FOLDER]     writes to FOLDER, by default out/quickstart
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:-out/quickstart}

step() { printf '\n== %s\n' "$*"; }

step "tools"
scripts/install_tools.sh
step "build"
cargo build --release --locked --package foveate
foveate() { cargo run --release --locked --quiet --package foveate -- "$@"; }

mkdir -p "$out"
step "1. a design, read from a file"
foveate presets bare >"$out/camera.toml"
foveate check "$out/camera.toml" | sed -n '1,/^$/p'
step "2. frames, scored by the bit-exact model"
foveate simulate scene:street --config "$out/camera.toml" --output "$out/simulation" --overlay --force
step "3. Verilog for it"
foveate generate --config "$out/camera.toml" --output "$out/core" --force
step "4. that Verilog against the model, every output at every clock"
foveate cosim scene:street --config "$out/core/design.toml" --rtl "$out/core/rtl" --replay "$out/replay"
foveate cosim scene:street --config "$out/core/design.toml" --rtl "$out/core/rtl" --replay "$out/replay" \
    --level rcm --grid 3x2
step "5. its area beside the paper's"
foveate estimate --config "$out/core/design.toml"
printf '\nall in %s; look at %s/simulation/overlay\n' "$out" "$out"
