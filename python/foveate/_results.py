# SPDX-License-Identifier: MIT OR Apache-2.0
"""Results that are a dict of the command line's JSON, and show themselves as its text."""
from __future__ import annotations

from html import escape
from pathlib import Path
from typing import Any

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
    """Why a region was sent or dropped: pixels, scores, thresholds, votes and the rule, as ``foveate explain --json`` has them."""


class Estimate(_Report):
    """Area and logic levels, as ``foveate estimate --json`` has them."""


class Fidelity(dict[str, Any]):
    """Errors of a design against the ideal camera, by the names of ``foveate explore``.

    Attributes
    ----------
    problem : str or None
        Why the footage ended before its end, if it did.
    """

    def __init__(self, values: dict[str, Any], problem: str | None) -> None:
        super().__init__(values)
        self._problem = problem

    @property
    def problem(self) -> str | None:
        """Why the footage ended before its end; None if it did not."""
        return self._problem

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th>{escape(name)}</th><td>{escape(str(value))}</td></tr>" for name, value in self.items())
        return f"<table>{rows}</table>"


class Inference:
    """A network behind the camera: what was saved, and its outputs.

    Attributes
    ----------
    folder : pathlib.Path
        What ``foveate infer`` writes: tables, charts and ``report.html``.
    summary : dict
        ``inference.json``.
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
        """Outputs by name, each an array [frames, ...shape], read when asked for."""
        return {entry["name"]: np.load(self.folder / entry["array"]) for entry in self.summary["outputs"]}

    def table(self, name: str) -> np.ndarray[Any, Any]:
        """Read a table of the folder, ``layers`` or ``frames``, as a structured array."""
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
