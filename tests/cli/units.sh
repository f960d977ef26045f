# Units, axes and placements that a format states: boxes of every format, whose size is known, and random ones of a seed.
. "$(dirname "$0")/lib.sh"
export PYTHONPATH=$RELIEF_SOURCE/tests/cases PYTHONDONTWRITEBYTECODE=1

python3 - <<'P'
import pathlib
import unit_files as u
box = ((1, 2, 4), (1.5, 3, 7))
def write(name, data):
    pathlib.Path(name).write_bytes(data)
for unit in ("inch", "millimeter", "parsec"):
    write(unit + ".3mf", u.threemf(box, unit))
write("none.3mf", u.threemf(box))
write("comma.3mf", u.threemf(box, number=u.comma))
write("short.3mf", u.threemf(box, transform="1 0 0 0 1 0 0 0 1"))
write("turned.3mf", u.threemf(box, "meter", "0 1 0 -1 0 0 0 0 1 10 20 0"))
mesh = f'<object id="1">{u.mesh_3mf(box)}</object>'
item = '<item objectid="1"/>'
def archive(name, objects=mesh, items=item, attributes="", others=()):
    write(name, u.archive_3mf(u.model_3mf(objects, items, "meter", attributes), others))
archive("self.3mf", mesh + '<object id="2"><components><component objectid="2"/></components></object>',
        '<item objectid="2"/>')
archive("nowhere.3mf", items='<item objectid="7"/>')
archive("index.3mf", mesh.replace('v3="1"', 'v3="8"'))
archive("path.3mf", items='<item objectid="1" p:path="/3D/none.model"/>')
archive("beams.3mf", attributes='xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02" '
        'requiredextensions="b"')
archive("support.3mf", mesh + mesh.replace('id="1"', 'id="2" type="support"'), item + '<item objectid="2"/>')
archive("unplaced.3mf", mesh + mesh.replace('id="1"', 'id="2"'))
archive("names.3mf", '<basematerials id="9"><base name="steel" displaycolor="#fff"/></basematerials>'
        + mesh.replace('id="1"', 'id="1" name="axle" pid="9" pindex="0"'))
write("cut.3mf", u.threemf(box)[:-30])
flipped = bytearray(u.threemf(box))
flipped[flipped.find(b"3D/a.model") + 30] ^= 4
write("flipped.3mf", bytes(flipped))
write("stored.3mf", b"no archive")
# Many times one box: 2^40 of them in a few lines.
doubled = "".join(f'<object id="{i + 1}"><components><component objectid="{i}"/><component objectid="{i}"/></components>'
                  '</object>' for i in range(1, 41))
archive("many.3mf", mesh + doubled, '<item objectid="41"/>')
P
small=(--map fixed8:size=8 -q)

# lies FILE BOUNDS UNIT [OPTION…]: what it is baked to.
lies() {
    local file=$1 bounds=$2 unit=$3
    shift 3
    expect 0 "$relief" bake "$file" -o box.relief "${small[@]}" "$@"
    expect 0 "$relief" info box.relief --json
    json stdout "d['unit'] == '$unit' and all(abs(a - b) < 1e-5 * max(map(abs, $bounds)) for a, b in zip(d['bounds']['min'] + d['bounds']['max'], $bounds))"
}

lies inch.3mf '[.0254, .0508, .1016, .0381, .0762, .1778]' m
lies millimeter.3mf '[.001, .002, .004, .0015, .003, .007]' m
expect_error 3 "parsec.3mf.*'parsec'.*--unit" "$relief" bake parsec.3mf -o x.relief
lies parsec.3mf '[1, 2, 4, 1.5, 3, 7]' m --unit m
lies none.3mf '[.001, .002, .004, .0015, .003, .007]' m
lies turned.3mf '[7, 21, 4, 8, 21.5, 7]' m
lies support.3mf '[1, 2, 4, 1.5, 3, 7]' m
expect 0 "$relief" bake support.3mf -o x.relief --map fixed8:size=8
grep -q 'left out what supports it' stderr || die "no word of the support: $(cat stderr)"
expect 0 "$relief" bake unplaced.3mf -o x.relief --map fixed8:size=8
grep -q 'left out 1 of its 2 meshes' stderr || die "no word of what is not placed: $(cat stderr)"
for name in axle steel 1; do
    expect 0 "$relief" bake names.3mf -o x.relief "${small[@]}" --as $name=solid
done
expect_error 3 'comma.3mf.*line 1.*point for the comma' "$relief" bake comma.3mf -o x.relief
expect_error 3 'short.3mf.*fewer than 12' "$relief" bake short.3mf -o x.relief
expect_error 3 'self.3mf.*within itself' "$relief" bake self.3mf -o x.relief
expect_error 3 "nowhere.3mf.*'7'.*does not exist" "$relief" bake nowhere.3mf -o x.relief
expect_error 3 'index.3mf.*vertex 8 of 8' "$relief" bake index.3mf -o x.relief
expect_error 3 "path.3mf.*'3D/none.model'.*does not exist" "$relief" bake path.3mf -o x.relief
expect_error 5 'beams.3mf.*beamlattice.*required' "$relief" bake beams.3mf -o x.relief
expect_error 3 'cut.3mf.*cut off' "$relief" bake cut.3mf -o x.relief
expect_error 3 'flipped.3mf.*damaged' "$relief" bake flipped.3mf -o x.relief
expect_error 3 'stored.3mf.*no ZIP' "$relief" bake stored.3mf -o x.relief
expect_error 6 'many.3mf.*more than .* triangles' "$relief" bake many.3mf -o x.relief

python3 "$RELIEF_SOURCE/tests/cases/units_cases.py" "$RELIEF_BIN" --seed "${RELIEF_TEST_SEED:-1}" --cases 24
