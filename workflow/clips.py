# SPDX-License-Identifier: MIT OR Apache-2.0
"""Clips of the configuration: a name for each, and which of its inputs are files."""
import re
from pathlib import Path


def names(clips):
    """Returns the clips by their names, which are fit for folders: the name of the file, with a number if another clip has it."""
    clip_of = {}
    for clip in clips:
        base_name = re.sub(r"[^\w.-]", "_", clip.removeprefix("scene:") if clip.startswith("scene:") else Path(clip).stem)
        name, number = base_name, 1
        while name in clip_of:
            number += 1
            name = f"{base_name}-{number}"
        clip_of[name] = clip
    return clip_of


def files(inputs):
    """Returns the inputs that are files or folders. The others are scenes, patterns, or names of spaces and accelerators."""
    return [path for path in inputs if path and Path(path).exists()]
