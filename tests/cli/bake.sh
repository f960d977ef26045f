# SPDX-License-Identifier: Apache-2.0
# The container contents that bake options cause, as `relief info` prints them. Threads, folder and name do not change a
# byte.
. "$(dirname "$0")/lib.sh"

for library in epoxy libGL\\. EGL; do
    ! ldd "$relief" | matches "$library" || die "relief needs $library"
done

box box.obj 1 2 3

# The paper's maps are three orthogonal front-back maps and a cube. The container names its source.
expect 0 "$relief" bake box.obj -o box.relief --paper --resolution 64 -q
[ ! -s stderr ] || die "-q prints output"
expect 0 "$relief" info box.relief --json
json stdout "[m['format'] for m in d['maps']] == ['front-back'] * 3 + ['cube'] and d['version'] == '2.0'"
json stdout "d['bounds']['min'] == [-1, -2, -3] and d['bounds']['max'] == [1, 2, 3]"
json stdout "d['provenance']['mesh_name'] == 'box.obj' and len(d['provenance']['mesh_hash']) == 32 and d['provenance']['triangles'] == 12"
json stdout "d['maps'][3]['compare'] == 'greater' and d['maps'][3]['width'] == 64"
expect 0 "$relief" info box.relief
grep -q 'front-back' stdout || die "info does not list the maps"

# A hole is closed, or kept on request. The bake reports it, and the container records it.
sed 's/^f 4 3 2 1$/f 4 3 2/' box.obj >open.obj
expect 0 "$relief" bake open.obj -o open.relief --map cube:size=16 --json
grep -q 'open.obj: closed 1 hole' stderr || die "the closed hole is not reported: $(cat stderr)"
json stdout "(d['closed_holes'], d['cap_triangles'], d['settings']['holes']) == (1, 1, 'close') and d['shape']['solids_with_holes'] == 1"
json stdout "d['provenance']['triangles'] == 11 and '--holes' not in d['provenance']['options']"
expect 0 "$relief" bake open.obj -o kept.relief --map cube:size=16 --json --holes keep
json stdout "(d['closed_holes'], d['shape']) == (0, None) and d['provenance']['options'].endswith(' --holes keep')"
! cmp -s open.relief kept.relief || die "--holes keep closes holes"

# Walls have two sides unless --as overrides it. The container records their thickness for checks.
grep -v '^f 4 3 2 1' box.obj >walls.obj
expect 0 "$relief" bake walls.obj -o walls.relief --budget 100kB --thickness 0.2 --json
json stdout "d['shape']['sheets'] == 1 and abs(d['shape']['thickness_max'] - 0.2) < 1e-6 and d['wrong_percent'] < 5"
json stdout "d['provenance']['options'].endswith(' --thickness 0.2')"
expect 0 "$relief" check walls.relief --mesh walls.obj --samples 2000 --max-error 5 --json
json stdout "d['mesh']['shape']['sheets'] == 1 and abs(d['mesh']['shape']['thickness_max'] - 0.2) < 1e-6"
expect 0 "$relief" bake walls.obj -o solid.relief --budget 100kB --as solid --no-check --json
json stdout "d['shape']['solids_with_holes'] == 1 and d['wrong_percent'] is None"
json stdout "' --as solid' in d['provenance']['options']"

# --map accepts every format. --resolution, --decode and --depth apply to maps without their own settings.
expect 0 "$relief" bake box.obj -o all.relief --resolution 32 -q \
    --map float:dir=+x --map float:dir=-y,compare=greater --map fixed8:dir=1/2/3,size=48x24 \
    --map front-back:dir=-z --map cube:size=16 --map cube:center=5/0/0,compare=less
expect 0 "$relief" info all.relief --json
json stdout "[(m['format'], m['compare']) for m in d['maps']] == [('float', 'less'), ('float', 'greater'), ('fixed8', 'less'), ('front-back', 'both'), ('cube', 'greater'), ('cube', 'less')]"
json stdout "(d['maps'][2]['width'], d['maps'][2]['height']) == (48, 24)"
expect 0 "$relief" info all.relief
grep -qE '^         --map cube:[^ ]*$' stdout || die "options are not wrapped: $(cat stdout)"
expect 0 "$relief" bake box.obj -o all.relief --resolution 16 --json --map front-back --map front-back:depth=unorm16 \
    --map cube:decode=plane --decode projected --depth half
json stdout "[('half' in m, 'projected' in m) for m in d['settings']['maps']] == [(True, True), (False, True), (False, False)]"

# A probably missing unit is suggested. With --unit the size is in metres.
box large.obj 30 60 90
expect 0 "$relief" bake large.obj -o unit.relief --map cube:size=16 --json
json stdout 'any("no unit is named" in w for w in d["warnings"])'
for unit in cm m; do
    expect 0 "$relief" bake large.obj -o unit.relief --map cube:size=16 --unit $unit
    ! grep -q 'warning' stderr && grep -qE '^box [0-9.]+ x [0-9.]+ x [0-9.]+ m, from' stderr || die "with $unit: $(cat stderr)"
done

# Threads, folder and output name do not change a byte.
for threads in 1 2 5; do
    expect 0 "$relief" bake walls.obj -o "t$threads.relief" --budget 60kB --threads $threads -q
    cmp t1.relief "t$threads.relief" || die "$threads threads and one thread give different bytes"
done
mkdir elsewhere
(cd elsewhere && "$relief" bake ../walls.obj -o x.relief --budget 60kB -q)
cmp t1.relief elsewhere/x.relief || die "another folder gives different bytes"
! grep -aq "$work" t1.relief || die "the output contains a path"

# Without -o the output is in the current folder, and never replaces the mesh.
mkdir default
(cd default && expect 0 "$relief" bake ../box.obj --map cube:size=16 --json)
json stdout "d['settings']['output'] == 'box.relief'"
[ "$(ls default)" = box.relief ] || die "without -o: $(ls default)"
cp box.obj mesh.relief
expect_error 1 "'mesh.relief' is the input" "$relief" bake mesh.relief
cmp box.obj mesh.relief || die "the default output overwrote the mesh"
expect_error 1 'MESH is required' "$relief" bake

# Several files: each gets a report, even after a failed one.
cp default/box.relief one.relief
echo damaged >bad.relief
expect 3 "$relief" info one.relief bad.relief box.relief
[ "$(grep -E '^[a-z]+\.relief:$' stdout | xargs)" = 'one.relief: bad.relief: box.relief:' ] || die "info: $(cat stdout)"
[ "$(wc -l <stderr)" = 2 ] && grep -q "error: 'bad.relief'" stderr && grep -q "error: 1 of 3 files failed, first 'bad.relief'" stderr || die "info: $(cat stderr)"
expect 0 "$relief" info one.relief box.relief --json
[ "$(python3 -c 'import json; text = open("stdout").read(); print([json.loads(d + "\n}")["file"] for d in text.split("\n}\n") if d])')" = "['one.relief', 'box.relief']" ] || die "info: $(cat stdout)"
expect 3 "$relief" check one.relief bad.relief box.relief
grep -q '^one.relief: sound' stdout && grep -q '^box.relief: sound' stdout && grep -q "1 of 3 files failed" stderr || die "check: $(cat stdout stderr)"
expect_error 1 'mesh needs a single FILE' "$relief" check one.relief box.relief --mesh box.obj

# A level in one collider.
for i in $(seq 0 3 297); do
    printf 'o n%d\nv %d 0 0\nv %d 1 0\nv %d 0 1\nf %d %d %d\n' "$i" "$i" "$i" $((i + 1)) $((i + 1)) $((i + 2)) $((i + 3))
done >level.obj
expect 0 "$relief" bake level.obj -o level.relief --map cube:size=16
grep -q 'level.obj: 100 nodes become one collider; .* --world DIR' stderr || die "a level: $(cat stderr)"
expect 0 "$relief" bake box.obj -o level.relief --map cube:size=16
! grep -e --world stderr || die "a box is not a level"

# An existing output is replaced, without leftover temporary files.
expect 0 "$relief" bake box.obj -o elsewhere/x.relief --paper --resolution 32 -q
[ "$(ls -A elsewhere)" = x.relief ] || die "files left behind: $(ls -A elsewhere)"

# Random numbers of the library, functions whose last bits vary, and clocks must not affect outputs.
# formats/base/portable_math.h replaces the functions. Benchmarks are exempt.
found=$(cd "$RELIEF_SOURCE" && grep -rnE --include=*.cpp --include=*.h --include=CMakeLists.txt \
    'std::(sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|exp|exp2|expm1|log|log2|log10|log1p|pow|hypot|cbrt|tgamma|lgamma|erf|erfc)\(|(uniform_(int|real)|normal|bernoulli|poisson|discrete)_distribution|random_device|random_shuffle|std::(shuffle|sample)\(|unordered_(map|set)|std::hash|__DATE__|__TIME__|std::time\(|system_clock|setlocale|-ffast-math|-march=|rtcNewDevice\(nullptr' \
    bake formats CMakeLists.txt | grep -vE '^bake/bench/' || true)
[ -z "$found" ] || die "results that vary between machines could affect outputs:"$'\n'"$found"
grep -q -- '-ffp-contract=off' "$RELIEF_SOURCE/CMakeLists.txt" || die "floating-point contraction is not off"
