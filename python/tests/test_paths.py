# SPDX-License-Identifier: MIT OR Apache-2.0
"""A path to a missing file, a folder, or an unreadable file raises Python's exception, wherever a path is given."""
from pathlib import Path

import numpy as np
import pytest

import foveate as fv
from conftest import ROOT

NETWORK = ROOT / "networks/denoiser.onnx"


def made(path, **options):
    return list(fv.simulate("scene:street", path, max_frames=1, **options))


READERS = {
    "Camera": fv.Camera,
    "Design": fv.Design,
    "simulate": fv.simulate,
    "simulate, list": lambda path: fv.simulate([path]),
    "simulate, camera": made,
    "explain": fv.explain,
    "fidelity": fv.fidelity,
    "fidelity, ideal": lambda path: fv.fidelity("scene:street", ideal=path, max_frames=2),
    "infer": lambda path: fv.infer(path, "scene:street", max_frames=2),
    "infer, frames": lambda path: fv.infer(path, np.zeros((2, 8, 8), np.uint8)),
    "infer, inputs": lambda path: fv.infer(NETWORK, path),
    "infer, camera": lambda path: fv.infer(NETWORK, "scene:street", path, max_frames=2),
    "infer, boxes": lambda path: fv.infer(NETWORK, "scene:street", max_frames=2, detect="yolox", boxes=path),
    "infer, accelerator": lambda path: fv.infer(NETWORK, "scene:street", max_frames=2, accelerator=str(path)),
    "generate": lambda path: fv.generate(path, "core"),
    "estimate": fv.estimate,
    "Registers": lambda path: fv.Registers(path, lambda address: 0, lambda address, value: None),
}
#: The functions for which a folder is footage.
FOLDERS = {"simulate", "simulate, list", "explain", "fidelity", "infer, inputs"}


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("kind", [str, Path])
def test_a_file_that_is_not_there(reader, kind, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(FileNotFoundError, match="nothing.toml"):
        READERS[reader](kind("nothing.toml"))
    with pytest.raises(FileNotFoundError, match="nothing.toml"):
        READERS[reader](kind(tmp_path / "none" / "nothing.toml"))


@pytest.mark.parametrize("reader", sorted(set(READERS) - FOLDERS - {"infer, boxes"}))
def test_a_folder_in_place_of_a_file(reader, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "folder.toml"
    folder.mkdir()
    with pytest.raises(IsADirectoryError, match="folder.toml"):
        READERS[reader](folder)


def forbidden():
    """Returns a file that even root may not read, if there is one."""
    path = Path("/proc/sys/vm/drop_caches")
    try:
        path.read_bytes()
    except PermissionError:
        return path
    except OSError:
        return None
    return None


@pytest.mark.skipif(forbidden() is None, reason="this system has no file that its user may not read")
@pytest.mark.parametrize("reader", ["infer", "infer, frames"])
def test_a_file_that_may_not_be_read(reader, tmp_path):
    with pytest.raises(PermissionError, match="drop_caches"):
        READERS[reader](forbidden())


@pytest.mark.skipif(forbidden() is None, reason="this system has no file that its user may not read")
def test_a_link_to_a_file_that_may_not_be_read(tmp_path):
    for name, read in [("camera.toml", fv.Camera), ("image.png", fv.simulate)]:
        (tmp_path / name).symlink_to(forbidden())
        with pytest.raises(PermissionError, match=name):
            read(tmp_path / name)


def test_a_file_in_place_of_a_folder(tmp_path):
    (tmp_path / "file").write_text("")
    for write in (
        lambda path: fv.generate("bare", path),
        lambda path: fv.infer(NETWORK, "scene:street", output=path, max_frames=2),
    ):
        with pytest.raises((FileExistsError, NotADirectoryError), match="file"):
            write(tmp_path / "file")
        with pytest.raises((FileExistsError, NotADirectoryError), match="file"):
            write(tmp_path / "file" / "core")


@pytest.mark.parametrize("value", [None, 3, 1.5, b"x" * 3, object()])
def test_what_is_no_path_is_a_type_error(value):
    for use in (
        lambda: fv.simulate(value),
        lambda: fv.generate("bare", value),
        lambda: fv.infer(value, "scene:street", max_frames=2),
        lambda: fv.simulate([value]),
    ):
        with pytest.raises(TypeError):
            use()


def test_a_file_that_is_wrong_is_a_value_error(tmp_path):
    (tmp_path / "wrong.onnx").write_bytes(b"no network")
    with pytest.raises(ValueError, match="wrong.onnx"):
        fv.infer(tmp_path / "wrong.onnx", "scene:street", max_frames=2)
    (tmp_path / "wrong.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(ValueError, match="wrong.toml"):
        fv.Camera(tmp_path / "wrong.toml")
