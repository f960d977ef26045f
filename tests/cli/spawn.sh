# [[spawn]]: births where particles hit or die, counted: as many as hits times the count, up to the limits.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o bunny.relief --paper --resolution 64 -q
scene() { # CAPACITY SPAWN…
    cat <<S
[collider]
file = "bunny.relief"
[time]
dt = 0.0078125
steps = 200
[particles]
capacity = $1
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
S
    printf '%b\n' "$2"
}
splash='[[spawn]]\non = "collision"\nof = "drop"\ntype = "splash"\ncount = 5\nspeed = [0.5, 1.0]\nkick = 0.1\nlifetime = 40'
born() { # FILE: births, and those refused
    "$relief_sim" "$1" --events hits.jsonl --json >report.json
    python3 -c "import json; p = json.load(open('report.json'))['particles']; print(p['born'], p['refused'])"
}
scene 5000 "" >alone.toml
scene 5000 "$splash" >splash.toml
[ "$(born alone.toml)" = "300 0" ] || die "without [[spawn]]: $(born alone.toml)"
[ "$(born splash.toml)" = "1800 0" ] || die "300 drops with five each: $(born splash.toml)"
python3 - <<'P'
import json
hits = [json.loads(line) for line in open('hits.jsonl')]
drops = [hit for hit in hits if hit['type'] == 0]
assert len(drops) == 300 == len({hit['id'] for hit in drops}), len(drops)
assert all(hit['id'] >= 300 for hit in hits if hit['type'] == 1) and len(hits) > 1000
P
json report.json "[(s['of'], s['type'], s['count'], s['cone']) for s in d['settings']['spawn']] == [(0, 1, [5, 5], 60)]"

# Limits: of a step, and of the capacity. Births and refusals are all that were due.
scene 5000 "$splash\nmost = 7" >most.toml
born most.toml >numbers
python3 - <<'P'
born, refused = map(int, open('numbers').read().split())
assert born + refused == 1800 and 300 < born < 1500, (born, refused)
P
scene 700 "$splash" >full.toml
[ "$(born full.toml)" = "700 1100" ] || die "with 700 places: $(born full.toml)"

# Deaths: two for each that dies of age, wherever it is, and two where it was killed.
death='[[spawn]]\non = "death"\nof = "drop"\ntype = "splash"\ncount = 2\nlifetime = 40'
scene 5000 "$death" | sed 's/^lifetime = 50.0/lifetime = [0.05, 2.0]/' >death.toml
[ "$(born death.toml)" = "900 0" ] || die "300 deaths: $(born death.toml)"
scene 5000 "$splash\n$death" >both.toml
[ "$(born both.toml)" = "2400 0" ] || die "300 hits that kill, five and two each: $(born both.toml)"

# The same for each API and path, with the hits written or not, and with pictures or not.
"$relief_sim" splash.toml --dump wanted.ply -q
for path in fragment compute; do
    for api in gl gles; do
        "$relief_sim" splash.toml --dump other.ply --path $path --api $api -q
        cmp other.ply wanted.ply || die "the $path path of $api has other particles"
    done
done
"$relief_sim" splash.toml --dump other.ply --events e.jsonl --events-min-speed 3 --frames frames -q
cmp other.ply wanted.ply || die "what is written beside changes the particles"

# Where they are born, and how fast: above the ground at the place of the hit, two steps later.
cat >one.toml <<'S'
[collider]
file = "bunny.relief"
[time]
dt = 0.0078125
steps = 100
[particles]
capacity = 10
[emitter]
point = [7.0, 1.0, 0.0]
burst = 1
rate = 0.0
velocity = [2.0, 0.0, 0.0]
velocity_spread = [0.0, 0.0, 0.0]
[forces]
gravity = [0.0, -9.8, 0.0]
drag = 0.0
[ground]
height = 0.0
[[type]]
on_collision = "stop"
[[type]]
[[spawn]]
on = "collision"
of = 0
type = 1
cone = 0
kick = 2.0
inherit = 0.5
S
"$relief_sim" one.toml --events hits.jsonl -q
step=$(python3 -c "import json; print(json.loads(open('hits.jsonl').readline())['step'])")
"$relief_sim" one.toml --steps $((step + 1)) --json >before.json
json before.json "d['particles']['born'] == 1"
"$relief_sim" one.toml --steps $((step + 2)) --dump one.ply --json >after.json
json after.json "d['particles']['born'] == 2"
python3 - <<'P'
import json, struct
hit = json.loads(open('hits.jsonl').readline())
data = open('one.ply', 'rb').read().split(b'end_header\n', 1)[1]
x, y, z, vx, vy, vz, age, lifetime, id, kind = struct.unpack('<8f2I', data[40:80])
dt, g = 0.0078125, 9.8
assert (id, kind) == (1, 1) and abs(age - dt) < 1e-6 and lifetime == 1
speed = 2 * hit['speed'] - g * dt  # the first step's gravity
assert abs(vy - speed) < 1e-4 and abs(vx - 1) < 1e-5 and vz == 0, (vx, vy, vz)
assert abs(y - speed * dt) < 1e-4 and abs(x - hit['position'][0] - dt) < 1e-4, (x, y)
P

expect 0 "$relief_sim" splash.toml --check
printf '[[spawn]]\non = "birth"\n' >>alone.toml
expect_error 3 'alone\.toml:29:6:.*spawn\.on.*collision' "$relief_sim" alone.toml
