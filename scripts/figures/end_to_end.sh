#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Measures the share of our own time from a video file to results: ffmpeg alone decodes a clip to the same luma, and
# `foveate simulate` runs on it, in turn, several times.
#
#   scripts/figures/end_to_end.sh CLIP...        RUNS=7 and FOVEATE=path/to/foveate may be set
#
# (a) ffmpeg into a pipe that `cat` empties, (n) ffmpeg into no output, (b) simulate with its default outputs,
# (c) simulate --no-rendered. Medians in seconds; our share of the wall time is 1 - a/b and 1 - a/c, negative if simulate is
# faster than ffmpeg with `cat`. CPU seconds are user + system: of foveate itself, and of the ffmpeg that it started.
set -euo pipefail

if [ $# -eq 0 ]; then
    echo "usage: $0 CLIP..." >&2
    exit 2
fi
cd "$(dirname "$0")/../.."
[ -r /proc/self/stat ] || { echo "${0##*/}: needs Linux, whose /proc it reads" >&2; exit 3; }
if [ -z "${FOVEATE:-}" ]; then
    cargo build --release --quiet -p foveate
    FOVEATE="${CARGO_TARGET_DIR:-target}/release/foveate"
fi
FOVEATE=$FOVEATE RUNS=${RUNS:-7} exec python3 - "$@" <<'PYTHON'
import os, resource, shutil, statistics, subprocess, sys, tempfile, time

FOVEATE, RUNS = os.environ["FOVEATE"], int(os.environ["RUNS"])
TICK = os.sysconf("SC_CLK_TCK")


def cpu_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def timed(run):
    cpu, start = cpu_of_children(), time.perf_counter()
    own = run()
    wall = time.perf_counter() - start
    return wall, cpu_of_children() - cpu, own


def ffmpeg(clip, end):
    luma = f"-map 0:v:0 -vf extractplanes=y -fps_mode passthrough {end}"
    command = f'ffmpeg -v error -nostdin -i "$1" {luma}'
    return lambda: subprocess.run(["sh", "-c", command, "sh", clip], check=True) and 0


def simulate(clip, folder, *options):
    def run():
        command = [FOVEATE, "simulate", clip, "-o", f"{folder}/out", "--quiet", *options]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        # A process that has ended but was not waited for still reports its own time, without that of its children.
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
        with open(f"/proc/{process.pid}/stat") as stat:
            fields = stat.read().rpartition(")")[2].split()
        if process.wait() != 0:
            sys.exit(f"foveate failed on {clip}")
        return (int(fields[11]) + int(fields[12])) / TICK

    return run


print("clip: wall a / n / b / c; ours of b, of c; CPU of b: foveate + ffmpeg; of c; of a")
for clip in sys.argv[1:]:
    seen = {name: [] for name in "anbc"}
    for _ in range(RUNS):
        for name in "anbc":
            folder = tempfile.mkdtemp()
            runs = {
                "a": ffmpeg(clip, "-f rawvideo pipe:1 | cat > /dev/null"),
                "n": ffmpeg(clip, "-f null -"),
                "b": simulate(clip, folder),
                "c": simulate(clip, folder, "--no-rendered"),
            }
            seen[name].append(timed(runs[name]))
            shutil.rmtree(folder)
    median = lambda name, part: statistics.median(run[part] for run in seen[name])
    wall = {name: median(name, 0) for name in "anbc"}
    own = {name: median(name, 2) for name in "bc"}
    tools = {name: statistics.median(run[1] - run[2] for run in seen[name]) for name in "bc"}
    print(
        f"{os.path.basename(clip)}: "
        + " / ".join(f"{wall[name]:.2f}" for name in "anbc")
        + f"; {1 - wall['a'] / wall['b']:.0%}, {1 - wall['a'] / wall['c']:.0%}"
        + f"; {own['b']:.2f} + {tools['b']:.2f}; {own['c']:.2f} + {tools['c']:.2f}; {median('a', 1):.2f}",
        flush=True,
    )
PYTHON
