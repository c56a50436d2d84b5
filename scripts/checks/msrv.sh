#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Builds the workspace with the oldest supported Rust, `rust-version` in Cargo.toml. Needs rustup, which downloads that version if it
# is missing. (Clippy's `incompatible_msrv` finds newer functions of the standard library without it.)
set -euo pipefail
cd "$(dirname "$0")/../.."
version=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
command -v rustup >/dev/null || { echo "msrv: needs rustup, to get Rust $version" >&2 && exit 3; }
rustup toolchain install "$version" --profile minimal --no-self-update >&2 ||
    { echo "msrv: rustup cannot get Rust $version; is there a connection?" >&2 && exit 3; }
CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-target}/msrv" cargo "+$version" check --workspace --locked
