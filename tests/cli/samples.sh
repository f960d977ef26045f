# SPDX-License-Identifier: Apache-2.0
# The samples' scenes with a fortieth of their particles: every scene is valid and plays, pictures show something, and particles
# are outside the bodies that rest, by the formulas that these were made from. Unit tests show those that move.
. "$(dirname "$0")/lib.sh"

samples=$RELIEF_SOURCE/samples
models_glmark2=/usr/share/glmark2/models
mesh() { python3 "$samples/meshes.py" "${1%.*}" "$1"; }

mesh basin.obj
mesh torus.obj
mesh terrain.obj
python3 "$samples/walker.py" walker.gltf
python3 "$samples/kitchen.py" kitchen.gltf
cp "$samples"/linked_tori.csv .
"$relief" bake "$bunny" -o bunny.relief --prefer inside --budget 300kB --quality fast -q
"$relief" bake $models_glmark2/horse.3ds -o horse.relief --budget 200kB --quality fast -q
"$relief" bake basin.obj -o basin.relief --map front-back:dir=-y,size=200x200 -q
"$relief" bake torus.obj -o torus.relief --budget 200kB -q
"$relief" bake terrain.obj -o terrain.relief --map fixed8:dir=-y,size=256x256,box=-4/-1.5/-4/4/1.5/4 --quality fast -q
"$relief" bake walker.gltf --animated -o walker.relief -q
python3 "$samples/village.py" .
"$relief" bake village.glb --world world --budget 2MB --quality fast -q
"$relief" bake kitchen.gltf -o kitchen.relief --quality fast -q

# Meshes have the same bytes each time.
mkdir again
python3 "$samples/meshes.py" torus again/torus.obj
for name in walker kitchen; do python3 "$samples/$name.py" again/$name.gltf; done
python3 "$samples/village.py" again
for name in torus.obj walker.gltf kitchen.gltf village.glb meshes; do
    diff -r $name again/$name || die "$name is another each time"
done

# Every scene in the folder passes --check, so that none is forgotten.
for scene in "$samples"/*.toml; do
    name=$(basename "$scene" .toml)
    cp "$scene" .
    expect 0 "$relief_sim" "$name.toml" --check
    # rate = 36000.0 -> 900, of those that rain thinly by themselves less
    python3 - "$name.toml" <<'P'
import re, sys
path = sys.argv[1]
text = open(path).read()
share = {'walker': 8, 'wobbling_torus': 10}.get(path[:-5], 40)
text = re.sub(r'(?m)^rate = ([0-9.]+)', lambda m: 'rate = %g' % (float(m[1]) / share), text)
text = re.sub(r'(?m)^every = .*', 'every = 100000', text)
if path in ('village.toml', 'walker.toml'):
    text = text.replace('clip = "walk"', 'clip = "walk", resolution = %d' % (128 if path == 'village.toml' else 256))
open(path, 'w').write(text)
P
done

# Every scene makes a page.
page_place >stub.html
for scene in "$samples"/*.toml; do
    RELIEF_VIEW_PAGE=stub.html expect 0 "$relief" view "$(basename "$scene")" -o page.html
done

# play NAME STEPS: NAME.json, NAME.ply and a frame.
play() {
    expect 0 "$relief_sim" "$1.toml" --steps "$2" --size 320x240 --frames "frames_$1" --dump "end_$1.ply" --json
    cp stdout "$1.json"
    json "$1.json" "d['steps'] == $2 and d['particles']['refused'] == 0 and d['particles']['in_contact'] > 0"
    json "$1.json" "d['particles']['born'] == d['particles']['alive'] + d['particles']['died']"
    local colors
    colors=$(identify -format '%k' "frames_$1/frame_0000.png")
    [ "$colors" -gt 200 ] || die "a frame of $1 has $colors colours: it shows nothing"
}
play bunny_in_the_snow 300
play catherine_wheel 170
play fountain 150
play linked_tori 180
play rain 300
play village 200
play wobbling_torus 180
play walker 60
expect 0 "$relief_sim" kitchen.toml --events hits.ndjson -q
play kitchen 480

cat >particles.py <<'P'
import ply

def read(name):
    """Of each particle: x y z, velocity, type."""
    for p in ply.read('end_' + name):
        yield (p['x'], p['y'], p['z']), (p['vx'], p['vy'], p['vz']), p['type']
P
export PYTHONPATH=$PYTHONPATH:$work:$samples

# Snow: born for 4 of 5 seconds, none dies; most lies still, on the bunny too, and none below the floor.
json bunny_in_the_snow.json "d['particles']['died'] == 0"
python3 - <<'P'
import particles
flakes = list(particles.read('bunny_in_the_snow.ply'))
floor = -0.991233
assert 6400 <= len(flakes) <= 6600, len(flakes)
lying = [p for p, v, _ in flakes if v == (0, 0, 0)]
assert len(lying) > 0.9 * len(flakes), len(lying)
on_bunny = sum(p[1] > floor + 0.3 and abs(p[0]) < 1.05 and abs(p[2]) < 0.8 for p in lying)
assert on_bunny > 0.15 * len(flakes), on_bunny
# A type stops at its radius above the floor, give or take the way of one step (speed 2.4, 1/60 s).
for radius, kind in ((0.0, 0), (0.012, 1), (0.026, 2)):
    lowest = min(p[1] for p, v, t in flakes if t == kind and v == (0, 0, 0)) - floor
    assert radius - 1e-4 <= lowest <= radius + 0.04, (kind, lowest)
P

# The wheel, at 17/12 s: new sparks are at the nozzles, which have turned by as much; none is in the ring or below the
# floor, some lie on the bunny; and smoke is in the ring, and above it.
python3 - <<'P'
import math, particles
floor = -0.991233
all_of = list(particles.read('catherine_wheel.ply'))
sparks = [p for p, _, t in all_of if t == 0]
smoke = [p for p, _, t in all_of if t == 1]
assert len(sparks) > 400 and len(smoke) > 8, (len(sparks), len(smoke))
turned = math.radians(600 * 170 / 120)
nozzles = [(0.36 * 1.29 * math.cos(turned + 2 * math.pi * i / 3), 1.55, -0.36 * 1.29 * math.sin(turned + 2 * math.pi * i / 3))
           for i in range(3)]
for nozzle in nozzles:
    assert min(math.dist(p, nozzle) for p in sparks) < 0.06, nozzle
def ring(p):
    return math.hypot(math.hypot(p[0], p[2]) - 0.36, p[1] - 1.55) - 0.36 * 0.26
assert min(map(ring, sparks)) > -0.005, min(map(ring, sparks))
assert min(p[1] for p in sparks) > floor - 1e-3
assert any(floor + 0.3 < p[1] < 0.9 and math.hypot(p[0], p[2]) < 0.8 for p in sparks)
assert min(map(ring, smoke)) < 0 and max(p[1] for p in smoke) > 1.7, (min(map(ring, smoke)), max(p[1] for p in smoke))
P

# Fountain: jets rise to their height (0.3 + 2.8² / 2 g), and no water gets below the floor.
python3 - <<'P'
import particles
drops = list(particles.read('fountain.ply'))
assert len(drops) > 2000, len(drops)
assert 1.1 < max(p[1] for p, _, _ in drops) < 1.5, max(p[1] for p, _, _ in drops)
assert min(p[1] for p, _, _ in drops) > -1e-3, min(p[1] for p, _, _ in drops)
held = sum(p[0] ** 2 + p[2] ** 2 < 1.44 ** 2 for p, _, _ in drops)
assert held > 0.85 * len(drops), (held, len(drops))
P

# Kitchen, at 8 s: hits on plates, table and floor have their materials, by where kitchen.py has these; flakes lie on the table,
# and none is left on a plate, though they fell there too.
python3 - <<'P'
import json, math, kitchen, particles

def surface(x, y, z):
    on_plate = [r - math.hypot(x - px, z - pz) for px, pz, r in kitchen.PLATES]
    if abs(y - kitchen.PLATE_TOP) < 0.003 and max(on_plate) > 0.008:
        return 'hot plate'
    if abs(y - kitchen.STOVE_TOP) < 0.003 and max(on_plate) < -0.01 and 0.51 < x < 1.11 and -0.57 < z < 0.01:
        return 'enamel'
    if abs(y - kitchen.TABLE_TOP) < 0.003 and -1.14 < x < 0.04 and abs(z) < 0.44 and math.hypot(x + 0.55, z) > 0.17:
        return 'wood'
    return 'tiles' if y < 0.003 else None

wrong, count = 0, {}
for line in open('hits.ndjson'):
    hit = json.loads(line)
    material = surface(*hit['position'])
    if material:
        count[material] = count.get(material, 0) + 1
        wrong += hit['material'] != material
print('kitchen:', count, wrong, 'wrong')
assert min(count[m] for m in ('hot plate', 'enamel', 'wood', 'tiles')) > 20, count
assert wrong * 100 <= sum(count.values()), (wrong, count)
lying = [p for p, v, t in particles.read('kitchen.ply') if v == (0, 0, 0) and t < 2]
over = lambda p, top: abs(p[1] - top) < 0.04
assert sum(over(p, kitchen.TABLE_TOP) and -1.14 < p[0] < 0.04 and abs(p[2]) < 0.44 for p in lying) > 200
plates = sum(over(p, kitchen.PLATE_TOP) and any(math.hypot(p[0] - x, p[2] - z) < r - 0.01 for x, z, r in kitchen.PLATES)
             for p in lying)
assert plates == 0, plates
P

# A walker's feet press prints into snow all the way, not only where a picture is drawn of it.
cat >prints.toml <<'T'
[[collider]]
file = "walker.relief"
play = { clip = "walk", resolution = 128 }
[[collider.key]]
time = 0.0
[[collider.key]]
time = 2.0
position = [0.0, 0.0, 2.36]
[time]
dt = 0.033333
steps = 60
[particles]
capacity = 1
[camera]
eye = [0.3, 6.0, 1.0]
target = [0.0, 0.0, 1.0]
fov = 40.0
[render]
size = [320, 240]
meshes = "."
[[render.weather]]
snow = 1.0
T
expect 0 "$relief_sim" prints.toml --frame-every 60 --frames prints_seldom -q
expect 0 "$relief_sim" prints.toml --frame-every 4 --frames prints_often -q
python3 - <<'P'
import glob, subprocess

def light(folder):
    frame = sorted(glob.glob(folder + '/*.png'))[-1]
    return subprocess.check_output(['convert', frame, '-colorspace', 'gray', '-depth', '8', 'gray:-'])

seldom, often = light('prints_seldom'), light('prints_often')
white = sorted(often)[len(often) // 2]
apart = sum(abs(a - b) > 0.04 * white for a, b in zip(seldom, often))
print('prints: pixels apart', apart)
assert apart < 20, apart
P

# The village: drops are above its ground, some have met roofs, and none that falls is as deep in a barn as its roof is thick.
python3 - <<'P'
import particles, village
drops = list(particles.read('village.ply'))
assert len(drops) > 2000, len(drops)
deep = min(p[1] - village.ground(p[0], p[2]) for p, _, _ in drops)
print('village: deepest', deep)
assert deep > -0.2, deep
splashes = [p for p, _, t in drops if t == 1]
assert sum(p[1] > 2.5 for p in splashes) > 5 and sum(p[1] < 1.0 for p in splashes) > 5, len(splashes)
x, z = 15.5, 17.5  # a barn, whose eaves are at 3.6
inside = [p for p, _, _ in drops if abs(p[0] - x) < 2.0 and abs(p[2] - z) < 2.0 and p[1] - village.ground(x, z) < 3.4]
assert not inside, inside[:3]
mud = [p for p, _, t in drops if t == 3]
assert mud and all(p[1] < 1.0 for p in mud), mud  # from under feet
P

# Rain: nothing is below the terrain by more than half a texel's diagonal (0.022) on a slope of 2; long drops die there,
# so that none is ever slow; water lies lower than rain would by chance.
python3 - <<'P'
import meshes, particles
drops = list(particles.read('rain.ply'))
deep = min(p[1] - meshes.height(p[0], p[2]) for p, _, _ in drops if abs(p[0]) < 3.9 and abs(p[2]) < 3.9)
print('rain: deepest', deep)
assert deep > -0.045, deep
assert min(-v[1] for _, v, t in drops if t == 0) > 3.0
water = [p for p, v, t in drops if t == 2 and abs(p[0]) < 3.9 and abs(p[2]) < 3.9 and
         p[1] - meshes.height(p[0], p[2]) < 0.05]
assert len(water) > 500, len(water)
heights = sorted(meshes.height(-4 + 8 * i / 100, -4 + 7.6 * k / 100) for i in range(101) for k in range(101))
mean = sum(p[1] for p in water) / len(water)
print('rain: water at', mean, 'terrain at', sum(heights) / len(heights))
assert mean < sum(heights) / len(heights) - 0.03
P
