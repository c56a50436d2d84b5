# SPDX-License-Identifier: MIT OR Apache-2.0
"""The plan of an exploration, as `foveate explore --plan` prints it."""
import functools
import json
from pathlib import Path


def read(plan):
    """The units by their names, each with the line that describes it."""
    return parsed(plan, Path(plan).stat().st_mtime_ns)


@functools.lru_cache(maxsize=1)
def parsed(plan, _changed):
    # Snakemake asks for it once for every unit.
    found = [{**json.loads(line), "line": line} for line in Path(plan).read_text().splitlines()]
    return {unit["unit"]: unit for unit in found}
