#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Builds the Python package with the features of the tests, installs it into an environment of its own, and prints the folder of
# programs of that environment. Its dependencies come from PyPI (python_tools.sh --package).
#
#   scripts/python.sh                   build and install
#   scripts/python.sh --test            also run its tests, without those that need PyTorch
#   scripts/python.sh --torch [--test]  the same in an environment that has PyTorch (5 GB), with all tests
#
# FOVEATE            an executable whose results those of the package must equal, instead of the debug build
# FOVEATE_PACKAGE    the folder that this script printed before: the package is not built and installed again
set -euo pipefail
cd "$(dirname "$0")/.."
environment=--package
if [ "${1:-}" = --torch ]; then
    environment=--torch
    shift
fi
case ${1:-} in
'' | --test) ;;
*) echo "python: unknown option $1; see the head of scripts/python.sh" >&2 && exit 2 ;;
esac
tools=${FOVEATE_PACKAGE:-}
if [ -z "$tools" ]; then
    tools=$(scripts/python_tools.sh $environment)
    wheels=${CARGO_TARGET_DIR:-target}/wheels
    rm -rf "$wheels"
    mkdir -p "$wheels"
    VIRTUAL_ENV=$(dirname "$tools") "$tools/maturin" build --profile dev --features as-tested --locked --out "$wheels" >"$wheels/build.log" 2>&1 ||
        { cat "$wheels/build.log" >&2 && exit 1; }
    "$tools/pip" install --quiet --disable-pip-version-check --force-reinstall --no-deps "$wheels"/*.whl >&2
fi
echo "$tools"
[ "${1:-}" = --test ] || exit 0
FOVEATE=$(scripts/checks/foveate.sh)
FOVEATE=$(realpath "$FOVEATE")
export FOVEATE
# Tests run in another folder, because the package in the sources has no compiled part. `-rs` names what is skipped.
cd python/tests
"$tools/python" -m pytest --config-file ../../pyproject.toml --rootdir ../.. -p no:cacheprovider -rs .
