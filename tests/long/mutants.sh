#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Gives relief broken meshes (tests/cli/mutants.sh) and every file of assimp-testmodels, and prints what became of them:
# tests/long/mutants.sh [COUNT] [--page], 2000 by default; with --page also into bake/measure/trust.md.
set -euo pipefail
cd "$(dirname "$0")/../.."

count=2000
page=
for argument in "$@"; do
    case $argument in
        --page) page=1 ;;
        *[!0-9]* | '')
            echo "mutants.sh: '$argument' is no number of mutants; use [COUNT] [--page]" >&2
            exit 1
            ;;
        *) count=$argument ;;
    esac
done
counts=$(mktemp)
trap 'rm -f "$counts"' EXIT
RELIEF_BIN=$(scripts/build.sh release relief)
export RELIEF_BIN RELIEF_SOURCE=$PWD RELIEF_MUTANTS=$count RELIEF_MUTANTS_PAGE=$counts
export RELIEF_MUTANTS_MODELS=/usr/share/assimp/models
status=0
bash tests/cli/mutants.sh || status=$?
if [ -n "$page" ] && [ -s "$counts" ]; then
    printf 'Written by `tests/long/mutants.sh %s --page`.\n\n' "$count" | cat - "$counts" |
        tests/long/page_part.sh bake/measure/trust.md mutants
fi
exit $status
