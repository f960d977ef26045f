#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Bakes one shard as a task of submit.sh's job array: task.sh RELIEF RECIPE OUTPUT_FOLDER TASKS
set -euo pipefail
exec "$1" bake --recipe "$2" -o "$3" --shard "$SLURM_ARRAY_TASK_ID/$4" -j "${SLURM_CPUS_PER_TASK:-${SLURM_CPUS_ON_NODE:-1}}" \
    --events "$3/reports/$SLURM_ARRAY_TASK_ID.jsonl" --warnings-only
