#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Runs the notebooks of python/notebooks and writes their output into them. Their tests compare this output.
set -euo pipefail
cd "$(dirname "$0")/.."
tools=$(scripts/python.sh --torch)
"$tools/python" - python/notebooks/*.ipynb <<'PYTHON'
import sys
import tempfile

import nbclient
import nbformat

for path in sys.argv[1:]:
    notebook = nbformat.read(path, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": folder}}).execute()
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)
    nbformat.write(notebook, path)
    print(path)
PYTHON
