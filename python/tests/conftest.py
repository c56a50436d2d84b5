# SPDX-License-Identifier: MIT OR Apache-2.0
"""Fixtures of the tests: the command line of this machine, whose results those of the package must equal."""
from __future__ import annotations

import ast
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]


class NamedOptions(ast.NodeTransformer):
    """Writes the options that a function takes as a group, `**options: Unpack[GROUP]`, one by one, as signatures have them."""

    def __init__(self):
        groups = ast.parse((ROOT / "python/foveate/_options.py").read_text()).body
        self.groups = {group.name: group.body[1:] for group in groups if isinstance(group, ast.ClassDef)}

    def visit_arguments(self, own):
        if own.kwarg and ast.unparse(own.kwarg.annotation).startswith("Unpack["):
            options = self.groups[own.kwarg.annotation.slice.id]
            own.kwonlyargs += [ast.arg(option.target.id, option.annotation) for option in options]
            own.kw_defaults += [ast.Constant(None)] * len(options)
            own.kwarg = None
        return own


def stub_of_the_compiled_part():
    """Returns the syntax tree of the stub, with every option of a group."""
    return NamedOptions().visit(ast.parse((ROOT / "python/foveate/_foveate.pyi").read_text()))


@pytest.fixture(scope="session")
def command():
    """Runs the program `foveate` that the environment variable FOVEATE names, else the one of the package."""
    program = [os.environ["FOVEATE"]] if "FOVEATE" in os.environ else [sys.executable, "-m", "foveate"]

    def run(*arguments):
        return subprocess.run([*program, *map(str, arguments)], check=True, capture_output=True, text=True).stdout

    return run


@pytest.fixture(scope="session")
def frames():
    """Makes a clip in which a part changes: 12 frames of 60 x 83 pixels, which is not a multiple of a region."""
    generator = np.random.default_rng(7)
    still = generator.integers(0, 256, (60, 83), np.uint8)
    clip = np.repeat(still[None], 12, axis=0)
    for number in range(1, 12):
        clip[number, 10:30, 3 * number : 3 * number + 25] = generator.integers(0, 256, (20, 25), np.uint8)
    return clip


def equal(outcome, expected):
    """Returns whether two outcomes are equal, except for the frame itself."""
    names = ("srs", "trs", "active", "action", "changed", "rendered")
    same = all(np.array_equal(getattr(outcome, name), getattr(expected, name)) for name in names)
    same = same and np.array_equal(outcome.displacements, expected.displacements)
    return same and all(np.array_equal(outcome.scores[name], expected.scores[name]) for name in outcome.scores)
