# SPDX-License-Identifier: MIT OR Apache-2.0
"""The source distribution has every file that is needed to build it; scripts/artefacts.sh --try builds it."""
import re
import subprocess
import sys
import tarfile
from pathlib import Path

import tomllib

from conftest import ROOT


def embedded():
    """Files outside of a crate that its code or its templates take in, relative to the project."""
    for crate in [*(ROOT / "crates").iterdir(), ROOT / "python"]:
        for source in (crate / "src").rglob("*.rs"):
            text = source.read_text().split("#[cfg(test)]")[0]
            for path in re.findall(r'include_(?:str|bytes)!\(\s*(?:concat!\()?"([^"]+)"', text):
                found = (source.parent / path).resolve()
                # Part of a name, which a macro completes.
                yield from found.glob("*.v") if path.endswith("/") else [found]
        settings = crate / "askama.toml"
        if settings.is_file():
            for folder in tomllib.loads(settings.read_text())["general"]["dirs"]:
                yield from (path for path in (crate / folder).resolve().rglob("*") if path.is_file())


def test_the_source_distribution_is_whole(tmp_path):
    maturin = Path(sys.executable).with_name("maturin")
    subprocess.run([maturin, "sdist", "--out", tmp_path], cwd=ROOT, check=True, capture_output=True)
    (archive,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(archive) as held:
        names = {name.split("/", 1)[1] for name in held.getnames() if "/" in name}
    wanted = {str(path.relative_to(ROOT)) for path in embedded()}
    assert len(wanted) > 50 and "tb/harness.cpp" in wanted and "rtl/median3x3.v" in wanted
    assert not wanted - names
    assert {"Cargo.lock", "pyproject.toml", "python/foveate/torch.py", "LICENSE-MIT"} <= names
