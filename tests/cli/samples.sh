# SPDX-License-Identifier: Apache-2.0
# Sample scenes with a fortieth of their particles: every scene is valid and plays, and pictures are not empty. The
# closed forms of the village and the kitchen, with many nodes and materials, verify where particles settle.
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

# Meshes are deterministic.
mkdir again
python3 "$samples/meshes.py" torus again/torus.obj
for name in walker kitchen; do python3 "$samples/$name.py" again/$name.gltf; done
python3 "$samples/village.py" again
for name in torus.obj walker.gltf kitchen.gltf village.glb meshes; do
    diff -r $name again/$name || die "$name is not deterministic"
done

# Every scene in the folder passes --check.
for scene in "$samples"/*.toml; do
    name=$(basename "$scene" .toml)
    cp "$scene" .
    expect 0 "$relief_sim" "$name.toml" --check
    # rate = 36000.0 -> 900; sparse scenes are reduced less
    python3 - "$name.toml" <<'P'
import re, sys
path = sys.argv[1]
text = open(path).read()
share = {'walker': 8, 'wobbling_torus': 10}.get(path[:-5], 40)
# The village's mud keeps its rate: at 2 MB few soles are as near the ground as the scene requires.
full = 1000 if path == 'village.toml' else 0
text = re.sub(r'(?m)^rate = ([0-9.]+)', lambda m: 'rate = %g' % (float(m[1]) / (share if float(m[1]) >= full else 1)), text)
text = re.sub(r'(?m)^steps_per_frame = .*', 'steps_per_frame = 100000', text)
if path in ('village.toml', 'walker.toml'):
    text = text.replace('clip = "walk"', 'clip = "walk", resolution = %d' % (128 if path == 'village.toml' else 256))
open(path, 'w').write(text)
P
done

# Every scene can be written as a page.
page_place >stub.html
for scene in "$samples"/*.toml; do
    RELIEF_VIEW_PAGE=stub.html expect 0 "$relief_sim" "$(basename "$scene")" --page page.html
done

play() { # NAME STEPS
    expect 0 "$relief_sim" "$1.toml" --steps "$2" --size 320x240 --frames "frames_$1" --dump "end_$1.ply" --json
    json stdout "d['steps'] == $2 and d['particles']['rejected'] == 0 and d['particles']['in_contact'] > 0"
    json stdout "d['particles']['born'] == d['particles']['alive'] + d['particles']['died']"
    local colors
    colors=$(identify -format '%k' "frames_$1/frame_0000.png")
    [ "$colors" -gt 200 ] || die "a frame of $1 has $colors colours: it is empty"
}
play bunny_in_the_snow 300
play catherine_wheel 170
play fountain 150
play linked_tori 180
play rain 300
play village 215
play wobbling_torus 180
play walker 60
expect 0 "$relief_sim" kitchen.toml --events hits.ndjson -q
play kitchen 480

PYTHONPATH=$PYTHONPATH:$samples python3 - <<'P'
import json, math, kitchen, ply, village

def particles(name):
    return [((p['x'], p['y'], p['z']), p['type'], p['vx'] == p['vy'] == p['vz'] == 0) for p in ply.read(name)]

def surface(x, y, z):
    on_plate = max(r - math.hypot(x - px, z - pz) for px, pz, r in kitchen.PLATES)
    if abs(y - kitchen.PLATE_TOP) < 0.003 and on_plate > 0.008:
        return 'hot plate'
    if abs(y - kitchen.STOVE_TOP) < 0.003 and on_plate < -0.01 and 0.51 < x < 1.11 and -0.57 < z < 0.01:
        return 'enamel'
    if abs(y - kitchen.TABLE_TOP) < 0.003 and -1.14 < x < 0.04 and abs(z) < 0.44 and math.hypot(x + 0.55, z) > 0.17:
        return 'wood'
    return 'tiles' if y < 0.003 else None

hits = [(surface(*hit['position']), hit['material']) for hit in map(json.loads, open('hits.ndjson'))]
known = [one for one in hits if one[0]]
assert all(sum(one[0] == name for one in known) > 20 for name in ('hot plate', 'enamel', 'wood', 'tiles')), known
assert sum(a != b for a, b in known) * 100 <= len(known), known
lying = [p for p, kind, rests in particles("end_kitchen.ply") if rests and kind < 2]
assert sum(abs(y - kitchen.TABLE_TOP) < 0.04 and -1.14 < x < 0.04 and abs(z) < 0.44 for x, y, z in lying) > 200
assert not any(abs(y - kitchen.PLATE_TOP) < 0.04 and math.hypot(x - px, z - pz) < r - 0.01 for x, y, z in lying
               for px, pz, r in kitchen.PLATES), 'flakes stay on a hot plate'

drops = particles("end_village.ply")
deep = min(y - village.ground(x, z) for (x, y, z), _, _ in drops)
assert len(drops) > 2000 and deep > -0.2, (len(drops), deep)
splashes = [p[1] for p, kind, _ in drops if kind == 1]
assert sum(y > 2.5 for y in splashes) > 5 and sum(y < 1 for y in splashes) > 5, 'on roofs, and on the ground'
inside = [(x, y, z) for (x, y, z), _, _ in drops if abs(x - 15.5) < 2 and abs(z - 17.5) < 2 and y - village.ground(15.5, 17.5) < 3.4]
assert not inside, f'in a barn whose eaves are at 3.6: {inside[:3]}'
mud = [p[1] for p, kind, _ in drops if kind == 3]
assert mud and max(mud) < 1, 'from under feet'
P

# A walker's feet leave prints in snow at every step, not only in drawn frames.
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
expect 0 "$relief_sim" prints.toml --steps-per-frame 60 --frames prints_seldom -q
expect 0 "$relief_sim" prints.toml --steps-per-frame 4 --frames prints_often -q
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
