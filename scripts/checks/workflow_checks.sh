# shellcheck shell=bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# For workflow.sh and slurm.sh, which source it: runs the same work on one machine and through Snakemake, and checks that the results
# are equal. They set `sources`, `FOVEATE` and PATH, and change into an empty folder; `snakemake` is a process that they start.
# shellcheck disable=SC2154

step() { printf '\n== %s\n' "$*"; }
fail() { echo "${0##*/}: $*" >&2 && exit 1; }

# Runs two scenes and a folder of pictures, with a number of frames of each, on one machine. Workflows are compared with it.
prepare() {
    local frames=$1 levels clips=(scene:street scene:shake made/rendered)
    levels=$(seq --separator=', ' 60 99)
    printf '[vary]\nspatial.0.level = [%s]\n' "$levels" >space.toml
    "$FOVEATE" simulate scene:random -o made --frames 60 --quiet
    "$FOVEATE" explore space.toml "${clips[@]}" -o alone/explore --max-frames "$frames" --no-area --quiet
    "$FOVEATE" analyze size "${clips[@]}" -o alone/size --max-frames "$frames" --quiet
    cat >config.yaml <<CONFIG
foveate: $FOVEATE
clips: ["scene:street", "scene:shake", made/rendered]
options: --max-frames $frames
explore: {space: space.toml, options: --no-area}
infer: {network: $sources/networks/denoiser.onnx}
analyze: {studies: [size]}
CONFIG
}

# Runs the workflow with a profile and further options.
run() {
    snakemake --snakefile "$sources/workflow/Snakefile" --profile "$sources/workflow/profiles/$1" --configfile config.yaml "${@:2}"
}

# Checks that the tables and the page of a folder are those of one machine.
same() {
    for name in points.csv points.parquet clips.csv report.html exploration.json; do
        cmp "alone/explore/$name" "$1/explore/$name" || fail "$1/explore/$name has other bytes than one machine writes"
    done
}

# Lists every finished result with the time and the inode number of its file, which change if it is written again.
finished() { find "$1/explore/measured" -name '*.json' -printf '%f %T@ %i\n' | sort; }

# Checks that the results of a list are unchanged.
kept() {
    [ -s "$2" ] || fail "nothing was finished when $3"
    lost=$(comm -23 "$2" <(finished "$1") | wc -l)
    [ "$lost" -eq 0 ] || fail "$lost results that were finished when $3 were done again"
    echo "$(wc -l <"$2") results were finished when $3; all are as they were"
}

# Waits until a command succeeds, as long as the process `snakemake` runs.
until_there() {
    until "$@"; do
        kill -0 "$snakemake" 2>/dev/null || { tail -40 snakemake.log && fail "Snakemake ended before: $*"; }
        sleep 0.1
    done
}
units_done() { [ "$(find out/explore/units -name '*.json' 2>/dev/null | wc -l)" -ge "$1" ]; }
# Lists the processes that run units here.
at_work() {
    local pid found=1
    for pid in $(pgrep -f -- "^$FOVEATE explore .* -o out/explore .* --only"); do
        [ "$(readlink "/proc/$pid/cwd")" = "$PWD" ] && echo "$pid" && found=0
    done
    return $found
}

# Kills the process of a unit, as a lack of memory does. If it ends just before, another one is killed.
kill_unit() {
    local victims
    until_there kill_one
    echo "killed process ${victims%%$'\n'*}, which did a unit"
}
kill_one() { victims=$(at_work) && kill -KILL "${victims%%$'\n'*}" 2>/dev/null; }
