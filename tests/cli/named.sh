# SPDX-License-Identifier: Apache-2.0
# --as NAME=KIND on command lines and in recipes: the container records it, and a check rebuilds the same solid. Unit
# tests cover names in each format and the solid of each kind.
. "$(dirname "$0")/lib.sh"

cat >meshes.py <<'P'
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
# A box whose lid has another material and shares its edges.
for name, glass in (('car', 'glass'), ('odd', 'Fenster = "vorn" $x;\'é')):
    open(name + '.obj', 'w').write('\n'.join(box(0, ['g car', 'usemtl paint'], sides + [('+y', ['usemtl ' + glass])], 1)) + '\n')
P
python3 meshes.py

# expect_bake MESH COUNTS OPTIONS…: COUNTS are solids, solids with holes, sheets and terrains.
expect_bake() {
    expect 0 "$relief" bake "$1" -o out.relief --budget 60kB --no-check --json "${@:3}"
    cp stdout report.json
    json report.json "[d['shape'][k] for k in ('solids', 'solids_with_holes', 'sheets', 'terrains')] == [$2]"
}

# Two groups of different kinds. The check agrees.
expect_bake two.obj '1, 0, 1, 0'
cp out.relief plain.relief
expect_bake two.obj '0, 1, 1, 0' --as tub=solid --as garden=shell --thickness 0.2
json report.json "d['shape']['named'] == [{'name': 'tub', 'as': 'solid', 'triangles': 10}, {'name': 'garden', 'as': 'shell', 'triangles': 12}]"
json report.json "d['provenance']['options'].endswith(' --as tub=solid --as garden=shell --thickness 0.2')"
cp out.relief two.relief
expect 0 "$relief" check two.relief --mesh two.obj --samples 2000 --max-error 3 --json
json stdout "d['mesh']['shape']['named'][1] == {'name': 'garden', 'as': 'shell', 'triangles': 12} and d['mesh']['shape']['solids_with_holes'] == 1"
sed 's/^g tub left/g tab/' two.obj >renamed.obj
expect_error 3 "renamed\.obj.*'tub'" "$relief" check two.relief --mesh renamed.obj --samples 1000
expect_bake two.obj '0, 0, 2, 0' --as garden=auto --as wood=shell
grep -q 'warning: two.obj: --as garden=auto' stderr || die "no warning: $(cat stderr)"

# A name without effect changes no texel. Without names not even a byte changes.
expect_bake two.obj '1, 0, 1, 0' --as tub=auto --as garden=solid
"$relief" export plain.relief --engine c plain -q && "$relief" export out.relief --engine c same -q
cmp plain/plain.texels same/out.texels && cmp plain/plain.constants same/out.constants || die "names without effect change the texels"
expect_bake two.obj '1, 0, 1, 0' --as auto
cmp plain.relief out.relief || die "--as auto is not the default"

# Artists' names reach the container, the check and its suggested commands.
odd="Fenster = \"vorn\" \$x;'é=shell"
expect 0 "$relief" bake odd.obj -o rough.relief --budget 10kB --no-check --as "$odd"
expect 0 "$relief" check rough.relief --mesh odd.obj --samples 2000 --json
python3 - "$odd" <<'P' || die "the suggested commands lack the name: $(cat stdout)"
import json, shlex, sys
d = json.load(open('stdout'))
sys.exit(0 if d['mesh']['shape']['sheets'] == 2 and d['advice'] and all(sys.argv[1] in shlex.split(a['command']) for a in d['advice']) else 1)
P

# Unknown or contradictory names and kinds.
while read -r pattern options; do
    # shellcheck disable=SC2086
    expect_error 1 "$pattern" "$relief" bake two.obj -o x.relief $options
done <<'O'
two\.obj.*'tob'.*'tub' --as tob=solid
'tub=sold'.*'solid' --as tub=sold
'=solid' --as =solid
'shell' --as solid --as shell
'tub=shell' --as tub=solid --as tub=shell
--repair --as tub=solid --repair wrap
--holes --as tub=solid --holes keep
O
[ ! -e x.relief ] || die "an error left a file"

# Recipes: a string or a list. A change bakes again.
printf '%s\n' 'version = 1' '[defaults]' 'output = "{stem}.baked.relief"' 'budget = "60kB"' 'no-check = true' 'as = "shell"' '[[asset]]' \
    'mesh = "two.obj"' 'as = ["tub=solid", "garden=shell"]' 'thickness = 0.2' '[[asset]]' 'mesh = "car.obj"' >r.toml
expect 0 "$relief" bake --recipe r.toml -q
cmp two.relief two.baked.relief || die "recipe and command line give different bytes"
sed -i 's/tub=solid/tub=shell/' r.toml
expect 0 "$relief" bake --recipe r.toml -q --json
json stdout "[a['state'] for a in d['assets']] == ['baked', 'up_to_date']"
sed -i 's/tub=shell/tub=sheet/' r.toml
expect_error 3 "r\.toml:9:6: .*'tub=sheet'" "$relief" bake --recipe r.toml
