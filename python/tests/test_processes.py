# SPDX-License-Identifier: MIT OR Apache-2.0
"""Threads, forks, signals and the end of the interpreter."""
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import foveate as fv
from conftest import ROOT, equal


def large_frame(seed=0):
    return np.random.default_rng(seed).integers(0, 256, (1500, 2000), np.uint8)


@pytest.mark.parametrize("kind", [fv.Camera, fv.TimedCamera])
def test_a_step_does_not_hold_the_interpreter(kind):
    frame, camera, ended = large_frame(), kind(), threading.Event()

    def work():
        for _ in range(40):
            camera.step(frame)
            # Without the reset, unchanged regions would be skipped and take no time.
            camera.reset()
        ended.set()

    switch_interval = sys.getswitchinterval()
    # A thread that held the interpreter during its steps would not release it before its end.
    sys.setswitchinterval(100)
    try:
        thread = threading.Thread(target=work)
        thread.start()
        turns = 0
        while not ended.is_set():
            turns += 1
            time.sleep(0)
        thread.join()
    finally:
        sys.setswitchinterval(switch_interval)
    assert turns > 5


def test_cameras_of_many_threads_give_the_bits_of_one():
    clip = [large_frame(seed)[:200, :300] for seed in range(6)]

    def run(_):
        camera = fv.Camera("steady")
        return [camera.step(frame, keep=True) for frame in clip]

    expected = run(None)
    with ThreadPoolExecutor(4) as pool:
        for outcomes in pool.map(run, range(8)):
            assert all(equal(one, other) for one, other in zip(outcomes, expected, strict=True))


@pytest.mark.parametrize("kind", [fv.Camera, fv.TimedCamera])
def test_a_camera_in_two_threads_is_refused_or_right(kind):
    frame, camera = large_frame(), kind()
    camera.step(frame)
    refused = []

    def work():
        for _ in range(20):
            try:
                camera.step(frame)
            except RuntimeError as error:
                refused.append(str(error))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert camera.frames == 1 + 80 - len(refused)
    assert all("another thread is using this camera" in text for text in refused)


def test_a_run_can_be_shared_by_threads():
    run = fv.simulate("scene:street", max_frames=40)
    with ThreadPoolExecutor(4) as pool:
        numbers = [number for part in pool.map(lambda _: [outcome.number for outcome in run], range(4)) for number in part]
    assert sorted(numbers) == list(range(40))


def scores_in_a_process(camera):
    frame = large_frame(1)[:100, :100]
    return camera.step(frame).scores["edge"].tolist()


@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
@pytest.mark.parametrize("method", ["fork", "spawn", "forkserver"])
def test_cameras_work_in_other_processes(method):
    context = multiprocessing.get_context(method)
    with context.Pool(2) as pool:
        scores = pool.map(scores_in_a_process, [fv.Camera("seamless"), fv.Camera("seamless", threads=2)])
    assert scores[0] == scores[1] == scores_in_a_process(fv.Camera("seamless"))


FORKED = """
import os, sys, numpy as np, foveate as fv
frame = np.arange(6400, dtype=np.uint8).reshape(80, 80)
one, many = fv.Camera(), fv.Camera(threads=2)
one.step(frame); many.step(frame)
child = os.fork()
if child == 0:
    assert one.step(frame).number == 1
    try:
        many.step(frame)
    except RuntimeError as error:
        assert "do not exist after a fork" in str(error)
        many.reset()
        assert many.step(frame).number == 0
        os._exit(7)
    os._exit(1)
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7

zoned = [fv.Camera(frame={"width": 80, "height": 80}, threads=threads, zones={}) for threads in (1, 2)]
for camera in zoned:
    camera.zones = np.full((10, 10), 3)
child = os.fork()
if child == 0:
    os._exit(0 if all(camera.step(frame).srs.all() and camera.zones.all() for camera in zoned) else 1)
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
"""


def test_a_camera_goes_on_after_a_fork_or_says_why_not():
    subprocess.run([sys.executable, "-W", "ignore", "-c", FORKED], check=True, timeout=60)


SHUTDOWN = """
import threading, time, numpy as np, foveate as fv
frame = np.random.default_rng(0).integers(0, 256, (2000, 3000), np.uint8)
def work():
    camera = fv.Camera()
    while True:
        camera.step(frame)
for _ in range(3):
    threading.Thread(target=work, daemon=True).start()
run = fv.simulate("scene:street", max_frames=100000)
next(run)
time.sleep(0.3)
"""


def test_the_interpreter_ends_with_frames_under_way():
    ended = subprocess.run([sys.executable, "-c", SHUTDOWN], capture_output=True, text=True, timeout=60)
    assert (ended.returncode, ended.stderr) == (0, "")


LONG = {
    "explain": "fv.explain('scene:street', frame=900000, max_frames=1000000)",
    "infer": f"fv.infer({str(ROOT / 'networks' / 'denoiser.onnx')!r}, 'scene:street', output=sys.argv[1], max_frames=1000000)",
    "simulate": "for _ in fv.simulate('scene:street', max_frames=1000000): pass",
    "fidelity": "fv.fidelity('scene:street', max_frames=1000000)",
    "clocks": "fv.clocks('scene:street', max_frames=1000000)",
    "events": "fv.events(fv.simulate('scene:street', max_frames=1000000))",
    "command": "import foveate.__main__, sys; sys.argv[1:] = ['simulate', 'scene:street', '-o', sys.argv[1], '--frames', '1000000', "
    "'--quiet']; foveate.__main__.main()",
}


@pytest.mark.parametrize("what", LONG)
def test_ctrl_c_ends_long_work_at_once(what, tmp_path):
    code = f"import sys; import foveate as fv; print('go', flush=True)\n{LONG[what]}"
    process = subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path / "out")], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "go\n"
    start_time = time.monotonic()
    # The command tells of its results only if there are some.
    while what == "command" and not any(tmp_path.rglob("000001.png")):
        assert process.poll() is None and time.monotonic() - start_time < 60
        time.sleep(0.01)
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    interrupt_time = time.monotonic()
    _, errors = process.communicate(timeout=30)
    assert time.monotonic() - interrupt_time < 5
    if what == "command":
        assert process.returncode == 130 and "interrupted; the results so far are in" in errors
    else:
        assert process.returncode == -signal.SIGINT and errors.rstrip().endswith("KeyboardInterrupt")


#: A replacement of Yosys, which writes at once a netlist that takes seconds to be read.
YOSYS = """#!{python}
import sys
if "-V" in sys.argv:
    sys.exit(print("Yosys 0.23 (git sha1 7ce5011c24b)"))
with open("netlist.json", "w") as file:
    file.write('{{"modules": {{"rpu": {{"cells": {{}}, "attributes": {{')
    file.write(", ".join(['"attribute": "1"'] * 8000000))
    file.write("}}}}}}}}")
open("netlist.v", "w").close()
open({marks!r} + "/" + ("whole" if "write_verilog" in open(sys.argv[-1]).read() else "leaves"), "w").close()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="stands for Yosys as a script")
def test_ctrl_c_ends_an_estimate_while_its_netlist_is_read(tmp_path):
    (tmp_path / "yosys").write_text(YOSYS.format(python=sys.executable, marks=str(tmp_path)))
    (tmp_path / "yosys").chmod(0o755)
    process = subprocess.Popen(
        [sys.executable, "-c", "import foveate as fv; fv.Design().estimate()"], stderr=subprocess.PIPE, text=True,
        env={**os.environ, "FOVEATE_YOSYS": str(tmp_path / "yosys"), "FOVEATE_CACHE": "off"},
    )
    start_time = time.monotonic()
    while not {"whole", "leaves"} <= {path.name for path in tmp_path.iterdir()}:
        assert process.poll() is None and time.monotonic() - start_time < 60
        time.sleep(0.01)
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    interrupt_time = time.monotonic()
    _, errors = process.communicate(timeout=60)
    assert time.monotonic() - interrupt_time < 4
    assert process.returncode == -signal.SIGINT and errors.rstrip().endswith("KeyboardInterrupt")


def test_the_command_is_there():
    version = subprocess.run([sys.executable, "-m", "foveate", "--version"], capture_output=True, text=True, check=True)
    assert version.stdout == f"foveate {fv.__version__}\n"
    unknown_command = subprocess.run([sys.executable, "-m", "foveate", "chekc"], capture_output=True, text=True)
    assert unknown_command.returncode == 2 and "check" in unknown_command.stderr
    missing_input = subprocess.run([sys.executable, "-m", "foveate", "simulate", "no.mp4", "-o", "x"], capture_output=True, text=True)
    assert missing_input.returncode == 2 and missing_input.stderr.startswith("foveate: input `no.mp4` does not exist")
