# SPDX-License-Identifier: MIT OR Apache-2.0
"""The options that several functions take, by name. A function takes a group as keyword arguments, and help shows each of them."""
from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, TypedDict, TypeVar, Union, cast

PathLike = Union[str, "os.PathLike[str]"]
Number = Union[int, float, str]
Section = Mapping[str, Any]
_Function = TypeVar("_Function", bound=Callable[..., Any])


class InputOptions(TypedDict, total=False):
    """How inputs are read; ``simulate`` describes these options. None is the default of each."""

    max_frames: int | None
    input_fps: Number | None
    rate: Number | None
    start: Number | None
    end: Number | None
    crop: tuple[int, int, int, int] | None
    resize: tuple[int, int] | None
    luma: Literal["coded", "full"] | None
    orientation: Literal["stored", "upright"] | None
    video_stream: int | None
    raw: str | None
    bayer: Literal["rggb", "bggr", "grbg", "gbrg"] | None
    timestamps: PathLike | None
    timestamp_unit: Literal["s", "ms", "us", "ns"] | None
    images: Literal["clip", "set", "cifar-sheet"] | None
    labels: PathLike | None


class Sections(TypedDict, total=False):
    """The tables of a configuration whose keys a camera or a design changes. None changes nothing."""

    frame: Section | None
    region: Section | None
    denoise: Section | None
    spatial: str | Section | Sequence[str | Section] | None
    decision: Section | None
    temporal: Section | None
    render: Section | None
    periphery: Section | None
    zones: Section | None
    hardware: Section | None


def takes_inputs(function: _Function) -> _Function:
    """Give a function with ``**options`` the signature that names every option of inputs."""
    own = inspect.signature(function)
    given = [one for one in own.parameters.values() if one.kind is not one.VAR_KEYWORD]
    types = {name: getattr(kind, "__forward_arg__", kind) for name, kind in InputOptions.__annotations__.items()}
    options = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=kind) for name, kind in types.items()]
    cast(Any, function).__signature__ = own.replace(parameters=[*given, *options])
    return function
