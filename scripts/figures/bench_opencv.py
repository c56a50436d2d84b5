# SPDX-License-Identifier: MIT OR Apache-2.0
"""Called by bench_opencv.sh: runs both programs in turn and prints the tables."""
import json
import os
import subprocess
import sys

THROUGHPUT = sys.argv[1]
ANCHOR = os.path.join(os.environ["FOVEATE_ANCHOR"], "cv_pipeline.py")
CLIPS = os.environ["FOVEATE_CLIPS"]
ROUNDS = int(os.environ.get("ROUNDS", "5"))
# Number of frames in a batch, where several are in memory.
BATCHES = {"1920x1080": 4, "224x224": 32}
SIZES = {"1920x1080": ("c1080.npy", 32), "224x224": ("c224.npy", 8)}
CASES = {"edge": "pipeline:edge", "edge,corner,mad": "pipeline:all(edge+harris+mad)"}


def engine_run(clip, *arguments):
    command = [THROUGHPUT, clip, *map(str, arguments)]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


def opencv_speeds():
    report = os.path.join(CLIPS, "opencv.json")
    clips = [f"{os.path.join(CLIPS, clip)}:{side}" for clip, side in SIZES.values()]
    command = [sys.executable, ANCHOR, "--bench", "--threads", "1", "--min-t", "0.4"]
    command += ["--json", report, "--clips", *clips]
    subprocess.run(command, check=True, capture_output=True)
    with open(report) as file:
        return {(row["size"], row["op"]): row["mpix_s"] for row in json.load(file)}


# Other programs on the machine can only make a run slower, so the fastest of several rounds is nearest to the true speed, for both
# programs.
def fastest(values):
    return max(values)


def print_table(title, header, rows):
    print(f"\n{title}\n")
    print("| " + " | ".join(header) + " |")
    print("| " + " | ".join("---" for _ in header) + " |")
    for row in rows:
        print("| " + " | ".join(map(str, row)) + " |", flush=True)


def compare_with_opencv():
    anchor, engine, copies = {}, {}, []
    for _ in range(ROUNDS):
        for key, value in opencv_speeds().items():
            anchor.setdefault(key, []).append(value)
        for size, (clip, side) in SIZES.items():
            path = os.path.join(CLIPS, clip)
            for features in CASES:
                for kind in ("shared", "isolated"):
                    options = ("--side", side, "--features", features, "--neighborhood", kind)
                    run = engine_run(path, *options, "--seconds", "0.6")
                    engine.setdefault((size, features, kind), []).append(run)
        copies.append(engine_run("--copy"))
    rows = []
    for (size, features, kind), runs in engine.items():
        fast = fastest(run["mpixel_s"] for run in runs)
        slow = fastest(anchor[size, CASES[features]])
        rows.append((size, features, kind, f"{fast:.0f}", f"{slow:.0f}", f"{fast / slow:.1f}x"))
    header = ("frame", "features", "windows", "engine Mpx/s", "OpenCV Mpx/s", "ratio")
    print_table("One thread, whole pipeline; OpenCV has Harris for corner.", header, rows)
    print_roofline(engine, copies)


# Bytes per pixel between core and memory or last-level cache, in the case that was measured: the
# frame is read, the reference is read and replaced, and the screen is written where regions are active.
def print_roofline(engine, copies):
    rows = []
    for size, copy in (("1920x1080", "copy_frame_gb_s"), ("224x224", "copy_small_gb_s")):
        bandwidth = fastest(run[copy][0] for run in copies)
        runs = engine[size, "edge", "shared"]
        bytes_per_pixel = 3 + fastest(run["active"] for run in runs)
        limit = 1000 * bandwidth / bytes_per_pixel
        memory = 1000 * fastest(run["copy_memory_gb_s"][0] for run in copies)
        fast = fastest(run["mpixel_s"] for run in runs)
        row = (size, f"{bytes_per_pixel:.2f}", f"{bandwidth:.0f}", f"{limit:.0f}")
        row += (f"{memory:.0f}" if size == "1920x1080" else "-",)
        rows.append(row + (f"{fast:.0f}", f"{100 * fast / limit:.0f} %"))
    header = ("frame", "bytes/pixel", "copy GB/s, planes in cache", "limit Mpx/s")
    header += ("limit of reading frames from memory, Mpx/s", "engine Mpx/s", "of the cache limit")
    print_table("Roofline of `edge`; copies count read and written bytes.", header, rows)
    names = {"copy_frame_gb_s": "1920x1080", "copy_small_gb_s": "224x224", "copy_memory_gb_s": "256 MiB"}
    rows = []
    for copy, name in names.items():
        one_thread, two_threads = (fastest(run[copy][index] for run in copies) for index in (0, 1))
        rows.append((name, f"{one_thread:.0f}", f"{two_threads:.0f}", f"{two_threads / one_thread:.2f}x"))
    header = ("copied at a time", "1 thread GB/s", "2 threads GB/s", "gain")
    print_table("What the same machine copies, each thread for itself.", header, rows)


def compare_instruction_sets():
    rows = []
    for level in ("portable", "avx2", "avx512"):
        runs = {size: [] for size in SIZES}
        for _ in range(ROUNDS):
            for size, (clip, side) in SIZES.items():
                path = os.path.join(CLIPS, clip)
                try:
                    runs[size].append(engine_run(path, "--side", side, "--level", level, "--seconds", "0.4"))
                except subprocess.CalledProcessError:
                    pass  # Not on this processor.
        cells = [f"{fastest(run['mpixel_s'] for run in run_speeds):.0f}" if run_speeds else "-" for run_speeds in runs.values()]
        rows.append((level, *cells))
    print_table("Instructions, `edge`, `shared`, Mpx/s.", ("level", *SIZES), rows)


# The gain is relative to the fastest combination of one thread. With screens, the caller gets every rendered frame: the engine's own buffer
# for one frame at a time, and copies of all of them for a batch.
def compare_thread_counts():
    rows = []
    for size, (clip, side) in SIZES.items():
        path = os.path.join(CLIPS, clip)
        batch_size = BATCHES[size]
        combinations = [(count, batch, screens) for batch, screens in ((1, False), (batch_size, False), (batch_size, True))
                        for count in (1, 2)]
        runs = {combination: [] for combination in combinations}
        for _ in range(ROUNDS):
            for (count, batch, screens), values in runs.items():
                options = ("--side", side, "--threads", count, "--batch", batch, "--seconds", "0.6")
                options += ("--screens",) if screens else ()
                values.append(engine_run(path, *options)["mpixel_s"])
        speed = {combination: fastest(values) for combination, values in runs.items()}
        fastest_speed = max(speed[1, batch, False] for batch in (1, batch_size))
        for _, batch, screens in combinations[::2]:
            one_thread, two_threads = (speed[count, batch, screens] for count in (1, 2))
            way = f"{batch} at a time" + (", screens kept" if screens else "")
            rows.append((size, way, f"{one_thread:.0f}", f"{two_threads:.0f}", f"{two_threads / fastest_speed:.2f}x"))
    header = ("frame", "frames", "1 thread Mpx/s", "2 threads Mpx/s", "over the fastest of 1 thread")
    print_table("Threads, `edge`.", header, rows)


def measure_skipping():
    paths = [(os.path.join(CLIPS, clip), side) for clip, side in SIZES.values()]
    paths += [(decode(video), 8) for video in os.environ.get("FOVEATE_VIDEOS", "").split()]
    rows = []
    for path, side in paths:
        on, off = [], []
        for _ in range(ROUNDS):
            off.append(engine_run(path, "--side", side, "--no-skip"))
            on.append(engine_run(path, "--side", side))
        fast, slow = (fastest(run["mpixel_s_mean"] for run in runs) for runs in (on, off))
        share = f"{100 * on[0]['skipped']:.1f} %"
        row = (os.path.basename(path), f"{on[0]['width']}x{on[0]['height']}", side, share)
        rows.append(row + (f"{slow:.0f}", f"{fast:.0f}", f"{fast / slow:.2f}x"))
    header = ("clip", "frame", "N", "regions skipped", "without Mpx/s", "with Mpx/s", "gain")
    print_table("Skipping what is bit-identical, `edge`, `shared`, mean of all frames.", header, rows)


def decode(video):
    """At most 200 frames of a video as bytes of luma."""
    import numpy

    name = os.path.splitext(os.path.basename(video))[0]
    path = os.path.join(CLIPS, name + ".npy")
    if not os.path.exists(path):
        probe = ["ffprobe", "-v", "error", "-select_streams", "v", "-of", "csv=p=0"]
        probe += ["-show_entries", "stream=width,height", video]
        sides = subprocess.run(probe, check=True, capture_output=True, text=True).stdout
        width, height = map(int, sides.split("\n")[0].strip(",").split(","))
        command = ["ffmpeg", "-v", "error", "-noautorotate", "-i", video, "-frames:v", "200"]
        command += ["-f", "rawvideo", "-pix_fmt", "gray", "-"]
        luma = subprocess.run(command, check=True, capture_output=True).stdout
        numpy.save(path, numpy.frombuffer(luma, numpy.uint8).reshape(-1, height, width))
    return path


compare_with_opencv()
compare_instruction_sets()
compare_thread_counts()
measure_skipping()
