# SPDX-License-Identifier: MIT OR Apache-2.0
"""Waits for a page that compiles no text, because its policy forbids it."""

import time


def eventually(holds, fault, timeout=20):
    """Waits until `holds()` is true, at most `timeout` seconds; `fault()` is the text of the error."""
    end = time.monotonic() + timeout
    while not holds():
        assert time.monotonic() < end, f"after {timeout} s not yet: {fault()}"
        time.sleep(0.005)


def until(page, expression, arg=None, timeout=20):
    """Waits until an expression holds. Playwright's own way compiles text in the page, which its policy forbids."""
    eventually(lambda: page.evaluate(expression, arg), lambda: f"{expression}; the page says {page.inner_text('#notice')!r}", timeout)
