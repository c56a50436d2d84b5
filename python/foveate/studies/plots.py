# SPDX-License-Identifier: MIT OR Apache-2.0
"""Figures of studies as SVG and PNG. The same results give the same bytes."""
from __future__ import annotations

import io
from collections.abc import Mapping
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np

from foveate.studies.data import StudyError
from foveate.studies.runs import write_whole

__all__ = ["accuracy", "savings"]

#: Okabe and Ito, as in every chart of the project: blue, vermilion, reddish purple, black, bluish green, orange, sky blue; then grey and brown.
_COLOURS = ("#0072b2", "#d55e00", "#cc79a7", "#000000", "#009e73", "#e69f00", "#56b4e9", "#8a8f94", "#7a4a1e")
_TITLES = {"mnist": "MNIST", "fashion-mnist": "FashionMNIST", "pictures": "pictures"}


def accuracy(summary: Mapping[str, Any], folder: Path) -> None:
    """Draw accuracy and bytes against the threshold, one column for each set."""
    figure, axes = _axes(2, len(summary["sets"]), heights=(2, 1))
    for column, entry in enumerate(summary["sets"]):
        upper, lower = axes[0][column], axes[1][column]
        rows = entry["figure"]
        upper.axhline(100 * entry["figure_original"], color=_COLOURS[3], linewidth=1, linestyle="--", label="originals")
        for learned, colour, label in ((True, _COLOURS[4], "trained on regions"), (False, _COLOURS[1], "trained on originals")):
            plotted_rows = [row for row in rows if (row["trained"] != "original") == learned]
            upper.plot([row["min_score"] for row in plotted_rows], [100 * row["accuracy"]["mean"] for row in plotted_rows], color=colour, label=label)
            for row in plotted_rows:
                upper.plot([row["min_score"]] * row["seeds"], [100 * value for value in row["tests"]], ".", color=colour, markersize=5)
        lower.plot([row["min_score"] for row in rows], [100 * row["sent_share"] for row in rows], color=_COLOURS[0])
        lower.set_ylim(0, 100)
        lower.set_xlabel("threshold: edge points of a region")
        lower.set_xticks([row["min_score"] for row in rows])
        upper.set_xticks([row["min_score"] for row in rows], [])
        upper.set_title(_title(entry["set"]), fontsize=10)
    axes[0][0].set_ylabel("accuracy on regions, %")
    axes[1][0].set_ylabel("bytes sent, %")
    axes[0][0].legend(frameon=False, fontsize=8)
    _save(figure, folder, "accuracy")


def savings(summary: Mapping[str, Any], folder: Path) -> None:
    """Draw accuracy against the share of bytes and of MACs, one row for each set, one line for each kind of camera."""
    sets = list(dict.fromkeys(row["set"] for row in summary["rows"]))
    figure, axes = _axes(len(sets), 2)
    for number, name in enumerate(sets):
        kinds: dict[str, list[Mapping[str, Any]]] = {}
        for row in summary["rows"]:
            if row["set"] == name:
                kinds.setdefault(row["kind"], []).append(row)
        for position, (key, label) in enumerate(
            (("sent_share", "bytes sent, % of the originals"), ("macs_share", "MACs needed, % of a whole image"))):
            axis = axes[number][position]
            axis.axhline(0, color="#a0a4a9", linewidth=1)
            for (kind, rows), colour, mark in zip(kinds.items(), cycle(_COLOURS), cycle("osD^vPX<>")):
                points = [(100 * row[key], 100 * row["original_difference"]) for row in rows]
                axis.plot(*np.transpose(points), color=colour, marker=mark, markersize=4, linewidth=1, label=kind)
                learned = [(100 * row[key], 100 * row["regions_difference"]) for row in rows if row["regions_difference"] is not None]
                if learned:
                    axis.plot(*np.transpose(learned), color=colour, marker=mark, markersize=4, linewidth=1, linestyle=":", markerfacecolor="none")
            if number == len(sets) - 1:
                axis.set_xlabel(label)
        axes[number][0].set_ylabel(f"{_title(name)}: accuracy, points")
    _legend(axes[0][0], learned=any(row["regions_difference"] is not None for row in summary["rows"]))
    _save(figure, folder, "savings")


def _legend(axes: Any, *, learned: bool) -> None:
    """Make the legend: the colour is the kind of camera, the filling of a mark says what networks learned from."""
    if learned:
        grey = {"color": "#5a5a5a", "marker": "o", "markersize": 4, "linewidth": 1}
        axes.plot([], [], label="filled: trained on originals", **grey)
        axes.plot([], [], label="hollow: trained on regions", linestyle=":", markerfacecolor="none", **grey)
    axes.legend(frameon=False, fontsize=7)


def _title(name: str) -> str:
    return _TITLES.get(name, name)


def _axes(rows: int, columns: int, heights: tuple[int, ...] | None = None) -> tuple[Any, Any]:
    try:
        import matplotlib
    except ImportError:
        raise StudyError("figures need matplotlib: pip install matplotlib") from None
    matplotlib.use("Agg")
    # Identifiers inside the SVG depend only on its content.
    matplotlib.rcParams["svg.hashsalt"] = "foveate"
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(rows, columns, figsize=(4.2 * columns, 2.9 * rows if heights is None else 5.2), squeeze=False,
                                   gridspec_kw=None if heights is None else {"height_ratios": heights}, layout="constrained")
    for axis in axes.flat:
        axis.grid(True, color="#e1e1e1", linewidth=0.6)
        axis.spines[["top", "right"]].set_visible(False)
        axis.tick_params(labelsize=8)
    return figure, axes


def _save(figure: Any, folder: Path, name: str) -> None:
    from matplotlib import pyplot

    for kind, metadata in (("svg", {"Date": None, "Creator": None}), ("png", {"Software": None})):
        content = io.BytesIO()
        figure.savefig(content, format=kind, dpi=110, metadata=metadata)
        write_whole(folder / f"{name}.{kind}", partial(_write, content.getvalue()))
    pyplot.close(figure)


def _write(content: bytes, path: Path) -> None:
    path.write_bytes(content)
