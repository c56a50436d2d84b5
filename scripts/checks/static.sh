#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Checks files that are not compiled: shell scripts (shellcheck), Python (ruff, and the tests of the scripts), hosted workflows (their
# schema), the container file (hadolint), CITATION.cff (its schema), the version in all places, dependencies (cargo-deny: licences,
# bans, sources; skipped if it is not installed), that no large file is tracked, and that examples in documentation are run. Installs
# missing tools except cargo-deny.
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/install_tools.sh
tools=$(scripts/python_tools.sh --static)
# Templates are not shell scripts yet; rtl/generated has scripts made of them.
mapfile -t shell < <(git ls-files '*.sh' .ci/run scripts/checks/tool_wrappers ':!tb' ':!crates/*/templates/*')
shellcheck "${shell[@]}"
mapfile -t python < <(git ls-files '*.py')
"$tools/ruff" check --quiet "${python[@]}"
python3 -W error::SyntaxWarning -m unittest discover --quiet --start-directory scripts/checks/tests
"$tools/check-jsonschema" --builtin-schema vendor.github-workflows .github/workflows/*.yml
"$tools/hadolint" Containerfile
"$tools/check-jsonschema" --builtin-schema vendor.citation-file-format CITATION.cff
scripts/checks/versions.py
# No file here must be large, except the engine of the live page, whose page has a limit of its own. A large file is there by mistake.
large=$(git ls-files -z | xargs -0 -I{} find {} -maxdepth 0 -size +1000k ! -path web/foveate.wasm)
[ -z "$large" ] || { echo "static: tracked files of more than 1 MB: $large" >&2 && exit 1; }
# rustdoc is not run on a crate without examples, because it would compile the crate to find none.
examples=$(find crates/*/src -name '*.rs' -exec awk 'FNR == 1 { inside = 0 }
    /^ *\/\/[\/!] *```/ { if (!inside && !/```text/) print FILENAME; inside = !inside }' {} +)
for example in $examples; do
    ! grep -q '^doctest = false' "${example%%/src/*}/Cargo.toml" ||
        { echo "static: $example has an example, which its crate's 'doctest = false' leaves untried" >&2 && exit 1; }
done
if command -v cargo-deny >/dev/null; then
    cargo deny --offline --locked --log-level error check licenses bans sources
else
    echo "skipped: cargo-deny is not installed (cargo install --locked cargo-deny); hosted CI runs it"
fi
