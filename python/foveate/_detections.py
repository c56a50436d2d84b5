# SPDX-License-Identifier: MIT OR Apache-2.0
"""Groups of active regions as detections of the package supervision, which is needed only here."""
from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from foveate import Outcome


def detections_of(outcome: Outcome) -> Any:
    """Return the boxes of an outcome as ``supervision.Detections``."""
    if find_spec("supervision") is None:
        raise ImportError(
            "outcome.detections() needs supervision, which is not installed: pip install supervision; outcome.boxes() needs no package",
            name="supervision",
        )
    return import_module("supervision").Detections(xyxy=outcome.boxes())
