# SPDX-License-Identifier: MIT OR Apache-2.0
"""Designs, cameras and outcomes as HTML for notebooks."""
from __future__ import annotations

from base64 import b64encode
from html import escape
from typing import TYPE_CHECKING

from foveate._foveate import decisions_png, grey_png

if TYPE_CHECKING:
    from foveate import Design, Outcome

#: The largest width of a picture in CSS pixels.
_WIDTH = 360


def design_card(design: Design) -> str:
    """Make the table of a design, as HTML."""
    rows: list[tuple[str, str]] = [
        ("frame", f"{design.width} x {design.height} pixels of {design.pixel_bits} bits"),
        ("regions", f"{design.columns} x {design.rows} = {design.regions}, of {design.region_size} x {design.region_size} pixels"),
        ("features", " + ".join(design.features)),
        ("organization", f"{design.organization}, {design.cycles_per_frame:,} clocks per frame"),
        ("fingerprint", design.fingerprint),
    ]
    body = "".join(f"<tr><th style='text-align:left'>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in rows)
    return f"<table><caption>foveate design</caption>{body}</table>"


def outcome_card(outcome: Outcome) -> str:
    """Make the pictures of an outcome, as HTML: the rendered frame, and the decisions in the colours of `overlay(outlines=True)`."""
    design = outcome.design
    width = min(_WIDTH, max(design.width, _WIDTH // 2))
    pictures = []
    if outcome.frame is not None:
        pictures.append(("frame", grey_png(outcome.frame, design.pixel_bits)))
    try:
        pictures.append(("rendered", grey_png(outcome.rendered, design.pixel_bits)))
    except RuntimeError:
        # The camera has taken another frame, so that only the decisions are left.
        pass
    pictures.append(("active green, SRS alone orange, TRS alone blue", decisions_png(outcome)))
    figures = "".join(
        f"<figure style='display:inline-block;vertical-align:top;margin:4px;width:{width}px'><img alt='{escape(name)}' width='{width}'"
        f" style='image-rendering:pixelated' src='data:image/png;base64,{b64encode(png).decode()}'>"
        f"<figcaption>{escape(name)}</figcaption></figure>"
        for name, png in pictures
    )
    return f"<div>{escape(repr(outcome)[1:-1])}<br>{figures}</div>"
