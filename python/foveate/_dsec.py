# SPDX-License-Identifier: MIT OR Apache-2.0
"""Pixel events as HDF5, in the layout of the data set DSEC: ``events/x``, ``y``, ``t`` and ``p``, ``t_offset`` and ``ms_to_idx``."""
from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from foveate._extras import require_packages

_EventArray = np.ndarray[Any, np.dtype[np.void]]

#: The fields of events, as in ``pixel_events.npz``.
EVENT_FIELDS = np.dtype([("x", "<i2"), ("y", "<i2"), ("t", "<i8"), ("p", "?")])
#: The types of DSEC. Times are microseconds since ``t_offset``.
DSEC_TYPES: dict[str, np.dtype[Any]] = {"x": np.dtype("<u2"), "y": np.dtype("<u2"), "t": np.dtype("<u4"), "p": np.dtype("u1")}


def write_dsec(
    path: str | os.PathLike[str],
    events: _EventArray,
    *,
    t_offset: int | None = None,
    compression: Literal["gzip", "lzf"] | None = "gzip",
) -> None:
    """Write pixel events as a file of HDF5 like those of the data set DSEC.

    DSEC compresses its own files with Blosc, which needs a plugin. This file needs none.

    Parameters
    ----------
    path : str or path
        The file to write. A file that exists is replaced.
    events : numpy.ndarray
        A structured array with the fields ``x``, ``y``, ``t`` (microseconds) and ``p``, in the order of ``t``, such as ``events`` of
        ``pixel_events.npz``.
    t_offset : int, optional
        The time from which the file counts, in microseconds: that of the first event by default. No event is earlier, and none is 2^32
        us (71 minutes) later.
    compression : {"gzip", "lzf"}, optional
        The compression, or ``None``. All installations of HDF5 have gzip.

    Raises
    ------
    ImportError
        If h5py is not installed.
    ValueError
        If the events lack a field, are not in the order of their times, or do not fit in the file.
    """
    require_packages("write_dsec", ["h5py"], "dsec")
    import h5py

    columns = _columns(events)
    offset = _offset(columns["t"], t_offset)
    times = _relative_times(columns["t"], offset)
    with h5py.File(path, "w") as file:
        for name, dtype in DSEC_TYPES.items():
            values = (times if name == "t" else columns[name]).astype(dtype)
            file.create_dataset(f"events/{name}", data=values, chunks=True, maxshape=(None,), compression=compression)
        file.create_dataset("ms_to_idx", data=_first_events(times), chunks=True, maxshape=(None,), compression=compression)
        file.create_dataset("t_offset", data=np.int64(offset))


def read_dsec(path: str | os.PathLike[str]) -> _EventArray:
    """Read the pixel events of a file of HDF5 like those of the data set DSEC.

    Parameters
    ----------
    path : str or path
        The file. Those of DSEC are compressed with Blosc, which needs the package hdf5plugin.

    Returns
    -------
    numpy.ndarray
        A structured array with the fields of ``pixel_events.npz``: ``x``, ``y`` (int16), ``t`` (int64, microseconds, with ``t_offset``)
        and ``p`` (bool).

    Raises
    ------
    ImportError
        If h5py is not installed.
    OSError
        If the file cannot be read, or is no file of HDF5.
    ValueError
        If the file lacks an array, or its events are damaged.
    """
    require_packages("read_dsec", ["h5py"], "dsec")
    import h5py

    # Its filters are registered when it is imported.
    with suppress(ImportError):
        import hdf5plugin  # noqa: F401
    with h5py.File(path, "r") as file:
        columns = {name: _stored(h5py, file, path, f"events/{name}") for name in DSEC_TYPES}
        offset = _stored(h5py, file, path, "t_offset", dimensions=0) if "t_offset" in file else np.int64(0)
    lengths = {name: len(column) for name, column in columns.items()}
    if len(set(lengths.values())) > 1:
        raise ValueError(f"{Path(path)}: the arrays of events have different lengths: {lengths}")
    for name in ("x", "y"):
        _require_range(f"{Path(path)}: {name}", columns[name], 0, np.iinfo(np.int16).max)
    events = np.empty(lengths["t"], EVENT_FIELDS)
    for name in ("x", "y", "p"):
        events[name] = columns[name]
    events["t"] = columns["t"].astype(np.int64) + np.int64(offset)
    _require_order(f"{Path(path)}: ", events["t"])
    return events


def _stored(h5py: Any, file: Any, path: str | os.PathLike[str], name: str, dimensions: int = 1) -> NDArray[Any]:
    """Return an array of whole numbers of a file."""
    stored = file.get(name)
    if not isinstance(stored, h5py.Dataset):
        raise ValueError(f"{Path(path)} has no array {name}; a file of DSEC has events/x, events/y, events/t and events/p")
    if stored.ndim != dimensions or stored.dtype.kind not in "iub":
        raise ValueError(f"{Path(path)}: {name} has {stored.ndim} dimensions of {stored.dtype}, and needs {dimensions} of whole numbers")
    try:
        return np.asarray(stored[()])
    except OSError as error:
        raise OSError(f"{Path(path)}: {name} cannot be read; files of DSEC need hdf5plugin, and others may be damaged: {error}") from error


def _columns(events: _EventArray) -> dict[str, NDArray[Any]]:
    """Return the fields of events, after checking them."""
    array = np.asarray(events)
    missing = [name for name in DSEC_TYPES if name not in (array.dtype.names or ())]
    if missing or array.ndim != 1:
        raise ValueError(f"events must be a structured array of one dimension with the fields x, y, t and p, not {array.ndim} of {array.dtype}")
    columns = {name: array[name] for name in DSEC_TYPES}
    for name, column in columns.items():
        if column.dtype.kind not in "iub":
            raise ValueError(f"the field {name} of events must have whole numbers, not {column.dtype}")
    for name, highest in (("x", np.iinfo(np.uint16).max), ("y", np.iinfo(np.uint16).max), ("p", 1)):
        _require_range(f"the field {name} of events", columns[name], 0, highest)
    _require_order("", columns["t"])
    return columns


def _offset(times: NDArray[Any], t_offset: int | None) -> int:
    if t_offset is not None:
        return int(t_offset)
    return int(times[0]) if len(times) else 0


def _relative_times(times: NDArray[Any], offset: int) -> NDArray[np.int64]:
    """Return times since the offset. They are in order, so the first and the last show whether all of them fit."""
    if len(times) and not 0 <= int(times[0]) - offset <= int(times[-1]) - offset < 1 << 32:
        raise ValueError(f"the times of events, {times[0]} to {times[-1]} us, do not fit: the file holds {offset} to {offset + (1 << 32) - 1} us")
    return times.astype(np.int64) - np.int64(offset)


def _first_events(times: NDArray[np.int64]) -> NDArray[np.uint64]:
    """Return, for each millisecond, the index of the first event that is not before it. All events are before the last millisecond."""
    milliseconds = int(times[-1]) // 1000 + 2 if len(times) else 1
    return np.searchsorted(times, 1000 * np.arange(milliseconds)).astype(np.uint64)


def _require_range(what: str, values: NDArray[Any], lowest: int, highest: int) -> None:
    if len(values) and not lowest <= int(values.min()) <= int(values.max()) <= highest:
        raise ValueError(f"{what} has values from {int(values.min())} to {int(values.max())}, and must have {lowest} to {highest}")


def _require_order(what: str, times: NDArray[Any]) -> None:
    wrong = np.flatnonzero(times[1:] < times[:-1])
    if len(wrong):
        at = int(wrong[0]) + 1
        raise ValueError(f"{what}the times of events must be in order, and event {at} has {times[at]} us after {times[at - 1]} us")
