# SPDX-License-Identifier: MIT OR Apache-2.0
"""The types are right, the stubs agree with the compiled part, and everything public is documented."""
import ast
import inspect
import shutil
import subprocess
import sys

import pytest

import foveate as fv
from conftest import ROOT, stub_of_the_compiled_part

USE = """
import numpy as np
import foveate as fv

camera = fv.Camera("paper", region={"size": 16}, spatial=["edge", {"feature": "mad"}])
outcome = camera.step(np.zeros((8, 8), np.uint8), keep=True)
active: int = int(outcome.active.sum())
scores: np.ndarray = outcome.scores["edge"]
for outcome in fv.simulate(["a.png", "b.png"], camera, max_frames=3, resize=(64, 48)):
    number: int = outcome.number
rows: np.ndarray = fv.events([outcome])
size: int = outcome.sent_bytes + outcome.sent_pixels
packets: bytes = outcome.packets(scores=True)
decoding = fv.decode(packets, camera)
for frame in decoding:
    moment: int = (frame.time_us or 0) + frame.number + len(frame.losses)
    seen: int = int(frame.active.sum())
kind: str = decoding.losses[0].kind
colours: np.ndarray = outcome.overlay(np.zeros((8, 8), np.uint8))
why: str = str(outcome.explain((0, 0))["rule"])
edges: np.ndarray = outcome.boxes()
found = outcome.detections()
clip = camera.run([np.zeros((8, 8), np.uint8)], rendered=False, progress=True, max_frames=1)
share: float = float(clip.active.mean()) + float(clip.scores["edge"].sum()) + len(clip)
seconds: np.ndarray = clip.time_us / 1e6
pixels: np.ndarray = fv.pixel_events(np.zeros((2, 8, 8), np.uint8), contrast=15, log=False)["x"]
outcomes = list(fv.simulate(np.zeros((2, 8, 8), np.uint8)))
timed = fv.TimedCamera(camera, clock_hz=100e6, sink_rate=(1, 4))
clock: int = int(timed.step(np.zeros((8, 8), np.uint8), time_us=5)["clock"][0])
rows = np.concatenate([timed.finish(), fv.clocks("scene:street", camera, sink_stalls=[[0, 2]], max_frames=3)])
words = np.zeros(1024, np.uint32)
core = fv.Registers(camera, lambda address: int(words[address // 4]), lambda address, value: words.__setitem__(address // 4, value))
core["edge_level"] = core["status.busy"]
core.set(edge_level=1, edge_min=2)
name: str = core.events()[0]
width: int = camera.registers()[0].fields[0].width
fv.Registers.over_serial("design.toml", open("/dev/null", "r+b", buffering=0)).received()
"""
WRONG = {
    "fv.Camera(size=3)": "size",
    "fv.Camera().step()": "step",
    "fv.simulate('a.mp4', frame_count=3)": "frame_count",
    "fv.TimedCamera(sink_rate=0.25)": "sink_rate",
    "x: str = fv.Design().columns": "columns|str",
    "x: str = next(fv.simulate('a.mp4')).packets()": "bytes|str",
    "fv.decode('packets.bin')": "decode",
    "fv.Camera().run('a.mp4', keep=True)": "keep",
    "fv.Camera().run('a.mp4').sent_bytes = 3": "read-only|sent_bytes",
    "fv.pixel_events('a.mp4', contrast='much')": "contrast",
    "next(fv.simulate('a.mp4')).explain(3)": "explain",
    "fv.Design().width = 3": "read-only|width",
    "fv.Registers.over_serial('paper', 'COM3')": "Port",
}


def run(*words, cwd):
    return subprocess.run([sys.executable, "-m", *words], cwd=cwd, capture_output=True, text=True)


@pytest.fixture(scope="module")
def mypy(tmp_path_factory):
    """Runs mypy in strict mode, with one cache for other packages."""
    cache = tmp_path_factory.mktemp("mypy")
    return lambda *words, cwd: run("mypy", "--strict", "--cache-dir", str(cache), *words, cwd=cwd)


def test_the_package_is_typed(mypy):
    checked = mypy("--config-file", "pyproject.toml", "python/foveate", cwd=ROOT)
    assert checked.returncode == 0, checked.stdout


def test_the_stubs_are_those_of_the_compiled_part(tmp_path, monkeypatch):
    # The stub that is compared has every option of a group, as signatures have them.
    typed = shutil.copytree(ROOT / "python/foveate", tmp_path / "typed/foveate")
    imports = "from typing import Literal, Sequence\nfrom foveate._options import Number, Section\n"
    (typed / "_foveate.pyi").write_text(imports + ast.unparse(stub_of_the_compiled_part()))
    monkeypatch.setenv("MYPYPATH", str(tmp_path / "typed"))
    # `main` and similar functions are not for users. Methods that PyO3 adds to classes are not in stubs.
    config = ["--mypy-config-file", str(ROOT / "pyproject.toml")]
    checked = run("mypy.stubtest", "foveate._foveate", "--ignore-missing-stub", *config, cwd=tmp_path)
    assert checked.returncode == 0, checked.stdout


def test_users_are_checked(mypy, tmp_path):
    (tmp_path / "good.py").write_text(USE)
    good = mypy("good.py", cwd=tmp_path)
    assert good.returncode == 0, good.stdout
    for number, line in enumerate(WRONG):
        (tmp_path / f"wrong{number}.py").write_text(f"import foveate as fv\n\n{line}\n")
    bad = mypy(*(f"wrong{number}.py" for number in range(len(WRONG))), cwd=tmp_path)
    for number, line in enumerate(WRONG):
        assert f"wrong{number}.py:3: error" in bad.stdout, line


def test_everything_public_has_its_documentation():
    for name in fv.__all__:
        thing = getattr(fv, name)
        if name in ("ACTIONS", "__version__"):
            continue
        assert inspect.getdoc(thing), name
    both = ["generate", "estimate", "registers"]
    methods_of = {
        fv.Camera: ["step", "run", "reset", *both],
        fv.Outcome: ["packets", "overlay", "explain", "boxes", "detections"],
        fv.TimedCamera: ["step", "finish", "reset"],
        fv.Design: ["toml", *both],
    }
    for made, methods in methods_of.items():
        for method in methods:
            assert inspect.getdoc(getattr(made, method)), method
    made = [fv.Camera, fv.TimedCamera, fv.Design, fv.Registers]
    methods = [fv.Camera.step, fv.Camera.run, fv.TimedCamera.step, fv.Outcome.packets, fv.Outcome.overlay, fv.Outcome.explain]
    functions = [fv.simulate, fv.clocks, fv.decode, fv.events, fv.explain, fv.fidelity, fv.infer, fv.generate, fv.pixel_events]
    for thing in (*made, *methods, *functions):
        assert "Parameters\n----------" in inspect.getdoc(thing), thing
