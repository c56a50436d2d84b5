# SPDX-License-Identifier: MIT OR Apache-2.0
"""A line of progress on standard error."""
from __future__ import annotations

import sys
import time

#: Seconds between two updates of the line.
_INTERVAL = 0.1


def is_watched() -> bool:
    """Return whether someone sees standard error as it is written: on a terminal or in a notebook."""
    stream = sys.stderr
    return stream is not None and (stream.isatty() or type(stream).__module__.startswith("ipykernel"))


class ProgressLine:
    """Writes how many frames are done, over the line before, and clears the line at the end."""

    def __init__(self) -> None:
        self._next_update = 0.0
        self._width = 0

    def __call__(self, done: int, total: int | None, rate: float | None) -> None:
        """Show the number of frames, that of all, and the frames per second, as far as they are known."""
        now = time.monotonic()
        if now < self._next_update:
            return
        self._next_update = now + _INTERVAL
        frames = f"{done} frames" if total is None else f"{done} of {total} frames"
        self._write(frames if rate is None else f"{frames}, {rate:.3g} per second")

    def clear(self) -> None:
        """Remove the line, if there is one."""
        if self._width:
            self._write("")
            sys.stderr.write("\r")
            sys.stderr.flush()

    def _write(self, text: str) -> None:
        sys.stderr.write("\r" + text.ljust(self._width))
        sys.stderr.flush()
        self._width = len(text)
