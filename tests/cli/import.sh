# SPDX-License-Identifier: Apache-2.0
# The worker that reads meshes: its limits, its death, and its parent's death. Units and axes reach the container. Unit
# tests cover the contents of each format.
. "$(dirname "$0")/lib.sh"
export TMPDIR="$work/tmp"
mkdir "$TMPDIR"

cat >good.stl <<'S'
solid t
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 2 0 vertex 1 0 0 endloop endfacet
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 0 3 endloop endfacet
facet normal 0 0 0 outer loop vertex 1 0 0 vertex 0 2 0 vertex 0 0 3 endloop endfacet
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 0 3 vertex 0 2 0 endloop endfacet
endsolid t
S
small=(--map fixed8:size=8 -q)

# Units and axes.
expect 0 "$relief" bake good.stl -o plain.relief "${small[@]}" --max-triangles 4
expect 0 "$relief" info plain.relief --json
json stdout "d['unit'] == '' and d['bounds']['max'] == [1, 2, 3] and '--u' not in d['provenance']['options']"
expect 0 "$relief" bake good.stl -o turned.relief "${small[@]}" --unit cm --up +z
expect 0 "$relief" info turned.relief --json
json stdout "d['unit'] == 'm' and d['provenance']['options'].endswith(' --unit cm --up +z')"
json stdout "all(abs(a - b) < 1e-6 for a, b in zip(d['bounds']['min'] + d['bounds']['max'], [0, 0, -.02, .01, .03, 0]))"
expect 0 "$relief" check turned.relief --mesh good.stl --samples 1000 --unit cm --up +z
expect_error 3 'good.stl' "$relief" check turned.relief --mesh good.stl --samples 1000
for option in '--max-import-memory 1kB' '--import-timeout 0' '--max-triangles 200000000'; do
    # shellcheck disable=SC2086
    expect_error 1 "${option%% *}" "$relief" bake good.stl -o x.relief $option
done

# Memory: a short header can request too much, and so can large meshes or instances. 90 million triangles in a few
# kilobytes are rejected before they are created.
printf '%s\n' ply 'format binary_little_endian 1.0' 'element vertex 99999999999' 'property float x' 'property float y' 'property float z' \
    'element face 1' 'property list uchar int vertex_indices' end_header >count.ply
expect_error 6 'count\.ply' "$relief" bake count.ply -o x.relief
sed -i 's/99999999999/300000000/' count.ply
expect_error 3 'count\.ply' "$relief" bake count.ply -o x.relief --max-import-memory 64MB
expect_error 6 'OutOfMemory\.off' "$relief" bake "$models/invalid/OutOfMemory.off" -o x.relief
python3 - <<'P'
import base64, json, struct
with open('large.obj', 'w') as file:
    file.writelines(f'v {i % 700} {i // 700} {i % 7}\n' for i in range(1490000))
    file.writelines(f'f {i + 1} {i + 2} {i + 701}\n' for i in range(1489000))
n = 3000
buffer = struct.pack('<9f', 0, 0, 0, 1, 0, 0, 0, 1, 0) + bytes(range(3)) * 1000
json.dump({
    'asset': {'version': '2.0'}, 'scenes': [{'nodes': list(range(n))}], 'nodes': [{'mesh': 0}] * n,
    'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1}] * 30}],
    'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},
                  {'bufferView': 1, 'componentType': 5121, 'count': 3000, 'type': 'SCALAR'}],
    'bufferViews': [{'buffer': 0, 'byteLength': 36}, {'buffer': 0, 'byteOffset': 36, 'byteLength': 3000}],
    'buffers': [{'byteLength': 3036, 'uri': 'data:;base64,' + base64.b64encode(buffer).decode()}]},
    open('instances.gltf', 'w'))
P
unfold unfold.dae
expect_error 6 'large\.obj' "$relief" bake large.obj -o x.relief --max-import-memory 64MB
(
    ulimit -v 2000000 -t 10
    expect_error 6 'instances\.gltf.*--max-triangles' "$relief" bake instances.gltf -o x.relief
)
expect_error 6 'unfold\.dae.*(import-timeout|max-import-memory)' "$relief" bake unfold.dae -o x.relief --import-timeout 2

filters() { # PID: the system call filters according to /proc
    grep -s '^Seccomp' "/proc/$1/status"
}

# start ARGUMENT…: bakes unfold.dae in the background, sets $parent and $worker, and stops the worker at once. On a busy
# machine the worker must not reach its memory limit first.
start() {
    nice -n 19 "$relief" bake unfold.dae --max-import-memory 8000000000 -o x.relief "$@" >"$work/stdout" 2>"$work/stderr" </dev/null &
    parent=$!
    worker=
    for _ in $(seq 500); do
        worker=$(cat "/proc/$parent/task/$parent/children" 2>/dev/null || true)
        worker=${worker%% *}
        # It is in its sandbox: a worker that dies earlier is restarted.
        [ -z "$worker" ] || [ "$(filters "$worker")" = "$(filters self)" ] || break
        sleep 0.01
    done
    [ -n "$worker" ] || die "no worker was started"
    kill -STOP "$worker"
}
expect_end() { # CODE PATTERN
    local code=0
    wait "$parent" || code=$?
    [ "$code" -eq "$1" ] && [ "$(wc -l <"$work/stderr")" -eq 1 ] && grep -qE "^relief: error: .*unfold\.dae.*$2" "$work/stderr" ||
        die "exit code $code instead of $1, or not one line with '$2': $(cat "$work/stderr")"
}

start --import-timeout 2
expect_end 6 'import-timeout'
gone "$worker" || die "a worker outlived its time limit"
start
kill -KILL "$worker"
expect_end 4 'SIGKILL'
start
kill -SEGV "$worker"
kill -CONT "$worker"
expect_end 3 'SIGSEGV'
start --import-timeout 600
kill -KILL "$parent"
wait "$parent" || true
kill -CONT "$worker" 2>/dev/null || true
gone "$worker" || die "a worker outlived its parent"

[ ! -e x.relief ] || die "an output despite an error"
[ -z "$(ls -A "$TMPDIR")" ] || die "temporary files: $(ls -A "$TMPDIR")"
