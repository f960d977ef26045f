# relief-sim --check, and what relief-sim writes while it plays: dumps, statistics. Readers that share no code
# with it read each of them.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o bunny.relief --paper --resolution 64 -q
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
every = 10
S

# --check needs no GPU, display or driver: here any attempt to open a context fails with 5.
no_gl=(env LIBGL_DRIVERS_PATH=/nonexistent __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent/egl.json)
expect 5 "${no_gl[@]}" "$relief_sim" scene.toml --steps 1
expect 0 "${no_gl[@]}" "$relief_sim" scene.toml --check
[ "$(wc -l <stdout)" -eq 1 ] && [ ! -s stderr ] || die "--check does not answer with one line"
grep -q "^'scene.toml' is valid: 25 steps of up to 3000 particles, .* collider 'bunny.relief'$" stdout ||
    die "--check says: $(cat stdout)"
expect 0 "${no_gl[@]}" "$relief_sim" scene.toml --check --json
json stdout "d['valid'] is True and d['steps'] == 25 and [f['kind'] for f in d['files']] == ['scene', 'collider']"
json stdout "all(f['bytes'] == __import__('os').path.getsize(f['file']) for f in d['files'])"
expect 0 "$relief_sim" bunny.relief --check --json
json stdout "[f['file'] for f in d['files']] == ['bunny.relief']"
expect 0 "$relief_sim" scene.toml --check -q
[ ! -s stdout ] || die "--check -q says something"

mkdir sub
head -c 1000 bunny.relief >truncated.relief
ln -s "$bunny" sub/link.relief
check_fails() { # CODE PATTERN SCENE
    printf '%s\n' "$3" >sub/bad.toml
    expect_error "$1" "$2" "$relief_sim" sub/bad.toml --check
    expect "$1" "$relief_sim" sub/bad.toml --check --json
    json stdout "d['valid'] is False and d['code'] == $1 and len(d['error']) > 10"
}
cp truncated.relief sub/
check_fails 3 'sub/bad\.toml:2:8: collider\.file: .*truncated\.relief' $'[collider]\nfile = "truncated.relief"'
check_fails 2 'sub/bad\.toml:2:8: .*missing\.relief' $'[collider]\nfile = "missing.relief"'
check_fails 3 'sub/bad\.toml:2:8: .*leads out' $'[collider]\nfile = "../bunny.relief"'
check_fails 3 'sub/bad\.toml:2:8: .*leads out' $'[collider]\nfile = "link.relief"'
check_fails 3 'sub/bad\.toml:2:8: .*absolute' "[collider]"$'\n'"file = \"$PWD/bunny.relief\""
cp bunny.relief sub/
check_fails 3 'sub/bad\.toml:4:.*fraction' $'[collider]\nfile = "bunny.relief"\n[collision]\nfraction = 1'
check_fails 2 'sub/bad\.toml:4:.*render\.mesh: .*missing\.obj' $'[collider]\nfile = "bunny.relief"\n[render]\nmesh = "missing.obj"'
check_fails 3 'sub/bad\.toml:4:.*render\.atlas: .*bunny\.relief' $'[collider]\nfile = "bunny.relief"\n[render]\natlas = "bunny.relief"\n[[type]]\ncell = 0'
check_fails 6 'sub/bad\.toml.*67108864' $'[collider]\nfile = "bunny.relief"\n[render]\nsize = [65535, 65535]'
expect_error 1 '--check' "$relief_sim" scene.toml --check --frames frames

# Dumps of every frame, the final one and the report tell the same story.
expect 0 "$relief_sim" scene.toml --dump-frames dumps --dump final.ply --json
cp stdout report.json
cat >read.py <<'P'
import glob, json, struct

def ply(name):
    data = open(name, 'rb').read()
    head, body = data.split(b'end_header\n', 1)
    lines = head.decode().splitlines()
    assert lines[:2] == ['ply', 'format binary_little_endian 1.0'], lines
    count = next(int(l.split()[2]) for l in lines if l.startswith('element vertex'))
    properties = [l.split()[1:] for l in lines if l.startswith('property')]
    assert properties == [['float', n] for n in ('x', 'y', 'z', 'vx', 'vy', 'vz', 'age', 'lifetime')] + [
        ['uint', 'id'], ['uint', 'type']], properties
    record = struct.Struct('<8f2I')
    assert len(body) == count * record.size
    names = [p[1] for p in properties]
    return [dict(zip(names, values)) for values in record.iter_unpack(body)]

report = json.load(open('report.json'))
files = sorted(glob.glob('dumps/*'))
assert files == [f'dumps/particles_{i:04}.ply' for i in range(3)], files
assert report['dumps'] == 3 and report['frames'] == 0
assert open(files[-1], 'rb').read() == open('final.ply', 'rb').read()
for file in files:
    particles = ply(file)
    ids = [p['id'] for p in particles]
    assert ids == sorted(set(ids)) and max(ids) < report['particles']['born']
    assert all(0 <= p['age'] <= p['lifetime'] <= 1.001 and p['type'] == 0 for p in particles)
last = report['particles']
assert len(ply('final.ply')) == last['alive'] == last['born'] - last['died'] > 0
assert last['died'] > 0 and last['collisions'] >= last['in_contact'] >= 0
P
python3 read.py
cp -r dumps first
"$relief_sim" scene.toml --dump-frames dumps --dump - >again.ply 2>text
diff -r dumps first || die "the same scene gives other dumps"
cmp again.ply final.ply || die "--dump - differs"
grep -q '25 steps' text || die "the summary is not on stderr beside --dump -"

expect_error 1 '--dump' "$relief_sim" scene.toml --events - --dump -
expect_error 2 'scene\.toml.*--dump-frames' "$relief_sim" scene.toml --dump-frames scene.toml
