# SPDX-License-Identifier: Apache-2.0
# Every verb on the bunny and on meshes of other formats: glTF, COLLADA, STL, PLY, OFF, 3DS and more.
. "$(dirname "$0")/lib.sh"

printf '0,0,0\n100,100,100\n' >points.csv
count=0
for mesh in "$bunny" "$models"/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb "$models"/Collada/duck.dae \
    "$models"/STL/Spider_ascii.stl "$models"/PLY/Wuson.ply "$models"/OFF/Wuson.off "$models"/3DS/fels.3ds \
    "$models"/FBX/spider.fbx "$models"/OBJ/spider.obj "$models"/LWO/LWO2/box_2uv_1unused.lwo; do
    [ -f "$mesh" ] || die "no such mesh: $mesh"
    count=$((count + 1))
    expect 0 "$relief" bake "$mesh" -o m.relief --budget 200kB
    expect 0 "$relief" info m.relief --json
    json stdout "d['provenance']['triangles'] > 0 and len(d['maps']) > 0"
    images=$(python3 -c "import json; print(sum(m['faces'] for m in json.load(open('stdout'))['maps']))")
    expect 0 "$relief" query m.relief --points points.csv -o out.csv
    [ "$(wc -l <out.csv)" -eq 3 ] || die "query lost points"
    expect 0 "$relief" query m.relief --points points.csv -o out.csv --distance plane
    expect 0 "$relief" slice m.relief --axis y --at center --size 64 -o slice.png
    expect 0 "$relief" export m.relief -o "maps$count"
    [ "$(find "maps$count" -name '*.exr' | wc -l)" -eq "$images" ] || die "export wrote $(ls "maps$count")"
    expect 0 "$relief_sim" m.relief --steps 5 --json
    json stdout "d['particles']['alive'] > 0"
    echo "$(basename "$mesh"): good"
done
[ "$count" -ge 6 ] || die "only $count meshes"
