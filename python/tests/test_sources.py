# SPDX-License-Identifier: MIT OR Apache-2.0
"""The source distribution has every file that its build needs; scripts/artefacts.sh --try builds it."""
import os
import re
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest
import tomllib

from conftest import ROOT


def embedded():
    """Yields the files that a crate's code or its templates include. Links are not followed: a package has a file in place of each."""
    for crate in [*(ROOT / "crates").iterdir(), ROOT / "python"]:
        for source in (crate / "src").rglob("*.rs"):
            text = source.read_text().split("#[cfg(test)]")[0]
            for path in re.findall(r'include_(?:str|bytes)!\(\s*(?:concat!\()?"([^"]+)"', text):
                found = Path(os.path.normpath(source.parent / path))
                # This is a part of a name, which a macro completes.
                yield from found.glob("*.v") if path.endswith("/") else [found]
        settings = crate / "askama.toml"
        if settings.is_file():
            excluded = tomllib.loads((crate / "Cargo.toml").read_text())["package"]["exclude"]
            # A table where it is that of the workspace: folders without templates.
            outside = tuple(str(crate) + folder for folder in excluded if isinstance(excluded, list))
            for folder in tomllib.loads(settings.read_text())["general"]["dirs"]:
                files = (path for path in (crate / folder).rglob("*") if path.is_file())
                yield from (path for path in files if not str(path).startswith(outside))


@pytest.mark.skipif("FOVEATE_WHOLE" not in os.environ, reason="it packs all sources; scripts/release.sh python runs it")
def test_the_source_distribution_is_whole(tmp_path):
    maturin = Path(sys.executable).with_name("maturin")
    subprocess.run([maturin, "sdist", "--out", tmp_path], cwd=ROOT, check=True, capture_output=True)
    (archive,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(archive) as held:
        names = {name.split("/", 1)[1] for name in held.getnames() if "/" in name}
    wanted = {str(path.relative_to(ROOT)) for path in embedded()}
    assert len(wanted) > 50 and "crates/cosim/tb/harness.cpp" in wanted and "crates/emit/rtl/median3x3.v" in wanted
    assert not wanted - names
    assert {"Cargo.lock", "pyproject.toml", "python/foveate/torch.py", "LICENSE-MIT"} <= names
