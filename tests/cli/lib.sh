# SPDX-License-Identifier: Apache-2.0
# Sourced by every test in this folder: a temporary folder and common checks.
set -euo pipefail

relief="$RELIEF_BIN/relief"
relief_sim="$RELIEF_BIN/relief-sim"
bunny=/usr/share/glmark2/models/bunny.obj
models=/usr/share/assimp/models
work=$(mktemp -d)
export PYTHONPATH=$RELIEF_SOURCE/tests/cli PYTHONDONTWRITEBYTECODE=1 # ply.py, processes.py
trap 'rm -rf "$work"' EXIT
cd "$work"

die() {
    echo "FAILED: $*" >&2
    exit 1
}

# expect CODE COMMAND…: the exit code must be CODE. Output goes to $work/stdout and $work/stderr.
expect() {
    local wanted=$1 code=0
    shift
    "$@" >"$work/stdout" 2>"$work/stderr" </dev/null || code=$?
    [ "$code" -eq "$wanted" ] || {
        cat "$work/stderr" >&2
        die "exit code $code instead of $wanted: $*"
    }
}

# expect_error CODE PATTERN COMMAND…: like expect. In addition stdout is empty, and stderr is one line that starts with
# the program's name and matches PATTERN (extended, any case).
expect_error() {
    local code=$1 pattern=$2
    shift 2
    expect "$code" "$@"
    [ "$(wc -l <"$work/stderr")" -eq 1 ] || {
        cat "$work/stderr" >&2
        die "not one line on stderr: $*"
    }
    grep -qE '^relief(-sim|-pages)?: error: ' "$work/stderr" || die "the error lacks the program's name: $(cat "$work/stderr")"
    grep -qiE -- "$pattern" "$work/stderr" || die "'$(cat "$work/stderr")' does not match '$pattern'"
    [ ! -s "$work/stdout" ] || die "output on stdout despite an error: $*"
}

# page_place: prints the line of the page template that contains the data.
page_place() {
    grep '^<script type="application/json"' "$RELIEF_SOURCE/runtime/web/view/index.html"
}

# gone PID: waits until the process and its group have ended; fails after a while.
gone() {
    python3 "$RELIEF_SOURCE/tests/cli/processes.py" "$1"
}

# COMMAND | matches PATTERN…: like grep -q, but reads to the end, so that COMMAND never fails by SIGPIPE.
matches() {
    grep "$@" >/dev/null
}

# tetrahedron FILE [SIZE]: an OBJ at the origin.
tetrahedron() {
    printf 'v 0 0 0\nv %s 0 0\nv 0 %s 0\nv 0 0 %s\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' "${2:-1}" "${2:-1}" "${2:-1}" >"$1"
}

# box FILE X Y Z: an OBJ from (-X, -Y, -Z) to (X, Y, Z) of six squares; the first is the side -Z.
box() {
    {
        printf "v %s %s %s\n" "-$2" "-$3" "-$4" "$2" "-$3" "-$4" "$2" "$3" "-$4" "-$2" "$3" "-$4" \
            "-$2" "-$3" "$4" "$2" "-$3" "$4" "$2" "$3" "$4" "-$2" "$3" "$4"
        printf 'f %s\n' '4 3 2 1' '5 6 7 8' '1 2 6 5' '3 4 8 7' '2 3 7 6' '1 5 8 4'
    } >"$1"
}

# unfold FILE: a COLLADA document in which each node instances the next one twice: 2⁴⁰ nodes, which the importer starts
# to expand.
unfold() {
    python3 - "$1" <<'P'
import sys
nodes = ''.join(f'<node id="n{i}"><instance_node url="#n{i + 1}"/><instance_node url="#n{i + 1}"/></node>' for i in range(40))
open(sys.argv[1], 'w').write(
    '<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>'
    f'<library_nodes>{nodes}<node id="n40"/></library_nodes><library_visual_scenes><visual_scene id="s"><node>'
    '<instance_node url="#n0"/></node></visual_scene></library_visual_scenes>'
    '<scene><instance_visual_scene url="#s"/></scene></COLLADA>')
P
}

# level OUT [KEY=VALUE…]: a small glTF level (level.py).
level() { python3 "$RELIEF_SOURCE/tests/cli/level.py" "$@"; }

# container_hashes DIR: the hash of every container in DIR.
container_hashes() { (cd "$1" && find . -name '*.relief' | sort | xargs sha256sum); }

# random_points FILE: 10,000 points in and around the bunny.
random_points() {
    python3 - "$1" <<'P'
import random, sys
random.seed(7)
with open(sys.argv[1], 'w') as out:
    for _ in range(10_000):
        out.write(','.join('%.6f' % random.uniform(-1.1, 1.1) for _ in range(3)) + '\n')
P
}

# json FILE EXPRESSION: a Python expression over the document `d` that must be true.
json() {
    python3 - "$1" "$2" <<'P' || die "not true for $1: $2"
import json, math, sys
d = json.load(open(sys.argv[1]))
sys.exit(0 if eval(sys.argv[2]) else 1)
P
}
