#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Kills relief during writes, injects write errors, and races several writers (tests/cli/atomic_outputs.sh), for
# RELIEF_ATOMIC_ROUNDS rounds (default: 20). Also kills the import worker and injects errors (tests/cli/import_faults.sh).
# Prints the counts, which bake/measure/trust.md cites.
set -euo pipefail
cd "$(dirname "$0")/../.."

RELIEF_BIN=$(scripts/build.sh release relief)
export RELIEF_BIN RELIEF_SOURCE=$PWD RELIEF_ATOMIC_ROUNDS=${RELIEF_ATOMIC_ROUNDS:-20} RELIEF_FAULTS_ALL=1
bash tests/cli/atomic_outputs.sh
bash tests/cli/import_faults.sh
