# SPDX-License-Identifier: MIT OR Apache-2.0
"""`foveate live` and its page together: settings and frames of the command are those of the page, to the byte."""

import os
import subprocess
from pathlib import Path

import onnx
import pytest
from waiting import until

pytest_plugins = ["pages"]

FOVEATE = os.environ.get("FOVEATE", "foveate")
DESIGN = ["--preset", "fovea", "--set", "region.size=4", "--set", "spatial.0.level=40"]


@pytest.fixture
def served(visit, chromium, tmp_path):
    """Opens the page of `foveate live` on a clip that no browser decodes."""
    clip = tmp_path / "clip.y4m"
    source = ["-f", "lavfi", "-i", "testsrc=size=100x60:rate=20:duration=0.6"]
    subprocess.run(["ffmpeg", "-v", "error", *source, "-pix_fmt", "yuv420p", clip], check=True)
    with subprocess.Popen([FOVEATE, "live", clip, *DESIGN], stdout=subprocess.PIPE, text=True) as live:
        link = live.stdout.readline().strip()
        yield lambda **options: (visit(chromium, link, **options), clip)
        live.terminate()
        assert live.wait(10) == 143


def test_a_clip_is_what_simulate_makes_of_it(served):
    page, clip = served(reduced_motion="reduce")
    until(page, "foveate.sums.frames === 1")
    assert page.evaluate("[foveate.camera.facts.width, foveate.camera.facts.height]") == [100, 60]
    page.click("#record")
    page.click("#reset")
    until(page, "foveate.sums.frames === 1")
    for number in range(2, 8):
        page.click("#step")
        until(page, "number => foveate.sums.frames === number", number)
    page.click("#record")
    with page.expect_download() as waiting:
        page.click("#download")
    ours = Path(waiting.value.path()).read_text().splitlines()
    out = Path(page.folder) / "out"
    subprocess.run([FOVEATE, "simulate", clip, "-o", out, *DESIGN, "--events", "csv", "--quiet"], check=True)
    theirs = (out / "events.csv").read_text().splitlines()
    assert ours == theirs[: 1 + 7 * 25 * 15]


def test_a_clip_has_its_own_times_and_an_end(served):
    page, _ = served()
    until(page, "document.getElementById('source-status').textContent.includes('the clip has ended')")
    assert page.locator("#notice").is_hidden()
    assert page.evaluate("foveate.sums.frames") == 12
    # Slowly, and begun again: 12 frames of 50 ms take 6 s at a tenth.
    page.locator("#speed").select_option("0.1")
    page.click("#reset")
    until(page, "foveate.sums.frames === 1")
    start_ms = page.evaluate("performance.now()")
    page.wait_for_timeout(1200)
    frames, end_ms = page.evaluate("[foveate.sums.frames, performance.now()]")
    assert 2 <= frames <= 1 + 4 * (end_ms - start_ms) / 1200


def test_a_second_page_takes_the_input_and_the_first_says_so(served):
    first, _ = served(reduced_motion="reduce")
    until(first, "foveate.sums.frames === 1")
    second = first.context.new_page()
    second.goto(first.url.split("#")[0])
    until(second, "window.foveate?.sums.frames === 1")
    first.click("#step")
    until(first, "document.getElementById('notice').textContent.includes('another page shows this input now')")
    second.click("#step")
    until(second, "foveate.sums.frames === 2")
    first.click("#reset")
    until(first, "foveate.sums.frames === 1")
    assert first.locator("#notice").is_hidden()
    second.close()


def test_the_secret_of_the_link_leaves_the_page_by_nothing_that_it_gives(served):
    page, _ = served(reduced_motion="reduce")
    until(page, "foveate.sums.frames === 1")
    told = []
    page.on("console", lambda line: told.append(line.text))
    secret = page.url.split("/")[3]
    assert len(secret) == 32
    (folder := Path(page.folder)).mkdir(exist_ok=True)
    (folder / "squares.onnx").write_bytes(onnx.squares())
    page.set_input_files("#network-file", folder / "squares.onnx")
    until(page, "!document.getElementById('copy-command').disabled", timeout=20)
    page.click("#record")
    page.click("#step")
    until(page, "foveate.sums.frames === 2")
    given = []
    for button, said in [("#copy-link", "copied"), ("#copy-toml", "copied"), ("#copy-command", "copied-command")]:
        page.click(button)
        until(page, "id => document.getElementById(id).textContent.includes('clipboard')", said)
        given.append(page.evaluate("navigator.clipboard.readText()"))
    # Where the browser gives no clipboard, the page shows the text.
    page.evaluate("() => { navigator.clipboard.writeText = () => Promise.reject(); document.execCommand = () => false; }")
    page.click("#copy-link")
    until(page, "document.getElementById('copied').textContent.includes('refuses')")
    with page.expect_download() as waiting:
        page.click("#download")
    given += [Path(waiting.value.path()).read_text(), waiting.value.suggested_filename, page.title(), page.content(), *told]
    assert given[0].startswith("#source=computer&")
    assert not any(secret in text for text in given)
    assert page.evaluate("document.referrer") == ""


def test_a_network_runs_on_the_page_that_is_served(served):
    page, _ = served(reduced_motion="reduce")
    until(page, "foveate.sums.frames === 1")
    (folder := Path(page.folder)).mkdir(exist_ok=True)
    (folder / "squares.onnx").write_bytes(onnx.squares())
    page.set_input_files("#network-file", folder / "squares.onnx")
    until(page, "foveate.network.result?.whole.length > 0", timeout=20)
    assert page.locator("#network-refused").is_hidden()
