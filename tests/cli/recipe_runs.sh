# SPDX-License-Identifier: Apache-2.0
# Recipe runs as processes: crashes, shards, signals and closed pipes; keys for external caches; the examples of pages.
. "$(dirname "$0")/lib.sh"

mkdir in
for i in 1 2 3 4 5; do tetrahedron "in/r$i.obj" "$i"; done
printf '%s\n' 'version = 1' '[[asset]]' 'mesh = "r?.obj"' 'output = "{stem}.relief"' 'map = "cube:size=32"' >in/r.toml

# One bake at a time and four concurrent shards in one folder give the same bytes.
expect 0 "$relief" bake --recipe in/r.toml -o single -j 1
container_hashes single >first
jobs=()
for k in 1 2 3 4; do
    "$relief" bake --recipe in/r.toml -o shards --shard $k/4 --events "s$k" -j 1 -q &
    jobs+=($!)
done
for job in "${jobs[@]}"; do wait "$job" || die "a shard failed"; done
container_hashes shards | cmp - first || die "four shards give different bytes"
[ "$(cat s1 s2 s3 s4 | grep -c '"event":"done"')" -eq 5 ] || die "shards overlap"
expect 0 "$relief" bake --recipe in/r.toml -o shards
[ "$(cat stderr)" = "5 assets up to date" ] || die "the cache of the shards is incomplete: $(cat stderr)"

# A crashed bake affects nothing else: the other asset is baked, and no temporary file is left.
mkdir many
for i in 0 1 2 3 4; do cp "$bunny" many/b$i.obj; done
tetrahedron many/a.obj
cat >many/m.toml <<'T'
version = 1
[defaults]
output = "{stem}.relief"
[[asset]]
mesh = "a.obj"
map = "cube:size=32"
[[asset]]
mesh = "b?.obj"
budget = "16MB"
quality = "best"
T
sed '/b?.obj/s/b?/b0/' many/m.toml >many/one.toml
python3 - "$relief" <<'P' || die "a crash is not reported as one"
import json, os, signal, subprocess, sys
run = subprocess.Popen([sys.argv[1], 'bake', '--recipe', 'many/one.toml', '-j', '1', '--events', '-'],
                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
while (event := json.loads(run.stdout.readline()))['event'] != 'started' or event['mesh'] != 'b0.obj':
    pass
# The event precedes the process.
while not (children := open(f'/proc/{run.pid}/task/{run.pid}/children').read().split()):
    pass
child = int(children[0])
while b'--json' not in (words := open(f'/proc/{child}/cmdline', 'rb').read()):  # until the child executes the bake
    pass
assert b'--timeout=3600' in words.split(b'\0'), words
os.kill(child, signal.SIGSEGV)
events = [json.loads(line) for line in run.stdout]
failed = [e for e in events if e['event'] == 'failed']
assert run.wait() == 4, run.returncode
assert len(failed) == 1 and failed[0]['code'] == 4 and 'signal 11' in failed[0]['error'], events
P
[ -f many/a.relief ] && rm many/a.relief || die "the other asset is missing"

# An interrupted run exits by the signal within 2 s and leaves no child and no temporary file. Finished outputs are
# kept.
for signal in INT TERM; do
    python3 - "$relief" $signal <<'P' || die "interrupting by SIG$signal failed"
import json, processes, signal, subprocess, sys, time
number = getattr(signal, 'SIG' + sys.argv[2])
signal.signal(signal.SIGINT, signal.default_int_handler)  # bash ignores SIGINT in background jobs
run = subprocess.Popen([sys.argv[1], 'bake', '--recipe', 'many/m.toml', '-j', '2', '--events', '-'],
                       stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
started = 0
for line in run.stdout:
    event = json.loads(line)
    started += event['event'] == 'started' and event['mesh'].startswith('b')
    if started == 2:
        break
time.sleep(0.3)
children = open(f'/proc/{run.pid}/task/{run.pid}/children').read().split()
assert children, 'no child runs'
begin = time.monotonic()
run.send_signal(number)
rest = [json.loads(line) for line in run.stdout]
code = run.wait()
took = time.monotonic() - begin
assert code == -number, code
assert took < 2, took
assert rest[-1]['event'] == 'summary' and rest[-1]['signal'] == number, rest
assert all(processes.gone(int(child), 0.0) for child in children), 'a child is left'
P
    [ -z "$(find many -name '.relief-*.tmp')" ] || die "a temporary file is left"
    [ -f many/a.relief ] || die "finished outputs are gone"
done
expect 0 "$relief" bake --recipe many/m.toml --dry-run
grep -q 'a.relief .*up to date' stdout || die "finished outputs are not recognised: $(cat stdout)"

# A killed run leaves no child. If the reader of events closes its pipe, the run continues and reports it.
python3 - "$relief" <<'P' || die "a killed run leaves a child, or a closed pipe ends a run"
import os, processes, subprocess, sys, time
run = subprocess.Popen([sys.argv[1], 'bake', '--recipe', 'many/m.toml', '-q'])
path = f'/proc/{run.pid}/task/{run.pid}/children'
while not (children := open(path).read().split()):
    time.sleep(0.02)
time.sleep(0.1)
run.kill()
run.wait()
assert all(processes.gone(int(child), 5.0) for child in children)
reader, writer = os.pipe()
os.close(reader)
run = subprocess.run([sys.argv[1], 'bake', '--recipe', 'in/r.toml', '-o', 'piped', '--events', '-'],
                     stdout=writer, stderr=subprocess.PIPE, text=True)
assert run.returncode == 2 and 'cannot write events' in run.stderr, run
P
container_hashes piped | cmp - first || die "a closed pipe stopped the bakes"

# The example of the page and the sample are valid recipes.
sed -n '/^```toml$/,/^```$/{//!p}' "$RELIEF_SOURCE/bake/recipe/README.md" >example.toml
mkdir -p rocks/test halls sample/meshes/rocks
tetrahedron rocks/a.obj 1
tetrahedron rocks/b.obj 2
tetrahedron rocks/test/c.obj 3
tetrahedron halls/entrance.obj 4
expect 0 "$relief" bake --recipe example.toml -j 2
[ "$(cd baked && find . -name '*.relief' | sort | xargs)" = "./halls/entrance.relief ./rocks/a.relief ./rocks/b.relief" ] ||
    die "the example bakes $(find baked -name '*.relief')"
cp "$RELIEF_SOURCE/samples/recipe/colliders.toml" sample/
cp rocks/a.obj sample/meshes/rocks/
cp rocks/b.obj sample/meshes/rocks/b_lod1.obj
expect 0 "$relief" bake --recipe sample/colliders.toml
[ "$(find sample -name '*.relief')" = sample/colliders/meshes/rocks/a.relief ] || die "the sample bakes $(find sample -name '*.relief')"

# Keys for external caches are known before the bake, are the same afterwards and in other folders, and change with any
# input.
keys() { python3 -c "import json; print(*[a['asset'] + '=' + a.get('key', '') for a in json.load(open('stdout'))['assets']])"; }
mkdir keys
tetrahedron keys/t.obj 2
{ echo 'mtllib m.mtl' && sed 's/^f/usemtl a\nf/' keys/t.obj; } >keys/m.obj
echo 'newmtl a' >keys/m.mtl
printf '%s\n' 'version = 1' '[[asset]]' 'mesh = "m.obj"' 'output = "m.relief"' 'budget = "20kB"' '[[asset]]' 'mesh = "t.obj"' \
    'output = "t.relief"' >keys/r.toml
cp -r keys elsewhere
expect 0 "$relief" bake --recipe keys/r.toml --dry-run --json
keys >before
grep -qE '^m.relief=[0-9a-f]{32} t.relief=[0-9a-f]{32}$' before || die "keys: $(cat before)"
for _ in baked up_to_date; do
    expect 0 "$relief" bake --recipe keys/r.toml --json
    keys | cmp - before || die "the bake changes the keys: $(keys)"
done
expect_changed() { # WHICH: the keys of exactly these assets change
    expect 0 "$relief" bake --recipe elsewhere/r.toml --dry-run --json
    [ "$(keys | tr ' ' '\n' | grep -vxFf <(tr ' ' '\n' <before) | cut -d= -f1)" = "$1" ] || die "wrong keys change, expected $1: $(keys)"
    cp keys/m.mtl keys/*.obj keys/*.toml elsewhere/
}
expect_changed ''
echo 'Kd 0 1 0' >>elsewhere/m.mtl
expect_changed m.relief
echo 'v 9 9 9' >>elsewhere/t.obj
expect_changed t.relief
sed -i 's/20kB/21kB/' elsewhere/r.toml
expect_changed m.relief
