# A worker reads meshes: its limits, its death, its parent's death; units and axes reach the container.
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
expect 0 "$relief" bake good.stl -o plain.relief "${small[@]}"
expect 0 "$relief" info plain.relief --json
json stdout "d['unit'] == '' and d['bounds']['max'] == [1, 2, 3] and '--u' not in d['provenance']['options']"
expect 0 "$relief" bake good.stl -o turned.relief "${small[@]}" --unit cm --up +z
expect 0 "$relief" info turned.relief --json
json stdout "d['unit'] == 'm' and d['provenance']['options'].endswith(' --unit cm --up +z')"
json stdout "all(abs(a - b) < 1e-6 for a, b in zip(d['bounds']['min'] + d['bounds']['max'], [0, 0, -.02, .01, .03, 0]))"
expect 0 "$relief" check turned.relief --mesh good.stl --samples 1000 --unit cm --up +z
expect_error 3 'bounds' "$relief" check turned.relief --mesh good.stl --samples 1000
expect_error 1 "unit.*'inch'.*one of m, cm" "$relief" bake good.stl -o x.relief --unit inch
expect_error 1 "up.*'z'.*\+z" "$relief" bake good.stl -o x.relief --up z
expect_error 1 'import-memory.*64MB' "$relief" bake good.stl -o x.relief --import-memory 1kB
expect_error 1 'import-time.*seconds' "$relief" bake good.stl -o x.relief --import-time 0

# What is no triangle is told; and a box by strips, which -1 ends, is the box by triangles.
python3 - <<'P'
corners = ''.join('%d %d %d\n' % (i & 1, i & 2, 3 * (i >> 2)) for i in range(8))
head = 'ply\nformat ascii 1.0\nelement vertex %d\n' + ''.join('property float %s\n' % axis for axis in 'xyz')
strips = [[0, 1, 4, 5, 6, 7, 2], [2, 7, 3], [2, 3, 0, 1], [0, 4, 2, 6], [1, 3, 5, 7]]
flat = ' -1 '.join(' '.join(map(str, strip)) for strip in strips)
faces = ''.join('3 %d %d %d\n' % (s[k + k % 2], s[k + 1 - k % 2], s[k + 2]) for s in strips for k in range(len(s) - 2))
lists = 'element %s %d\nproperty list int int vertex_indices\nend_header\n'
open('strips.ply', 'w').write(head % 8 + lists % ('tristrips', 1) + corners + '%d %s\n' % (len(flat.split()), flat))
open('faces.ply', 'w').write(head % 8 + lists % ('face', 12) + corners + faces)
open('loose.ply', 'w').write(head % 9 + lists % ('face', 12) + corners + '5 5 5\n' + faces)
open('cloud.ply', 'w').write(head % 8 + 'end_header\n' + corners)
P
for mesh in strips faces; do
    expect 0 "$relief" bake $mesh.ply -o $mesh.relief --map float:size=16 --json
    json stdout "d['provenance']['triangles'] == 12 and d['unused_vertices'] == 0 and d['warnings'] == []"
    json stdout "d['mesh_health']['solid']"
    "$relief" export $mesh.relief -o $mesh -q
done
diff -r strips faces || die "strips are baked to other maps than their triangles"
expect 0 "$relief" bake loose.ply -o loose.relief --map float:size=16
grep -q '^loose.ply: 12 triangles, 1 vertex of no triangle$' stderr || die "the report says: $(cat stderr)"
grep -q 'warning: .*1 of its 9 vertices belongs to no polygon' stderr || die "no warning: $(cat stderr)"
expect 0 "$relief" bake loose.ply -o loose.relief --map float:size=16 --json
json stdout "d['unused_vertices'] == 1"
expect_error 3 'cloud\.ply.*8 vertices but no faces' "$relief" bake cloud.ply -o x.relief

# Memory: a header of a few bytes may ask for too much, and a mesh of honest size must fit.
ply() {
    printf 'ply\nformat binary_little_endian 1.0\nelement vertex %s\nproperty float x\nproperty float y\n' "$1"
    printf 'property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n'
}
ply 99999999999 >count.ply
expect_error 6 'count\.ply.*has 99999999999 vertices, more than the limit' "$relief" bake count.ply -o x.relief
ply 300000000 >count.ply
expect_error 3 'count\.ply.*ends too early' "$relief" bake count.ply -o x.relief --import-memory 64MB
expect_error 6 'OutOfMemory\.off.*353535235358 vertices.*simplify' "$relief" bake "$models/invalid/OutOfMemory.off" -o x.relief
python3 - <<'P'
with open('large.obj', 'w') as file:
    file.writelines(f'v {i % 700} {i // 700} {i % 7}\n' for i in range(1490000))
    file.writelines(f'f {i + 1} {i + 2} {i + 701}\n' for i in range(1489000))
P
expect_error 6 'large\.obj.*more than 64000000 bytes' "$relief" bake large.obj -o x.relief --import-memory 64MB

# Instances: 90 million triangles in a few kilobytes are refused before there is one of them, and without much memory.
python3 - <<'P'
import base64, json, struct
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
(
    ulimit -v 2000000 -t 10
    expect_error 6 'instances\.gltf.*more than 20000000 triangles.*--max-triangles' \
        "$relief" bake instances.gltf -o x.relief
)
expect_error 6 'instances\.gltf.*--max-triangles' "$relief" bake instances.gltf -o x.relief --max-triangles 3
expect_error 1 'max-triangles.*1 to 100000000' "$relief" bake good.stl -o x.relief --max-triangles 200000000
expect 0 "$relief" bake good.stl -o x.relief "${small[@]}" --max-triangles 4
rm x.relief

# A COLLADA document whose nodes each stand for two of the next: 2⁴⁰ in all, which the importer begins to unfold.
python3 - <<'P'
nodes = ''.join(f'<node id="n{i}"><instance_node url="#n{i + 1}"/><instance_node url="#n{i + 1}"/></node>'
                for i in range(40))
open('unfold.dae', 'w').write(
    '<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>'
    f'<library_nodes>{nodes}<node id="n40"/></library_nodes><library_visual_scenes><visual_scene id="s"><node>'
    '<instance_node url="#n0"/></node></visual_scene></library_visual_scenes>'
    '<scene><instance_visual_scene url="#s"/></scene></COLLADA>')
P

filters() { # PID: what /proc says of its system call filters
    grep -s '^Seccomp' "/proc/$1/status"
}

# start ARGUMENT…: bakes unfold.dae in the background; sets $parent and its $worker, which is stopped at once. Both are
# slower than this script where the machine is busy: the worker must not reach its limit of memory before.
start() {
    nice -n 19 "$relief" bake unfold.dae --import-memory 8000000000 -o x.relief "$@" >"$work/stdout" 2>"$work/stderr" </dev/null &
    parent=$!
    worker=
    for _ in $(seq 500); do
        worker=$(cat "/proc/$parent/task/$parent/children" 2>/dev/null || true)
        worker=${worker%% *}
        # In its sandbox it has begun: what dies before is begun again.
        [ -z "$worker" ] || [ "$(filters "$worker")" = "$(filters self)" ] || break
        sleep 0.01
    done
    [ -n "$worker" ] || die "no worker was started"
    kill -STOP "$worker"
}

# ends CODE PATTERN: how it ended.
ends() {
    local code=0
    wait "$parent" || code=$?
    [ "$code" -eq "$1" ] || die "exit code $code instead of $1: $(cat "$work/stderr")"
    [ "$(wc -l <"$work/stderr")" -eq 1 ] || die "not one line of error: $(cat "$work/stderr")"
    grep -qE "^relief: error: .*unfold\.dae.*$2" "$work/stderr" || die "'$(cat "$work/stderr")' does not match '$2'"
}

gone() {
    for _ in $(seq 500); do
        # A zombie waits for its new parent only.
        grep -qs '^State:.[^ZX]' "/proc/$1/status" || return 0
        sleep 0.01
    done
    return 1
}

start --import-time 2
ends 6 'within 2 s.*import-time'
gone "$worker" || die "a worker outlived its time"

start
kill -KILL "$worker"
ends 4 'SIGKILL'

start
kill -SEGV "$worker"
kill -CONT "$worker"
ends 3 'crashed.*SIGSEGV'

start --import-time 600
kill -KILL "$parent"
wait "$parent" || true
kill -CONT "$worker" 2>/dev/null || true
gone "$worker" || die "a worker outlived its parent"

# A document that unfolds without end hits the limit of time or of memory.
expect_error 6 'unfold\.dae.*import-(time|memory)' "$relief" bake unfold.dae -o x.relief --import-time 2

[ ! -e x.relief ] || die "an output beside an error"
[ -z "$(ls -A "$TMPDIR")" ] || die "temporary files: $(ls -A "$TMPDIR")"
