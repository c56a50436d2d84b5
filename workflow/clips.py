# SPDX-License-Identifier: MIT OR Apache-2.0
"""Clips of the configuration: a name for each, and which of its inputs are files."""
import re
from pathlib import Path


def names(clips):
    """Every clip by a name that is fit for a folder: that of its file, with a number where it is there already."""
    found = {}
    for clip in clips:
        own = re.sub(r"[^\w.-]", "_", clip.removeprefix("scene:") if clip.startswith("scene:") else Path(clip).stem)
        name, number = own, 1
        while name in found:
            number += 1
            name = f"{own}-{number}"
        found[name] = clip
    return found


def files(inputs):
    """Those that are files or folders. Others are scenes, patterns, or names of spaces and accelerators."""
    return [path for path in inputs if path and Path(path).exists()]
