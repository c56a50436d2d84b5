# SPDX-License-Identifier: MIT OR Apache-2.0
"""What the command line does beside simulating, as functions."""
from __future__ import annotations

import json
import os
import shutil
import tempfile
import weakref
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Union

from foveate import _foveate
from foveate._results import Estimate, Explanation, Fidelity, Inference

PathLike = Union[str, "os.PathLike[str]"]
Inputs = Union[PathLike, Sequence[PathLike]]


def explain(inputs: Inputs, camera: Any = None, *, frame: int = 0, region: tuple[int, int] = (0, 0), **options: Any) -> Explanation:
    """Explain why a region of a frame was sent or dropped.

    Parameters
    ----------
    inputs : path, pattern, "scene:NAME" or a list of these
        Footage, as of ``simulate``.
    camera : Camera, Design, preset, file or dict, optional
        The camera. What it has seen does not matter: the frames before run through one of its own.
    frame : int, default 0
        Number of the frame.
    region : (int, int), default (0, 0)
        Column and row of the region.
    **options
        How inputs are read, see ``simulate``.

    Returns
    -------
    Explanation
        A dict; ``print`` shows it as text.

    Raises
    ------
    IndexError
        If there is no such frame or region.
    """
    values, text = _foveate.explain(inputs, camera, frame=frame, region=region, **options)
    return Explanation(json.loads(values), text)


def fidelity(inputs: Inputs, camera: Any = None, *, ideal: Any = None, **options: Any) -> Fidelity:
    """Measure the errors of a design against the ideal camera, which computes in real numbers over whole frames.

    Parameters
    ----------
    inputs : path, pattern, "scene:NAME" or a list of these
        Footage, as of ``simulate``.
    camera : Camera, Design, preset, file or dict, optional
        The design to judge.
    ideal : Camera, Design, preset, file or dict, optional
        The task. By default that of ``camera`` itself, so that only its rounding and its windows are judged.
    **options
        How inputs are read, see ``simulate``.

    Returns
    -------
    Fidelity
        A dict: ``srs_flips``, ``trs_flips``, ``missed``, ``false_alarms`` (shares of the area), ``psnr_ideal`` in dB (None if
        identical), ``ssim_ideal``, ``scores``, ``staleness`` and more.
    """
    values, problem = _foveate.fidelity(inputs, camera, ideal=ideal, **options)
    return Fidelity(json.loads(values), problem)


def generate(camera: Any, folder: PathLike, *, force: bool = False, prefix: str | None = None) -> list[Path]:
    """Write the Verilog of a design, with file lists, constraints, benches and a README.

    Parameters
    ----------
    camera : Camera, Design, preset, file or dict
        The design.
    folder : path
        The folder to write. It appears when it is complete.
    force : bool, default False
        Replace the folder if it holds a generated core.
    prefix : str, optional
        What the names of all modules begin with, before a ``_``, so that several cores fit into one chip. With
        ``"auto"`` it is made from the fingerprint of the design.

    Returns
    -------
    list of pathlib.Path
        The files.

    Raises
    ------
    ValueError
        If names of modules cannot begin with the prefix.
    FileExistsError
        If the folder holds something.
    """
    return [Path(folder) / name for name in _foveate.generate(camera, folder, force, prefix)]


def estimate(camera: Any) -> Estimate:
    """Synthesize a design with Yosys, and count LUTs, registers, memories and logic levels.

    Parameters
    ----------
    camera : Camera, Design, preset, file or dict
        The design. A second estimate of the same design comes from a cache.

    Returns
    -------
    Estimate
        A dict; ``print`` shows it beside the paper's table.

    Raises
    ------
    ToolError
        If Yosys is missing or fails.
    """
    values, text = _foveate.estimate(camera)
    return Estimate(json.loads(values), text)


def infer(network: PathLike, inputs: Any, camera: Any = None, output: PathLike | None = None, **options: Any) -> Inference:
    """Run a network on what a camera sends, and count what its masks save.

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
        The folder to write; by default one that lives as long as the result.
    **options
        ``mode`` ("dense", "exact", "compare", "truncate=T" or "fixed"; default "exact"), ``tune`` (such as "variation=10%"),
        ``reference`` (bool), ``accelerator`` (name or file), ``mean`` and ``scale`` (a number, or one for each channel),
        ``framing`` ("same", "letterbox", "letterbox=416x416", "stretch", "stretch=416x416"; default "same"),
        ``whole_frames`` (bool: the network runs on the frames before the camera, too), ``detect`` (such as "yolox,score=0.3"),
        ``boxes`` (path or list of paths of ground-truth boxes), ``pictures`` (bool), ``force`` (bool), and how inputs are read,
        see ``simulate``.

    Returns
    -------
    Inference
        Its ``summary``, ``outputs`` and tables.

    Raises
    ------
    TypeError
        If there is no such option, or ``inputs`` are neither footage nor frames.
    FileNotFoundError, ValueError
        If the network or an input cannot be read, or they do not go together.
    """
    if output is not None:
        return Inference(Path(output), json.loads(_foveate.infer(network, inputs, camera, output, **options)))
    temporary = Path(tempfile.mkdtemp(prefix="foveate-"))
    try:
        summary = _foveate.infer(network, inputs, camera, temporary / "inference", **options)
    except BaseException:
        shutil.rmtree(temporary)
        raise
    found = Inference(temporary / "inference", json.loads(summary))
    weakref.finalize(found, shutil.rmtree, temporary, ignore_errors=True)
    return found
