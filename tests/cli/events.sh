# SPDX-License-Identifier: Apache-2.0
# relief-sim --events and [[spawn]]: the hits of a run as lines of JSON, and the births that they cause. Unit tests show each API and
# path, and what a hit makes.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o bunny.relief --paper --resolution 64 -q
# Four drops fall on the ground from 1.25 above it, a second apart, and stay where they touch it.
cat >drop.toml <<'S'
[collider]
file = "bunny.relief"
[time]
dt = 0.0078125
steps = 600
[particles]
capacity = 10
[emitter]
point = [7.0, 2.0, 0.5]
velocity = [0.25, 0.0, 0.0]
velocity_spread = [0.0, 0.0, 0.0]
rate = 1.0
duration = 4.0
spread = false
lifetime = 1.5
[forces]
gravity = [0.0, -9.8, 0.0]
drag = 0.0
[ground]
height = 0.75
[[type]]
on_collision = "stop"
S
"$relief_sim" drop.toml --events hits.jsonl -q
python3 - <<'P'
import json
hits = [json.loads(line) for line in open('hits.jsonl')]
assert len(hits) == 4, hits
dt = 1 / 128
fall = 0.0  # semi-implicit Euler: after n steps g dt^2 n (n + 1) / 2
n = 0
while fall < 1.25:
    n += 1
    before, fall = fall, fall + 9.8 * dt * dt * n
inside = (1.25 - before) / (fall - before)
for i, hit in enumerate(hits):
    # A drop is born at the start of the step that ends at its moment.
    born = i + 1 - dt
    assert hit['id'] == i and hit['type'] == 0 and hit['body'] is None and hit['normal'] == [0, 1, 0], hit
    assert hit['step'] == round(born / dt) + n, hit
    assert abs(hit['time'] - (born + dt * (n - 1 + inside))) < 1e-4, hit
    assert all(abs(a - b) < 1e-4 for a, b in zip(hit['position'], [7 + 0.25 * (hit['time'] - born), 0.75, 0.5])), hit
    assert abs(hit['speed'] - 9.8 * dt * n) < 1e-4, hit
    assert abs(hit['velocity'][0] - 0.25) < 1e-6 and hit['velocity'][1] == -hit['speed'], hit
P
expect 0 "$relief_sim" drop.toml --events none.jsonl --events-min-speed 5 -q
[ ! -s none.jsonl ] || die "--events-min-speed leaves slower hits in"
expect 0 "$relief_sim" drop.toml --events all.jsonl --events-min-speed 4.5 -q
cmp all.jsonl hits.jsonl

"$relief_sim" drop.toml --events - 2>text | cmp - hits.jsonl || die "--events - differs"
grep -q '600 steps' text || die "the summary is not on stderr beside --events -"
expect_error 1 '--events-min-speed' "$relief_sim" drop.toml --events-min-speed 1
expect_error 1 '--events' "$relief_sim" drop.toml --events - --json
expect_error 1 '--check' "$relief_sim" drop.toml --check --events e
expect_error 2 'nowhere.*--events' "$relief_sim" drop.toml --events nowhere/e.jsonl
expect_error 2 '/dev/full.*--events' "$relief_sim" drop.toml --events /dev/full

# [[spawn]]: 300 drops die where they hit, with five births each and two for each death, up to the capacity.
cat >splash.toml <<'S'
[collider]
file = "bunny.relief"
[time]
dt = 0.0078125
steps = 200
[particles]
capacity = 5000
[emitter]
box_min = [6.0, 1.0, -1.0]
box_max = [8.0, 3.0, 1.0]
burst = 300
rate = 0.0
lifetime = 50.0
[forces]
gravity = [0.0, -9.8, 0.0]
drag = 0.0
[ground]
height = 0.0
[[type]]
name = "drop"
on_collision = "die"
[[type]]
name = "splash"
on_collision = "stop"
[render]
size = [64, 48]
[[spawn]]
on = "death"
of = "drop"
type = "splash"
count = 2
lifetime = 40
[[spawn]]
on = "collision"
of = "drop"
type = "splash"
count = 5
speed = [0.5, 1.0]
kick = 0.1
lifetime = 40
S
for capacity in 5000 700; do
    sed -i "s/^capacity = .*/capacity = $capacity/" splash.toml
    expect 0 "$relief_sim" splash.toml --events hits.jsonl --json
    json stdout "(d['particles']['born'], d['particles']['refused']) == (min(2400, $capacity), max(2400 - $capacity, 0))"
done
sed 's/"death"/"birth"/' splash.toml >wrong.toml
expect_error 3 'wrong\.toml:28:6:' "$relief_sim" wrong.toml

# Drops enter a plate, 1 thick and turned by 30 degrees, in one step, by up to 0.4: a hit is on the face that they entered by.
python3 - <<'P'
import math
turn = math.radians(30)
c, s = math.cos(turn), math.sin(turn)
with open('plate.obj', 'w') as file:
    for x, y, z in ((x, y, z) for x in (-5, 5) for y in (-0.5, 0.5) for z in (-5, 5)):
        file.write(f'v {x * c - y * s} {x * s + y * c} {z}\n')
    for quad in ('1 2 4 3', '5 7 8 6', '1 5 6 2', '3 4 8 7', '1 3 7 5', '2 6 8 4'):
        file.write(f'f {quad}\n')
P
"$relief" bake plate.obj -o plate.relief --budget 256kB -q
printf '%s\n' '[collider]' 'file = "plate.relief"' '[time]' 'dt = 1.0' 'steps = 1' '[particles]' 'capacity = 4000' '[emitter]' \
    'box_min = [-0.51, 0.5555, -4.0]' 'box_max = [-0.27, 0.7955, 4.0]' 'velocity = [0.25, -0.4330127, 0.0]' \
    'velocity_spread = [0.0, 0.0, 0.0]' 'rate = 0.0' 'burst = 4000' 'lifetime = 9.0' '[forces]' 'gravity = [0.0, 0.0, 0.0]' \
    'wind = [0.0, 0.0, 0.0]' 'drag = 0.0' '[ground]' 'enabled = false' >plate.toml
"$relief_sim" plate.toml --events hits.jsonl -q
python3 - <<'P'
import json
hits = [json.loads(line) for line in open('hits.jsonl')]
assert len(hits) > 3900, len(hits)
for hit in hits:
    p, n = hit['position'], hit['normal']
    assert abs(-0.5 * p[0] + 0.8660254 * p[1] - 0.5) < 2e-3, hit
    assert -0.5 * n[0] + 0.8660254 * n[1] > 0.9999, hit
    assert abs(hit['speed'] - 0.5) < 1e-3, hit
P
