# SPDX-License-Identifier: Apache-2.0
# OpenVDB: particles as points, and a collider's field as a level set and a mesh, compared with vdb_print and relief
# query. A build without OpenVDB prints one line about it.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o b.relief --budget 100kB -q
cat >s.toml <<'T'
[collider]
file = "b.relief"
[time]
steps = 60
[render]
steps_per_frame = 20
[emitter]
rate = 3000.0
T

if [ "$RELIEF_OPENVDB" != ON ]; then
    expect_error 5 'no OpenVDB .*relief-vdb.so is missing.*install libopenvdb-dev' "$relief" export b.relief --vdb b.vdb
    expect_error 5 'no OpenVDB' "$relief" export b.relief --mesh b.ply
    expect_error 5 'no OpenVDB' "$relief_sim" s.toml -q --dump s.vdb
    expect_error 5 'no OpenVDB' "$relief_sim" s.toml -q --dump-frames frames --dump-format vdb
    [ "$(ls)" = "$(printf 'b.relief\ns.toml\nstderr\nstdout')" ] || die "files were written: $(ls)"
    exit 0
fi

# The same particles as in PLY, with the usual attribute names.
"$relief_sim" s.toml -q --dump s.ply
"$relief_sim" s.toml -q --dump s.vdb
"$relief_sim" s.toml -q --dump - --dump-format vdb >again.vdb
cmp s.vdb again.vdb || die "equal runs write different bytes"
count=$(sed -n 's/^element vertex //p;/end_header/q' s.ply | head -1)
[ "$count" -gt 1000 ] || die "$count particles"
vdb_print -l s.vdb >printed
for words in 'name: particles' ptdataidx32 "points: $count\$"; do
    grep -q "$words" printed || die "vdb_print does not print '$words': $(cat printed)"
done
"$relief_sim" s.toml -q --dump-frames frames --dump-format vdb
[ "$(ls frames | tr '\n' ' ')" = "particles_0000.vdb particles_0001.vdb particles_0002.vdb " ] || die "frames: $(ls frames)"
cmp frames/particles_0002.vdb s.vdb || die "the last frame is not the final dump"
expect_error 1 'ply' "$relief_sim" s.toml --dump x --dump-format obj

# The level set, as another tool reads it.
expect 0 "$relief" export b.relief --vdb b.vdb --voxels 64
vdb_print -l b.vdb >printed
for words in 'Name: surface' 'level set' 'Tree_float'; do
    grep -q "$words" printed || die "vdb_print does not print '$words': $(cat printed)"
done
expect 0 "$relief" export b.relief --vdb - --voxels 64
cmp stdout b.vdb || die "standard output has a different level set"

# The mesh is closed, and its surface matches relief query.
expect 0 "$relief" export b.relief --mesh b.ply --voxels 96
python3 - <<'P' >points.csv || die "the mesh is not closed"
import struct
head, body = open('b.ply', 'rb').read().split(b'end_header\n', 1)
vertices = int(head.split(b'element vertex ')[1].split()[0])
faces = int(head.split(b'element face ')[1].split()[0])
points = [struct.unpack_from('<3f', body, 12 * i) for i in range(vertices)]
at, edges = 12 * vertices, {}
for _ in range(faces):
    n = body[at]
    face = struct.unpack_from(f'<{n}I', body, at + 1)
    at += 1 + 4 * n
    for a, b in zip(face, face[1:] + face[:1]):
        edges[a, b] = edges.get((a, b), 0) + 1
assert at == len(body) and faces > 10000
assert all(edges.get((b, a), 0) == times for (a, b), times in edges.items())
for p in points:
    print(','.join(map(repr, p)))
P
"$relief" query b.relief --points points.csv -o answers.csv
python3 - <<'P' || die "the mesh does not match the field's surface"
import csv, statistics
rows = list(csv.reader(open('answers.csv')))
distances = sorted(abs(float(row[3])) for row in rows if row[3] and row[0] != 'x')
assert statistics.median(distances) < 0.1 * 2 / 96, statistics.median(distances)
assert distances[int(0.99 * len(distances))] < 1.0 * 2 / 96, distances[int(0.99 * len(distances))]
P
expect_error 1 'no output; add' "$relief" export b.relief
expect_error 1 'has no effect without' "$relief" export b.relief -o maps --voxels 64
expect_error 1 'voxels' "$relief" export b.relief --vdb x.vdb --voxels 4
expect_error 1 'output .* is the input' "$relief" export b.relief --vdb b.relief
expect_error 2 'folder' "$relief" export b.relief --vdb nowhere/x.vdb
[ ! -e x.vdb ] || die "a rejected export left a file"
mkdir -p both
expect_error 1 '--mesh and --engine would both write' "$relief" export b.relief --mesh both/relief.glsl --engine c both
[ -z "$(ls both)" ] || die "a rejected export wrote files"
