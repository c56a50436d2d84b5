# SPDX-License-Identifier: MIT OR Apache-2.0
"""Region-based event cameras for Python: the engine of the command ``foveate``, on arrays.

>>> import foveate as fv
>>> camera = fv.Camera("paper", region={"size": 16})
>>> outcome = camera.step(frame)            # a 2-D array of uint8
>>> outcome.active                          # bool, rows x columns of regions
>>> for outcome in fv.simulate("street.mp4", camera, max_frames=100): ...
>>> fv.events(outcomes)                     # a table of region events
>>> fv.decode(outcome.packets(), camera)    # frames of what the camera sends
>>> fv.clocks("street.mp4", "raster")       # a table of the clocks at which the hardware decides and sends regions

Every number is computed by the code of the command line, so the results are equal, bit by bit.
"""
from foveate._clip import ClipOutcome
from foveate._dsec import read_dsec, write_dsec
from foveate._foveate import (
    Camera,
    DecodedFrame,
    Decoding,
    Design,
    Outcome,
    Run,
    TimedCamera,
    ToolError,
    __version__,
    clocks,
    decode,
    luma,
    presets,
    simulate,
)
from foveate._registers import Register, RegisterField, Registers
from foveate._results import Estimate, Explanation, Fidelity, Inference, StreamLoss
from foveate._tables import events
from foveate._work import estimate, explain, fidelity, generate, infer, pixel_events

#: Names of the values of ``Outcome.action``, the actions for a region on the screen.
ACTIONS = ("blank", "hold", "forward", "summarize")


__all__ = [
    "ACTIONS",
    "Camera",
    "ClipOutcome",
    "DecodedFrame",
    "Decoding",
    "Design",
    "Estimate",
    "Explanation",
    "Fidelity",
    "Inference",
    "Outcome",
    "Register",
    "RegisterField",
    "Registers",
    "Run",
    "StreamLoss",
    "TimedCamera",
    "ToolError",
    "__version__",
    "clocks",
    "decode",
    "estimate",
    "events",
    "explain",
    "fidelity",
    "generate",
    "infer",
    "luma",
    "pixel_events",
    "presets",
    "read_dsec",
    "simulate",
    "write_dsec",
]
