# SPDX-License-Identifier: MIT OR Apache-2.0
"""Region events of the command line as a data set for PyTorch, frame by frame."""
from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch.utils.data import Dataset

from foveate import ACTIONS
from foveate._extras import require_packages

#: The columns of ``events.parquet`` that become one tensor, by the key of that tensor.
_PAIRS = {"xy": ("x", "y"), "pixel_xy": ("x0", "y0"), "displacement": ("dx", "dy")}


class RegionEvents(Dataset[dict[str, torch.Tensor]]):
    """The region events of a clip, an item for each frame.

    Reads the folder that ``foveate simulate --events parquet`` writes, a group of rows at a time, so that memory does not grow
    with the length of the clip. Needs ``pyarrow``.

    Parameters
    ----------
    folder : path
        The folder with ``events.parquet`` and ``summary.json``.

    Attributes
    ----------
    features : tuple of str
        Names of the features, in the order of the columns of ``scores``.

    Raises
    ------
    FileNotFoundError
        If the folder lacks one of the files.

    Notes
    -----
    The item of a frame with n rows is a dict of tensors: ``frame`` and ``t_us`` (int64, one number each), ``xy`` (int32, n x 2,
    column and row of the region), ``pixel_xy`` (int32, n x 2, its first pixel), ``srs`` and ``trs`` (bool, n), ``scores`` (int64,
    n x features), ``changed`` (int32, n), ``action`` (uint8, n, an index into ``foveate.ACTIONS``), and with the feature
    ``flow`` also ``displacement`` (int32, n x 2). A frame without rows has n = 0.

    Examples
    --------
    >>> events = RegionEvents("out")
    >>> loader = torch.utils.data.DataLoader(events, batch_size=8, collate_fn=RegionEvents.collate, num_workers=2)
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        require_packages("RegionEvents", ["pyarrow"], "tables")
        from pyarrow import parquet

        self._path = Path(folder) / "events.parquet"
        summary = Path(folder) / "summary.json"
        for path in (self._path, summary):
            if not path.is_file():
                raise FileNotFoundError(f"{path} does not exist; foveate simulate --events parquet writes it")
        frames = int(json.loads(summary.read_text(encoding="utf-8"))["frames"])
        numbers = parquet.read_table(self._path, columns=["frame"])["frame"].to_numpy()
        # Rows are in the order of frames. Row self._starts[k] is the first of frame k.
        self._starts: NDArray[np.int64] = np.searchsorted(numbers, np.arange(frames + 1)).astype(np.int64)
        self._times = self._times_of_frames(Path(folder), frames)
        names = parquet.read_schema(self._path).names
        self.features = tuple(name.removeprefix("score_") for name in names if name.startswith("score_"))
        self._columns = names
        self._group_starts = self._starts_of_groups()
        self._group: tuple[int, dict[str, NDArray[Any]]] | None = None

    @staticmethod
    def _times_of_frames(folder: Path, frames: int) -> NDArray[np.int64]:
        """Return the times of all frames, which the table of events lacks for frames without rows."""
        table = np.genfromtxt(folder / "frames.csv", delimiter=",", names=True, dtype=None, encoding="utf-8", usecols=(0, 1))
        return np.atleast_1d(table["t_us"]).astype(np.int64)[:frames]

    def _starts_of_groups(self) -> NDArray[np.int64]:
        from pyarrow import parquet

        metadata = parquet.read_metadata(self._path)
        rows = [metadata.row_group(number).num_rows for number in range(metadata.num_row_groups)]
        return np.concatenate([[0], np.cumsum(rows)]).astype(np.int64)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_group": None}

    def __len__(self) -> int:
        return len(self._starts) - 1

    def __getitem__(self, index: int) -> dict[str, torch.Tensor]:
        if not -len(self) <= index < len(self):
            raise IndexError(f"frame {index} of {len(self)} frames")
        frame = index % len(self)
        rows = self._rows(int(self._starts[frame]), int(self._starts[frame + 1]))
        scores = [rows[f"score_{feature}"] for feature in self.features]
        arrays = {key: np.stack([rows[one], rows[other]], axis=1) for key, (one, other) in _PAIRS.items() if one in rows}
        arrays |= {"srs": rows["srs"], "trs": rows["trs"], "scores": np.stack(scores, axis=1), "changed": rows["t_count"]}
        arrays["action"] = rows["action"]
        found = {key: torch.from_numpy(array) for key, array in arrays.items()}
        return {"frame": torch.tensor(frame), "t_us": torch.tensor(int(self._times[frame])), **found}

    def _rows(self, start: int, end: int) -> dict[str, NDArray[Any]]:
        """Return the columns of some rows, which may lie in several groups."""
        first = int(np.searchsorted(self._group_starts, start, side="right")) - 1
        last = int(np.searchsorted(self._group_starts, max(start, end - 1), side="right")) - 1
        last_group = max(len(self._group_starts) - 2, 0)
        parts = []
        for group in range(min(first, last_group), min(last, last_group) + 1):
            offset = int(self._group_starts[group])
            columns = self._columns_of_group(group)
            parts.append({name: values[max(start - offset, 0):end - offset] for name, values in columns.items()})
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def _columns_of_group(self, group: int) -> dict[str, NDArray[Any]]:
        """Return the columns of a group of rows. The last group is kept, because frames are mostly read in order."""
        if self._group is None or self._group[0] != group:
            from pyarrow import parquet

            with parquet.ParquetFile(self._path) as file:
                table = file.read_row_group(group) if file.num_row_groups else file.read()
            columns = {name: table[name].to_numpy() for name in self._columns if name != "action"}
            texts, places = np.unique(table["action"].to_numpy(zero_copy_only=False).astype(str), return_inverse=True)
            columns["action"] = np.array([ACTIONS.index(text) for text in texts], np.uint8)[places]
            self._group = (group, columns)
        return self._group[1]

    @staticmethod
    def collate(items: Sequence[dict[str, torch.Tensor]]) -> dict[str, torch.Tensor]:
        """Join the items of a batch, for ``collate_fn`` of a ``DataLoader``.

        Parameters
        ----------
        items : sequence of dict
            Items of one data set.

        Returns
        -------
        dict of str to Tensor
            The rows of all items one after the other, ``batch`` (int64, the number of the item of each row), and ``frame`` and
            ``t_us`` with a number for each item.
        """
        counts = torch.tensor([len(item["srs"]) for item in items])
        joined = {key: torch.cat([item[key] for item in items]) for key in items[0] if key not in ("frame", "t_us")}
        single = {key: torch.stack([item[key] for item in items]) for key in ("frame", "t_us")}
        return {**single, "batch": torch.repeat_interleave(torch.arange(len(items)), counts), **joined}
