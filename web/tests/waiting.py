# SPDX-License-Identifier: MIT OR Apache-2.0
"""Waits for a page that compiles no text, because its policy forbids it."""

import time


def until(page, expression, arg=None, timeout=8):
    """Waits until an expression holds. Playwright's own way compiles text in the page, which its policy forbids."""
    end = time.monotonic() + timeout
    while not page.evaluate(expression, arg):
        assert time.monotonic() < end, f"after {timeout} s not yet: {expression}; the page says {page.inner_text('#notice')!r}"
        time.sleep(0.005)
