#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Compares events in EVT 2.0, EVT 3.0 and AEDAT4 with what other programs read from these files (faery, evlib, evt3, expelliarmus, aedat,
# dv-processing), and reads what faery and dv-processing write (scripts/checks/event_readers.py). Takes some minutes, and installs missing
# tools, except Rust.
#
#   scripts/event_readers.sh            made recordings
#   scripts/event_readers.sh FILE...    these recordings, too
#
# FOVEATE   the program (default: built here)
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
-h | --help) sed -n '3,10s/^# \{0,1\}//p' "$0" && exit 0 ;;
esac
tools=$(scripts/python_tools.sh --events)
FOVEATE=$(scripts/checks/foveate.sh)
cargo build --locked --quiet --package foveate-media --example events_as_csv
READER=$(realpath "${CARGO_TARGET_DIR:-target}/debug/examples/events_as_csv")
export FOVEATE READER
exec "$tools/python" scripts/checks/event_readers.py "$@"
