#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Makes the pictures of the live page that the book shows: docs/images/live-*.png. Chromium opens the page, and its own keys and
controls are used. `scripts/python_tools.sh --browser` prints the folder of a Python with what this needs.

    scripts/figures/web_pictures.py PAGE         of this file; `foveate live --page PAGE` writes it
"""

import io
import shutil
import sys
import time
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

IMAGES = Path(__file__).parents[2] / "docs/images"
# The page has few colours, and greys.
COLOURS = 160


def save_phone(browser, address):
    """Takes a picture of the page on a phone, in both schemes side by side."""
    pictures = []
    for scheme in ("light", "dark"):
        page = open_page(browser, address, scheme, {"width": 390, "height": 844})
        step_frames(page, 60)
        page.evaluate("scrollTo(0, 0)")
        pictures.append(Image.open(io.BytesIO(page.screenshot())))
        page.close()
    both = Image.new("RGB", (2 * 390 + 20, 844), "#808080")
    for place, picture in enumerate(pictures):
        both.paste(picture, (place * 410, 0))
    data = io.BytesIO()
    both.save(data, "png")
    save("live-phone.png", data.getvalue())


def open_page(browser, address, scheme, size):
    """Opens the page, which stands still at its first frame."""
    page = browser.new_page(viewport=size, color_scheme=scheme, reduced_motion="reduce")
    page.goto(address)
    while not page.evaluate("window.foveate?.sums.frames > 0"):
        time.sleep(0.01)
    return page


def step_frames(page, count):
    """Steps a number of frames."""
    for number in range(count):
        page.click("#step")
        while page.evaluate("foveate.sums.frames") < number + 2:
            time.sleep(0.01)
    time.sleep(0.3)


def save(name, data):
    """Writes a small PNG."""
    picture = Image.open(io.BytesIO(data)).convert("RGB").quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE, kmeans=1, dither=Image.Dither.NONE)
    picture.save(IMAGES / name, optimize=True)
    print(f"docs/images/{name}: {(IMAGES / name).stat().st_size} bytes")


def save_overview(page):
    """Takes a picture of the three screens and the controls."""
    step_frames(page, 60)
    save("live.png", page.screenshot())


def save_large_regions(page):
    """Takes a picture with larger regions, which change the screen and the bytes."""
    page.fill("[data-key='region.size'] input[type=number]", "32")
    page.keyboard.press("Tab")
    step_frames(page, 60)
    page.focus("[data-key='region.size'] input[type=range]")
    page.evaluate("scrollTo(0, 0)")
    save("live-regions.png", page.screenshot())


def save_explanation(page):
    """Takes a picture of the explanation of a sent region."""
    step_frames(page, 60)
    active = page.evaluate("[...foveate.camera.regions].flatMap((byte, region) => byte === 3 ? [region] : [])")
    columns = page.evaluate("foveate.camera.facts.columns")
    row, column = divmod(active[len(active) * 2 // 3], columns)
    box = page.locator("#decisions").bounding_box()
    side = box["width"] / columns
    page.mouse.click(box["x"] + (column + 0.5) * side, box["y"] + (row + 0.5) * side)
    time.sleep(0.3)
    page.set_viewport_size({"width": 1280, "height": 1800})
    box = page.locator("#why").bounding_box()
    save("live-region.png", page.screenshot(clip={"x": box["x"] - 16, "y": box["y"] - 16, "width": box["width"] + 32, "height": box["height"] + 32}))


def main():
    address = Path(sys.argv[1]).resolve().as_uri()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox", "--disable-gpu"])
        for make, fragment, scheme in ((save_overview, "", "light"), (save_large_regions, "", "dark"), (save_explanation, "#preset=paper", "light")):
            page = open_page(browser, address + fragment, scheme, {"width": 1280, "height": 800})
            make(page)
            page.close()
        save_phone(browser, address)
        browser.close()


if __name__ == "__main__":
    main()
