#!/bin/sh
# SPDX-License-Identifier: MIT OR Apache-2.0
# Measures the engine against a numpy + OpenCV pipeline on the same clips, in turn, and prints the ratios.
#
# FOVEATE_ANCHOR  folder with cv_pipeline.py and make_clip.py (required)
# FOVEATE_CLIPS   folder where clips are made and kept (default: target/clips)
# FOVEATE_VIDEOS  videos, separated by spaces, on which skipping is measured (default: none)
# ROUNDS          number of rounds; the best of each figure counts, on both sides (default: 5)
set -eu
cd "$(dirname "$0")/../.."

fail() { echo "bench_opencv: $*" >&2; exit 1; }
[ -n "${FOVEATE_ANCHOR:-}" ] || fail "set FOVEATE_ANCHOR to the folder with cv_pipeline.py and make_clip.py"
for file in cv_pipeline.py make_clip.py; do
    [ -f "$FOVEATE_ANCHOR/$file" ] || fail "there is no $file in FOVEATE_ANCHOR=$FOVEATE_ANCHOR"
done
python3 -c 'import cv2, numpy' 2>/dev/null || fail "needs: pip install numpy opencv-python-headless"
command -v ffmpeg >/dev/null || fail "needs ffmpeg in PATH"

target=${CARGO_TARGET_DIR:-target}
clips=${FOVEATE_CLIPS:-$target/clips}
mkdir -p "$clips"
[ -f "$clips/c224.npy" ] || python3 "$FOVEATE_ANCHOR/make_clip.py" "$clips/c224.npy" 224 224 300
[ -f "$clips/c1080.npy" ] || python3 "$FOVEATE_ANCHOR/make_clip.py" "$clips/c1080.npy" 1920 1080 40
cargo build --release --quiet -p foveate-engine --example throughput

export FOVEATE_CLIPS="$clips"
exec python3 scripts/figures/bench_opencv.py "$target/release/examples/throughput"
