# SPDX-License-Identifier: MIT OR Apache-2.0
"""Results as a dict of the command line's JSON, which are printed as its text."""
from __future__ import annotations

from html import escape
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np


class _Report(dict[str, Any]):
    """The JSON of the command line as a dict. ``print`` shows its text."""

    _text: str

    def __init__(self, values: dict[str, Any], text: str) -> None:
        super().__init__(values)
        self._text = text

    def __str__(self) -> str:
        return self._text

    def _repr_html_(self) -> str:
        return f"<pre>{escape(self._text)}</pre>"


class Explanation(_Report):
    """The reason why a region was sent or dropped: pixels, scores, thresholds, votes and the rule, as in ``foveate explain --json``.

    That of ``Outcome.explain`` has no pixels, and nothing that follows from them.
    """


class Estimate(_Report):
    """Area and logic levels, as in ``foveate estimate --json``."""


class Fidelity(dict[str, Any]):
    """Errors of a design against the ideal camera, by the names of ``foveate explore``.

    Attributes
    ----------
    problem : str or None
        The error that ended the footage before its end, if any.
    """

    def __init__(self, values: dict[str, Any], problem: str | None) -> None:
        super().__init__(values)
        self._problem = problem

    @property
    def problem(self) -> str | None:
        """The error that ended the footage before its end; None without an error."""
        return self._problem

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th>{escape(name)}</th><td>{escape(str(value))}</td></tr>" for name, value in self.items())
        return f"<table>{rows}</table>"


class StreamLoss(NamedTuple):
    """Something that is missing or wrong in a stream of packets, as a line of ``losses.csv``. ``str`` says it in words."""

    kind: str
    frame: int | None
    row: int | None
    column: int | None
    amount: int | None
    offset: int | None
    text: str

    def __str__(self) -> str:
        return self.text


for _name, _doc in {
    "kind": "Kind, the column ``what`` of ``losses.csv``, such as \"bytes\", \"frames\" or \"region\".",
    "frame": "Number of the frame; None if it is not known.",
    "row": "Row of regions; None if the loss is not one of a row.",
    "column": "Column of the region; None if the loss is not one of a region.",
    "amount": "Number of bytes, frames or packets, the column ``count`` of ``losses.csv``; None for a loss without a number.",
    "offset": "First byte in the stream that is no packet; None for other losses.",
    "text": "The loss in words, as ``foveate decode`` prints it.",
}.items():
    getattr(StreamLoss, _name).__doc__ = _doc


class Inference:
    """The result of a network behind the camera: its outputs, and what the masks saved.

    Attributes
    ----------
    folder : pathlib.Path
        The folder that ``foveate infer`` writes: tables, charts and ``report.html``.
    summary : dict
        The content of ``inference.json``.
    """

    def __init__(self, folder: Path, summary: dict[str, Any]) -> None:
        self._folder, self._summary = folder, summary

    @property
    def folder(self) -> Path:
        """The folder that ``foveate infer`` writes: tables, charts and ``report.html``."""
        return self._folder

    @property
    def summary(self) -> dict[str, Any]:
        """The content of ``inference.json`` as a dict."""
        return self._summary

    @property
    def outputs(self) -> dict[str, np.ndarray[Any, Any]]:
        """Outputs by name, each an array of shape [frames, ...shape], read from the folder at each use."""
        return {entry["name"]: np.load(self.folder / entry["array"]) for entry in self.summary["outputs"]}

    def table(self, name: str) -> np.ndarray[Any, Any]:
        """Read a table of the folder, ``layers`` or ``frames``, as a structured array. Raises a KeyError for an unknown name."""
        path = self.folder / f"{name}.csv"
        if not path.is_file():
            tables = ", ".join(sorted(path.stem for path in self.folder.glob("*.csv")))
            raise KeyError(f"there is no table {name!r}; there are {tables}")
        # NumPy's types do not know that comments may be None.
        read: Any = np.genfromtxt
        table: np.ndarray[Any, Any] = read(path, delimiter=",", names=True, dtype=None, encoding="utf-8", comments=None)
        return table

    def __repr__(self) -> str:
        summary = self.summary
        return f"<foveate.Inference of {summary['frames']} frames, mode {summary['mode']}, in {self.folder}>"
