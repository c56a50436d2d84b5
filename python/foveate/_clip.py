# SPDX-License-Identifier: MIT OR Apache-2.0
"""The outcomes of all frames of a clip as arrays, made by ``Camera.run``."""
from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from foveate import _foveate
from foveate._foveate import Camera, Design
from foveate._progress import ProgressLine, is_watched


class ClipOutcome:
    """The outcomes of all frames of a clip, stacked: the first axis of every array is the frame. Made by ``Camera.run``.

    Attributes
    ----------
    srs, trs, active : array of bool, shape (frames, rows, columns)
        Spatial relevance, temporal relevance, and both.
    action : array of uint8, shape (frames, rows, columns)
        Action of each region on the screen, an index into ``foveate.ACTIONS``.
    changed : array of int64, shape (frames, rows, columns)
        Number of changed pixels of each region.
    scores : dict of str to array of int64, shape (frames, rows, columns)
        Scores by feature, as those of ``Outcome``.
    displacements : array of int8, shape (frames, rows, columns, 2), or None
        Movement of the content of each region; None for a design without the feature ``flow``.
    rendered : array of uint8 or uint16, shape (frames, height, width), or None
        Frames on the receiver's screen; None if the run left them out.
    number, time_us, sent_pixels, sent_bytes : array of int64, shape (frames,)
        Number and time of each frame, and what it sends, as those of ``Outcome``.
    names : tuple of str
        Name of each frame.
    design : Design
        The design that the frames were shown to.
    problem : str or None
        The error that ended the footage before its end, if any.
    """

    def __init__(self, design: Design, arrays: dict[str, Any], problem: str | None) -> None:
        self._design, self._arrays, self._problem = design, arrays, problem

    @property
    def design(self) -> Design:
        """The design that the frames were shown to."""
        return self._design

    @property
    def problem(self) -> str | None:
        """The error that ended the footage before its end; None without an error."""
        return self._problem

    @property
    def srs(self) -> NDArray[np.bool_]:
        """Spatial relevance: array of bool, shape (frames, rows, columns)."""
        return cast("NDArray[np.bool_]", self._arrays["srs"])

    @property
    def trs(self) -> NDArray[np.bool_]:
        """Temporal relevance: array of bool, shape (frames, rows, columns)."""
        return cast("NDArray[np.bool_]", self._arrays["trs"])

    @property
    def active(self) -> NDArray[np.bool_]:
        """Regions whose pixels are sent: array of bool, shape (frames, rows, columns)."""
        return cast("NDArray[np.bool_]", self._arrays["active"])

    @property
    def action(self) -> NDArray[np.uint8]:
        """The action of each region on the screen, an index into ``foveate.ACTIONS``: array of uint8, shape (frames, rows, columns)."""
        return cast("NDArray[np.uint8]", self._arrays["action"])

    @property
    def changed(self) -> NDArray[np.int64]:
        """Number of changed pixels of each region: array of int64, shape (frames, rows, columns)."""
        return cast("NDArray[np.int64]", self._arrays["changed"])

    @property
    def scores(self) -> dict[str, NDArray[np.int64]]:
        """Scores by feature: dict of str to array of int64, shape (frames, rows, columns)."""
        return cast("dict[str, NDArray[np.int64]]", self._arrays["scores"])

    @property
    def displacements(self) -> NDArray[np.int8] | None:
        """Movement of the content of each region: array of int8, shape (frames, rows, columns, 2); None for a design without ``flow``."""
        return cast("NDArray[np.int8] | None", self._arrays["displacements"])

    @property
    def rendered(self) -> NDArray[np.uint8] | NDArray[np.uint16] | None:
        """Frames on the receiver's screen: array of uint8 or uint16, shape (frames, height, width); None if the run left them out."""
        return cast("NDArray[np.uint8] | NDArray[np.uint16] | None", self._arrays["rendered"])

    @property
    def number(self) -> NDArray[np.int64]:
        """Number of each frame: array of int64, shape (frames,)."""
        return cast("NDArray[np.int64]", self._arrays["number"])

    @property
    def time_us(self) -> NDArray[np.int64]:
        """Time of each frame in microseconds: array of int64, shape (frames,)."""
        return cast("NDArray[np.int64]", self._arrays["time_us"])

    @property
    def sent_pixels(self) -> NDArray[np.int64]:
        """Number of pixels that the active regions of each frame forward: array of int64, shape (frames,)."""
        return cast("NDArray[np.int64]", self._arrays["sent_pixels"])

    @property
    def sent_bytes(self) -> NDArray[np.int64]:
        """Number of bytes of the packets of each frame, without scores: array of int64, shape (frames,)."""
        return cast("NDArray[np.int64]", self._arrays["sent_bytes"])

    @property
    def names(self) -> tuple[str, ...]:
        """Name of each frame: tuple of str."""
        return tuple(self._arrays["names"])

    def __len__(self) -> int:
        return len(self.number)

    def __repr__(self) -> str:
        share = f"{self.active.mean():.1%}"
        return f"<foveate.ClipOutcome of {len(self)} frames: {share} of the regions active, {self.sent_bytes.sum()} bytes sent>"


def run_camera(camera: Camera, inputs: Any, rendered: bool, progress: bool | None, options: dict[str, Any]) -> ClipOutcome:
    """Show a clip to a camera, with a line of progress if it is wanted."""
    line = ProgressLine() if (is_watched() if progress is None else progress) else None
    try:
        return ClipOutcome(*_foveate.run_clip(camera, inputs, rendered, line, **options))
    finally:
        if line is not None:
            line.clear()
