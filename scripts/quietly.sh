#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# quietly.sh COMMAND…: runs COMMAND. With RELIEF_QUIET, prints its output only if it fails, and reports the progress of ninja
# in five lines.
set -euo pipefail
[ -n "${RELIEF_QUIET-}" ] || exec "$@"
log=$(mktemp)
trap 'rm -f "$log"' EXIT

# Copies its input to the log. Prints a line for each fifth of ninja's steps if there are at least 20.
progress() {
    local line fifths=0 now
    while IFS= read -r line; do
        printf '%s\n' "$line" >>"$log"
        if [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] && [ "${BASH_REMATCH[2]}" -ge 20 ]; then
            now=$((5 * BASH_REMATCH[1] / BASH_REMATCH[2]))
            if [ "$now" -gt "$fifths" ]; then
                fifths=$now
                echo "  ${BASH_REMATCH[1]} of ${BASH_REMATCH[2]} steps" >&2
            fi
        fi
    done
}

"$@" 2>&1 | progress || {
    code=$?
    cat "$log" >&2
    exit "$code"
}
