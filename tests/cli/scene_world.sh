# Worlds in scenes: the same particles as of colliders that are placed by hand; bodies that move; bad worlds and names.
. "$(dirname "$0")/lib.sh"

python3 "$RELIEF_SOURCE/tests/cli/level.py" level.gltf
"$relief" bake level.gltf --world w --budget 200kB -q
python3 - <<'P'
import json
d = json.load(open('w/world.json'))
floor, box = (next(i for i, c in enumerate(d['colliders']) if c['mesh'] == name) for name in ('floor', 'box'))
body = {'rotation': [0, 0, 0, 1], 'scale': 1, 'restitution': 1, 'friction': 0}
d['bodies'] = [{**body, 'collider': floor, 'node': 'ground', 'position': [0, -0.5, 0], 'restitution': 0.5},
               {**body, 'collider': box, 'node': 'first', 'position': [1, 0, 0], 'scale': 2},
               {**body, 'collider': box, 'node': 'second', 'position': [-3, 0.25, 0], 'friction': 0.5}]
json.dump(d, open('w/three.json', 'w'))
json.dump({**d, 'bodies': d['bodies'] + d['bodies'][2:]}, open('w/tiles.json', 'w'))  # of the second node two, in one place
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
collides = [0, 1, 2]
[ground]
enabled = false
'''
keys = '[[collider.key]]\ntime = 0\n[[collider.key]]\ntime = 1\nposition = [-3, 2, 0]\nangle = 90\n'
ground, first = file[0] + 'position = [0, -0.5, 0]\nrestitution = 0.5\n', file[1] + 'position = [1, 0, 0]\nscale = 2\n'
second = file[1] + 'position = [-3, 0.25, 0]\nfriction = 0.5\n'
table = '[[collider]]\n'
scenes = {'world': 'world = "w/three.json"\n' + rest,
          'hand': table + ground + table + first + table + second + rest,
          'moved': 'world = "w/three.json"\n' + table + 'node = "second"\n' + keys + table + 'node = "first"\nposition = [2, 0, 0]\n' + rest,
          'moved_hand': table + second + keys + table + first.replace('[1, ', '[2, ') + table + ground + rest,
          'beside': 'world = "w/three.json"\n' + table + file[1] + 'position = [8, 0, 0]\n' + rest,
          'beside_hand': table + file[1] + 'position = [8, 0, 0]\n' + table + ground + table + first + table + second + rest}
# As many tiles move and are met as one body; by the number of the node's table, of all that are left out.
scenes['tiles'], scenes['tiles_hand'] = scenes['moved'].replace('three', 'tiles'), scenes['moved_hand']
scenes['through'] = scenes['tiles'].replace('[0, 1, 2]', '[1, 2]')
scenes['through_hand'] = scenes['moved_hand'].replace('[0, 1, 2]', '[1, 2]')
for name, text in scenes.items():
    open(name + '.toml', 'w').write(text)
P

for scene in world moved beside tiles through; do
    for one in $scene ${scene}_hand; do
        expect 0 "$relief_sim" $([ $one = world_hand ] && echo hand || echo $one).toml --dump $one.ply --events $one.jsonl --json
        mv stdout $one.json
    done
    cmp $scene.ply ${scene}_hand.ply || die "$scene: other particles than by hand"
    cmp $scene.jsonl ${scene}_hand.jsonl || die "$scene: other hits than by hand"
    [ "$(grep -o '"body":.' $scene.jsonl | sort | uniq -c | awk '$1 > 20' | wc -l)" = "$([ $scene = through ] && echo 2 || echo 3)" ] ||
        die "$scene: nearly nothing is hit: $(grep -o '"body":.' $scene.jsonl | sort | uniq -c)"
done
! cmp -s world.ply moved.ply || die "a moved body moves nothing"
json world.json "[c['node'] for c in d['settings']['collider']] == ['ground', 'first', 'second'] and d['settings']['world'] == 'w/three.json'"
json world.json "d['settings']['type'][0]['collides'] == [0, 1, 2] and d['settings']['collider'][1]['scale'] == 2"
json moved.json "[c['node'] for c in d['settings']['collider']] == ['second', 'first', 'ground']"
json moved.json "d['settings']['collider'][0]['key'][0]['position'] == [-3, 0.25, 0] and d['settings']['collider'][1]['position'] == [2, 0, 0]"
! cmp -s tiles.ply through.ply || die "a node that is passed through changes nothing"
json tiles.json "[c['node'] for c in d['settings']['collider']] == ['second', 'first', 'ground', 'second']"
# Each file is on the GPU once, also where a collider names it again.
json beside.json "d['collider'] == $(python3 -c "import json; print(json.load(open('world.json'))['collider'])")"

# A world alone: snow falls on it, in pictures too. The same with every number a step's path has.
expect 0 "$relief_sim" w/world.json --steps 30 --frames frames --size 64x48 --dump alone.ply --json
json stdout "len(d['settings']['collider']) == 5 and d['settings']['collider'][2]['angle'] != 0 and d['frames'] == 3"
[ -s frames/frame_0002.png ] || die "no pictures of a world"
echo 'world = "w/world.json"' >only.toml
expect 0 "$relief_sim" only.toml --steps 30 --dump only.ply -q
cmp alone.ply only.ply || die "a scene of a world alone is another scene"
expect 0 "$relief_sim" w/world.json --check --json
json stdout "[f['kind'] for f in d['files']] == ['world'] + ['collider'] * 3 and d['bodies'] == 5 and d['files'][0]['file'] == 'w/world.json'"
expect 0 "$relief_sim" moved.toml --check
grep -q '3 bodies of a world' stdout || die "--check: $(cat stdout)"
# Outputs do not overwrite what a world names.
expect_error 1 "is the input|is read|would be" "$relief_sim" only.toml --dump w/world.json

# Bad scenes: one line, with the place.
scene() { # scene CODE PATTERN TEXT
    printf "$3" >bad.toml
    expect_error "$1" "$2" "$relief_sim" bad.toml --check
}
scene 2 "bad.toml:1:9: world: .*No such file" 'world = "w/none.json"\n'
scene 3 "bad.toml:1:9: world .*leaves|bad.toml:1:9: world.*folder" 'world = "../w/world.json"\n'
scene 3 "bad.toml:3:1: collider.node needs world|bad.toml:2:8: collider.node needs world" '[[collider]]\nnode = "first"\n'
scene 3 "bad.toml:1:9: collider.0..node = 'frist' is the name of no body of 'w/world.json'; " 'world = "w/world.json"\n[[collider]]\nnode = "frist"\n'
scene 3 "node = 'first' is named by two colliders; " 'world = "w/world.json"\n[[collider]]\nnode = "first"\n[[collider]]\nnode = "first"\n'
scene 3 "bad.toml:4:9: collider.scale of a body is the world's; " 'world = "w/world.json"\n[[collider]]\nnode = "first"\nscale = 2\n'
scene 3 "node is empty; " 'world = "w/world.json"\n[[collider]]\nnode = ""\n'
scene 3 "collider.node.*collider.file|collider.file.*collider.node" 'world = "w/world.json"\n[[collider]]\nnode = "first"\nfile = "a.relief"\n'
scene 3 "render.mesh is drawn for a single collider, and not for a world; " 'world = "w/world.json"\n[render]\nmesh = "a.obj"\n'
scene 3 "collides" 'world = "w/world.json"\n[[type]]\ncollides = [65536]\n'
scene 3 "type.0..collides names a body that the scene does not have; .* there are 5, numbered from 0" 'world = "w/world.json"\n[[type]]\ncollides = [9]\n'
scene 3 "type.0..collides names a body that the scene does not have; .* there are 3, numbered from 0" 'world = "w/tiles.json"\n[[collider]]\nnode = "second"\n[[type]]\ncollides = [3]\n'
python3 - <<'P'
import json
d = json.load(open('w/world.json'))
for name, bodies in (('twice', d['bodies'] + [{**d['bodies'][1], 'scale': 2}]), ('many', d['bodies'][:1] * 65536), ('far', [{**d['bodies'][0], 'position': [1e12, 0, 0]}])):
    json.dump({**d, 'bodies': bodies}, open(f'w/{name}.json', 'w'))
P
scene 3 "node = 'first' is the name of 2 bodies of 'w/twice.json' in different places; " 'world = "w/twice.json"\n[[collider]]\nnode = "first"\n'
scene 6 "bad.toml:1:9: the world's 65536 bodies and the scene's other colliders are more than 65536; " "world = \"w/many.json\"\n[[collider]]\n$(sed -n '2s/$/\\n/p' hand.toml)position = [9, 9, 9]\n"
scene 3 "bad.toml:1:9: its position and scale bring" 'world = "w/far.json"\n'
expect_error 3 "w/far.json'?: .*reach beyond" "$relief_sim" w/far.json --check
expect_error 2 "w/none.json" "$relief_sim" w/none.json
echo '{}' >w/none.json
expect_error 3 "w/none.json.*is no world.*; " "$relief_sim" w/none.json
mv w/box-* .
expect_error 2 "w/world.json.*colliders.*No such file" "$relief_sim" w/world.json
