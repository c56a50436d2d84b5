#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Builds the Python package as the tests are built, installs it into an environment of its own, and prints that environment's
# folder of programs. What it needs comes from PyPI (python_tools.sh --package).
#
#   scripts/python.sh           build and install
#   scripts/python.sh --test    and run its tests
#
# FOVEATE            an executable that the package must equal, instead of the debug build
# FOVEATE_PACKAGE    what this script has printed before: nothing is built and installed again
set -euo pipefail
cd "$(dirname "$0")/.."
tools=${FOVEATE_PACKAGE:-}
if [ -z "$tools" ]; then
    tools=$(scripts/python_tools.sh --package)
    wheels=${CARGO_TARGET_DIR:-target}/wheels
    rm -rf "$wheels"
    mkdir -p "$wheels"
    VIRTUAL_ENV=$(dirname "$tools") "$tools/maturin" build --profile dev --features as-tested --locked --out "$wheels" >"$wheels/build.log" 2>&1 ||
        { cat "$wheels/build.log" >&2 && exit 1; }
    "$tools/pip" install --quiet --disable-pip-version-check --force-reinstall --no-deps "$wheels"/*.whl >&2
fi
echo "$tools"
[ "${1:-}" = --test ] || exit 0
FOVEATE=$(scripts/foveate.sh)
FOVEATE=$(realpath "$FOVEATE")
export FOVEATE
# Not from here: the package of the sources has no compiled part.
cd python/tests
"$tools/python" -m pytest --config-file ../../pyproject.toml --rootdir ../.. -p no:cacheprovider .
