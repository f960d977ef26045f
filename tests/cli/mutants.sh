# SPDX-License-Identifier: Apache-2.0
# Broken meshes, sixty by default: baked soundly or refused in one line, and nothing is left behind.
. "$(dirname "$0")/lib.sh"
run=(python3 -B "$RELIEF_SOURCE/tests/cli/mutants.py")

# The checks themselves are checked: each of these bad programs is caught.
# suspect PATTERN COMMANDS: a `relief` of these shell commands fails by a line that matches PATTERN.
suspect() {
    printf '#!/bin/bash\n%s\n' "$2" >suspect
    chmod +x suspect
    expect 1 env -u RELIEF_TEST_SEED "${run[@]}" ./suspect 1 --hang 2 --jobs 4
    grep -qE "^FAILED: mutant 0: .*$1" "$work/stderr" || die "not found out: $2: $(cat "$work/stderr")"
}
refuse='echo "relief: error: $2: no" >&2; exit 3'
suspect 'exit code -11' 'kill -SEGV $$'
suspect 'exit code 1:' 'exit 1'
suspect 'no end within 2 s' '[[ $2 = *mutant* ]] || exit 3; sleep 60'
suspect 'not one line' 'echo "relief: error: no" >&2; exit 3'
suspect 'not one line' "echo 'relief: warning: x' >&2; $refuse"
suspect 'files: .*out\.relief' "touch \"\$4\"; $refuse"
suspect "files: .*'x" "touch \"\$TMPDIR/x\"; $refuse"
suspect 'processes left' "setsid sleep 60 & $refuse"
suspect 'relief check: exit code 3' '[ "$1" = check ] && exit 3; touch "$4"'

"${run[@]}" "$relief" "${RELIEF_MUTANTS:-60}" --page "${RELIEF_MUTANTS_PAGE:-$work/page}" \
    ${RELIEF_MUTANTS_MODELS:+--models "$RELIEF_MUTANTS_MODELS"}
