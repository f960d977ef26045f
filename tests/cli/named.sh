# --as NAME=KIND: what has a name in the file is taken for what the user says, in OBJ and glTF, on command lines and in
# recipes; the container remembers it, and a check rebuilds the same solid.
. "$(dirname "$0")/lib.sh"

cat >meshes.py <<'P'
import base64, json, struct

CORNERS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
FACES = {'-z': (0, 2, 3, 1), '+z': (4, 5, 7, 6), '-y': (0, 1, 5, 4), '+y': (2, 6, 7, 3), '-x': (0, 4, 6, 2), '+x': (1, 3, 7, 5)}

def box(x, head, faces, first):
    """With a line of its own before each face."""
    lines = [f'v {x + c[0]} {c[1]} {c[2]}' for c in CORNERS] + head
    for name, line in faces:
        lines += line + ['f ' + ' '.join(str(first + i) for i in FACES[name])]
    return lines

sides = [(name, []) for name in FACES if name != '+y']
open('two.obj', 'w').write('\n'.join(
    box(0, ['g tub left', 'usemtl wood'], sides, 1) +
    box(4, ['o garden house', 'usemtl wood'], sides + [('+y', [])], 9)) + '\n')
# A box whose lid is of another material, and shares its edges.
open('car.obj', 'w').write('\n'.join(
    box(0, ['g car', 'usemtl paint'], sides + [('+y', ['usemtl glass'])], 1)) + '\n')

points = [i for name in FACES for i in FACES[name]]
indices = [4 * f + k for f in range(6) for k in (0, 1, 2, 0, 2, 3)]
buffer = b''.join(struct.pack('<3f', *CORNERS[i]) for i in points) + struct.pack('<36H', *indices)
def primitive(accessor, material):
    return {'attributes': {'POSITION': 0}, 'indices': accessor, 'material': material}
def view(offset, length):
    return {'buffer': 0, 'byteOffset': offset, 'byteLength': length}
def accessor(offset, count):
    return {'bufferView': 1, 'byteOffset': offset, 'componentType': 5123, 'count': count, 'type': 'SCALAR'}
# The fourth face is the lid.
json.dump({
    'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}],
    'nodes': [{'name': 'street', 'children': [1, 2]}, {'name': 'first', 'mesh': 0},
              {'name': 'second', 'mesh': 0, 'translation': [4, 0, 0]}],
    'materials': [{'name': 'paint'}, {'name': 'glass'}],
    'meshes': [{'primitives': [primitive(1, 0), primitive(2, 1), primitive(3, 0)]}],
    'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 24, 'type': 'VEC3', 'min': [-1] * 3, 'max': [1] * 3},
                  accessor(0, 18), accessor(36, 6), accessor(48, 12)],
    'bufferViews': [view(0, 288), view(288, 72)],
    'buffers': [{'byteLength': 360, 'uri': 'data:application/octet-stream;base64,' + base64.b64encode(buffer).decode()}]},
    open('cars.gltf', 'w'))
open('points.csv', 'w').write('x,y,z\n0,0,0\n4,0,0\n0.2,1.05,0.3\n0.2,-1.02,0.3\n')
P
python3 meshes.py
small=(--budget 60kB --no-check)

# bakes MESH SHAPE OPTIONS…: SHAPE as Python over `s`.
bakes() {
    expect 0 "$relief" bake "$1" -o out.relief "${small[@]}" --json "${@:3}"
    cp stdout report.json
    python3 - "$2" <<'P' || die "'$*' finds $(python3 -c 'import json; print(json.load(open("report.json"))["shape"])')"
import json, sys
s = json.load(open('report.json'))['shape']
sys.exit(0 if eval(sys.argv[1]) else 1)
P
}
counts='(s["solids"], s["solids_with_holes"], s["sheets"], s["terrains"])'

# Two groups, each as it is said; the check finds the same, and so does the shader's side: queries.
bakes two.obj "$counts == (1, 0, 1, 0) and s['named'] == []"
cp out.relief plain.relief
bakes two.obj "$counts == (0, 1, 1, 0) and s['named'] == [{'name': 'tub', 'as': 'solid', 'triangles': 10}, {'name': 'garden', 'as': 'shell', 'triangles': 12}]" \
    --as tub=solid --as garden=shell --thickness 0.2
json report.json "d['provenance']['options'].endswith(' --as tub=solid --as garden=shell --thickness 0.2')"
cp out.relief two.relief
expect 0 "$relief" query two.relief --points points.csv -o field.csv
python3 - <<'P' || die "the tub is not full, or the house not empty: $(cat field.csv)"
import csv, sys
f = [float(row['f']) for row in csv.DictReader(open('field.csv'))]
sys.exit(0 if f[0] < 0 and f[1] > 0 else 1)
P
expect 0 "$relief" check two.relief --mesh two.obj --samples 2000 --max-error 3 --json
json stdout "d['mesh']['shape']['named'][1] == {'name': 'garden', 'as': 'shell', 'triangles': 12}"
json stdout "d['mesh']['shape']['solids_with_holes'] == 1 and d['mesh']['shape']['sheets'] == 1"
expect 0 "$relief" check two.relief --mesh two.obj --samples 2000
grep -q '^shape: .*; tub (10 triangles) as solid; garden (12 triangles) as shell$' stdout || die "check says: $(cat stdout)"
# The same mesh with other names is another one.
sed 's/^g tub left/g tab/' two.obj >renamed.obj
expect_error 3 "renamed\.obj.*'tub'; did you mean 'tab'.*give --mesh the mesh" "$relief" check two.relief --mesh renamed.obj --samples 1000
# The default is for what has no name.
bakes two.obj "$counts == (1, 0, 1, 0) and s['as'] == 'shell'" --as shell --as garden=auto
bakes two.obj "$counts == (0, 0, 2, 0)" --as garden=auto --as wood=shell
grep -q 'warning: two.obj: --as garden=auto changes nothing: a later --as' stderr || die "no warning: $(cat stderr)"
bakes two.obj "$counts == (1, 0, 1, 0)" --as wood=shell --as garden=auto
[ ! -s stderr ] || grep -qv warning stderr || die "a warning: $(cat stderr)"

# A name that changes nothing changes no texel; without one, not even a byte.
bakes two.obj "$counts == (1, 0, 1, 0)" --as tub=auto --as garden=solid
"$relief" export plain.relief -o plain -q && "$relief" export out.relief -o same -q
diff -r plain same || die "names that say what is so anyway change the texels"
expect 0 "$relief" bake two.obj -o again.relief "${small[@]}" -q --as auto
cmp plain.relief again.relief || die "--as auto is not the default"

# A material that shares its edges is a part of its own, and what is closed stays whole where nothing is a wall.
bakes car.obj "$counts == (1, 0, 0, 0)"
bakes car.obj "$counts == (0, 0, 2, 0)" --as glass=shell
bakes car.obj "$counts == (0, 1, 1, 0)" --as glass=shell --as paint=solid --thickness 0.2
expect 0 "$relief" query out.relief --points points.csv -o field.csv
python3 - <<'P' || die "the car is not full below its glass: $(cat field.csv)"
import csv, sys
f = [float(row['f']) for row in csv.DictReader(open('field.csv'))]
sys.exit(0 if f[0] < 0 and f[2] < 0 and f[3] > 0 else 1)
P
expect 0 "$relief" check out.relief --mesh car.obj --samples 2000 --max-error 3
bakes car.obj "$counts == (1, 0, 0, 0)" --as paint=solid
bakes car.obj "$counts == (0, 0, 1, 0)" --as car=shell

# glTF: a node and all below it, of instances each, and materials.
bakes cars.gltf "$counts == (2, 0, 0, 0)"
bakes cars.gltf "$counts == (1, 0, 1, 0) and s['named'][0]['triangles'] == 12" --as second=shell
bakes cars.gltf "$counts == (0, 0, 2, 0) and s['named'][0]['triangles'] == 24" --as street=shell
bakes cars.gltf "$counts == (0, 0, 4, 0) and s['named'][0]['triangles'] == 4" --as glass=shell
bakes cars.gltf "$counts == (1, 0, 2, 0)" --as glass=shell --as first=solid
expect 0 "$relief" check out.relief --mesh cars.gltf --samples 2000

# Names as artists give them reach the container, the check and the commands that it advises.
sed "s/^usemtl glass/usemtl Fenster = \"vorn\" \$x;'é/" car.obj >names.obj
bakes names.obj "s['named'][0]['name'] == 'Fenster = \"vorn\" \$x;\'é'" --as "Fenster = \"vorn\" \$x;'é=shell"
json report.json "'Fenster = \"vorn\" \$x;\'é=shell' in __import__('shlex').split(d['provenance']['options'])"
expect 0 "$relief" check out.relief --mesh names.obj --samples 2000 --json
json stdout "d['mesh']['shape']['sheets'] == 2"
expect 0 "$relief" bake names.obj -o rough.relief --budget 10kB --no-check --as "Fenster = \"vorn\" \$x;'é=shell"
expect 0 "$relief" check rough.relief --mesh names.obj --samples 2000 --json
cp stdout check.json
python3 - <<'P' || die "the advised commands lack the name: $(cat check.json)"
import json, shlex, sys
word = 'Fenster = "vorn" $x;\'é=shell'
advice = json.load(open('check.json'))['advice']
sys.exit(0 if advice and all(word in shlex.split(a['command']) for a in advice) else 1)
P

# What no name has, and what is no kind.
expect_error 1 "two\.obj.*'tob'; did you mean 'tub'\? It has 'tub left', 'tub', 'left', 'wood', 'garden'" "$relief" bake two.obj -o x.relief --as tob=solid
expect_error 1 "two\.obj.*names no triangles '-o'; it has" "$relief" bake two.obj -o x.relief --as -o=solid
expect_error 1 "as is 'tub=sold' but.*did you mean 'solid'" "$relief" bake two.obj -o x.relief --as tub=sold
expect_error 1 "as is '=solid' but" "$relief" bake two.obj -o x.relief --as =solid
expect_error 1 "as is 'shell' but another --as says solid" "$relief" bake two.obj -o x.relief --as solid --as shell
expect_error 1 "as is 'tub=shell' but another --as has the same name" "$relief" bake two.obj -o x.relief --as tub=solid --as tub=shell
expect_error 1 'NAME=KIND.*--repair' "$relief" bake two.obj -o x.relief --as tub=solid --repair wrap
expect_error 1 'NAME=KIND.*--holes keep' "$relief" bake two.obj -o x.relief --as tub=solid --holes keep
[ ! -e x.relief ] || die "an error left a file"

# Recipes: a string or a list, checked before anything is baked; a change bakes again.
cat >r.toml <<'R'
version = 1
[defaults]
output = "{stem}.baked.relief"
budget = "60kB"
no-check = true
as = "shell"
[[asset]]
mesh = "two.obj"
as = ["tub=solid", "garden=shell"]
thickness = 0.2
[[asset]]
mesh = "car.obj"
R
expect 0 "$relief" bake --recipe r.toml -q
cmp two.relief two.baked.relief || die "a recipe bakes other bytes than its options"
expect 0 "$relief" info car.baked.relief --json
json stdout "' --as shell --thickness' in d['provenance']['options']"
sed -i 's/tub=solid/tub=shell/' r.toml
expect 0 "$relief" bake --recipe r.toml -q --json
json stdout "[a['state'] for a in d['assets']] == ['baked', 'up to date']"
sed -i 's/tub=shell/tub=sheet/' r.toml
expect_error 3 "r\.toml:9:6: --as is 'tub=sheet' but" "$relief" bake --recipe r.toml
