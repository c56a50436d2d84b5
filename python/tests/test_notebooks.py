# SPDX-License-Identifier: MIT OR Apache-2.0
"""The notebooks run from an empty kernel, and contain the output that they print."""
import os

import nbclient
import nbformat
import pytest

from conftest import ROOT

NOTEBOOKS = sorted((ROOT / "python/notebooks").glob("*.ipynb"))


def texts(notebook):
    """Returns the printed output of a notebook by cell, without its pictures, which depend on the version of matplotlib."""
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    # One output may come in several pieces.
    return ["".join(output.text for output in cell.outputs if output.output_type == "stream") for cell in cells]


def test_there_are_notebooks():
    assert [path.stem for path in NOTEBOOKS] == ["regions", "thresholds", "training"]


# Most runs take one notebook. The one about training needs PyTorch, and longer than everything else here: with FOVEATE_WHOLE, as
# scripts/release.sh sets it.
RUN = [path for path in NOTEBOOKS if path.stem == "thresholds" or "FOVEATE_WHOLE" in os.environ]


@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::RuntimeWarning")
@pytest.mark.parametrize("path", RUN, ids=lambda path: path.stem)
def test_a_notebook_runs(path, tmp_path):
    written = nbformat.read(path, as_version=4)
    run = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(run, timeout=300, kernel_name="python3", resources={"metadata": {"path": tmp_path}}).execute()
    # The accuracies of trained networks differ in their last digits from one processor to another.
    if path.stem != "training":
        assert texts(run) == texts(written)
    cells = [cell for cell in run.cells if cell.cell_type == "code"]
    assert any(output.get("data", {}).get("image/png") for cell in cells for output in cell.outputs)
