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

# The mesh. LevelSet.* and SurfaceMesh.* compare it with closed forms.
expect 0 "$relief" export b.relief --mesh b.ply --voxels 96
head -c 400 b.ply | grep -aqE '^element face [0-9]{5}' || die "the mesh has few faces: $(head -c 400 b.ply)"
expect_error 1 'no output; add' "$relief" export b.relief
expect_error 1 'has no effect without' "$relief" export b.relief -o maps --voxels 64
expect_error 1 'voxels' "$relief" export b.relief --vdb x.vdb --voxels 4
expect_error 1 'output .* is the input' "$relief" export b.relief --vdb b.relief
expect_error 2 'folder' "$relief" export b.relief --vdb nowhere/x.vdb
[ ! -e x.vdb ] || die "a rejected export left a file"
mkdir -p both
expect_error 1 '--mesh and --engine would both write' "$relief" export b.relief --mesh both/relief.glsl --engine c both
[ -z "$(ls both)" ] || die "a rejected export wrote files"
