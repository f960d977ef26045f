# SPDX-License-Identifier: Apache-2.0
# Height maps: one collider or tiles, equal for every file format, and checks against the height map. Unit tests cover
# the error bound, drops on seams, and invalid settings and files.
. "$(dirname "$0")/lib.sh"

heights() { python3 "$RELIEF_SOURCE/tests/cli/heights.py" "$@"; }

heights hills.png 130
heights hills.r16 130
settings=spacing=1,low=0,high=100
expect 0 "$relief" bake hills.png --heights $settings -o ground.relief --json --depfile ground.d
json stdout "d['columns'] == d['rows'] == 130 and len(d['tiles']) == 1 and d['tiles'][0]['squares'] == 129**2"
json stdout "d['heights'] == '$settings' and 0 < d['error_max'] < 0.03 and d['inputs'][0]['file'] == 'hills.png'"
[ "$(tr -d '\\\n' <ground.d | tr -s ' ')" = 'ground.relief: hills.png' ] || die "depfile: $(cat ground.d)"
expect 0 "$relief" check ground.relief
expect 0 "$relief" info ground.relief
grep -q -- "with --heights $settings" stdout || die "info: $(cat stdout)"

# Equal samples in another file or from a recipe give equal ground.
expect 0 "$relief" bake hills.r16 --heights high=100,low=0 -o raw.relief
python3 -c "
import random
r = random.Random(1)
print('\n'.join(f'{r.uniform(-1, 131)},{r.uniform(5, 60)},{r.uniform(-1, 131)}' for _ in range(2000)))" >points.csv
expect 0 "$relief" query ground.relief --points points.csv -o from_png.csv
expect 0 "$relief" query raw.relief --points points.csv -o from_raw.csv
cmp from_png.csv from_raw.csv || die "equal samples give different ground"
printf '%s\n' 'version = 1' '[[asset]]' 'mesh = "hills.png"' 'output = "hills.relief"' "heights = \"$settings\"" >recipe.toml
expect 0 "$relief" bake --recipe recipe.toml -q
cmp ground.relief hills.relief || die "a recipe gives different ground"

# Tiles form a world. A second bake removes files that it does not replace.
expect 0 "$relief" bake hills.png --heights $settings,tile=64 --world w --json
json stdout "len(d['tiles']) == 9 and d['output'] == 'w' and d['removed'] == []"
json w/world.json "d['unit'] == 'm' and [b['node'] for b in d['bodies']][:4] == ['tile 0 0', 'tile 1 0', 'tile 2 0', 'tile 0 1']"
json w/world.json "d['bodies'][4]['position'] == [64, 0, 64]"
expect 0 "$relief" check w/world.json
# The tiles give the same sides, decided by the body of the point's own tile.
expect 0 "$relief" query w/world.json --points points.csv -o world.csv
expect 0 "$relief" query ground.relief --points points.csv -o plane.csv --distance plane
python3 - <<'P' || die "world and collider differ"
import csv
world, ground = (list(csv.DictReader(open(name))) for name in ('world.csv', 'plane.csv'))
assert len(world) == len(ground) == 2000
for w, g in zip(world, ground):
    assert (float(w['f']) < 0) == (float(g['f']) < 0), (w, g)
    column, row = (min(max(float(w[axis]) // 64, 0), 2) for axis in 'xz')
    if float(w['f']) < 0 and all(4 < float(w[axis]) % 64 < 60 for axis in 'xz'):
        assert int(w['body']) == 3 * row + column, w
P
expect_error 1 "w/world.json.*--distance plane" "$relief" query w/world.json --points points.csv -o bad.csv --distance nearest
expect_error 1 "is the input" "$relief" query w/world.json --points points.csv -o "$(echo w/*-0-0-*.relief)"
expect_error 2 "missing/world.json" "$relief" query missing/world.json --points points.csv -o bad.csv
expect 0 "$relief" bake hills.png --heights $settings,tile=100,offset=5/-3/1 --world w --json
json stdout "len(d['tiles']) == 4 and len(d['removed']) == 9"
json w/world.json "d['bodies'][3]['position'] == [105, -3, 101]"
[ "$(find w -type f | wc -l)" -eq 5 ] || die "containers are left over: $(ls w)"

# Checks against the height map, with the settings of the bake and with others.
expect 0 "$relief" check ground.relief --mesh hills.png --samples 5000 --max-error 1
grep -q '^ground.relief: ground of hills.png, 130x130 samples' stdout || die "check: $(cat stdout)"
expect 0 "$relief" check w/world.json --mesh hills.png --json --samples 5000
json stdout "d['heights'] == 'spacing=1,low=0,high=100,offset=5/-3/1,tile=100' and d['near']['missing'] == d['seams']['missing'] == 0"
json stdout "0 < d['seams']['error']['max'] < 0.03 and d['seams']['wrong_percent'] < 1 and d['warnings'] == []"
expect 7 "$relief" check ground.relief --mesh hills.png --heights $settings,offset=0/0.5/0 --samples 5000 --max-error 10
grep -q 'set --mesh and --heights as in the bake, or raise' stderr || die "a shift is not detected: $(cat stderr)"
expect 0 "$relief" check ground.relief --mesh hills.r16 --samples 500
grep -q 'warning: hills.r16 is not the file' stderr || die "a different file: $(cat stderr)"
heights larger.png 140
expect_error 3 "larger.png" "$relief" check ground.relief --mesh larger.png

# The container records the settings, so check accepts any file name.
for file in c.bil c.bin c.dem c; do
    cp hills.r16 $file
    expect 0 "$relief" bake $file --heights $settings,width=130 -o c.relief
    expect 0 "$relief" check c.relief --mesh $file --samples 500 --json
    json stdout "d['heights'] == '$settings,width=130' and d['near']['wrong_percent'] < 1 and d['warnings'] == []"
done
"$relief" check c.relief --mesh - --samples 500 <c.bil >stdout || die "a height map from standard input"
"$relief" check - --mesh c.bil --samples 500 <c.relief >stdout || die "a collider from standard input"
expect 0 "$relief" bake c.bil --heights $settings,width=130,tile=64 --world cw
expect 0 "$relief" check cw/world.json --mesh c.bil --samples 500

# Cliffs are reported, and a cliff at a seam only once.
heights wide.png 130 step65
expect 0 "$relief" bake wide.png --heights low=0,high=655.35,tile=64 --world wide
grep -q 'warning: wide.png: 129 squares are steep:' stderr || die "the cliff: $(cat stderr)"

# Invalid calls and files: one line, and nothing is written.
rejects() { # CODE PATTERN FILE SETTINGS
    expect_error "$1" "$2" "$relief" bake "$3" --heights "$4" -o bad.relief
    [ ! -e bad.relief ] || die "a failed bake writes a file"
}
rejects 1 "spacing" hills.png spacin=1
head -c 3000 hills.png >cut.png
rejects 3 "cut.png" cut.png low=0,high=1
expect_error 3 "cut.png" "$relief" check ground.relief --mesh cut.png
rejects 2 "none.png" none.png low=0,high=1
rejects 5 "points.csv" points.csv low=0,high=1
truncate -s 2000000000 large.raw # 10⁹ samples; the sparse file uses no space
rejects 6 "large.raw" large.raw low=0,high=1
rm large.raw
expect_error 5 "hills.png.*--heights" "$relief" bake hills.png -o bad.relief
expect_error 1 "--budget" "$relief" bake hills.png --heights $settings -o bad.relief --budget 1MB
expect_error 1 "both name the output" "$relief" bake hills.png --heights $settings -o bad.relief --world v
expect 0 "$relief" bake hills.png --heights $settings -q
[ -s hills.relief ] || die "without -o: $(ls)"
expect_error 1 "tile= of --heights" "$relief" bake hills.png --heights $settings,tile=64 -o bad.relief
expect_error 1 "is required" "$relief" bake --heights $settings
expect_error 1 "--heights" "$relief" check ground.relief --heights $settings
expect_error 6 "10000000" "$relief" check ground.relief --mesh hills.png --samples 10000001
tetrahedron t.obj
"$relief" bake t.obj -o t.relief --map cube:size=16 -q
expect_error 1 "t.relief" "$relief" check t.relief --mesh hills.png
expect_error 5 "c.bil.*t.relief was not baked from a height map" "$relief" check t.relief --mesh c.bil
