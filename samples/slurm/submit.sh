#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Bakes a recipe on a Slurm cluster: submit.sh RECIPE OUTPUT_FOLDER [TASKS] [-- OPTION…]
#
# Submits a job array of TASKS tasks (default: 16), one for each shard of the recipe, and a final job that merges their
# reports. Passes each OPTION to sbatch, such as --partition=farm --cpus-per-task=8 --time=4:00:00. Prints the id of the
# final job, whose exit code is that of the whole bake. Run it again to resume: it bakes only what is out of date.
#
# OUTPUT_FOLDER/reports/ contains report.json, failures.txt, and the events and log of each task. The recipe and the
# folder need the same paths on every node. `relief` must be on PATH there, or RELIEF must contain its path.
set -euo pipefail

usage() {
    sed -n '2,9p' "$0" | sed 's/^# \{0,1\}//' >&2
    exit 1
}
[ $# -ge 2 ] || usage
recipe=$(realpath -e "$1") || exit 2
out=$(realpath -m "$2")
tasks=16
shift 2
if [ $# -gt 0 ] && [ "$1" != -- ]; then
    tasks=$1
    shift
fi
[ "${1---}" = -- ] && [[ "$tasks" =~ ^[1-9][0-9]*$ ]] || usage
[ $# -eq 0 ] || shift
here=$(dirname "$(realpath "$0")")
relief=${RELIEF:-$(command -v relief)} || {
    echo "submit.sh: relief is not on PATH; install it, or set RELIEF to its path" >&2
    exit 5
}

mkdir -p "$out/reports"
rm -f "$out"/reports/*.jsonl "$out/reports/report.json" "$out/reports/failures.txt"
# --requeue restarts the tasks of dead nodes; a restarted shard resumes where it stopped.
array=$(sbatch --parsable --job-name=relief --array="1-$tasks" --requeue --open-mode=append \
    --output="$out/reports/%a.log" "$@" \
    "$here/task.sh" "$relief" "$recipe" "$out" "$tasks")
sbatch --parsable --job-name=relief-report --dependency="afterany:$array" --output="$out/reports/report.log" \
    --wrap="python3 '$here/gather.py' '$out/reports' $tasks"
