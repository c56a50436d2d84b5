# SPDX-License-Identifier: MIT OR Apache-2.0
"""Pixel events as HDF5, in the layout of DSEC: what is written is read again, by h5py, too, and damaged files end with an error."""
from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import foveate as fv

FIELDS = [("x", "i2"), ("y", "i2"), ("t", "i8"), ("p", "?")]


def recording(times: Any) -> np.ndarray[Any, Any]:
    times = np.asarray(times, np.int64)
    events = np.empty(len(times), FIELDS)
    numbers = np.arange(len(times))
    events["x"], events["y"], events["t"], events["p"] = numbers * 7 % 640, numbers * 5 % 480, times, numbers % 3 == 0
    return events


def some_recording() -> np.ndarray[Any, Any]:
    return recording(np.sort(np.random.default_rng(3).integers(1_700_000_000_000_000, 1_700_000_000_090_000, 5000)))


@pytest.mark.parametrize("compression", ["gzip", "lzf", None])
def test_what_is_written_is_read(tmp_path: Path, compression: Any) -> None:
    events = some_recording()
    fv.write_dsec(tmp_path / "events.h5", events, compression=compression)
    found = fv.read_dsec(str(tmp_path / "events.h5"))
    assert found.dtype == np.dtype(FIELDS)
    assert (found == events).all()


def test_h5py_finds_the_layout_of_dsec(tmp_path: Path) -> None:
    events = some_recording()
    fv.write_dsec(tmp_path / "events.h5", events)
    with h5py.File(tmp_path / "events.h5") as file:
        assert set(file) == {"events", "ms_to_idx", "t_offset"}
        types = {name: array.dtype for name, array in file["events"].items()}
        assert types == {"x": np.uint16, "y": np.uint16, "t": np.uint32, "p": np.uint8}
        assert (file["t_offset"].dtype, file["ms_to_idx"].dtype) == (np.int64, np.uint64)
        assert file["t_offset"][()] == events["t"][0] and file["events/t"][0] == 0
        times, index = file["events/t"][:].astype(np.int64), file["ms_to_idx"][:].astype(np.int64)
    # The definition of DSEC: the event of the index is not before the millisecond, and the one before it is.
    assert index[0] == 0 and index[-1] == len(times) and len(index) == times[-1] // 1000 + 2
    for millisecond, first in enumerate(index):
        assert first == len(times) or times[first] >= 1000 * millisecond
        assert first == 0 or times[first - 1] < 1000 * millisecond


def test_milliseconds_at_their_limits(tmp_path: Path) -> None:
    times = [5, 999, 1000, 1000, 3999, 4000]
    fv.write_dsec(tmp_path / "events.h5", recording(times), t_offset=0)
    with h5py.File(tmp_path / "events.h5") as file:
        assert file["ms_to_idx"][:].tolist() == [0, 2, 4, 4, 5, 6]
        assert file["events/t"][:].tolist() == times and file["t_offset"][()] == 0


def test_an_offset_that_is_given(tmp_path: Path) -> None:
    events = recording([2_000_000, 2_000_001, 2_000_000 - 500 + (1 << 32) - 1])
    fv.write_dsec(tmp_path / "events.h5", events, t_offset=1_999_500)
    with h5py.File(tmp_path / "events.h5") as file:
        assert file["t_offset"][()] == 1_999_500 and file["events/t"][0] == 500
    assert (fv.read_dsec(tmp_path / "events.h5") == events).all()
    for wrong in (2_000_001, 1_999_499):
        with pytest.raises(ValueError, match="do not fit"):
            fv.write_dsec(tmp_path / "wrong.h5", events, t_offset=wrong)
    assert not (tmp_path / "wrong.h5").exists()


def test_an_empty_recording(tmp_path: Path) -> None:
    fv.write_dsec(tmp_path / "events.h5", recording([]))
    assert fv.read_dsec(tmp_path / "events.h5").shape == (0,)
    with h5py.File(tmp_path / "events.h5") as file:
        assert file["ms_to_idx"][:].tolist() == [0] and file["t_offset"][()] == 0


def changed(events: np.ndarray[Any, Any], name: str, value: int) -> np.ndarray[Any, Any]:
    events[name][1] = value
    return events


@pytest.mark.parametrize(("change", "words"), [
    (lambda events: events[["x", "y", "t"]], "fields x, y, t and p"),
    (lambda events: events.reshape(2, -1), "one dimension"),
    (lambda events: events.astype([("x", "f4"), *FIELDS[1:]]), "x of events must have whole numbers"),
    (lambda events: events[::-1], "event 1 has 3 us after 4 us"),
    (lambda events: changed(events, "x", -2), "x of events has values from -2"),
])
def test_events_that_cannot_be_written(tmp_path: Path, change: Any, words: str) -> None:
    events = recording([1, 2, 3, 4])
    with pytest.raises(ValueError, match=words):
        fv.write_dsec(tmp_path / "events.h5", change(events))
    assert not (tmp_path / "events.h5").exists()


def replace(file: h5py.File, name: str, data: Any) -> None:
    del file[name]
    file[name] = data


@pytest.mark.parametrize(("damage", "words"), [
    (lambda file: file.__delitem__("events/p"), "no array events/p"),
    (lambda file: replace(file, "events/x", np.zeros(3, np.uint16)), "different lengths"),
    (lambda file: replace(file, "events/y", np.full(4, 40_000, np.uint16)), "y has values from 40000"),
    (lambda file: replace(file, "events/t", np.array([1, 3, 2, 4])), "event 2 has 3 us after 4 us"),
    (lambda file: replace(file, "events/t", np.zeros(4)), "float64"),
    (lambda file: replace(file, "events/t", np.zeros((2, 2), np.uint32)), "2 dimensions"),
    (lambda file: replace(file, "t_offset", np.zeros(2, np.int64)), "t_offset has 1 dimensions"),
])
def test_damaged_arrays_are_refused(tmp_path: Path, damage: Any, words: str) -> None:
    path = tmp_path / "events.h5"
    fv.write_dsec(path, recording([1, 2, 3, 4]))
    with h5py.File(path, "r+") as file:
        damage(file)
    with pytest.raises(ValueError, match=words) as error:
        fv.read_dsec(path)
    assert "events.h5" in str(error.value)


def test_damaged_files_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "events.h5"
    fv.write_dsec(path, some_recording())
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(OSError, match="truncated"):
        fv.read_dsec(path)
    with h5py.File(tmp_path / "whole.h5", "w") as file:
        pass
    with pytest.raises(ValueError, match="no array events/x"):
        fv.read_dsec(tmp_path / "whole.h5")
    path.write_bytes(whole)
    with h5py.File(path) as file:
        chunk = file["events/x"].id.get_chunk_info(0).byte_offset
    path.write_bytes(whole[:chunk] + bytes(64) + whole[chunk + 64 :])
    with pytest.raises(OSError, match="events/x cannot be read"):
        fv.read_dsec(path)


@pytest.mark.parametrize("name", ["read_dsec", "write_dsec"])
def test_without_h5py(name: str) -> None:
    code = f"import sys; sys.modules['h5py'] = None\nimport foveate as fv\nfv.{name}('events.h5'{', None' if name[0] == 'w' else ''})"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert result.stderr.splitlines()[-1].startswith(f"ImportError: {name} needs h5py, which is not installed: pip install h5py")
