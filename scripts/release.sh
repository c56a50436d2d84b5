#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Runs every check in full, which a release must pass, with a log of the figures that the documents quote. Takes hours on two cores. A
# step that has passed on this commit is not run again, so an interrupted run continues.
#
#   scripts/release.sh                    all steps
#   scripts/release.sh STEP...            some of them; whole:FOLDER is the part of the step `whole` that tests crates/FOLDER
#   scripts/release.sh --changed [BASE]   those that the table in CONTRIBUTING.md names for the files that have changed since the commit
#                                         BASE; without BASE, since the last recorded run of each step
#   scripts/release.sh --list             lists the steps
#   scripts/release.sh --left             lists what this commit lacks for a release, and the manual steps (RELEASING.md)
#
# Logs are in target/release-log/COMMIT: STEP.log of each step, and figures.md of all steps. A step that passes becomes a row of
# docs/data/release-runs.csv, which is committed.
set -euo pipefail
cd "$(dirname "$0")/.."

foveate() { "${CARGO_TARGET_DIR:-target}/release/foveate" "$@"; }

# ---- The steps, a function each
step_test() { scripts/test.sh; }
step_quickstart() { scripts/quickstart.sh "$log/quickstart"; }
step_cosim() {
    foveate cosim --full --preset paper scene:street
    foveate cosim --full --preset serial scene:street
    foveate cosim --full --preset serial --set hardware.fold=38 --set "hardware.feed='raster'" --rounds 0 scene:street
    # Many vectors of each kind of reference and of irrelevant regions: one seed can miss a fault that needs two regions side by side.
    local organization preset rounds=(--level rcm --grid 4x3 --rounds 20 --set "frame={width=48,height=36}")
    for organization in pipelined serial raster; do
        for preset in paper steady fovea; do
            foveate cosim "${rounds[@]}" --preset "$preset" --set "hardware.organization='$organization'"
        done
        foveate cosim "${rounds[@]}" --preset fovea --set "hardware.organization='$organization'" --set "hardware.pipelining='deep'" \
            --set periphery.blocks=4 --set periphery.level=1 --set "render.payload='raw'"
    done
    # The negative control: only the last regions of the whole array get wrong pixels, which no smaller grid shows.
    foveate generate --preset paper --output "$log/miswired" --force
    sed -i 's/pixel_i\[REGION\*8+:8\]/pixel_i[(REGION^512)*8+:8]/' "$log/miswired/rtl/rcm.v"
    grep -q 'REGION^512' "$log/miswired/rtl/rcm.v"
    local ended=0
    foveate cosim --config "$log/miswired/design.toml" --rtl "$log/miswired/rtl" --replay "$log/replay" --full --rounds 0 scene:street ||
        ended=$?
    [ "$ended" -eq 1 ] || { echo "the miswired array ended with $ended, not with a mismatch" && return 1; }
}
step_whole() {
    # The whole lists of faults, netlists and designs, of which the tests otherwise take a part, and the tests that take long. No test is
    # chosen by its name, because a test that no name fits would never take its whole list. whole:FOLDER is the part of crates/FOLDER.
    if [ $# -eq 0 ]; then
        FOVEATE_WHOLE=1 cargo test --workspace --locked -- --include-ignored
    else
        export FOVEATE_WHOLE=1
        cargo test --manifest-path "crates/$1/Cargo.toml" --locked -- --include-ignored
    fi
}
step_python() { FOVEATE_WHOLE=1 scripts/python.sh --torch --test; }
step_page() { scripts/web.sh --test; }
step_workflow() { scripts/workflow.sh; }
step_documents() { scripts/snippets.sh --whole; }
step_rustdoc() { RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked; }
step_netlists() {
    local array=(--level rcm --rounds 1)
    foveate cosim --netlist --preset bare --rounds 1
    foveate cosim --netlist --preset paper --rounds 1
    foveate cosim --netlist --preset bare "${array[@]}" --grid 3x2
    foveate cosim --netlist --preset serial --rounds 1
    # DSP blocks, and block RAM.
    foveate cosim --netlist --preset bare --rounds 1 --set "spatial=[{feature='variance'}]"
    foveate cosim --netlist --preset serial "${array[@]}" --set "denoise.filter='none'" --set region.size=4 \
        --set "hardware.feed='raster'" --set hardware.fold=4 --set "hardware.memory='block'"
    # Block RAM with a port to write and a port to read.
    local raster=(--preset raster "${array[@]}" --grid 4x3 --set region.size=4 --set frame.pixel_bits=4)
    foveate cosim --netlist "${raster[@]}"
    foveate cosim --netlist "${raster[@]}" --set "hardware.pipelining='deep'" --set "temporal.reference='last-sent'" \
        --set "render.payload='raw'"
    # The features and filters that the presets do not have.
    local small=(--rounds 1 --set region.size=4 --set frame.pixel_bits=4) features="{feature='surface'},{feature='segment',min_score=3,mean_fraction_bits=2}"
    foveate cosim --netlist --preset bare "${small[@]}" --set "spatial=[$features]" --set "denoise.filter='switching3x3'"
    foveate cosim --netlist --preset bare "${small[@]}" --level rcm --grid 3x2 --set "spatial=[$features,{feature='flow',radius=2}]" \
        --set "denoise.filter='binomial3x3'" --set "hardware.organization='serial'" --set hardware.fold=2
    foveate cosim --netlist --preset bare "${small[@]}" --level rcm --grid 4x3 --set "spatial=[$features]" \
        --set "denoise.filter='binomial3x3'" --set "hardware.organization='raster'" --set "hardware.pipelining='deep'"
    # Classes of regions, plain and deep.
    local zoned=("${small[@]}" --level rcm --set "spatial=[{feature='edge'},$features]" --set "zones={}")
    foveate cosim --netlist --preset bare "${zoned[@]}" --grid 3x2
    foveate cosim --netlist --preset steady "${zoned[@]}" --grid 3x2 --set "hardware.pipelining='deep'" --set "render.irrelevant='mean'"
    foveate cosim --netlist --preset bare "${zoned[@]}" --grid 3x2 --set "hardware.organization='serial'" --set hardware.fold=2
    foveate cosim --netlist --preset steady "${zoned[@]}" --grid 4x3 --set "hardware.organization='raster'" --set "render.irrelevant='mean'"
}
step_area() { foveate estimate --compare --markdown; }
step_lint() { scripts/lint.sh && scripts/checks/area_growth.py; }
step_formal() { scripts/formal.sh; }
step_coverage() { scripts/coverage.sh; }
step_artefacts() { scripts/artefacts.sh --try; }
step_buses() { scripts/buses.sh; }
step_boards() { scripts/board_parts.sh --faults && scripts/boards.sh; }
step_readers() { scripts/event_readers.sh; }
step_newer() { scripts/newer_tools.sh; }
step_mutation() { scripts/mutation.sh --table --resume; }
step_memory() { scripts/checks/memory.sh; }
step_networks() {
    local python
    python=$(scripts/python_tools.sh --package)/python
    "$python" scripts/checks/onnx_schemas.py && "$python" scripts/checks/onnx_nodes.py
}
step_fuzz() { scripts/checks/fuzz.py; }
step_bench() {
    foveate bench --preset paper
    foveate bench --preset serial
}
step_speed() {
    # The program of the last recorded run is built anew, because the speeds of two machines do not compare.
    local recorded
    recorded=$(awk -F, '$2 == "speed" { commit = $1 } END { print commit }' "$record")
    [ -n "$recorded" ] || { echo "no run is recorded, so later runs compare with this commit" && return; }
    git worktree remove --force "$log/recorded" 2>/dev/null || true
    git worktree add --detach "$log/recorded" "$recorded"
    (cd "$log/recorded" && CARGO_TARGET_DIR=target cargo build --release --locked --quiet --package foveate)
    scripts/checks/speed.py "$FOVEATE" "$log/recorded/target/release/foveate"
    git worktree remove --force "$log/recorded"
}
steps=(test quickstart documents rustdoc page python workflow cosim whole netlists area lint formal buses boards coverage artefacts readers newer
    mutation memory networks fuzz bench speed)

# Lists the manual steps. Ends with 1 while this commit lacks something.
left() {
    local version name lacks=() open=()
    version=$(scripts/checks/versions.py --print)
    [ -z "$(git status --porcelain -- . ":!$record")" ] || lacks+=("the tree has changes that no commit has; git status shows them")
    mapfile -t -O "${#lacks[@]}" lacks < <(scripts/checks/versions.py --release 2>&1)
    ! git rev-parse --quiet --verify "refs/tags/v$version" >/dev/null ||
        lacks+=("there is a tag v$version already, of $(git rev-list -1 --abbrev-commit "v$version"); raise the version, or delete it if it was never pushed")
    for name in "${steps[@]}"; do
        [ -e "$log/$name.passed" ] || open+=("$name")
    done
    [ ${#open[@]} -eq 0 ] || lacks+=("steps that have not passed on ${commit:0:10}: ${open[*]}; scripts/release.sh runs them")
    if [ ${#lacks[@]} -gt 0 ]; then
        printf '%s\n' "before Foveate $version is released:" "${lacks[@]/#/- }"
    else
        echo "nothing is left for the steps of Foveate $version"
    fi
    cat <<END
by hand then, in this order (RELEASING.md has the reasons):
1. git tag --sign v$version --message "Foveate $version" && git push origin v$version
2. wait for the hosted run "Release": checks, artefacts, container, and a draft of the release; download its artefacts into target/artefacts
3. cargo publish --workspace --exclude foveate-python --locked
4. \$(scripts/python_tools.sh --artefacts)/twine upload target/artefacts/*.whl target/artefacts/foveate-$version.tar.gz
5. publish the draft
6. on another machine: cargo binstall foveate && pip install foveate && foveate --version
7. a section [Unreleased] in CHANGELOG.md, and the next version in Cargo.toml and CITATION.cff
END
    [ ${#lacks[@]} -eq 0 ]
}

record=docs/data/release-runs.csv
commit=$(git rev-parse HEAD)
log=$(realpath -m "${CARGO_TARGET_DIR:-target}/release-log/$commit")
case ${1:-} in
--left) left && exit 0 || exit 1 ;;
-h | --help) sed -n '3,16s/^# \{0,1\}//p' "$0" && exit 0 ;;
--changed)
    chosen=$(scripts/checks/release_steps.py "${@:2}")
    [ -n "$chosen" ] || { echo "no step has changed sources" && exit 0; }
    # shellcheck disable=SC2086  # a step is one word
    set -- $chosen
    echo "steps with changed sources: $*"
    ;;
--list) printf '%s\n' "${steps[@]}" && exit 0 ;;
esac
for name in "$@"; do
    declare -F "step_${name%%:*}" >/dev/null || { echo "release: there is no step $name; scripts/release.sh --list shows them" >&2; exit 2; }
done
[ -z "$(git status --porcelain --untracked-files=no -- . ":!$record")" ] || { echo "release: commit first; a log belongs to a commit" >&2; exit 2; }
mkdir -p "$log"
scripts/install_tools.sh
cargo build --release --locked --quiet --package foveate
FOVEATE=$(realpath "${CARGO_TARGET_DIR:-target}/release/foveate")
export FOVEATE

machine="$(nproc) cores $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -1 | tr -d ',')"
selected=("$@")
[ $# -gt 0 ] || selected=("${steps[@]}")
failed=()
for name in "${selected[@]}"; do
    [ ! -e "$log/$name.passed" ] || { echo "$name: passed before"; continue; }
    echo "$name: $(date +%H:%M:%S), log in $log/$name.log"
    began=$SECONDS
    # This is not a condition of `if`, because `set -e` would not hold inside of the step then.
    set +e
    part=()
    [ "$name" = "${name#*:}" ] || part=("${name#*:}")
    (set -ex && "step_${name%%:*}" "${part[@]}") >"$log/$name.log" 2>&1
    ended=$?
    set -e
    if [ $ended -eq 0 ]; then
        echo "$((SECONDS - began)) s" >"$log/$name.passed"
        echo "${commit:0:10},$name,$(date +%F),$machine,$((SECONDS - began)),passed" >>"$record"
        echo "$name: passed in $((SECONDS - began)) s"
    else
        failed+=("$name")
        echo "$name: FAILED after $((SECONDS - began)) s; the end of its log:"
        tail -5 "$log/$name.log"
    fi
done

{
    echo "# Figures of ${commit:0:10}"
    for name in "${steps[@]}"; do
        printf '\n## %s: %s\n```\n' "$name" "$(cat "$log/$name.passed" 2>/dev/null || echo "not passed")"
        # Long logs are reduced to their summary; of other logs all lines are kept.
        case $name in
        test | quickstart) grep -E '^[0-9]+ passed|^test result: FAILED|^book:' "$log/$name.log" || true ;;
        *) grep -v '^+' "$log/$name.log" | tail -60 || true ;;
        esac 2>/dev/null
        echo '```'
    done
} >"$log/figures.md"
echo "figures: $log/figures.md"
[ ${#failed[@]} -eq 0 ] || { echo "release: ${failed[*]} failed" >&2; exit 1; }
[ $# -gt 0 ] || left
