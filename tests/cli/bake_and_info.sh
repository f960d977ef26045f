# The baker and its report on a small closed mesh and on the bunny.
. "$(dirname "$0")/lib.sh"

cat >box.obj <<'O'
v -1 -2 -3
v 1 -2 -3
v 1 2 -3
v -1 2 -3
v -1 -2 3
v 1 -2 3
v 1 2 3
v -1 2 3
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 3 4 8 7
f 2 3 7 6
f 1 5 8 4
O

# The paper's set is three orthogonal front-back maps and one cube; the container says where it comes from.
expect 0 "$relief" bake box.obj -o box.relief --paper --resolution 64 -q
[ ! -s stderr ] || die "-q is not quiet"
expect 0 "$relief" info box.relief --json
cp stdout info.json
json info.json "[m['format'] for m in d['maps']] == ['front-back'] * 3 + ['cube']"
json info.json "d['version'] == '1.3'"
json info.json "d['bounds']['min'] == [-1, -2, -3] and d['bounds']['max'] == [1, 2, 3]"
json info.json "d['provenance']['mesh_name'] == 'box.obj' and len(d['provenance']['mesh_hash']) == 32"
json info.json "d['provenance']['triangles'] == 12"
json info.json "d['maps'][3]['compare'] == 'greater' and d['maps'][3]['width'] == 64"
expect 0 "$relief" info box.relief
grep -q 'front-back' stdout || die "info does not list the maps"

# A nearly closed mesh is baked as a solid, and the report says so; the container still names the mesh.
sed 's/^f 4 3 2 1$/f 4 3 2/' box.obj >open.obj
expect 0 "$relief" bake open.obj -o open.relief --map cube:size=16 --json
grep -q 'open.obj: closed 1 hole for baking: the mesh is nearly closed' stderr ||
    die "closing a hole is not reported: $(cat stderr)"
cp stdout report.json
json report.json "(d['closed_holes'], d['cap_triangles'], d['settings']['holes']) == (1, 1, 'close')"
json report.json "d['shape']['solids_with_holes'] == 1 and d['shape']['sheets'] == 0 and d['shape']['thickness'] is None"
json report.json "d['provenance']['triangles'] == 11 and '--holes' not in d['provenance']['options']"
expect 0 "$relief" bake open.obj -o kept.relief --map cube:size=16 --json --holes keep
cp stdout report.json
json report.json "(d['closed_holes'], d['cap_triangles'], d['settings']['holes'], d['shape']) == (0, 0, 'keep', None)"
json report.json "d['provenance']['options'].endswith(' --holes keep')"
cmp -s open.relief kept.relief && die "--holes keep closes holes"
expect_error 1 'holes.*close or keep' "$relief" bake open.obj -o bad.relief --holes fill

# A box without a bottom is walls with two sides, unless --as says otherwise; the container remembers how thick they are.
grep -v '^f 4 3 2 1' box.obj >walls.obj
expect 0 "$relief" bake walls.obj -o walls.relief --budget 100kB --thickness 0.2 --json
grep -q 'walls.obj: 1 sheet would be solid .* --as solid' stderr || die "--as solid is not recommended: $(cat stderr)"
cp stdout report.json
json report.json "d['shape']['closable_sheets'] == 1"
json report.json "d['shape']['sheets'] == 1 and abs(d['shape']['thickness'] - 0.2) < 1e-6 and d['wrong_percent'] < 5"
json report.json "d['provenance']['options'].endswith(' --thickness 0.2') and d['provenance']['triangles'] == 10"
json report.json "len(d['maps']) <= 8"
expect 0 "$relief" check walls.relief --mesh walls.obj --samples 2000 --max-error 5 --json
cp stdout report.json
json report.json "d['mesh']['shape']['sheets'] == 1 and abs(d['mesh']['shape']['thickness'] - 0.2) < 1e-6"
expect 0 "$relief" bake walls.obj -o solid.relief --budget 100kB --as solid --no-check --layout views --max-maps 2 --json
cp stdout report.json
json report.json "d['shape']['solids_with_holes'] == 1 and d['wrong_percent'] is None and len(d['maps']) <= 2"
json report.json "' --as solid' in d['provenance']['options']"
expect_error 1 'thickness.*walls.obj is 6 long' "$relief" bake walls.obj -o bad.relief --thickness 100
expect_error 1 'thickness.*a length above 0' "$relief" bake walls.obj -o bad.relief --thickness -1
expect_error 1 'as.*must be one of auto, solid, shell, terrain' "$relief" bake walls.obj -o bad.relief --as sheet

# --map takes every format, projection and compare; the effective settings are printed.
expect 0 "$relief" bake box.obj -o all.relief --resolution 32 --json \
    --map float:dir=+x --map float:dir=-y,compare=greater --map fixed8:dir=1/2/3,size=48x24 \
    --map front-back:dir=-z --map cube:size=16 --map cube:center=5/0/0,compare=less
cp stdout report.json
expect 0 "$relief" info all.relief --json
cp stdout info.json
json info.json "[(m['format'], m['compare']) for m in d['maps']] == [('float', 'less'), ('float', 'greater'), ('fixed8', 'less'), ('front-back', 'both'), ('cube', 'greater'), ('cube', 'less')]"
json info.json "(d['maps'][2]['width'], d['maps'][2]['height']) == (48, 24)"

# --decode and --depth apply to maps that do not set their own.
expect 0 "$relief" bake box.obj -o all.relief --resolution 16 --json --map front-back --map front-back:depth=unorm16 \
    --map cube:decode=plane --decode projected --depth half
json stdout "['half' in m for m in d['settings']['maps']] == [True, False, False]"
json stdout "['projected' in m for m in d['settings']['maps']] == [True, True, False]"
expect 0 "$relief" bake box.obj -o all.relief --resolution 16 --json --map front-back --map float:dir=+x,up=-z
json stdout "d['settings']['maps'] == ['front-back:dir=-z,size=16x16,depth=unorm16,decode=plane,box=tight', 'float:dir=+x,up=-z,size=16x16,compare=less,decode=plane,box=tight']"

# Threads, folder and output name do not change the bytes, compressed or not.
for threads in 1 2 5; do
    expect 0 "$relief" bake "$bunny" -o "t$threads.relief" --threads $threads -q
done
cmp t1.relief t2.relief || die "two threads bake other bytes than one"
cmp t1.relief t5.relief || die "five threads bake other bytes than one"
mkdir elsewhere
(cd elsewhere && "$relief" bake "$bunny" -o x.relief -q)
cmp t1.relief elsewhere/x.relief || die "another folder gives other bytes"
! grep -aq "$work" t1.relief || die "the output holds a path"

# An older output is replaced; no temporary file stays.
expect 0 "$relief" bake box.obj -o t1.relief --paper --resolution 32 -q
[ "$(ls -A elsewhere)" = x.relief ] || die "files left behind: $(ls -A elsewhere)"

# Help leads with an example, for every verb; versions are printed.
for verb in bake info query slice view export; do
    expect 0 "$relief" $verb --help
    head -8 stdout | matches "relief $verb " || die "help of $verb does not lead with an example"
done
expect 0 "$relief" --help
expect 0 "$relief" --version
grep -qE '[0-9]+\.[0-9]+\.[0-9]+' stdout || die "no version"
expect 0 "$relief_sim" --help
head -8 stdout | matches 'relief-sim ' || die "help of relief-sim does not lead with an example"
