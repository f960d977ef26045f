# Height maps: one collider or tiles, the same from every file, and hostile ones in one line.
. "$(dirname "$0")/lib.sh"

heights() { python3 "$RELIEF_SOURCE/tests/cli/heights.py" "$@"; }

heights hills.png 150
heights hills.r16 150
settings=spacing=1,low=0,high=100
expect 0 "$relief" bake hills.png --heights $settings -o ground.relief --json --depfile ground.d
cp stdout report.json
json report.json "d['columns'] == d['rows'] == 150 and len(d['tiles']) == 1 and d['tiles'][0]['squares'] == 149**2"
json report.json "d['heights'] == '$settings' and 0 < d['error_max'] < 0.03 and d['inputs'][0]['file'] == 'hills.png'"
[ "$(tr -d '\\\n' <ground.d | tr -s ' ')" = 'ground.relief: hills.png' ] || die "depfile: $(cat ground.d)"
expect 0 "$relief" check ground.relief
expect 0 "$relief" info ground.relief
grep -q -- "with --heights $settings" stdout || die "info: $(cat stdout)"

# Samples are the same from another file, and threads change nothing.
cp ground.relief first.relief
expect 0 "$relief" bake hills.png --heights $settings -o ground.relief -j 1 -q
cmp first.relief ground.relief || die "threads change the ground"
expect 0 "$relief" bake hills.r16 --heights high=100,low=0 -o raw.relief
grep -q '^raw.relief: ground of 150x150 samples, nowhere off by more than' stderr || die "no line: $(cat stderr)"
python3 -c "
import random
r = random.Random(1)
print('\n'.join(f'{r.uniform(-1, 151)},{r.uniform(5, 60)},{r.uniform(-1, 151)}' for _ in range(2000)))" >points.csv
expect 0 "$relief" query ground.relief --points points.csv -o from_png.csv
expect 0 "$relief" query raw.relief --points points.csv -o from_raw.csv
cmp from_png.csv from_raw.csv || die "the same samples are other ground"

# Tiles, again by other threads, and found by whoever reads worlds.
expect 0 "$relief" bake hills.png --heights $settings,tile=64 --world w --json
json stdout "len(d['tiles']) == 9 and d['output'] == 'w' and d['removed'] == []"
json w/world.json "d['unit'] == 'm' and [b['node'] for b in d['bodies']][:4] == ['tile 0 0', 'tile 1 0', 'tile 2 0', 'tile 0 1']"
json w/world.json "d['bodies'][4]['position'] == [64, 0, 64] and d['colliders'][4]['min'][0] == -4"
expect 0 "$relief" check w/world.json
expect 0 "$relief" bake hills.png --heights $settings,tile=64 --world one -j 1 -q
diff -r w one || die "threads change the world"

# Drops on both sides of the seams at x = 64 and z = 64, in the shaders: none is below the ground, none is thrown up.
python3 - >scene.toml <<'P'
import json
world = json.load(open("w/world.json"))
print('[time]\nsteps = 180\n[particles]\ncapacity = 4096\n[forces]\ngravity = [0.0, -9.81, 0.0]')
print('[[type]]\nname = "drop"\non_collision = "bounce"\nrestitution = 0.2\nfriction = 0.6')
for low, high in (([63.95, 56, 20], [64.05, 58, 120]), ([20, 56, 63.95], [120, 58, 64.05])):
    print(f'[[emitter]]\ntype = "drop"\nbox_min = {low}\nbox_max = {high}\nrate = 2000\nlifetime = 100')
for body in world["bodies"]:
    print(f'[[collider]]\nfile = "w/{world["colliders"][body["collider"]]["file"]}"\nposition = {body["position"]}')
P
expect 0 "$relief_sim" scene.toml --dump drops.ply -q
python3 "$RELIEF_SOURCE/tests/cli/heights.py" --below drops.ply 100 >below
python3 -c "
count, below, highest = map(float, open('below').read().split())
assert count > 2000 and -0.05 < below < 0.05 and highest < 58, (count, below, highest)" || die "drops on seams: $(cat below)"

expect 0 "$relief" bake hills.png --heights $settings,tile=100,offset=5/-3/1 --world w --json
json stdout "len(d['tiles']) == 4 and len(d['removed']) == 9"
json w/world.json "d['bodies'][3]['position'] == [105, -3, 101]"
[ "$(find w -type f | wc -l)" -eq 5 ] || die "containers are left over: $(ls w)"

# Against the height map: with the settings that it was baked with, and with others.
expect 0 "$relief" check ground.relief --mesh hills.png --max-error 1
grep -q '^ground.relief: ground of hills.png, 150x150 samples; 22201 squares with ground' stdout || die "check: $(cat stdout)"
expect 0 "$relief" check w/world.json --mesh hills.png --json --samples 20000
json stdout "d['heights'] == 'spacing=1,low=0,high=100,offset=5/-3/1,tile=100' and d['near']['missing'] == d['seams']['missing'] == 0"
json stdout "0 < d['seams']['error']['max'] < 0.03 and d['seams']['wrong_percent'] < 1 and d['anywhere']['wrong_percent'] < 0.1"
json stdout "len(d['worst']) == 10 and d['worst'][0]['node'].startswith('tile ') and d['warnings'] == []"
expect 7 "$relief" check ground.relief --mesh hills.png --heights $settings,offset=0/0.5/0 --max-error 10
grep -q 'more than --max-error 10 %; bake it again from' stderr || die "a shift passes: $(cat stderr)"
expect 0 "$relief" check ground.relief --mesh hills.r16
grep -q 'warning: hills.r16 is another file than the one that ground.relief was baked from' stderr || die "another file: $(cat stderr)"
heights larger.png 160
expect_error 3 "larger.png: its ground lies from .0, 0. to .159, 159. in x and z, and that of ground.relief .* give the height map" \
    "$relief" check ground.relief --mesh larger.png
expect_error 2 "none.png" "$relief" check ground.relief --mesh none.png
head -c 3000 hills.png >cut.png
expect_error 3 "cut.png.*cannot be read as PNG" "$relief" check ground.relief --mesh cut.png
expect_error 1 "spacing is 'nan'" "$relief" check ground.relief --mesh hills.png --heights spacing=nan
expect_error 1 "--html is for meshes" "$relief" check ground.relief --mesh hills.png --html x.html
expect_error 1 "--unit is for meshes" "$relief" check ground.relief --mesh hills.png --unit m
expect_error 6 "limit is 10000000" "$relief" check ground.relief --mesh hills.png --samples 10000001
expect_error 1 "--heights requires --mesh" "$relief" check ground.relief --heights $settings
cp "$bunny" bunny.obj
expect 0 "$relief" bake bunny.obj --budget 32kB -o bunny.relief -q
expect_error 1 "bunny.relief was not baked from a height map; give" "$relief" check bunny.relief --mesh hills.png

# A recipe.
cat >recipe.toml <<'T'
version = 1
[[asset]]
mesh = "hills.png"
output = "hills.relief"
heights = "spacing=1,low=0,high=100"
T
expect 0 "$relief" bake --recipe recipe.toml -q
cmp first.relief hills.relief || die "a recipe bakes other ground"

# No variation, and a step.
heights flat.png 40 flat
expect 0 "$relief" bake flat.png --heights low=0,high=65535 -o flat.relief -q
heights step.png 40 step
expect 0 "$relief" bake step.png --heights low=0,high=65.535 -o step.relief -q
expect 0 "$relief" bake step.png --heights low=0,high=655.35 -o step.relief
grep -q 'warning: step.png: 39 squares are steeper than 71 degrees' stderr || die "no word of cliffs: $(cat stderr)"

# A cliff beside a seam is counted once, and the summary leaves it out.
heights wide.png 130 step65
expect 0 "$relief" bake wide.png --heights low=0,high=655.35,tile=64 --world wide
grep -q 'warning: wide.png: 129 squares are steeper than 71 degrees' stderr || die "another cliff: $(cat stderr)"
grep -q 'along y but where it is steep; ' stderr || die "a summary without the cliff: $(cat stderr)"

# Bad calls and bad files: one line with the cure, and nothing is written.
bad() { # bad CODE PATTERN FILE SETTINGS
    expect_error "$1" "$2" "$relief" bake "$3" --heights "$4" -o bad.relief
    [ ! -e bad.relief ] || die "a failed bake writes"
}
bad 1 "low is 5 but must be below high, 1; swap" hills.png low=5,high=1
bad 1 "spacing is 'nan' but must be" hills.png spacing=nan,low=0,high=1
bad 1 "spacing is 'inf' but must be" hills.png spacing=inf,low=0,high=1
bad 1 "hills.png.*needs high=" hills.png low=0
bad 1 "did you mean 'spacing'" hills.png spacin=1
bad 1 "tile is '0'" hills.png tile=0
head -c 30000 hills.r16 >cut.r16
bad 3 "cut.r16.*30000 bytes, which are no square.*width=N" cut.r16 low=0,high=1
heights one.png 1
bad 3 "one.png.*1x1 samples.*at least 2x2" one.png low=0,high=1
heights colour.png 8 rgb
bad 5 "colour.png.*in colour at column 0 of row 0; save it as grey" colour.png low=0,high=1
head -c 3000 hills.png >cut.png
bad 3 "cut.png.*cannot be read as PNG" cut.png low=0,high=1
bad 3 "flat.png: no square has ground" flat.png low=0,high=1,hole=1234
bad 2 "none.png.*No such file" none.png low=0,high=1
bad 5 "points.csv.*no PNG or EXR image" points.csv low=0,high=1
truncate -s 2000000000 large.raw # 10⁹ samples, which take no room
bad 6 "large.raw" large.raw low=0,high=1
truncate -s 600000000 large.raw
bad 6 "large.raw.*30000x10000 samples, and 268435456 are the most; cut it" large.raw low=0,high=1,width=30000
rm large.raw
bad 6 "step.png: it lies so far from the origin" step.png low=0,high=1,spacing=0.3,offset=0/0/5000000
bad 6 "step.png: its heights are so far from 0" step.png low=6000,high=6000.001,spacing=0.0001
bad 6 "step.png: .*larger spacing" step.png low=0,high=1000000000,spacing=0.000001
expect_error 5 "hills.png.*no mesh format.*height map, bake it with relief bake --heights" "$relief" bake hills.png -o bad.relief
expect_error 1 "--budget is for meshes" "$relief" bake hills.png --heights $settings -o bad.relief --budget 1MB
expect_error 1 "--unit is for meshes" "$relief" bake hills.png --heights $settings -o bad.relief --unit m
expect_error 1 "two ways" "$relief" bake hills.png --heights $settings -o bad.relief --world v
expect_error 1 "is required" "$relief" bake hills.png --heights $settings
expect_error 1 "is the input" "$relief" bake hills.png --heights $settings -o hills.png
