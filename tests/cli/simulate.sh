# relief-sim from outside: its dependencies, its outputs, its repeatability.
. "$(dirname "$0")/lib.sh"

for library in assimp embree CGAL gmp mpfr tbb OpenEXR IlmImf; do
    ! ldd "$relief_sim" | matches -i "$library" || die "relief-sim needs $library"
done

"$relief" bake "$bunny" -o bunny.relief --budget 200kB -q
expect 0 "$relief_sim" bunny.relief --steps 40 --frames frames --size 160x120 --dump a.ply --json --seed 3
cp stdout report.json
json report.json "d['settings']['time']['steps'] == 40"
[ "$(find frames -name '*.png' | wc -l)" -ge 1 ] || die "no frames"
first=$(find frames -name '*.png' | sort | head -1)
[ "$(identify -format '%wx%h' "$first")" = 160x120 ] || die "frames are not 160x120"
[ "$(identify -format '%k' "$first")" -gt 50 ] || die "a frame of fewer than 50 colours shows nothing"

# The same seed gives the same run, another seed a different one.
"$relief_sim" bunny.relief --steps 40 --dump b.ply --seed 3 -q
cmp a.ply b.ply || die "the same seed gives another run"
"$relief_sim" bunny.relief --steps 40 --dump c.ply --seed 4 -q
! cmp -s a.ply c.ply || die "another seed gives the same run"

# The other API runs the same scene.
"$relief_sim" bunny.relief --steps 40 --dump es.ply --seed 3 --api gles -q

# Compute shaders, where the context has them; else one line says what is missing.
"$relief_sim" bunny.relief --steps 5 --path compute --json >stdout
json stdout 'd["path"] == "compute" and d["particles"]["born"] > 0'
"$relief_sim" bunny.relief --steps 5 --path fragment --json >stdout
json stdout 'd["path"] == "fragment"'
MESA_GL_VERSION_OVERRIDE=3.3 expect_error 5 'OpenGL 4\.3 or OpenGL ES 3\.1.*take the fragment path' \
    "$relief_sim" bunny.relief --steps 5 --path compute
expect_error 1 '--check excludes --path|--path excludes --check' "$relief_sim" bunny.relief --check --path compute

# The ends of what a scene may ask for: the lightest of the largest in the thickest air and the strongest wind.
for integrator in euler verlet; do
    for air in 'drag = 1e6' 'viscosity = 1e6'; do
        cat >extreme.toml <<S
[collider]
file = "bunny.relief"
[time]
dt = 1.0
steps = 12
integrator = "$integrator"
[particles]
capacity = 1000
[emitter]
burst = 500
lifetime = [100.0, 100.0]
box_min = [-1.0, -1.0, -1.0]
box_max = [1.0, 1.0, 1.0]
[forces]
gravity = [0.0, -1e6, 0.0]
wind = [1e6, -1e6, 1e6]
$air
[[type]]
mass = 1e-15
radius = 1e9
S
        expect 0 "$relief_sim" extreme.toml --dump "extreme_${integrator}_${air%% *}.ply" -q
    done
done

# A place and a scale within their ranges that are too much together.
printf '[collider]\nfile = "bunny.relief"\nposition = [0.0, 1e9, 0.0]\nscale = 1e6\n' >moved.toml
expect_error 3 'moved.toml:2:8: .*beyond 1e\+09; place it nearer' "$relief_sim" moved.toml

# A wind that no float holds any more, within all ranges: an error that names the type, and nothing is dumped. Its own
# attractor, however small, is no such thing.
python3 -c "import struct; open('flow.raw', 'wb').write(struct.pack('<24f', *[1e6] * 24))"
lost_scene() { # RADIUS
    cat <<S
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
box_min = [2.0, 2.0, 2.0]
box_max = [2.0, 2.0, 2.0]
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
[[attractor]]
position = [2.0, 2.0, 2.0]
strength = -1e6
radius = 1e-300
[[type]]
name = "rain"
[[type]]
name = "dust"
mass = 1e-15
radius = $1
S
}
lost_scene 1e9 >lost.toml
for api in gl gles; do
    expect_error 4 "lost\.toml:31:1: particles of the type 'dust' are lost: .*; lower" \
        "$relief_sim" lost.toml --api "$api" --dump lost.ply -q
    [ ! -e lost.ply ] || die "a dump beside an error"
done
lost_scene 1e-9 >found.toml
expect 0 "$relief_sim" found.toml --dump extreme_attractor.ply -q

python3 - <<'P'
# The PLY matches its header, and every number is finite.
import glob, math, struct
extremes = glob.glob('extreme_*.ply')
assert len(extremes) == 5, extremes
for name in ['a.ply', 'es.ply'] + extremes:
    data = open(name, 'rb').read()
    head, body = data.split(b'end_header\n', 1)
    lines = head.decode().splitlines()
    assert lines[0] == 'ply' and lines[1] == 'format binary_little_endian 1.0', lines
    count = next(int(l.split()[2]) for l in lines if l.startswith('element vertex'))
    kinds = {'float': 'f', 'int': 'i', 'uint': 'I', 'uchar': 'B', 'float32': 'f', 'uint32': 'I'}
    properties = [l.split() for l in lines if l.startswith('property')]
    record = struct.Struct('<' + ''.join(kinds[p[1]] for p in properties))
    names = [p[2] for p in properties]
    assert {'x', 'y', 'z', 'vx', 'vy', 'vz'} <= set(names), names
    assert count > 100 and len(body) == count * record.size, (count, len(body), record.size)
    for values in record.iter_unpack(body):
        assert all(math.isfinite(v) for v in values), values
P
