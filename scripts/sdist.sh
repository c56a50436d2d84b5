#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Makes the source distribution of the Python package, and installs it alone, as pip does from an index: in an empty environment,
# away from these sources. Then it makes the first picture of the guide. Takes minutes.
set -euo pipefail
cd "$(dirname "$0")/.."
tools=$(scripts/python_tools.sh --package)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$tools/maturin" sdist --out "$folder"
python3 -m venv "$folder/environment"
cd "$folder"
environment/bin/pip install --quiet --disable-pip-version-check foveate-*.tar.gz
environment/bin/python -c '
import foveate as fv
for outcome in fv.simulate("scene:street", "paper", max_frames=20):
    pass
print(outcome, len(outcome._repr_html_()))
'
environment/bin/foveate --version
