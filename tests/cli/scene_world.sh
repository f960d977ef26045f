# SPDX-License-Identifier: Apache-2.0
# Worlds in scenes: the same particles as with separately placed colliders, moving bodies, and streaming worlds. Unit
# tests cover keys, names and limits.
. "$(dirname "$0")/lib.sh"

level level.gltf
"$relief" bake level.gltf --world w --budget 200kB -q
python3 - <<'P'
import json
d = json.load(open('w/world.json'))
floor, box = (next(i for i, c in enumerate(d['colliders']) if c['mesh'] == name) for name in ('floor', 'box'))
body = {'rotation': [0, 0, 0, 1], 'scale': 1, 'restitution': 1, 'friction': 0}
d['bodies'] = [{**body, 'collider': floor, 'node': 'ground', 'position': [0, -0.5, 0], 'restitution': 0.5},
               {**body, 'collider': box, 'node': 'first', 'position': [1, 0, 0], 'scale': 2},
               {**body, 'collider': box, 'node': 'second', 'position': [-3, 0.25, 0], 'friction': 0.5}]
json.dump({**d, 'bodies': d['bodies'] + d['bodies'][2:]}, open('w/tiles.json', 'w'))  # the second node gets two bodies in one place
file = [f'file = "w/{d["colliders"][i]["file"]}"\n' for i in (floor, box)]
rest = '''[time]
steps = 60
[particles]
capacity = 2000
[emitter]
box_min = [-4.5, 3.5, -1.0]
box_max = [9.0, 4.5, 1.0]
rate = 2000.0
lifetime = 9.0
[[type]]
radius = 0.02
restitution = 0.4
collides_with = [0, 1, 2]
[ground]
enabled = false
'''
keys = '[[collider.key]]\ntime = 0\n[[collider.key]]\ntime = 1\nposition = [-3, 2, 0]\nangle = 90\n'
ground, first = file[0] + 'position = [0, -0.5, 0]\nrestitution = 0.5\n', file[1] + 'position = [2, 0, 0]\nscale = 2\n'
second = file[1] + 'position = [-3, 0.25, 0]\nfriction = 0.5\n'
table = '[[collider]]\n'
# The tiles of a node move and collide as one body.
open('moved.toml', 'w').write('world = "w/tiles.json"\n' + table + 'node = "second"\n' + keys + table +
                              'node = "first"\nposition = [2, 0, 0]\n' + rest)
open('by_hand.toml', 'w').write(table + second + keys + table + first + table + ground + rest)
P
for scene in moved by_hand; do expect 0 "$relief_sim" $scene.toml --dump $scene.ply --events $scene.jsonl --json; done
cmp moved.ply by_hand.ply || die "different particles than with placed colliders"
cmp moved.jsonl by_hand.jsonl || die "different hits than with placed colliders"
[ "$(grep -o '"body":.' moved.jsonl | sort | uniq -c | awk '$1 > 20' | wc -l)" = 3 ] || die "too few hits"
expect 0 "$relief_sim" moved.toml --json -q
json stdout "[c['node'] for c in d['settings']['collider']] == ['second', 'first', 'ground', 'second'] and d['settings']['world'] == 'w/tiles.json'"
json stdout "d['settings']['collider'][0]['key'][0]['position'] == [-3, 0.25, 0] and d['settings']['collider'][1]['position'] == [2, 0, 0]"

# Only a world: snow falls on it, also in pictures.
expect 0 "$relief_sim" w/world.json --steps 30 --frames frames --size 64x48 --dump single.ply --json
json stdout "len(d['settings']['collider']) == 5 and d['settings']['collider'][2]['angle'] != 0 and d['frames'] == 3"
[ -s frames/frame_0002.png ] || die "a world has no pictures"
echo 'world = "w/world.json"' >only.toml
expect 0 "$relief_sim" only.toml --steps 30 --dump only.ply -q
cmp single.ply only.ply || die "a scene with only a world differs"
expect 0 "$relief_sim" w/world.json --check --json
json stdout "[f['kind'] for f in d['files']] == ['world'] + ['collider'] * 3 and d['bodies'] == 5 and d['files'][0]['file'] == 'w/world.json'"
expect_error 1 "w/world.json" "$relief_sim" only.toml --dump w/world.json
printf 'world = "w/world.json"\n[[collider]]\nnode = "frist"\n' >bad.toml
expect_error 3 "bad.toml:3:8: .*frist" "$relief_sim" bad.toml --check
echo 'world = "w/none.json"' >bad.toml
expect_error 2 "bad.toml:1:9: " "$relief_sim" bad.toml --check
mv w/box-* .
expect_error 2 "w/world.json" "$relief_sim" w/world.json

# A shower moves over nine tiles and needs only a few at a time. If these are loaded, streaming does not change the run.
python3 "$RELIEF_SOURCE/tests/cli/heights.py" hills.r16 560
expect 0 "$relief" bake hills.r16 --heights low=0,high=100,tile=256 --world t --json
json stdout "len(d['tiles']) == 9 and sum(t['coarse'] is not None for t in d['tiles']) == 8"
scene() {
    printf 'world = "t/world.json"\n%s\n[time]\nsteps = 120\n[particles]\ncapacity = 4096\n[forces]\ngravity = [0, -9.81, 0]\n' "$1"
    printf '[ground]\nenabled = false\n[camera]\neye = [1, 90, 1]\ntarget = [20, 0, 20]\n[[emitter]]\nbox_min = [0, 62, 0]\n'
    printf 'box_max = [40, 66, 40]\nvelocity = [0, -30, 0]\nlifetime = 100\n[[emitter.key]]\ntime = 0\nposition = [30, 0, 30]\n'
    printf '[[emitter.key]]\ntime = 2\nposition = [480, 0, 480]\n'
}
scene '' >all.toml
scene $'[stream]\nradius = 30' >stream.toml
scene $'[stream]\nradius = 30\nmemory = 0.65' >little.toml
for name in all stream little; do
    expect 0 "$relief_sim" $name.toml --dump $name.ply --json
    json stdout "d['warnings'] == []"
    # Coarse tiles of the hills have errors up to 3 m.
    python3 "$RELIEF_SOURCE/tests/cli/heights.py" --below $name.ply 100 $([ $name = little ] && echo 3 || echo 0.05) || die "$name"
done
cmp all.ply stream.ply || die "the run differs although all needed tiles are loaded"
expect 0 "$relief_sim" little.toml --dump again.ply -q
cmp little.ply again.ply || die "two runs of one scene differ"

# A missing file is reported once. A missing coarse file is an error.
container_file() { python3 -c "import json; print(json.load(open('t/world.json'))['colliders'][0]$1['file'])"; }
fine=$(container_file '') coarse=$(container_file "['coarse']")
mv "t/$fine" kept
expect 0 "$relief_sim" stream.toml --json
json stdout "len(d['warnings']) == 1 and '$fine' in d['warnings'][0]"
expect_error 2 "stream.toml:1:9: world: .*$fine" "$relief_sim" stream.toml --check
head -c 1000 kept >"t/$fine"
expect_error 3 "stream.toml:1:9: world: .*$fine" "$relief_sim" stream.toml --check
mv kept "t/$fine"
expect 0 "$relief_sim" stream.toml --check --json
json stdout "{'t/$fine', 't/$coarse'} <= {f['file'] for f in d['files']}"
mv "t/$coarse" kept
expect_error 2 "stream.toml:1:9: world: .*$coarse" "$relief_sim" stream.toml
expect 0 "$relief_sim" all.toml -q
mv kept "t/$coarse"
scene $'[stream]\nradius = 30\nmemory = 0.01' >none.toml
expect_error 6 't/world.json' "$relief_sim" none.toml
scene $'[stream]' >none.toml
expect_error 3 'stream.radius' "$relief_sim" none.toml
