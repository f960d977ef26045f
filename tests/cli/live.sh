# Scenes whose collider deforms: relief-sim plays them without a baked file, and refuses nonsense in one line.
. "$(dirname "$0")/lib.sh"

python3 "$RELIEF_SOURCE/samples/meshes.py" torus torus.obj
scene() { # KEYS… of [collider]
    {
        echo '[collider]'
        printf '%s\n' "$@"
        cat <<'T'
[time]
steps = 30
[particles]
capacity = 2000
[emitter]
box_min = [-1.2, 0.4, -1.2]
box_max = [1.2, 0.5, 1.2]
rate = 0.0
burst = 2000
lifetime = 100.0
[ground]
height = -1.0
T
    } >scene.toml
}
wobble='deform = { amplitude = 0.1, frequency = 2 }'

# The mesh moves, so the particles end elsewhere than on a mesh that hardly does; the same scene ends the same.
scene 'mesh = "torus.obj"' 'deform = { amplitude = 1e-4, frequency = 2 }' 'resolution = 64'
"$relief_sim" scene.toml --dump still.ply -q
scene 'mesh = "torus.obj"' "$wobble" 'resolution = 64'
expect 0 "$relief_sim" scene.toml --check
[[ $(cat stdout) == *"3 maps"* && $(cat stdout) == *"torus.obj"* ]] || die "--check does not tell of the mesh"
expect 0 "$relief_sim" scene.toml --dump wobble.ply --json
cp stdout report.json
json report.json "d['settings']['collider']['deform']['frequency'] == 2"
json report.json "d['particles']['alive'] == 2000 and d['particles']['in_contact'] > 0"
! cmp -s still.ply wobble.ply || die "the wobble does nothing"
"$relief_sim" scene.toml --dump again.ply -q
cmp wobble.ply again.ply || die "the same scene ends in another way"
"$relief_sim" scene.toml --dump es.ply --api gles -q || die "not in OpenGL ES"

# Pictures show the deformed mesh, and change with it.
printf '[render]\nmesh = "torus.obj"\nsize = [160, 120]\nevery = 15\n' >>scene.toml
expect 0 "$relief_sim" scene.toml --frames frames --steps 30
[ "$(identify -format '%k' frames/frame_0001.png)" -gt 100 ] || die "a frame shows nothing"
! cmp -s frames/frame_0000.png frames/frame_0001.png || die "two frames are the same"

# Mistakes get one line, which names the place.
scene 'mesh = "torus.obj"' 'deform = { kind = "twist", amplitude = 1, frequency = 1 }'
expect_error 3 'scene.toml:3:12: .*kind' "$relief_sim" scene.toml
scene 'mesh = "none.obj"' "$wobble"
expect_error 2 'scene.toml:2:8: collider.mesh: .*none.obj' "$relief_sim" scene.toml --check
scene 'mesh = "torus.obj"'
expect_error 3 'scene.toml:2:8: .*needs collider.deform' "$relief_sim" scene.toml --check
echo "no mesh" >broken.obj
scene 'mesh = "broken.obj"' "$wobble"
expect_error 3 'collider.mesh: .*broken.obj' "$relief_sim" scene.toml
