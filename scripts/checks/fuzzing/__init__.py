# SPDX-License-Identifier: MIT OR Apache-2.0
"""The parts of scripts/checks/fuzz.py: readers and their samples, mutations, and the judgement of answers."""
