# Animated meshes: baked, shown, checked, the same for any number of threads, from recipes, and refused in one line.
. "$(dirname "$0")/lib.sh"

cp "$models/glTF2/simple_skin/simple_skin.gltf" skin.gltf
cp "$models/glTF2/glTF-Sample-Models/AnimatedMorphCube-glTF/"AnimatedMorphCube.{gltf,bin} .
cube=AnimatedMorphCube.gltf

expect 0 "$relief" bake $cube --animated --resolution 64 -o cube.relief --json --depfile cube.d
cp stdout report.json
json report.json "d['version'] == '1.5' and d['settings']['animated'] and d['settings']['resolution'] == 64"
json report.json "[c['name'] for c in d['animation']['clips']] == ['Square'] and d['animation']['morph_targets'] == 2"
json report.json "[m['encloses'] for m in d['maps']] == [False] * 3 and {(m['width'], m['height']) for m in d['maps']} == {(64, 64)}"
json report.json "[i['file'] for i in d['inputs']] == ['$cube', 'AnimatedMorphCube.bin']"
matches AnimatedMorphCube.bin <cube.d || die "depfile: $(cat cube.d)"
expect 0 "$relief" info cube.relief
matches '24 vertices moved by 1 joint and 2 morph targets' <stdout || die "info: $(cat stdout)"
matches -E '^  Square +4.2' <stdout || die "no clip: $(cat stdout)"
matches -- '--animated$' <stdout || die "not recorded: $(cat stdout)"
expect 0 "$relief" info cube.relief --json
json stdout "abs(d['animation']['clips'][0]['seconds'] - 4.2) < 0.01 and d['animation']['joints'] == 1"
json stdout "d['animation']['groups'] == ['AnimatedMorphCube'] and d['animation']['materials'] == ['Material']"
expect 0 "$relief" check cube.relief
expect 0 "$relief" check cube.relief --mesh $cube --max-error 2
matches 'in its rest pose' <stdout || die "check: $(cat stdout)"

# A program that knows no animation has a collider at rest.
printf '0,0,0\n0.9,0.9,0.9\n1.5,0,0\n0,-1.2,0\n' >points.csv
expect 0 "$relief" query cube.relief --points points.csv -o field.csv
python3 -c "
import csv
rows = list(csv.DictReader(open('field.csv')))
assert [bool(r['f']) and float(r['f']) < 0 for r in rows] == [True, True, False, False], rows" || die "rest pose: $(cat field.csv)"

expect 0 "$relief" bake $cube --animated --resolution 64 -o one.relief -q -j 1
cmp cube.relief one.relief || die "threads change an animated bake"
expect 0 "$relief" bake $cube -o still.relief -q
expect 0 "$relief" info still.relief --json
json stdout "d['animation'] is None and d['version'] != '1.5'"

# Clips of other files, by names of nodes; from a recipe too, whose outputs follow them.
python3 - <<'P'
import json
d = json.load(open("AnimatedMorphCube.gltf"))
clips = dict(d)
del d["animations"]
json.dump(d, open("still.gltf", "w"))
clips["animations"][0]["name"] = "swell"
json.dump(clips, open("clips.gltf", "w"))
clips["nodes"][0]["name"] = "Somebody"
json.dump(clips, open("strange.gltf", "w"))
P
expect 0 "$relief" bake still.gltf --animated --clips $cube --clips clips.gltf --resolution 32 -o clips.relief --json
json stdout "[c['name'] for c in d['animation']['clips']] == ['Square', 'swell'] and d['settings']['clips'] == ['$cube', 'clips.gltf']"
json stdout "[i['file'] for i in d['inputs']] == ['still.gltf', 'AnimatedMorphCube.bin', '$cube', 'AnimatedMorphCube.bin', 'clips.gltf', 'AnimatedMorphCube.bin']"
cat >r.toml <<'T'
version = 1
[[asset]]
mesh = "still.gltf"
output = "out/{stem}.relief"
animated = true
clips = ["clips.gltf"]
resolution = 32
T
expect 0 "$relief" bake --recipe r.toml --dry-run --json
key=$(python3 -c "import json; print(json.load(open('stdout'))['assets'][0]['key'])")
expect 0 "$relief" bake --recipe r.toml --json
json stdout "d['counts']['baked'] == 1 and d['assets'][0]['key'] == '$key'"
expect 0 "$relief" bake --recipe r.toml --json
json stdout "d['counts']['baked'] == 0"
sed -i 's/swell/shrink/' clips.gltf
expect 0 "$relief" bake --recipe r.toml --json
json stdout "d['counts']['baked'] == 1"
expect 0 "$relief" info out/still.relief
matches -E '^  shrink' <stdout || die "the clip of before: $(cat stdout)"

expect 0 "$relief" bake still.gltf --animated -o posable.relief --resolution 32
matches 'still.gltf: it has no animation, and moves only as a program poses it' <stderr || die "$(cat stderr)"
tetrahedron='v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n'
printf "$tetrahedron" >t.obj
expect_error 5 "animations of a .obj are not read; convert it to glTF" "$relief" bake t.obj --animated -o no.relief
expect_error 3 "strange.gltf': none of the nodes that it moves is one of the mesh, by name: 'Somebody'" \
    "$relief" bake still.gltf --animated --clips strange.gltf -o no.relief
expect_error 3 "nothing in it moves" "$relief" bake "$models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb" \
    --animated -o no.relief
expect_error 2 "absent.glb" "$relief" bake $cube --animated --clips absent.glb -o no.relief
expect_error 1 "--budget does nothing with --animated; leave one out" "$relief" bake $cube --animated --budget 1MB -o no.relief
expect_error 1 "--clips does nothing without --animated; add it" "$relief" bake $cube --clips $cube -o no.relief
expect_error 1 "--animated is for one mesh, and a level has many" "$relief" bake $cube --animated --world w
expect_error 1 "the same file|overwrite|input" "$relief" bake $cube --animated --clips clips.gltf -o clips.gltf
[ ! -e no.relief ] || die "an output beside an error"

# A scene plays the clip; what the clip is not, is refused where it stands.
cat >scene.toml <<'T'
time = { steps = 20 }
[particles]
capacity = 1024
[[collider]]
file = "cube.relief"
play = { clip = "Square", speed = 2 }
[[collider]]
file = "cube.relief"
position = [5, 0, 0]
T
expect 0 "$relief_sim" scene.toml -q
sed -i 's/Square/Circle/' scene.toml
expect_error 3 "scene.toml:.*'Circle' is no clip of .*'Square'" "$relief_sim" scene.toml -q
sed -i 's/cube.relief/still.relief/; s/Circle/Square/' scene.toml
expect_error 3 "has no animated mesh; bake it with --animated" "$relief_sim" scene.toml -q
