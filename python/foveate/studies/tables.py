# SPDX-License-Identifier: MIT OR Apache-2.0
"""Results of studies as CSV, JSON and Markdown. The same results give the same bytes."""
from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from foveate.studies.runs import write_whole

__all__ = ["PAPER", "accuracy_markdown", "savings_markdown", "verdict", "write_csv", "write_json", "write_text"]

#: Points between originals and regions in the paper's table, of one training each; by set.
PAPER: Mapping[str, float] = {"mnist": 0.13, "fashion-mnist": 0.2}


def write_csv(path: Path, rows: Sequence[Mapping[str, Any]]) -> None:
    """Write rows with the same keys as CSV."""
    text = io.StringIO()
    table = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
    write_text(path, text.getvalue())


def write_json(path: Path, values: Any) -> None:
    """Write a value as JSON."""
    write_text(path, json.dumps(values, indent=1) + "\n")


def write_text(path: Path, text: str) -> None:
    """Write a text to a file, which appears whole or not at all."""
    write_whole(path, lambda partial: partial.write_text(text, encoding="utf-8"))


def write_all(path: Path, rows: Sequence[Mapping[str, Any]], summary: Mapping[str, Any], text: str) -> None:
    """Write the rows, the summary and the table of a study to files with the same ``path`` and different extensions."""
    write_csv(path.with_suffix(".csv"), rows)
    write_json(path.with_suffix(".json"), summary)
    write_text(path.with_suffix(".md"), text)


def accuracy_markdown(summary: Mapping[str, Any]) -> str:
    """Return the table beside the paper's, and a conclusion for each row in words."""
    lines = [
        "| set | trained on | tested on | seeds | accuracy | difference, points | over seeds | over images | McNemar | bytes | paper |",
        "| --- | --- | --- | ---: | ---: | ---: | --- | --- | --- | ---: | ---: |",
    ]
    for entry in summary["sets"]:
        seeds = entry["table"][0]["seeds"]
        lines.append(f"| {entry['set']} | originals | originals | {seeds} | {100 * entry['original']['mean']:.2f} % | | | | | 100.0 % | |")
        for row in entry["table"]:
            # The paper's camera has only this row.
            paper = PAPER.get(entry["set"]) if row["trained"] != "original" and entry["model"] == "lenet5" else None
            lines.append(
                f"| {entry['set']} | {_kind(row['trained'])} | {row['tested']} | {row['seeds']} | {100 * row['accuracy']['mean']:.2f} % "
                f"| {100 * row['difference']['mean']:+.2f} | {_range(row['difference'])} | {_ends(row['bootstrap'])} "
                f"| {row['significant']} of {row['seeds']} | {100 * row['sent_share']:.1f} % | {'' if paper is None else paper} |")
    lines.append("")
    lines += [f"* {line}" for entry in summary["sets"] for line in verdict(entry)]
    lines.append("* Intervals cover seeds and images, not other training recipes, with which differences may be larger.")
    return "\n".join(lines) + "\n"


def verdict(entry: Mapping[str, Any]) -> Sequence[str]:
    """Return the conclusions of a set. A difference is reported only if neither other seeds nor other images explain it."""
    return [f"{entry['set']}, {_kind(row['trained'])}, tested on {row['tested']}: {_conclusion(row)}" for row in entry["table"]]


def _conclusion(row: Mapping[str, Any]) -> str:
    largest = f"{100 * row['largest']:.2f} points"
    seeds = (row["difference"]["low"], row["difference"]["high"])
    if seeds[0] is None:
        return "one seed alone does not show how much seeds differ"
    intervals = (seeds, row["bootstrap"])
    if all(high < 0 for _, high in intervals):
        return f"a loss of {-100 * row['difference']['mean']:.2f} points, at most {largest}"
    if all(low > 0 for low, _ in intervals):
        return f"a gain of {100 * row['difference']['mean']:.2f} points, at most {largest}"
    return f"no difference larger than {largest}"


def savings_markdown(summary: Mapping[str, Any]) -> str:
    """Return a row for every camera of every set."""
    lines = ["| set | camera | active | bytes | MACs needed | trained on originals, points | trained on regions, points |",
             "| --- | --- | ---: | ---: | ---: | ---: | ---: |"]
    for row in summary["rows"]:
        lines.append(f"| {row['set']} | {row['camera']} | {100 * row['active_share']:.1f} % | {100 * row['sent_share']:.1f} % "
                     f"| {100 * row['macs_share']:.1f} % | {_points(row['original_difference'])} | {_points(row['regions_difference'])} |")
    return "\n".join(lines) + "\n"


def _points(share: float | None) -> str:
    return "" if share is None else f"{100 * share:+.2f}"


def _kind(trained: str) -> str:
    return "originals" if trained == "original" else "regions"


def _range(interval: dict[str, Any]) -> str:
    return "" if interval["low"] is None else _ends((interval["low"], interval["high"]))


def _ends(ends: Sequence[float] | tuple[float, float]) -> str:
    return f"{100 * ends[0]:+.2f} to {100 * ends[1]:+.2f}"
