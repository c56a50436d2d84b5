# SPDX-License-Identifier: MIT OR Apache-2.0
"""If a package of an extra is missing, one line says what to install."""
from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest


def run_without(package: str, code: str) -> subprocess.CompletedProcess[str]:
    """Runs code in an interpreter that does not find some packages."""
    code = f"import sys; sys.modules[{package!r}] = None\n{code}"
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)


def error_text(user: str, package: str, extra: str) -> str:
    return f"{user} needs {package}, which is not installed: pip install {package}, or in a clone of the sources pip install '.[{extra}]'"


@pytest.mark.parametrize("module", ["accuracy", "savings", "runs", "models", "training", "tables", "plots"])
def test_a_study_without_torch(module: str) -> None:
    result = run_without("torch", f"import foveate.studies.{module}")
    assert result.stderr.splitlines()[-1] == "ImportError: " + error_text("foveate.studies", "torch", "studies")
    assert result.stderr.count("Traceback") == 1


def test_data_sets_without_torch() -> None:
    result = run_without("torch", "import foveate.torch")
    assert result.stderr.splitlines()[-1] == "ImportError: " + error_text("foveate.torch", "torch", "torch")
    assert result.stderr.count("Traceback") == 1


@pytest.mark.parametrize(("package", "name", "arguments"), [
    ("torch", "torch", ["accuracy"]),
    ("matplotlib", "matplotlib", ["accuracy"]),
    ("onnx", "onnx", ["savings"]),
    ("torchvision", "torchvision", ["accuracy", "--model", "resnet18"]),
    ("PIL", "pillow", ["accuracy", "--sets", "pictures"]),
])
def test_the_command_says_so_before_it_begins(package: str, name: str, arguments: list[str], tmp_path: Path) -> None:
    arguments = [*arguments, "-o", str(tmp_path / "out"), "--data", str(tmp_path)]
    # Other packages may be missing, too: none is imported before the check.
    patch = "import importlib.util as util, importlib.machinery as machinery\nfound = util.find_spec\nimport foveate._extras as extras\n" \
        f"extras.find_spec = lambda name: found(name) if name == {package!r} else machinery.ModuleSpec(name, None)\n"
    result = run_without(package, f"{patch}from foveate.studies.__main__ import main\nsys.exit(main({arguments!r}))")
    assert (result.returncode, result.stderr) == (1, f"error: {error_text('foveate.studies', name, 'studies')}\n")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("kind", ["pandas", "pyarrow"])
def test_tables(kind: str) -> None:
    result = run_without(kind, f"import foveate as fv\nfv.events(fv.simulate('scene:street', max_frames=1), kind={kind!r})")
    assert result.stderr.splitlines()[-1] == "ImportError: " + error_text(f"kind = '{kind}'", kind, "tables")


def test_help_needs_nothing() -> None:
    result = run_without("torch", "from foveate.studies.__main__ import main\nmain(['--help'])")
    assert result.returncode == 0 and "accuracy" in result.stdout
