# relief-sim --events: the hits of a run, as closed forms and the particles' own counts say.
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
cat >check.py <<'P'
import json, math
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
    assert hit['id'] == i and hit['type'] == 0 and hit['body'] is None, hit
    assert hit['step'] == round(born / dt) + n, hit
    assert abs(hit['time'] - (born + dt * (n - 1 + inside))) < 1e-4, hit
    assert hit['normal'] == [0, 1, 0]
    assert all(abs(a - b) < 1e-4 for a, b in zip(hit['position'], [7 + 0.25 * (hit['time'] - born), 0.75, 0.5])), hit
    assert abs(hit['speed'] - 9.8 * dt * n) < 1e-4, hit
    assert abs(hit['velocity'][0] - 0.25) < 1e-6 and hit['velocity'][1] == -hit['speed'], hit
P
python3 check.py
expect 0 "$relief_sim" drop.toml --events none.jsonl --events-min-speed 5 -q
[ ! -s none.jsonl ] || die "--events-min-speed leaves slower hits in"
expect 0 "$relief_sim" drop.toml --events all.jsonl --events-min-speed 4.5 -q
cmp all.jsonl hits.jsonl

# Snow on the bunny: hits lie on it, the same for each API and path, and nothing else changes.
cat >snow.toml <<'S'
[collider]
file = "bunny.relief"
[time]
steps = 80
[particles]
capacity = 3000
[emitter]
burst = 2000
lifetime = [0.1, 3.0]
[ground]
enabled = false
S
"$relief_sim" snow.toml --dump without.ply -q
for path in fragment compute; do
    for api in gl gles; do
        expect 0 "$relief_sim" snow.toml --dump with.ply --events $path.$api --path $path --api $api -q
        [ $path.$api = fragment.gl ] && cmp with.ply without.ply
        cmp $path.$api fragment.gl || die "the $path path of $api has other hits"
    done
done
python3 - <<'P'
import json
hits = [json.loads(line) for line in open('fragment.gl')]
assert len(hits) > 200, len(hits)
assert all(hit['body'] == 0 for hit in hits)
key = [(hit['step'], hit['time']) for hit in hits]
assert [k[0] for k in key] == sorted(k[0] for k in key)
with open('points.csv', 'w') as out:
    for hit in hits:
        out.write(','.join(repr(c) for c in hit['position']) + '\n')
P
"$relief" query bunny.relief --points points.csv -o field.csv -q
python3 - <<'P'
import csv
fields = [float(line['f']) for line in csv.DictReader(open('field.csv'))]
off = sorted(abs(field) for field in fields)
assert off[len(off) // 2] < 0.004 and off[-1] < 0.1, off  # a texel is 0.03
P
"$relief_sim" snow.toml --events - 2>text | cmp - fragment.gl || die "--events - differs"
grep -q '80 steps' text || die "the summary is not on stderr beside --events -"

expect_error 1 '--events-min-speed' "$relief_sim" snow.toml --events-min-speed 1
expect_error 1 '--events-min-speed' "$relief_sim" snow.toml --events e --events-min-speed -1
expect_error 1 '--events' "$relief_sim" snow.toml --events - --json
expect_error 1 '--events' "$relief_sim" snow.toml --events - --dump -
expect_error 1 '--check' "$relief_sim" snow.toml --check --events e
expect_error 2 'nowhere.*--events' "$relief_sim" snow.toml --events nowhere/e.jsonl
expect_error 2 '/dev/full.*--events' "$relief_sim" snow.toml --events /dev/full
