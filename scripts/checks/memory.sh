#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Checks that memory does not grow with the length of a clip: compares the peak memory of `foveate simulate` over a short clip and over
# one thirty times as long. Fails if the long clip takes over a fifth more. Needs ffmpeg and Linux.
#
#   scripts/checks/memory.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
[ -r /proc/self/stat ] || { echo "${0##*/}: needs Linux, whose /proc it reads" >&2; exit 3; }
cargo build --release --locked --quiet --package foveate
foveate=${CARGO_TARGET_DIR:-target}/release/foveate
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Reads the peak resident memory in KiB, as the kernel counts it, during the run.
peak() {
    "$foveate" simulate "$1" --output "$work/out" --force --no-rendered --quiet >/dev/null &
    local pid=$! seen=0 now
    while now=$(awk '/VmHWM/ {print $2}' "/proc/$pid/status" 2>/dev/null) && [ -n "$now" ]; do
        seen=$now
        sleep 0.02
    done
    wait "$pid"
    echo "$seen"
}

for seconds in 4 120; do
    ffmpeg -v error -f lavfi -i "testsrc=size=640x480:rate=25:duration=$seconds" -c:v mpeg4 "$work/$seconds.mp4"
done
short=$(peak "$work/4.mp4")
long=$(peak "$work/120.mp4")
printf '%6s frames: %6d KiB\n' 100 "$short" 3000 "$long"
[ "$long" -le $((short * 6 / 5)) ] || { echo "memory grows with the length of the clip" >&2; exit 1; }
