# SPDX-License-Identifier: MIT OR Apache-2.0
"""Functions for the commands other than ``simulate``."""
from __future__ import annotations

import json
import shutil
import tempfile
import weakref
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

import numpy as np
from numpy.typing import NDArray

from foveate import _foveate
from foveate._options import InputOptions, PathLike, takes_inputs
from foveate._results import Estimate, Explanation, Fidelity, Inference

if TYPE_CHECKING:
    from typing_extensions import Unpack

Inputs = Union[PathLike, Sequence[PathLike]]
#: The type of a pixel event, that of tonic.
_PIXEL_EVENT = np.dtype([("x", "<i2"), ("y", "<i2"), ("t", "<i8"), ("p", "?")])


@takes_inputs
def explain(
    inputs: Any,
    camera: Any = None,
    *,
    frame: int = 0,
    region: tuple[int, int] = (0, 0),
    **options: Unpack[InputOptions],
) -> Explanation:
    """Explain why a region of a frame was sent or dropped.

    Parameters
    ----------
    inputs : path, pattern, "scene:NAME", a list of these, or frames
        Footage or frames, as of ``simulate``.
    camera : Camera, Design, preset, file or dict, optional
        The camera. Its own state is neither used nor changed: the earlier frames are shown to another camera of its design.
    frame : int, default 0
        Number of the frame.
    region : (int, int), default (0, 0)
        Column and row of the region.
    max_frames, input_fps, rate, start, end, crop, resize, luma, orientation : optional
        How inputs are read, see ``simulate``.
    video_stream, raw, bayer, timestamps, timestamp_unit, images, labels : optional
        How inputs are read, see ``simulate``.

    Returns
    -------
    Explanation
        A dict; ``print`` shows it as text.

    Raises
    ------
    IndexError
        If the frame or the region does not exist.
    TypeError
        If an option does not exist, or if ``inputs`` are neither footage nor frames.
    """
    values, text = _foveate.explain(inputs, camera, frame=frame, region=region, **options)
    return Explanation(json.loads(values), text)


@takes_inputs
def fidelity(
    inputs: Any,
    camera: Any = None,
    *,
    ideal: Any = None,
    **options: Unpack[InputOptions],
) -> Fidelity:
    """Measure the errors of a design against the ideal camera, which computes in real numbers over whole frames.

    Parameters
    ----------
    inputs : path, pattern, "scene:NAME", a list of these, or frames
        Footage or frames, as of ``simulate``.
    camera : Camera, Design, preset, file or dict, optional
        The design to measure.
    ideal : Camera, Design, preset, file or dict, optional
        The ideal design. The default is ``camera`` itself, so that only its rounding and its windows are measured.
    max_frames, input_fps, rate, start, end, crop, resize, luma, orientation : optional
        How inputs are read, see ``simulate``.
    video_stream, raw, bayer, timestamps, timestamp_unit, images, labels : optional
        How inputs are read, see ``simulate``.

    Returns
    -------
    Fidelity
        A dict: ``action_flips``, ``srs_flips``, ``trs_flips`` (shares of the area), ``missed``, ``false_alarms`` (shares of the active
        area, without the first frame of every clip), ``stale_regions`` (share of the relevant regions), ``psnr_ideal`` in dB (None if
        identical), ``ssim_ideal``, ``scores``, ``staleness`` and more.
    """
    values, problem = _foveate.fidelity(inputs, camera, ideal=ideal, **options)
    return Fidelity(json.loads(values), problem)


@takes_inputs
def pixel_events(
    inputs: Any,
    camera: Any = None,
    *,
    contrast: float | None = None,
    log: bool = False,
    **options: Unpack[InputOptions],
) -> NDArray[np.void]:
    """Make the events of an ordinary event camera of the same frames, in the layout of the package tonic.

    Parameters
    ----------
    inputs : path, pattern, "scene:NAME", a list of these, or frames
        Footage or frames of one clip, as of ``simulate``.
    camera : Camera, Design, preset, file or dict, optional
        The design, whose bits per pixel the frames have, and whose ``temporal.level`` is the default of the contrast. Its state is
        neither used nor changed.
    contrast : float, optional
        The change of a pixel that makes an event, from 0.01 on: in grey levels, or as a natural logarithm with ``log``. The default
        is ``temporal.level`` + 1, or 0.2 with ``log``.
    log : bool, default False
        Take the logarithms of pixels.
    max_frames, input_fps, rate, start, end, crop, resize, luma, orientation : optional
        How inputs are read, see ``simulate``.
    video_stream, raw, bayer, timestamps, timestamp_unit, images, labels : optional
        How inputs are read, see ``simulate``. Frames from arrays have the times of ``rate`` (30 frames per second).

    Returns
    -------
    numpy.ndarray
        All events, a structured array: ``x``, ``y`` (int16, column and row of the pixel), ``t`` (int64, microseconds) and ``p`` (bool,
        brighter), as ``tonic.io.make_structured_array`` makes it and transforms of tonic take it. They are those of ``foveate
        simulate --pixel-events``. An event has the time of its frame, and needs 13 bytes.

    Raises
    ------
    FileNotFoundError, ValueError
        If an input cannot be read, is a set of unrelated images, or does not fit the configuration, or if the contrast is below 0.01.
    TypeError
        If an option does not exist or has another type, or if ``inputs`` are neither footage nor frames.
    ToolError
        If ffmpeg is needed and missing.

    Examples
    --------
    >>> events = pixel_events("scene:street", contrast=15, max_frames=8)
    >>> events["p"].mean(), events["t"].max()
    """
    records = _foveate.pixel_event_records(inputs, camera, contrast, log, **options)
    return records.view(_PIXEL_EVENT)


def generate(camera: Any, folder: PathLike, *, force: bool = False, prefix: str | None = None) -> list[Path]:
    """Write the Verilog of a design, with file lists, constraints, benches and a README.

    Parameters
    ----------
    camera : Camera, Design, preset, file or dict
        The design. A camera that takes its size from its frames must have seen one.
    folder : path
        The folder to write. It appears only when it is complete.
    force : bool, default False
        Replace the folder if it holds a generated core.
    prefix : str, optional
        Prefix of the names of all modules, before a ``_``, so that several cores fit into one chip. With ``"auto"`` it
        is made from the fingerprint of the design.

    Returns
    -------
    list of pathlib.Path
        The files that were written.

    Raises
    ------
    ValueError
        If names of modules cannot begin with the prefix, or if the camera has no size yet.
    FileExistsError
        If the folder is not empty.
    """
    return [Path(folder) / name for name in _foveate.generate(camera, folder, force, prefix)]


def estimate(camera: Any) -> Estimate:
    """Synthesize a design with Yosys, and count LUTs, registers, memories and logic levels.

    Parameters
    ----------
    camera : Camera, Design, preset, file or dict
        The design. A second estimate of the same design comes from a cache. A camera that takes its size from its frames
        must have seen one.

    Returns
    -------
    Estimate
        A dict; ``print`` shows it beside the paper's table.

    Raises
    ------
    ToolError
        If Yosys is missing or fails.
    ValueError
        If the camera has no size yet.
    """
    values, text = _foveate.estimate(camera)
    return Estimate(json.loads(values), text)


@takes_inputs
def infer(
    network: PathLike,
    inputs: Any,
    camera: Any = None,
    output: PathLike | None = None,
    *,
    mode: str | None = None,
    tune: str | None = None,
    reference: bool = False,
    accelerator: str | None = None,
    mean: float | Sequence[float] = 0.0,
    scale: float | Sequence[float] = 1.0,
    framing: str = "same",
    whole_frames: bool = False,
    noise: str | None = None,
    every: int = 1,
    detect: str | None = None,
    boxes: Inputs | None = None,
    pictures: bool = False,
    force: bool = False,
    **options: Unpack[InputOptions],
) -> Inference:
    """Run a network on the output of a camera, and count what its masks save.

    Parameters
    ----------
    network : path
        An ONNX file whose input is [1, channels, height, width], with 1 or 3 channels.
    inputs : path, pattern, "scene:NAME" or a list of these, or array of shape (frames, height, width), or list of arrays
        Footage, as of ``simulate``. Images of a list are one clip; each other input is a clip of its own. Or frames: grey
        pixels as ``Camera.step`` takes them, together one clip, of which a copy is kept until the end.
    camera : Camera, Design, preset, file or dict, optional
        The camera in front of the network.
    output : path, optional
        The folder to write. The default is a temporary folder, which is removed together with the result.
    mode : str, optional
        "dense", "exact", "compare", "truncate=T" or "fixed"; "exact" without it.
    tune : str, optional
        The largest change of the outputs for which limits are searched, such as "variation=10%"; in place of a mode.
    reference : bool, default False
        Compute every frame whole as well, and measure how far the outputs are from it. Always on with "truncate=T", "fixed" and
        ``tune``.
    accelerator : str, optional
        The name of an accelerator, or the path of its file.
    mean, scale : float or sequence of float, default 0 and 1
        The number that is subtracted from pixels, and the number by which they are then divided; or one per channel.
    framing : str, default "same"
        "same", "letterbox", "letterbox=416x416", "stretch" or "stretch=416x416".
    whole_frames : bool, default False
        Run the network also on the frames before the camera.
    noise : str, optional
        Standard deviations in grey levels of 8 bits, such as "1,2,4": run the network also on whole frames with such Gaussian
        noise; "0" is none. The default with ``whole_frames`` or ``detect`` is "1,2,4".
    every : int, default 1
        Run the network on one of this many frames.
    detect : str, optional
        The format of detections, such as "yolox,score=0.3".
    boxes : path or list of paths, optional
        Ground-truth boxes.
    pictures : bool, default False
        Write the outputs that are pictures as image files, too.
    force : bool, default False
        Replace ``output`` if it holds a result.
    max_frames, input_fps, rate, start, end, crop, resize, luma, orientation : optional
        How inputs are read, see ``simulate``.
    video_stream, raw, bayer, timestamps, timestamp_unit, images, labels : optional
        How inputs are read, see ``simulate``.

    Returns
    -------
    Inference
        The result, with ``summary``, ``outputs`` and tables.

    Raises
    ------
    TypeError
        If an option does not exist, or if ``inputs`` are neither footage nor frames.
    FileNotFoundError, IsADirectoryError, PermissionError
        If the network or another file cannot be read.
    ValueError
        If a file has wrong content, or if the inputs do not fit each other.
    """
    choices: dict[str, Any] = dict(
        mode=mode, tune=tune, reference=reference, accelerator=accelerator, mean=mean, scale=scale, framing=framing,
        whole_frames=whole_frames, noise=noise, every=every, detect=detect, boxes=boxes, pictures=pictures, force=force, **options,
    )
    if output is not None:
        return Inference(Path(output), json.loads(_foveate.infer(network, inputs, camera, output, **choices)))
    temporary = Path(tempfile.mkdtemp(prefix="foveate-"))
    try:
        summary = _foveate.infer(network, inputs, camera, temporary / "inference", **choices)
    except BaseException:
        shutil.rmtree(temporary)
        raise
    inference = Inference(temporary / "inference", json.loads(summary))
    weakref.finalize(inference, shutil.rmtree, temporary, ignore_errors=True)
    return inference
