# SPDX-License-Identifier: MIT OR Apache-2.0
"""Fixtures of test_page.py: the page in Chromium, as a file or from a server, with and without a camera."""

import base64
import io
import json
import os
import shutil
import struct
import subprocess
import threading
import time
import urllib.parse
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest
from PIL import Image
from waiting import until

# Python's digits of base 85, and those of the page (crates/boards/src/view/frame_player.rs).
PYTHON_DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%&()*+-;<=>?@^_`{|}~"
PAGE_DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%()*+-.:;=?@[]^_{|}~"
CHROMIUMS = ("chromium", "chromium-browser", "google-chrome", "chrome")


@pytest.fixture(scope="session")
def page_file(tmp_path_factory):
    """The page as one file, as the program writes it."""
    path = tmp_path_factory.mktemp("page") / "page.html"
    subprocess.run([os.environ["FOVEATE"], "live", "--page", path], check=True)
    return path


@pytest.fixture(scope="session")
def chromium(browser):
    """Chromium without a camera; `browser` of conftest.py has one."""
    made = browser.browser_type.launch(executable_path=next(filter(None, map(shutil.which, CHROMIUMS))), args=["--no-sandbox", "--disable-gpu"])
    yield made
    made.close()


@pytest.fixture
def visit(tmp_path):
    """Opens an address in a browser; what a page throws or its policy refuses fails the test."""
    contexts, wrong = [], []

    def visit(browser, address, ready="!!window.foveate", permissions=(), before="", folded=False, **options):
        context = browser.new_context(**{"viewport": {"width": 1280, "height": 800}, **options})
        context.set_default_timeout(20000)
        contexts.append(context)
        context.grant_permissions(["clipboard-read", "clipboard-write", *permissions])
        # A script that runs before those of the page.
        context.add_init_script(before)
        page = context.new_page()
        page.folder = str(tmp_path)
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("console", lambda told: wrong.append(told.text) if "Content Security Policy" in told.text else None)
        page.goto(address)
        until(page, ready)
        if not folded:
            page.evaluate("for (const one of document.querySelectorAll('#all-settings')) one.open = true")
        return page

    yield visit
    for context in contexts:
        context.close()
    assert wrong == []


@pytest.fixture
def opened(visit, chromium, page_file):
    """Opens the page with a fragment."""
    return lambda fragment, **options: visit(chromium, page_file.as_uri() + fragment, **options)


@pytest.fixture
def still(opened):
    """Opens the page, which stands still at its first frame."""

    def still(fragment, **options):
        page = opened(fragment, reduced_motion="reduce", **options)
        until(page, "foveate.sums.frames >= 1")
        return page

    return still


@pytest.fixture
def picture():
    """A PNG in colour; with another `base` it is brighter."""

    def picture(width, height, base=0):
        pixels = bytes((base * 9 + value) % 256 for y in range(height) for x in range(width) for value in (x * 3 % 90, y * 5 % 90, x * y % 90))
        file = io.BytesIO()
        Image.frombytes("RGB", (width, height), pixels).save(file, "png")
        return file.getvalue()

    return picture


@pytest.fixture
def camera(visit, browser, page_file):
    """Opens the page in a browser with a camera."""
    return lambda fragment: visit(browser, page_file.as_uri() + fragment, permissions=["camera"])


@pytest.fixture
def broken(visit, chromium, page_file, tmp_path):
    """Opens the page with these bytes, or this text, in place of the compressed engine."""

    def broken(data):
        text = data if isinstance(data, str) else base64.b85encode(data).decode().translate(str.maketrans(PYTHON_DIGITS, PAGE_DIGITS))
        before, rest = page_file.read_text().split('id="wasm">', 1)
        after = rest.split("</script>", 1)[1]
        path = tmp_path / "broken.html"
        path.write_text(f'{before}id="wasm">{text}</script>{after}')
        return visit(chromium, path.as_uri(), ready="!document.getElementById('notice').hidden")

    return broken


class Frames(BaseHTTPRequestHandler):
    """Serves the page and three frames, as `foveate live` does."""

    def log_message(self, *_):
        self.server.log.append(f"{self.command} {self.path}")

    def answer(self, kind, data):
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        self.wfile.write(data)

    def do_GET(self):
        where = urllib.parse.urlsplit(self.path)
        if where.path == "/":
            return self.answer("text/html", self.server.page)
        number = int(urllib.parse.parse_qs(where.query)["after"][0]) + 1
        head, pixels = {"status": "running", "text": ""}, b""
        if number < 3:
            head.update(number=number, t_us=number * 33333, width=48, height=32)
            pixels = bytes((x * y + number * 20) % 256 for y in range(32) for x in range(48))
        else:
            time.sleep(0.1)
            head.update(status="ended", text=self.server.end)
        text = json.dumps(head).encode()
        return self.answer("application/octet-stream", struct.pack("<I", len(text)) + text + pixels)

    def do_POST(self):
        self.answer("text/plain", b"")


@pytest.fixture
def server(visit, chromium, page_file):
    """The page from a server with frames, and the server, which has a log of requests and a text for the end."""
    served = ThreadingHTTPServer(("127.0.0.1", 0), Frames)
    served.log, served.end = [], "the clip has ended"
    served.page = page_file.read_text().replace('<html lang="en">', '<html lang="en" data-frames="frames">').encode()
    threading.Thread(target=served.serve_forever, daemon=True).start()
    yield visit(chromium, f"http://127.0.0.1:{served.server_port}/"), served
    served.shutdown()
    served.server_close()
