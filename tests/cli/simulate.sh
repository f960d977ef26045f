# SPDX-License-Identifier: Apache-2.0
# relief-sim from outside: its dependencies, --check, and its outputs, read by an independent reader.
. "$(dirname "$0")/lib.sh"

for library in assimp embree CGAL gmp mpfr tbb OpenEXR IlmImf; do
    ! ldd "$relief_sim" | matches -i "$library" || die "relief-sim needs $library"
done
"$relief" bake "$bunny" -o bunny.relief --paper --resolution 64 -q
# OpenGL without KHR_robustness.
expect 0 env GALLIUM_DRIVER=softpipe "$relief_sim" bunny.relief --steps 2
cat >scene.toml <<'S'
[collider]
file = "bunny.relief"
[time]
steps = 25
[particles]
capacity = 3000
[emitter]
burst = 1000
lifetime = [0.1, 1.0]
[render]
size = [33, 21]
steps_per_frame = 10
S

# --check needs no GPU, display or driver: here any attempt to create a context fails with 5.
no_gl=(env LIBGL_DRIVERS_PATH=/nonexistent __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent/egl.json)
expect 5 "${no_gl[@]}" "$relief_sim" scene.toml --steps 1
expect 0 "${no_gl[@]}" "$relief_sim" scene.toml --check
[ "$(wc -l <stdout)" -eq 1 ] && [ ! -s stderr ] && grep -q "scene.toml.* 25 steps .*3000 particles.*bunny.relief" stdout ||
    die "--check does not print one line: $(cat stdout stderr)"
expect 0 "${no_gl[@]}" "$relief_sim" scene.toml --check --json
json stdout "d['valid'] is True and d['steps'] == 25 and [f['kind'] for f in d['files']] == ['scene', 'collider']"
json stdout "all(f['bytes'] == __import__('os').path.getsize(f['file']) for f in d['files'])"
expect 0 "$relief_sim" scene.toml --check -q
[ ! -s stdout ] || die "--check -q prints output"

mkdir sub
ln -s "$bunny" sub/link.relief
check_fails() { # CODE PATTERN SCENE
    printf '%s\n' "$3" >sub/bad.toml
    expect_error "$1" "sub/bad\.toml$2" "$relief_sim" sub/bad.toml --check
    expect "$1" "$relief_sim" sub/bad.toml --check --json
    json stdout "d['valid'] is False and d['code'] == $1 and len(d['error']) > 10"
}
check_fails 2 ':2:8: .*missing\.relief' $'[collider]\nfile = "missing.relief"'
check_fails 3 ':2:8: ' $'[collider]\nfile = "../bunny.relief"'
check_fails 3 ':2:8: ' $'[collider]\nfile = "link.relief"'
cp bunny.relief sub/
check_fails 3 ':4:.*fraction' $'[collider]\nfile = "bunny.relief"\n[collision]\nfraction = 1'
check_fails 2 ':4:.*missing\.obj' $'[collider]\nfile = "bunny.relief"\n[render]\nmesh = "missing.obj"'
check_fails 6 '.*67108864' $'[collider]\nfile = "bunny.relief"\n[render]\nsize = [65535, 65535]'
expect_error 1 '--check' "$relief_sim" scene.toml --check --frames frames

# Frames, the final dump and the report agree, and pictures are not empty.
expect 0 "$relief_sim" scene.toml --dump-frames dumps --dump final.ply --frames frames --size 160x120 --json --seed 3
cp stdout report.json
python3 - <<'P'
import glob, json, math, ply
report = json.load(open('report.json'))
files = sorted(glob.glob('dumps/*'))
assert files == [f'dumps/particles_{i:04}.ply' for i in range(3)], files
assert report['settings']['time']['steps'] == 25 and report['dumps'] == report['frames'] == 3
assert open(files[-1], 'rb').read() == open('final.ply', 'rb').read()
for file in files:
    particles = ply.read(file)
    assert list(particles[0]) == ['x', 'y', 'z', 'vx', 'vy', 'vz', 'age', 'lifetime', 'id', 'type']
    ids = [p['id'] for p in particles]
    assert ids == sorted(set(ids)) and max(ids) < report['particles']['born']
    assert all(0 <= p['age'] <= p['lifetime'] <= 1.001 and p['type'] == 0 for p in particles)
    assert all(map(math.isfinite, (value for p in particles for value in p.values())))
last = report['particles']
assert len(particles) == last['alive'] == last['born'] - last['died'] > 0
assert last['died'] > 0 and last['collisions'] >= last['in_contact'] >= 0
P
[ "$(identify -format '%wx%h' frames/frame_0001.png)" = 160x120 ] || die "frames are not 160x120"
[ "$(identify -format '%k' frames/frame_0001.png)" -gt 50 ] || die "a frame has fewer than 50 colours"

# Equal seeds give equal runs, different seeds different ones. Compute shaders and the other API play the same scene.
"$relief_sim" scene.toml --dump - --seed 3 >again.ply 2>text
cmp again.ply final.ply || die "the same seed gives a different run, or --dump - different bytes"
grep -q '25 steps' text || die "the summary is not on stderr with --dump -"
"$relief_sim" scene.toml --dump other.ply --seed 4 -q
! cmp -s other.ply final.ply || die "another seed gives the same run"
"$relief_sim" scene.toml --shaders compute --api gles --dump other.ply --seed 3 --json >stdout
json stdout 'd["shaders"] == "compute" and d["particles"]["born"] > 0'
cmp other.ply final.ply || die "compute shaders give a different run"
MESA_GL_VERSION_OVERRIDE=3.3 expect_error 5 'OpenGL 4\.3 or OpenGL ES 3\.1' "$relief_sim" scene.toml --shaders compute
expect_error 1 '--shaders' "$relief_sim" scene.toml --check --shaders compute

# Valid settings whose combination is too large: one line, and nothing is dumped.
printf '[collider]\nfile = "bunny.relief"\nposition = [0.0, 1e9, 0.0]\nscale = 1e6\n' >moved.toml
expect_error 3 'moved.toml:2:8: ' "$relief_sim" moved.toml
python3 -c "import struct; open('flow.raw', 'wb').write(struct.pack('<24f', *[1e6] * 24))"
cat >lost.toml <<'S'
[collider]
file = "bunny.relief"
[time]
dt = 0.01
steps = 100
[particles]
capacity = 1000
[emitter]
burst = 500
lifetime = [100.0, 100.0]
type = "dust"
[forces]
viscosity = 1e6
[flow]
raw = "flow.raw"
size = [2, 2, 2]
box_min = [-1e9, -1e9, -1e9]
box_max = [1e9, 1e9, 1e9]
gain = 1e6
outside = "edge"
[ground]
enabled = false
[[type]]
name = "rain"
[[type]]
name = "dust"
mass = 1e-15
radius = 1e9
S
for api in gl gles; do
    expect_error 4 "lost\.toml:25:1: .*'dust'" "$relief_sim" lost.toml --api "$api" --dump lost.ply -q
    [ ! -e lost.ply ] || die "a dump despite an error"
done
