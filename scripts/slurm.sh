#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Runs workflow/ on a real Slurm: installs it from Debian packages, starts munged, slurmctld and slurmd of one node with two parallel
# jobs on the loopback address, and stops them at the end. Needs root. During the run a job is killed, the controller is killed and
# started again, and the disk of the results is full. The tables must be equal to those of one machine, byte by byte, and no finished
# unit is done again.
#
# FOVEATE    an executable to use instead of the debug build
set -euo pipefail
cd "$(dirname "$0")/.."
if [ "$(id -u)" -ne 0 ]; then
    echo "slurm: this starts daemons and mounts a small disk, so it needs root" >&2
    exit 3
fi
# The mounts are visible only to this script, and vanish with it.
[ "${1:-}" = --inside ] || exec unshare -m "$0" --inside

# shellcheck source=scripts/checks/workflow_checks.sh
. scripts/checks/workflow_checks.sh

step "tools"
if ! { command -v slurmctld && command -v slurmd && command -v munged; } >/dev/null; then
    # The user of apt may be unable to write to /dev/null in some containers.
    apt-get -o APT::Sandbox::User=root update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends slurm-wlm munge
fi
tools=$(scripts/python_tools.sh --workflow)
FOVEATE=$(scripts/checks/foveate.sh)
export PATH=$tools:$PATH
sources=$PWD

work=$(mktemp -d)
declare -A daemons=()
stop() {
    [ -z "${snakemake:-}" ] || kill -KILL "$snakemake" 2>/dev/null || true
    # Without this controller another one would be asked.
    [ -z "${daemons[slurmctld]:-}" ] || scancel --full --user root 2>/dev/null || true
    for daemon in slurmd slurmctld munged; do
        [ -z "${daemons[$daemon]:-}" ] || { kill "${daemons[$daemon]}" && wait "${daemons[$daemon]}"; } 2>/dev/null || true
    done
    cd /
    umount --quiet /etc/slurm "$work/run/here/full/explore" 2>/dev/null || true
    rm -rf "$work"
}
trap stop EXIT
trap 'exit 143' TERM INT HUP

step "a cluster of one node"
mkdir "$work"/{etc,state,spool,run}
# The path where Slurm looks without SLURM_CONF, which Snakemake's plugin removes from the environment of jobs.
mkdir -p /etc/slurm
mount --bind "$work/etc" /etc/slurm
dd if=/dev/urandom of="$work/munge.key" bs=1024 count=1 status=none
chmod 600 "$work/munge.key"
host=$(hostname -s)
cat >"$work/etc/slurm.conf" <<CONF
ClusterName=foveate
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
AuthInfo=socket=$work/run/munge.socket
SlurmUser=root
SlurmdUser=root
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
ReturnToService=2
MinJobAge=3600
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/run/slurmctld.pid
SlurmdPidFile=$work/run/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
SlurmdParameters=config_overrides
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=8000 State=UNKNOWN
PartitionName=main Nodes=$host Default=YES State=UP
CONF
controller() {
    slurmctld -D 2>>"$work/slurmctld.err" &
    daemons[slurmctld]=$!
}
munged --foreground --force --key-file="$work/munge.key" --socket="$work/run/munge.socket" --pid-file="$work/run/munged.pid" \
    --log-file="$work/munged.log" --seed-file="$work/munged.seed" 2>"$work/munged.err" &
daemons[munged]=$!
until [ -S "$work/run/munge.socket" ]; do sleep 0.1; done
controller
slurmd -D -N "$host" 2>"$work/slurmd.err" &
daemons[slurmd]=$!
up() { sinfo --noheader --format %T 2>/dev/null | grep -E 'idle|mixed|allocated' >/dev/null; }
for _ in {1..100}; do
    if up; then break; fi
    sleep 0.2
done
up || { tail "$work"/*.log && fail "the node did not come up"; }
srun --quiet true
sinfo

step "one machine"
mkdir "$work/run/here" && cd "$work/run/here"
prepare 200
# Runs the workflow on Slurm with a folder of results, for all files or for some.
on_slurm() {
    run slurm --config "output=$1" --retries "${RETRIES:-2}" --latency-wait 10 --slurm-status-command squeue --slurm-init-seconds-before-status-checks 2 \
        --seconds-between-status-checks 2 --slurm-no-account --default-resources mem_mb=2000 runtime=3 -- "${@:2}"
}
run local --cores 2 --config output=local >local.log 2>&1 || { tail -40 local.log && fail "Snakemake failed on one machine"; }

# Tests that jobs run, and that each has begun the step that does its work.
all_at_work() {
    local job jobs
    jobs=$(squeue --noheader --states RUNNING --format %A)
    [ -n "$jobs" ] || return 1
    for job in $jobs; do squeue --noheader --steps --format %i | grep -x "$job\.0" >/dev/null || return 1; done
}

step "Slurm, with a process killed, a job cancelled, and the controller killed and started again"
on_slurm out >snakemake.log 2>&1 &
snakemake=$!
until_there units_done 1
finished out >before
kill_unit
until_there units_done 2
until_there at_work >/dev/null
# This is not head, which would end squeue by a broken pipe.
job=$(squeue --noheader --states RUNNING --format %A | sed -n 1p)
scancel "$job"
echo "cancelled job $job"
until_there units_done 3
# A job that is about to start its first step when the controller stops hangs until its time limit.
until_there all_at_work
finished out >later
kill -KILL "${daemons[slurmctld]}"
sleep 5
controller
echo "killed the controller, and started it again after 5 s"
wait "$snakemake" || { tail -60 snakemake.log && fail "Snakemake failed on Slurm"; }
same out
cmp alone/size/size.csv out/size.csv || fail "size.csv has other bytes than one machine writes"
cmp local/infer.csv out/infer.csv || fail "infer.csv has other bytes than one machine writes"
kept out before "the process was killed"
kept out later "the controller was killed"
echo "$(grep -c 'Error in rule' snakemake.log) jobs failed on the way, and were submitted again"

step "Slurm, with a full disk"
mkdir -p full/explore
mount -t tmpfs -o size=250k none full/explore
if RETRIES=0 on_slurm full full/explore/points.csv >full.log 2>&1; then
    fail "no job failed on a full disk"
fi
grep -rhoE 'foveate: .*(no storage space|No space left).*' .snakemake/slurm_logs | sort -u | sed -n 1p | grep . || fail "no job named the full disk"
find full/explore -name '*.json' -exec python3 -c 'import json, sys; [json.load(open(name)) for name in sys.argv[1:]]' {} +
finished full >before
mount -o remount,size=20m full/explore
on_slurm full full/explore/points.csv >full.log 2>&1 || { tail -60 full.log && fail "Snakemake failed after there was room"; }
same full
kept full before "the disk was full"
step "all tables have the bytes of one machine"
