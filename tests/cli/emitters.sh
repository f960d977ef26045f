# Emitters that move, runs that begin before time 0, and frames from one step to another, as files show them.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o bunny.relief --paper --resolution 64 -q
scene() { # LINES…: particles that meet nothing
    printf '%s\n' '[[collider]]' 'file = "bunny.relief"' 'position = [0.0, -50.0, 0.0]' "$@"
}
tail=('[particles]' 'capacity = 4000' '[forces]' 'gravity = [0.0, 0.0, 0.0]' 'drag = 0.0' '[ground]' 'enabled = false'
    '[render]' 'size = [64, 48]')
time=('[time]' 'dt = 0.0078125' 'steps = 128')
cat >ply.py <<'P'
import sys
def read(path):
    """Rows of a binary PLY of floats and unsigned ints, as tuples of its properties by name."""
    import struct
    data = open(path, 'rb').read()
    head, body = data.split(b'end_header\n', 1)
    names, form, count = [], '<', 0
    for line in head.decode().splitlines():
        words = line.split()
        if words[:2] == ['element', 'vertex']: count = int(words[2])
        if words[0] == 'property':
            form += {'float': 'f', 'uint': 'I', 'int': 'i', 'uchar': 'B', 'ushort': 'H'}[words[1]]
            names.append(words[2])
    return [dict(zip(names, row)) for row in struct.iter_unpack(form, body[:count * struct.calcsize(form)])]
P

# --- a nozzle on a circle, in the space of a collider that goes sideways: each birth lies on a helix of its own moment ---
nozzle=('[emitter]' 'point = [1.0, 50.0, 0.0]' 'attach = 0' 'rate = 1000.0' 'velocity = [0.0, 0.0, 0.0]'
    'velocity_spread = [0.0, 0.0, 0.0]' 'lifetime = 100.0'
    '[[emitter.key]]' 'time = 0.0' '[[emitter.key]]' 'time = 0.5' 'angle = 90' '[[emitter.key]]' 'time = 1.0' 'angle = 180')
moves=('[[collider.key]]' 'time = 0.0' '[[collider.key]]' 'time = 1.0' 'position = [3.0, -50.0, 0.0]')
scene "${moves[@]}" "${time[@]}" "${nozzle[@]}" "${tail[@]}" >still.toml
scene "${moves[@]}" "${time[@]}" "${nozzle[@]/attach = 0/attach = 0
inherit = 1.0}" "${tail[@]}" >thrown.toml
expect 0 "$relief_sim" still.toml -q --dump still.ply
expect 0 "$relief_sim" thrown.toml -q --dump thrown.ply
python3 - <<'P'
import math, ply
for name, thrown in (('still.ply', False), ('thrown.ply', True)):
    rows = ply.read(name)
    assert len(rows) == 1000, len(rows)
    for row in rows:
        moment = 1.0 - row['age']
        # A step before the first, nothing has moved yet.
        t = max(moment, 0.0)
        place = (3 * t + math.cos(math.pi * t), 0.0, -math.sin(math.pi * t))
        speed = (3 - math.pi * math.sin(math.pi * t), 0.0, -math.pi * math.cos(math.pi * t)) if moment > 0 else (0, 0, 0)
        if not thrown: speed = (0, 0, 0)
        for axis, p, v in zip('xyz', place, speed):
            assert abs(row[axis] - p - v * row['age']) < 2e-3, (name, row, place, speed)
            assert abs(row['v' + axis] - v) < 2e-3, (name, row, speed)
P
json <("$relief_sim" thrown.toml --json) "d['settings']['emitter']['attach'] == 0 and d['settings']['emitter']['inherit'] == 1 and len(d['settings']['emitter']['key']) == 3"

# --- prewarm: the particles of a longer run, at the time of a shorter one ---
fall=('[emitter]' 'rate = 300.0' 'point = [0.0, 1.0, 0.0]' 'seed = 7' 'lifetime = [0.2, 0.9]')
frames=("${tail[@]/drag = 0.0/drag = 0.5}" 'first = 0' 'every = 64')
scene '[time]' 'dt = 0.0078125' 'steps = 192' "${fall[@]}" "${frames[@]}" >long.toml
scene '[time]' 'dt = 0.0078125' 'steps = 128' 'prewarm = 0.5' "${fall[@]}" "${frames[@]}" >warm.toml
expect 0 "$relief_sim" long.toml -q --dump-frames long
expect 0 "$relief_sim" warm.toml -q --dump-frames warm
[ "$(ls long)" = "$(printf 'particles_%04d.ply\n' 0 1 2 3)" ] || die "frames: $(ls long)"
[ "$(ls warm)" = "$(printf 'particles_%04d.ply\n' 0 1 2)" ] || die "frames: $(ls warm)"
for i in 0 1 2; do
    cmp "warm/particles_000$i.ply" "long/particles_000$((i + 1)).ply" || die "warmed up, frame $i is another"
done
python3 - <<'P'
import ply
assert len(ply.read('long/particles_0000.ply')) == 0 and len(ply.read('warm/particles_0000.ply')) > 100
P
# Its births are counted, its hits are nobody's.
scene '[time]' 'dt = 0.0078125' 'steps = 64' 'prewarm = 1.0' '[emitter]' 'burst = 100' 'rate = 0.0' \
    'box_min = [-1.0, 1.0, -1.0]' 'box_max = [1.0, 1.5, 1.0]' 'velocity = [0.0, -4.0, 0.0]' '[ground]' 'height = 0.0' \
    '[[type]]' 'on_collision = "stop"' >hits.toml
expect 0 "$relief_sim" hits.toml -q --events hits.jsonl
[ ! -s hits.jsonl ] || die "hits of before time 0 are written: $(head -1 hits.jsonl)"
sed 's/^prewarm.*/prewarm = 0.0/' hits.toml >cold.toml
expect 0 "$relief_sim" cold.toml -q --events hits.jsonl
[ "$(wc -l <hits.jsonl)" -eq 100 ] || die "not a hit of each: $(wc -l <hits.jsonl)"

# --- frames from one step to another ---
expect 0 "$relief_sim" long.toml -q --dump-frames all --first-frame 0 --frame-every 1
expect 0 "$relief_sim" long.toml -q --dump-frames some --first-frame 10 --last-frame 25 --frame-every 7 --frames pictures
[ "$(ls all | wc -l)" -eq 193 ] || die "not one frame a step: $(ls all | wc -l)"
[ "$(ls some | wc -l)" -eq 4 ] && [ "$(ls pictures | wc -l)" -eq 4 ] || die "steps 10, 17, 24 and 25: $(ls some pictures)"
i=0
for step in 10 17 24 25; do
    cmp "some/particles_000$i.ply" "$(printf 'all/particles_%04d.ply' $step)" || die "frame $i is not of step $step"
    i=$((i + 1))
done
expect_error 1 '--first-frame.* need --frames or --dump-frames' "$relief_sim" long.toml --first-frame 3
expect_error 1 '--frame-every need --frames or --dump-frames' "$relief_sim" long.toml --frame-every 3
expect_error 1 'comes after --last-frame' "$relief_sim" long.toml --frames f --first-frame 3 --last-frame 2
sed 's/^first = 0/last = 20/' long.toml >last.toml
expect_error 1 'of step 30, comes after the last, of step 20' "$relief_sim" last.toml --frames f --first-frame 30
[ ! -e f ] || die "a refused run made its folder"

# --- births on surfaces: of what plays a clip, of a mesh file, and of a collider that has maps alone ---
cp "$models/glTF2/glTF-Sample-Models/AnimatedMorphCube-glTF/"AnimatedMorphCube.{gltf,bin} .
"$relief" bake AnimatedMorphCube.gltf --animated --resolution 64 -o cube.relief -q
expect 0 "$relief" info cube.relief
group=AnimatedMorphCube
matches "^groups   '$group'" <stdout || die "info: $(cat stdout)"
matches "^material 'Material'" <stdout || die "info: $(cat stdout)"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' >t.obj
"$relief" bake t.obj -q -o t.relief
sparks() { # sparks KEYS…: a scene of births with no speed of their own, which nothing moves
    cat <<'T2'
time = { dt = 0.015625, steps = 64 }
particles = { capacity = 8192 }
forces = { gravity = [0, 0, 0], drag = 0 }
ground = { enabled = false }
[[type]]
collides = []
[[collider]]
file = "cube.relief"
[[collider]]
file = "t.relief"
position = [5, 0, 0]
[[emitter]]
shape = "surface"
speed = 0
rate = 6000
T2
    printf '%s\n' "$@"
}
sparks 'attach = 0' "group = \"$group\"" >sparks.toml
expect 0 "$relief_sim" sparks.toml -q --dump rest.ply
expect 0 "$relief_sim" sparks.toml -q --dump again.ply
cmp rest.ply again.ply || die "other births by the same seed"
sed '0,/cube.relief"/s//cube.relief"\nplay = { clip = "Square" }/; s/speed = 0/speed = 0\ninherit = 1/' sparks.toml >plays.toml
expect 0 "$relief_sim" plays.toml -q --dump plays.ply
sparks 'attach = 1' >maps.toml
expect 0 "$relief_sim" maps.toml -q --dump maps.ply
sparks 'attach = 1' 'mesh = "t.obj"' >mesh.toml
expect 0 "$relief_sim" mesh.toml -q --dump mesh.ply
expect 0 "$relief_sim" mesh.toml --check
matches "mesh '.*t.obj'" <stdout || die "--check does not tell of the surface: $(cat stdout)"
printf '0,0,0,0,1,0\n' >p.csv
sed 's/^shape.*/points = "p.csv"/; /^mesh/d' mesh.toml >points.toml
expect 0 "$relief_sim" points.toml --check
matches "points '.*p.csv'" <stdout || die "--check does not tell of the points: $(cat stdout)"
python3 - <<'P'
import ply
def places(name):
    return [(p['x'], p['y'], p['z']) for p in ply.read(name)]
assert abs(len(places('rest.ply')) - 6000) <= 1
# The mean place of what stays is that of the surface; of what is thrown with it, that goes on.
mean = lambda name: [sum(c) / 6000 for c in zip(*places(name))]
assert max(abs(a - b) for a, b in zip(mean('rest.ply'), mean('plays.ply'))) > 0.05, (mean('rest.ply'), mean('plays.ply'))
# On a tetrahedron of three right triangles and one of area sqrt(3)/2: x + y + z = 1 has its share, in maps and in the mesh.
share = 3 ** 0.5 / (3 + 3 ** 0.5)
for name in ['maps.ply', 'mesh.ply']:
    far = 2e-2 if name == 'maps.ply' else 1e-5
    slant = 0
    for x, y, z in places(name):
        x -= 5
        assert min(abs(x), abs(y), abs(z), abs(x + y + z - 1) / 3 ** 0.5) < far, (name, x, y, z)
        slant += abs(x + y + z - 1) / 3 ** 0.5 < min(abs(x), abs(y), abs(z))
    assert abs(slant / 6000 - share) < 0.03, (name, slant)
P
sparks 'attach = 0' 'group = "Head"' >wrong.toml
expect_error 3 "wrong.toml:.*emitter.group: there is no joint or node .*'Head'; it has '$group'" "$relief_sim" wrong.toml -q
sparks 'attach = 1' 'material = "skin"' >wrong.toml
expect_error 3 "t.relief': emitter.material needs a mesh, and it keeps none" "$relief_sim" wrong.toml -q
sparks 'mesh = "absent.obj"' >wrong.toml
expect_error 2 "absent.obj" "$relief_sim" wrong.toml -q
