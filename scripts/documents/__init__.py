# SPDX-License-Identifier: MIT OR Apache-2.0
"""The documents as a reader pastes them: commands and blocks of Python of a page, and whether they print what the page shows."""
