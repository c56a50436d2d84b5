# SPDX-License-Identifier: MIT OR Apache-2.0
"""The plan of an exploration, as `foveate explore --plan` prints it."""
import functools
import json
from pathlib import Path


def read(plan):
    """Returns the units by their names, each with the line that describes it."""
    return parse_plan(plan, Path(plan).stat().st_mtime_ns)


@functools.lru_cache(maxsize=1)
def parse_plan(plan, _modification_time):
    # Snakemake reads the plan once for every unit, so the last one is cached until its file changes.
    units = [{**json.loads(line), "line": line} for line in Path(plan).read_text().splitlines()]
    return {unit["unit"]: unit for unit in units}
