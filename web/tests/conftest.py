# SPDX-License-Identifier: MIT OR Apache-2.0
"""A page in Chromium that has loaded the engine, and the native program beside it.

Nothing is served: the browser's requests to http://localhost/ are answered from the folder web/, all others are refused.
The camera of the browser is a file whose pictures carry their number (camera_clip.py).
"""

import os
import shutil
from pathlib import Path

import camera_clip
import pytest
from native import Program
from playwright.sync_api import sync_playwright

WEB = Path(__file__).resolve().parent.parent
PAGE = "http://localhost/"
START = """<!doctype html><meta charset="utf-8"><title>test</title><script type="module">
import { Engine } from "./engine.js";
const answer = await fetch("./foveate.wasm");
window.engine = await Engine.load(await answer.arrayBuffer());
window.Engine = Engine;
</script>"""


@pytest.fixture(scope="session")
def native(tmp_path_factory):
    """The installed program."""
    return Program(os.environ["FOVEATE"], tmp_path_factory)


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    """Chromium with a camera that plays the clip of camera_clip.py."""
    clip = tmp_path_factory.mktemp("camera") / "clip.y4m"
    camera_clip.write(clip)
    names = ["chromium", "chromium-browser", "google-chrome", "chrome"]
    chromium = next(filter(None, map(shutil.which, names)), None)
    assert chromium, "no Chromium in PATH; on Debian: apt-get install chromium"
    flags = [
        "--no-sandbox",
        "--disable-gpu",
        "--use-fake-ui-for-media-stream",
        "--use-fake-device-for-media-stream",
        f"--use-file-for-fake-video-capture={clip}",
    ]
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=flags)
        yield browser
        browser.close()


def answer(route):
    """Answers a request from the folder of the page."""
    path = route.request.url.removeprefix(PAGE).split("?")[0].split("#")[0]
    if path == "start.html":
        route.fulfill(body=START, content_type="text/html")
        return
    file = WEB / path
    types = {".js": "text/javascript", ".wasm": "application/wasm", ".html": "text/html", ".css": "text/css"}
    if route.request.url.startswith(PAGE) and file.is_file() and file.suffix in types:
        route.fulfill(body=file.read_bytes(), content_type=types[file.suffix])
    else:
        route.abort()


@pytest.fixture
def page(browser):
    """A page that has loaded the engine; `run` of page.js shows a camera frames."""
    # Cameras are for secure contexts, and the own name of this machine is one.
    context = browser.new_context()
    context.route("**/*", answer)
    page = context.new_page()
    page.goto(PAGE + "start.html")
    page.wait_for_function("window.engine !== undefined")
    page.add_script_tag(path=Path(__file__).with_name("page.js"))
    yield page
    context.close()
