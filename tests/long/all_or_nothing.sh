#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Kills relief during writes, injects write errors, and races several writers (tests/cli/atomic_outputs.sh), for
# RELIEF_ATOMIC_ROUNDS rounds (default: 20). Also kills the import worker and injects errors (tests/cli/import_faults.sh).
# Prints the counts; --page also writes them into bake/measure/trust.md.
set -euo pipefail
cd "$(dirname "$0")/../.."

counts=$(mktemp) faults=$(mktemp)
trap 'rm -f "$counts" "$faults"' EXIT
RELIEF_BIN=$(scripts/build.sh release relief)
export RELIEF_FAULTS_PAGE=$faults
export RELIEF_BIN RELIEF_SOURCE=$PWD RELIEF_ATOMIC_PAGE=$counts RELIEF_ATOMIC_ROUNDS=${RELIEF_ATOMIC_ROUNDS:-20}
bash tests/cli/atomic_outputs.sh
bash tests/cli/import_faults.sh
if [ "${1:-}" = --page ]; then
    { printf 'Written by `tests/long/all_or_nothing.sh --page`.\n\n' && cat "$counts" && echo && cat "$faults"; } |
        tests/long/page_part.sh bake/measure/trust.md 'all or nothing'
fi
