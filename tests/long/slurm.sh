#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs samples/slurm on a one-machine cluster: slurm.sh FOLDER, with the executable in RELIEF. The first run bakes
# models and a level, with a requeued task, a killed task and broken meshes. The second run bakes the rest, the third bakes
# nothing, and the fourth bakes the level again, after a container was deleted. Needs root.
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh slurm-wlm munge sweethome3d-furniture unzip

work=$1/slurm farm=$1/farm out=$1/farm_out models=/usr/share/sweethome3d/furniture tasks=8
mkdir -p "$work"/{state,spool} /run/munge "$farm"
export SLURM_CONF=$work/slurm.conf
cat >"$SLURM_CONF" <<C
ClusterName=nightly
SlurmctldHost=$(hostname)
AuthType=auth/munge
SlurmUser=root
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
ReturnToService=2
KillWait=2
JobAcctGatherType=jobacct_gather/none
NodeName=$(hostname) CPUs=$(nproc) State=UNKNOWN
PartitionName=farm Nodes=ALL Default=YES MaxTime=INFINITE State=UP
C
[ -s /etc/munge/munge.key ] || mungekey
chown munge: /run/munge /etc/munge/munge.key
munge -n >/dev/null 2>&1 || runuser -u munge -- munged
trap 'scontrol shutdown || true; cat "$out"/reports/report.json "$out"/reports/report.log 2>/dev/null || true' EXIT
slurmctld
slurmd
for _ in $(seq 60); do
    ! sinfo -h -o %T 2>/dev/null | grep -q idle || break
    sleep 1
done
sinfo -h -o %T | grep -q idle || {
    tail -n 5 "$work"/slurm*.log
    exit 1
}

for archive in Scopia KatorLegaz; do
    mkdir -p "$farm/$archive"
    unzip -q -o "$models/$archive.sh3f" -d "$farm/$archive"
done
find "$farm" -name '*.obj' | sort | tail -n +486 | xargs -r rm
printf 'v 0 0 0\nf 1 2 9\n' >"$farm/broken_index.obj"
printf 'no mesh\n' >"$farm/broken_text.obj"
python3 tests/cli/level.py "$farm/yard.gltf"
printf 'version = 1\n[defaults]\nbudget = "60kB"\nquality = "fast"\n[[asset]]\nmesh = "**/*.obj"\noutput = "{dir}/{stem}.relief"\n' \
    >"$farm/r.toml"
printf '[[asset]]\nmesh = "*.gltf"\noutput = "worlds/{stem}/world.json"\nbudget = "200kB"\n' >>"$farm/r.toml"

submit() { job=$(samples/slurm/submit.sh "$farm/r.toml" "$out" $tasks -- --cpus-per-task=1); }
ended() { # waits until all tasks of the job end
    while squeue -h -j "$job" 2>/dev/null | grep -q .; do sleep 2; done
}
report() { python3 -c "import json; d = json.load(open('$out/reports/report.json')); print($1)"; }
counts="[d['baked'], d['failed'], d['unfinished_tasks']]"
submit
sleep 20
# Simulates a failed node, whose task Slurm restarts, and a task that is killed permanently.
scontrol requeue "$((job - 1))_1" || true
sleep 2
pkill -KILL -f "shard 2/$tasks" || true
ended
echo "first run: $(tail -1 "$out/reports/report.log" | head -c 200)"
[ "$(report "d['failed'] >= 2 and d['unfinished_tasks'] == [2]")" = True ]
submit
ended
[ "$(report "d['unfinished_tasks'] == [] and d['failed']")" = 2 ]
grep -q broken_index "$out/reports/failures.txt"
[ "$(find "$out" ! -path '*/worlds/*/*.relief' \( -name '*.relief' -o -name world.json \) | wc -l)" = \
    "$(report "d['baked'] + d['up_to_date']")" ]
"$RELIEF" check "$out/worlds/yard/world.json" --mesh "$farm/yard.gltf" --max-error 1 >/dev/null
echo "slurm: $(report "d['baked'] + d['up_to_date']") of $(find "$farm" -name '*.obj' | wc -l) models and a level"
rm "$farm"/broken_*.obj
submit
ended
[ "$(report "$counts")" = '[0, 0, []]' ]
rm "$out"/worlds/yard/floor-*.relief
submit
ended
[ "$(report "$counts")" = '[1, 0, []]' ]
"$RELIEF" check "$out/worlds/yard/world.json" >/dev/null
