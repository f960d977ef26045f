# SPDX-License-Identifier: Apache-2.0
# Animated meshes: bakes, checks, recipes and playback, and meshes that relief-sim deforms. Unit tests cover the import,
# poses, scene keys and errors.
. "$(dirname "$0")/lib.sh"

cp "$models/glTF2/glTF-Sample-Models/AnimatedMorphCube-glTF/"AnimatedMorphCube.{gltf,bin} .
cube=AnimatedMorphCube.gltf

expect 0 "$relief" bake $cube --animated --resolution 64 -o cube.relief --json --depfile cube.d
json stdout "d['settings']['animated'] and d['settings']['resolution'] == 64"
json stdout "[c['name'] for c in d['animation']['clips']] == ['Square'] and d['animation']['morph_targets'] == 2"
json stdout "[i['file'] for i in d['inputs']] == ['$cube', 'AnimatedMorphCube.bin']"
matches AnimatedMorphCube.bin <cube.d || die "depfile: $(cat cube.d)"
expect 0 "$relief" info cube.relief
matches -E '^  Square +4.2' <stdout && matches "^groups   'AnimatedMorphCube'" <stdout && matches "^material 'Material'" <stdout && matches -- '--animated$' <stdout || die "info: $(cat stdout)"
expect 0 "$relief" info cube.relief --json
json stdout "abs(d['animation']['clips'][0]['duration'] - 4.2) < 0.01 and d['animation']['joints'] == 1"
expect 0 "$relief" check cube.relief --mesh $cube --max-error 2
matches 'in its rest pose' <stdout || die "check: $(cat stdout)"
printf '0,0,0\n0.9,0.9,0.9\n1.5,0,0\n0,-1.2,0\n' >points.csv
expect 0 "$relief" query cube.relief --points points.csv -o field.csv
python3 -c "
import csv
rows = list(csv.DictReader(open('field.csv')))
assert [bool(r['f']) and float(r['f']) < 0 for r in rows] == [True, True, False, False], rows" || die "rest pose: $(cat field.csv)"
"$relief" view cube.relief
grep -q '"animated":true' cube.html || die "the page does not mention the rest pose"
expect 0 "$relief" bake $cube --animated --resolution 64 -o one.relief -q -j 1
cmp cube.relief one.relief || die "the number of threads changes an animated bake"
expect 0 "$relief" bake $cube -o still.relief -q
expect 0 "$relief" info still.relief --json
json stdout "d['animation'] is None"

# Clips of other files, also in recipes, whose outputs depend on them.
python3 - <<'P'
import json
d = json.load(open("AnimatedMorphCube.gltf"))
clips = dict(d)
del d["animations"]
json.dump(d, open("still.gltf", "w"))
clips["animations"][0]["name"] = "swell"
json.dump(clips, open("clips.gltf", "w"))
P
expect 0 "$relief" bake still.gltf --animated --clips $cube --clips clips.gltf --resolution 32 -o clips.relief --json
json stdout "[c['name'] for c in d['animation']['clips']] == ['Square', 'swell'] and d['settings']['clips'] == ['$cube', 'clips.gltf']"
printf '%s\n' 'version = 1' '[[asset]]' 'mesh = "still.gltf"' 'output = "out/{stem}.relief"' 'animated = true' 'clips = ["clips.gltf"]' 'resolution = 32' >r.toml
expect 0 "$relief" bake --recipe r.toml -q
sed -i 's/swell/shrink/' clips.gltf
expect 0 "$relief" bake --recipe r.toml --json
json stdout "d['counts']['baked'] == 1"
expect 0 "$relief" info out/still.relief
matches -E '^  shrink' <stdout || die "the previous clip: $(cat stdout)"

tetrahedron t.obj
expect_error 5 "t.obj" "$relief" bake t.obj --animated -o no.relief
expect_error 2 "absent.glb" "$relief" bake $cube --animated --clips absent.glb -o no.relief
expect_error 1 "--budget" "$relief" bake $cube --animated --budget 1MB -o no.relief
expect_error 1 "--clips" "$relief" bake $cube --clips $cube -o no.relief
expect_error 1 "--animated" "$relief" bake $cube --animated --world w
expect_error 1 "clips.gltf" "$relief" bake $cube --animated --clips clips.gltf -o clips.gltf
[ ! -e no.relief ] || die "an output despite an error"

# A scene plays the clip.
printf '%s\n' 'time = { steps = 20 }' '[particles]' 'capacity = 1024' '[[collider]]' 'file = "cube.relief"' 'play = { clip = "Square", speed = 2 }' >scene.toml
expect 0 "$relief_sim" scene.toml -q
sed -i 's/Square/Circle/' scene.toml
expect_error 3 "scene.toml:.*'Circle'" "$relief_sim" scene.toml -q

# A deformed torus: the particles end elsewhere than on a nearly rigid one, and the result is reproducible.
python3 "$RELIEF_SOURCE/samples/meshes.py" torus torus.obj
scene() { # KEY…: of [collider]
    printf '%s\n' '[collider]' "$@" '[time]' 'steps = 30' '[particles]' 'capacity = 2000' '[emitter]' 'box_min = [-1.2, 0.4, -1.2]' \
        'box_max = [1.2, 0.5, 1.2]' 'rate = 0.0' 'burst = 2000' 'lifetime = 100.0' '[ground]' 'height = -1.0' '[render]' \
        'mesh = "torus.obj"' 'size = [160, 120]' 'steps_per_frame = 15' >scene.toml
}
scene 'mesh = "torus.obj"' 'deform = { amplitude = 1e-4, frequency = 2 }' 'resolution = 64'
"$relief_sim" scene.toml --dump still.ply -q
scene 'mesh = "torus.obj"' 'deform = { amplitude = 0.1, frequency = 2 }' 'resolution = 64'
expect 0 "$relief_sim" scene.toml --check
[[ $(cat stdout) == *"3 maps"* && $(cat stdout) == *"torus.obj"* ]] || die "--check does not mention the mesh"
expect 0 "$relief_sim" scene.toml --dump wobble.ply --frames frames --json
json stdout "d['settings']['collider']['deform']['frequency'] == 2 and d['particles']['alive'] == 2000 and d['particles']['in_contact'] > 0"
! cmp -s still.ply wobble.ply || die "the wobble has no effect"
[ "$(identify -format '%k' frames/frame_0001.png)" -gt 100 ] || die "a frame is empty"
! cmp -s frames/frame_0000.png frames/frame_0001.png || die "two frames are equal"
"$relief_sim" scene.toml --dump again.ply -q
cmp wobble.ply again.ply || die "the result is not reproducible"
"$relief_sim" scene.toml --dump es.ply --api gles -q || die "failed in OpenGL ES"
sed -i 's/torus.obj/none.obj/' scene.toml
expect_error 2 'scene.toml:2:8: ' "$relief_sim" scene.toml --check
echo "no mesh" >none.obj
expect_error 3 'none.obj' "$relief_sim" scene.toml
