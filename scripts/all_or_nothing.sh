#!/usr/bin/env bash
# Kills relief while it writes, makes its writing fail, and races several writers (tests/cli/atomic_outputs.sh), for
# RELIEF_ATOMIC_ROUNDS rounds (20 by default). Prints what it counted; with --page also into bake/measure/trust.md.
set -euo pipefail
cd "$(dirname "$0")/.."

counts=$(mktemp)
trap 'rm -f "$counts"' EXIT
RELIEF_BIN=$(scripts/build.sh release relief)
export RELIEF_BIN RELIEF_SOURCE=$PWD RELIEF_ATOMIC_PAGE=$counts RELIEF_ATOMIC_ROUNDS=${RELIEF_ATOMIC_ROUNDS:-20}
bash tests/cli/atomic_outputs.sh
if [ "${1:-}" = --page ]; then
    python3 - "$counts" <<'P'
import sys
page = open('bake/measure/trust.md').read()
begin, end = '<!-- all or nothing -->\n', '<!-- /all or nothing -->'
head, rest = page.split(begin)
body = 'Written by `scripts/all_or_nothing.sh --page`.\n\n' + open(sys.argv[1]).read()
open('bake/measure/trust.md', 'w').write(head + begin + body + end + rest.split(end, 1)[1])
P
fi
