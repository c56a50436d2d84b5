#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Runs workflow/ on this machine with two parallel jobs, kills the process of a unit and then Snakemake itself, and continues. The
# tables must be equal to those of one machine, byte by byte, and no finished unit is done again. scripts/slurm.sh does it on Slurm.
#
# FOVEATE    an executable to use instead of the debug build
set -euo pipefail
cd "$(dirname "$0")/.."
tools=$(scripts/python_tools.sh --workflow)
FOVEATE=$(scripts/checks/foveate.sh)
export PATH=$tools:$PATH
sources=$PWD
# shellcheck source=scripts/checks/workflow_checks.sh
. scripts/checks/workflow_checks.sh
work=$(mktemp -d)
trap '[ -z "${snakemake:-}" ] || kill -KILL -- "-$snakemake" 2>/dev/null; rm -rf "$work"' EXIT
cd "$work"
prepare 60

# Snakemake is in a process group of its own, so that it can be killed with all its processes.
setsid bash -c ". '$sources/scripts/checks/workflow_checks.sh'; sources='$sources'; run local --cores 2 --config output=out" >snakemake.log 2>&1 &
snakemake=$!
kill_unit
until_there units_done 3
finished out >before
kill -KILL -- "-$snakemake"
wait "$snakemake" 2>/dev/null || true
snakemake=
run local --unlock >snakemake.log 2>&1
run local --cores 2 --rerun-incomplete >snakemake.log 2>&1 || { tail -40 snakemake.log && fail "Snakemake failed"; }
same out
cmp alone/size/size.csv out/size.csv || fail "size.csv has other bytes than one machine writes"
kept out before "Snakemake was killed"
[ "$(wc -l <out/infer.csv)" -eq 4 ] || fail "infer.csv does not have a row for each clip"

# In a larger space only the units with new designs are run: the last of each clip.
finished out >before
sed -i 's/99\]/99, 100, 101]/' space.toml
run local --cores 2 >snakemake.log 2>&1
kept out before "the space was made larger"
[ "$(grep -cE '^(local)?rule unit:' snakemake.log)" -eq 3 ] || fail "units are done again though their designs are the same"
[ "$(finished out | wc -l)" -eq $((42 * 3)) ] || fail "a larger space was not measured whole"

# The name of the folder is one word of the commands, whatever characters it has.
run local --cores 1 --config 'output=my out; x' --dry-run --printshellcmds >snakemake.log 2>&1
grep -qF -- "-o 'my out; x'/explore" snakemake.log || { tail -40 snakemake.log && fail "the name of the output is no word of a shell"; }
