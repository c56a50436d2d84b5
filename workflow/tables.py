# SPDX-License-Identifier: MIT OR Apache-2.0
"""Makes one table of the folders of many clips.

    tables.py rows OUT.csv STUDY FOLDER...    the rows of a study, as one run over all the clips writes them
    tables.py totals OUT.csv FOLDER...        the totals of a network: a row for each clip, without times
"""
import csv
import io
import json
import os
import sys
from pathlib import Path


def rows(out, study, *folders):
    """Writes the rows of a study: the comments of all folders, the columns once, and the rows of all folders."""
    comments, columns, lines = [], None, []
    for folder in folders:
        text = (Path(folder) / f"{study}.csv").read_text().splitlines(keepends=True)
        folder_comments = [line for line in text if line.startswith("#")]
        comments += folder_comments[1:] if comments else folder_comments
        head, *more = text[len(folder_comments):]
        if columns not in (None, head):
            sys.exit(f"tables: `{folder}` has other columns than the folders before it: {head.strip()}")
        columns = head
        lines += more
    write(out, "".join([*comments, columns, *lines]))


def totals(out, *folders):
    """Writes a row for each clip, with the totals in its `inference.json`. Times depend on the machine, so they stay in the folders."""
    summaries = []
    for folder in folders:
        summary = json.loads((Path(folder) / "inference.json").read_text())
        summaries.append({"clip": Path(folder).name, **dict(scalars(summary))})
    columns = list(dict.fromkeys(column for row in summaries for column in row))
    text = io.StringIO()
    table = csv.DictWriter(text, columns, lineterminator="\n")
    table.writeheader()
    table.writerows(summaries)
    write(out, text.getvalue())


def scalars(value, name=""):
    """Yields the names and values of all numbers and texts; a name inside an object is `object.name`. Lists and times are left out."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from scalars(inner, f"{name}.{key}" if name else key)
    elif not isinstance(value, list) and value is not None and "seconds" not in name:
        yield name, value


def write(out, text):
    """Writes a file, which appears whole or not at all."""
    Path(f"{out}.partial").write_text(text)
    os.replace(f"{out}.partial", out)


if __name__ == "__main__":
    {"rows": rows, "totals": totals}[sys.argv[1]](*sys.argv[2:])
