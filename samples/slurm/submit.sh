#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Bakes a recipe on a cluster of Slurm: submit.sh RECIPE OUTPUT_FOLDER [TASKS] [-- OPTION…]
#
# Submits a job array of TASKS tasks (16), each of which bakes one shard of the recipe, and a job after them that gathers
# what they say. OPTIONs go to sbatch, such as --partition=farm --cpus-per-task=8 --time=4:00:00. Prints the number of the
# last job; its exit code is that of the whole. Run it again to go on: what is up to date is not baked again.
#
# OUTPUT_FOLDER/reports/ has report.json, failures.txt, and the events and the log of each task. The recipe and the
# folder must have the same names on every node; `relief` must be on PATH there, or RELIEF name it.
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
    echo "submit.sh: relief is not on PATH; install it, or name it by RELIEF" >&2
    exit 5
}

mkdir -p "$out/reports"
rm -f "$out"/reports/*.jsonl "$out/reports/report.json" "$out/reports/failures.txt"
# A task whose node dies is begun again (--requeue): its shard goes on where it was.
array=$(sbatch --parsable --job-name=relief --array="1-$tasks" --requeue --open-mode=append \
    --output="$out/reports/%a.log" "$@" \
    "$here/task.sh" "$relief" "$recipe" "$out" "$tasks")
sbatch --parsable --job-name=relief-report --dependency="afterany:$array" --output="$out/reports/report.log" \
    --wrap="python3 '$here/gather.py' '$out/reports' $tasks"
