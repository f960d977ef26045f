#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# quietly.sh COMMAND…: runs it. With RELIEF_QUIET its output is shown only if it fails.
set -euo pipefail
[ -n "${RELIEF_QUIET-}" ] || exec "$@"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
"$@" >"$log" 2>&1 || {
    code=$?
    cat "$log" >&2
    exit "$code"
}
