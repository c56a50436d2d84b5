# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs the documents as a reader pastes them: the commands and blocks of Python of a page, whose output must be that of the page."""
