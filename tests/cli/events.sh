# SPDX-License-Identifier: Apache-2.0
# relief-sim --events and [[spawn]]: hits as lines of JSON, and the births that they cause. Unit tests cover the closed
# form of a hit in each API and path, also on bodies, and the effects of a hit.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o bunny.relief --paper --resolution 64 -q
# Four drops, a second apart, fall on the ground from 1.25 above it and stay where they touch it.
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
interpolate = false
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
assert [(h['id'], h['type'], h['body'], h['normal']) for h in hits] == [(i, 0, None, [0, 1, 0]) for i in range(4)], hits
P
expect 0 "$relief_sim" drop.toml --events none.jsonl --events-min-speed 5 -q
[ ! -s none.jsonl ] || die "--events-min-speed keeps slower hits"
expect 0 "$relief_sim" drop.toml --events all.jsonl --events-min-speed 4.5 -q
cmp all.jsonl hits.jsonl

"$relief_sim" drop.toml --events - 2>text | cmp - hits.jsonl || die "--events - differs"
grep -q '600 steps' text || die "the summary is not on stderr with --events -"
expect_error 1 '--events-min-speed' "$relief_sim" drop.toml --events-min-speed 1
expect_error 1 '--events' "$relief_sim" drop.toml --events - --json
expect_error 1 '--check' "$relief_sim" drop.toml --check --events e
expect_error 2 'nowhere.*--events' "$relief_sim" drop.toml --events nowhere/e.jsonl
expect_error 2 '/dev/full.*--events' "$relief_sim" drop.toml --events /dev/full

# [[spawn]]: five births for each hit of a drop.
sed '/^capacity/s/10/100/; s/^\[\[type/&]]\nname = "drop"\n#/' drop.toml >splash.toml
printf '%s\n' '[[type]]' 'name = "splash"' '[[spawn]]' 'on = "collision"' 'parent = "drop"' 'type = "splash"' 'count = 5' 'lifetime = 40' >>splash.toml
expect 0 "$relief_sim" splash.toml --json
json stdout "(d['particles']['born'], d['particles']['rejected']) == (24, 0)"
