# SPDX-License-Identifier: MIT OR Apache-2.0
"""If a package of an extra is missing, one line says what to install."""
from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest


def without(package: str, code: str) -> subprocess.CompletedProcess[str]:
    """Runs code in an interpreter that does not find some packages."""
    code = f"import sys; sys.modules[{package!r}] = None\n{code}"
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)


def says(user: str, package: str, extra: str) -> str:
    return f"{user} needs {package}, which is not installed: pip install {package}, or in a clone of the sources pip install '.[{extra}]'"


@pytest.mark.parametrize("module", ["accuracy", "savings", "runs", "models", "training", "tables", "plots"])
def test_a_study_without_torch(module: str) -> None:
    ended = without("torch", f"import foveate.studies.{module}")
    assert ended.stderr.splitlines()[-1] == "ImportError: " + says("foveate.studies", "torch", "studies")
    assert ended.stderr.count("Traceback") == 1


def test_data_sets_without_torch() -> None:
    ended = without("torch", "import foveate.torch")
    assert ended.stderr.splitlines()[-1] == "ImportError: " + says("foveate.torch", "torch", "torch")
    assert ended.stderr.count("Traceback") == 1


@pytest.mark.parametrize(("package", "name", "words"), [
    ("torch", "torch", ["accuracy"]),
    ("matplotlib", "matplotlib", ["accuracy"]),
    ("onnx", "onnx", ["savings"]),
    ("torchvision", "torchvision", ["accuracy", "--model", "resnet18"]),
    ("PIL", "pillow", ["accuracy", "--sets", "pictures"]),
])
def test_the_command_says_so_before_it_begins(package: str, name: str, words: list[str], tmp_path: Path) -> None:
    words = [*words, "-o", str(tmp_path / "out"), "--data", str(tmp_path)]
    # Other packages may be missing, too: none is imported before the check.
    known = "import importlib.util as util, importlib.machinery as machinery\nfound = util.find_spec\nimport foveate._extras as extras\n" \
        f"extras.find_spec = lambda name: found(name) if name == {package!r} else machinery.ModuleSpec(name, None)\n"
    ended = without(package, f"{known}from foveate.studies.__main__ import main\nsys.exit(main({words!r}))")
    assert (ended.returncode, ended.stderr) == (1, f"error: {says('foveate.studies', name, 'studies')}\n")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("kind", ["pandas", "pyarrow"])
def test_tables(kind: str) -> None:
    ended = without(kind, f"import foveate as fv\nfv.events(fv.simulate('scene:street', max_frames=1), kind={kind!r})")
    assert ended.stderr.splitlines()[-1] == "ImportError: " + says(f"kind = '{kind}'", kind, "tables")


def test_help_needs_nothing() -> None:
    ended = without("torch", "from foveate.studies.__main__ import main\nmain(['--help'])")
    assert ended.returncode == 0 and "accuracy" in ended.stdout
