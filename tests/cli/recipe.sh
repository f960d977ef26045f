# Recipes: what is baked and what is not, one bad asset among good ones, parallel runs, shards, interruptions, and caches
# that cannot be trusted.
. "$(dirname "$0")/lib.sh"

# tetrahedron FILE SIZE
tetrahedron() {
    printf 'v 0 0 0\nv %s 0 0\nv 0 %s 0\nv 0 0 %s\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' "$2" "$2" "$2" >"$1"
}
mkdir -p in/rocks/deep
for i in 1 2 3; do tetrahedron "in/rocks/r$i.obj" "$i"; done
tetrahedron in/rocks/deep/d.obj 5
tetrahedron in/rocks/skip.obj 6
tetrahedron in/hill.obj 7
cat >in/r.toml <<'T'
version = 1
[defaults]
output = "baked/{stem}.relief"
map = ["cube:size=32"]
[[asset]]
mesh = "rocks/**/*.obj"
exclude = "rocks/skip.obj"
[[asset]]
mesh = "hill.obj"
compress = 3
T
cp -r in pristine

# events FILE: the names of the events, in order.
events() { python3 -c "import json,sys; print(*[json.loads(l)['event'] for l in open(sys.argv[1])])" "$1"; }
hashes() { (cd "$1" && find . -name '*.relief' | sort | xargs sha256sum); }

# A dry run writes nothing; a run bakes everything; the second does nothing and says so.
expect 0 "$relief" bake --recipe in/r.toml --dry-run
grep -q 'baked/d.relief.*rocks/deep/d.obj.*new' stdout || die "the dry run does not say what and why: $(cat stdout)"
[ ! -e in/baked ] || die "a dry run wrote something"
expect 0 "$relief" bake --recipe in/r.toml --events events.jsonl --json -j 2
cp stdout report.json
json report.json "d['counts']['baked'] == 5 and [a['state'] for a in d['assets']] == ['baked'] * 5"
json report.json "[a['asset'] for a in d['assets']] == ['baked/%s.relief' % n for n in ('d', 'r1', 'r2', 'r3', 'hill')]"
json report.json "all(len(a['hash']) == 32 and a['bytes'] > 0 and a['ms'] > 0 for a in d['assets'])"
grep -q '5 assets: 5 baked;' stderr || die "no summary: $(cat stderr)"
[ "$(events events.jsonl | tr ' ' '\n' | sort | tr '\n' ' ')" = "$(printf '%s ' done done done done done start \
    started started started started started summary)" ] ||
    die "events: $(events events.jsonl)"
[ "$(ls -A in/baked)" = "$(printf '%s\n' d.relief hill.relief r1.relief r2.relief r3.relief)" ] ||
    die "files: $(ls -A in/baked)"
"$relief" bake in/rocks/r1.obj -o alone.relief --map cube:size=32 -q
cmp alone.relief in/baked/r1.relief || die "a recipe bakes other bytes than its options alone"
hashes in >first
expect 0 "$relief" bake --recipe in/r.toml --events -
[ "$(events stdout)" = "start skipped skipped skipped skipped skipped summary" ] || die "events: $(cat stdout)"
[ "$(cat stderr)" = "5 assets up to date" ] || die "the second run does not say so: $(cat stderr)"
touch in/rocks/*.obj in/r.toml
expect 0 "$relief" bake --recipe in/r.toml -q
[ ! -s stderr ] || die "-q is not quiet"

# rebakes NAMES…: a run bakes these and nothing else; afterwards all bytes are as at first, unless an option changed.
rebakes() {
    expect 0 "$relief" bake --recipe in/r.toml --json -q
    json stdout "sorted(a['asset'] for a in d['assets'] if a['state'] == 'baked') == sorted('baked/%s.relief' % n for n in '$*'.split())"
}
rebakes ''
rm in/baked/r2.relief
rebakes r2
printf x >>in/baked/r3.relief
rebakes r3
hashes in | cmp - first || die "a damaged output was not made good"
tetrahedron in/rocks/r1.obj 1.5
rebakes r1
sed -i 's/compress = 3/compress = 4/' in/r.toml
rebakes hill
sed -i 's/size=32/size=16/' in/r.toml
rebakes d hill r1 r2 r3
rebakes ''

# A corrupt or foreign cache gives a warning, and everything is baked again.
for text in '' '{' '[]' '{"format": "relief-cache", "version": 9, "outputs": {}}'; do
    printf '%s' "$text" >in/.relief-cache.json
    expect 0 "$relief" bake --recipe in/r.toml
    grep -q 'warning: .*\.relief-cache\.json.*baked again' stderr || die "no warning for '$text': $(cat stderr)"
    grep -q '5 baked' stderr || die "not everything was baked again for '$text': $(cat stderr)"
done
rebakes ''

# An asset with a damaged mesh fails: it is named, its older output stays, and the others are baked.
rm -r in && cp -r pristine in
mkdir in/baked
echo precious >in/baked/r2.relief
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n' >in/rocks/r2.obj
expect 3 "$relief" bake --recipe in/r.toml --events e.jsonl -j 2
grep -q 'error: baked/r2.relief: .*r2\.obj' stderr || die "the failed asset is not named: $(cat stderr)"
grep -q "error: 1 of 5 assets failed, first 'baked/r2.relief'" stderr || die "no last word: $(cat stderr)"
[ "$(cat in/baked/r2.relief)" = precious ] || die "an older output was touched"
grep '"event":"failed"' e.jsonl >failed.json
json failed.json "d['code'] == 3 and 'r2.obj' in d['error'] and d['asset'] == 'baked/r2.relief'"
expect 3 "$relief" bake --recipe in/r.toml
grep -q '4 up to date, 1 failed' stderr || die "the second run: $(cat stderr)"
cp pristine/rocks/r2.obj in/rocks/
expect 0 "$relief" bake --recipe in/r.toml
hashes in | cmp - first || die "mended, it gives other bytes"
rm -r in && cp -r pristine in

# A bake that takes too long is ended, and the exit code says "limit".
cat >slow.toml <<'T'
version = 1
[[asset]]
mesh = "bunny.obj"
output = "bunny.relief"
budget = "16MB"
quality = "best"
T
cp "$bunny" bunny.obj
sed 's/^budget/time-limit = 0.2\n&/' slow.toml >late.toml
expect 6 "$relief" bake --recipe late.toml
grep -q 'bunny.relief: .*--time-limit' stderr || die "the limit is not named: $(cat stderr)"

# A bake that crashes harms nothing else: the other asset is baked, and no temporary file is left.
tetrahedron small.obj 1
printf '%s\n' '[[asset]]' 'mesh = "small.obj"' 'output = "small.relief"' 'map = "cube:size=16"' >>slow.toml
python3 - "$relief" <<'P' || die "a crash is not told as one"
import json, os, signal, subprocess, sys
run = subprocess.Popen([sys.argv[1], 'bake', '--recipe', 'slow.toml', '-j', '1', '--events', '-'],
                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
while json.loads(run.stdout.readline())['event'] != 'started':
    pass
# The event comes before the process.
while not (children := open(f'/proc/{run.pid}/task/{run.pid}/children').read().split()):
    pass
child = int(children[0])
while b'--json' not in (words := open(f'/proc/{child}/cmdline', 'rb').read()):  # not yet the bake's own
    pass
assert b'--time-limit=3600' in words.split(b'\0'), words
os.kill(child, signal.SIGSEGV)
events = [json.loads(line) for line in run.stdout]
failed = [e for e in events if e['event'] == 'failed']
assert run.wait() == 4, run.returncode
assert len(failed) == 1 and failed[0]['code'] == 4 and 'signal 11' in failed[0]['error'], events
assert [e['asset'] for e in events if e['event'] == 'done'] == ['small.relief'], events
P

# One bake at a time, two at a time, and four shards at once into one folder give the same bytes.
for at_once in 1 2; do
    expect 0 "$relief" bake --recipe pristine/r.toml -o "out$at_once" -j $at_once
    hashes "out$at_once" | cmp - first || die "-j $at_once gives other bytes"
done
jobs=()
for k in 1 2 3 4; do
    "$relief" bake --recipe pristine/r.toml -o shards --shard $k/4 --events "s$k" -j 1 -q &
    jobs+=($!)
done
for job in "${jobs[@]}"; do wait "$job" || die "a shard failed"; done
hashes shards | cmp - first || die "four shards give other bytes"
[ "$(cat s1 s2 s3 s4 | grep -c '"event":"done"')" -eq 5 ] || die "shards overlap"
expect 0 "$relief" bake --recipe pristine/r.toml -o shards
[ "$(cat stderr)" = "5 assets up to date" ] || die "the shards' cache is not whole: $(cat stderr)"

# An interrupted run ends by the signal within 2 s and leaves no child and no temporary file; what was done stays done.
mkdir many && cp bunny.obj many/
for i in 1 2 3 4; do cp bunny.obj many/b$i.obj; done
tetrahedron many/a.obj 1
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
for signal in INT TERM; do
    python3 - "$relief" $signal <<'P' || die "interrupting by SIG$signal failed"
import json, os, processes, signal, subprocess, sys, time
number = getattr(signal, 'SIG' + sys.argv[2])
signal.signal(signal.SIGINT, signal.default_int_handler)  # bash has background jobs ignore it
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
    [ -f many/a.relief ] || die "what was done is gone"
done
expect 0 "$relief" bake --recipe many/m.toml --dry-run
grep -q 'a.relief .*up to date' stdout || die "what was done is not known: $(cat stdout)"

# A killed run leaves no child behind.
python3 - "$relief" <<'P' || die "a killed run leaves a child"
import processes, subprocess, sys, time
run = subprocess.Popen([sys.argv[1], 'bake', '--recipe', 'many/m.toml', '-q'])
path = f'/proc/{run.pid}/task/{run.pid}/children'
while not (children := open(path).read().split()):
    time.sleep(0.02)
time.sleep(0.1)
run.kill()
run.wait()
sys.exit(0 if all(processes.gone(int(child), 5.0) for child in children) else 1)
P

# Mistakes in a recipe are reported with their place, before anything is baked.
recipe_fails() {
    local code=$1 pattern=$2
    printf 'version = 1\n%s\n' "$3" >pristine/wrong.toml
    expect_error "$code" "$pattern" "$relief" bake --recipe pristine/wrong.toml -o wrong_out
    [ ! -e wrong_out ] || die "something was written for a wrong recipe"
}
asset=$'[[asset]]\nmesh = "hill.obj"\noutput = "h.relief"'
recipe_fails 3 "wrong\.toml:5:1: unknown key 'budgte'; did you mean 'budget'" "$asset"$'\nbudgte = 1'
recipe_fails 3 "wrong\.toml:5:11: --quality is 'bets' but must be .*did you mean 'best'" "$asset"$'\nquality = "bets"'
recipe_fails 3 'wrong\.toml:5:7: --map and --paper' "$asset"$'\nmap = "float"\npaper = true'
recipe_fails 3 "wrong\.toml:7:10: 'hill.obj' and 'rocks/r1.obj' would both" \
    "$asset"$'\n[[asset]]\nmesh = "rocks/r1.obj"\noutput = "h.relief"'
recipe_fails 3 "wrong\.toml:3:8: mesh 'none/\*' matches no file" $'[[asset]]\nmesh = "none/*"\noutput = "{stem}.relief"'
recipe_fails 3 'leads out' $'[[asset]]\nmesh = "hill.obj"\noutput = "../h.relief"'
expect_error 2 'none\.toml' "$relief" bake --recipe none.toml
expect_error 1 'MESH and --recipe' "$relief" bake bunny.obj --recipe pristine/r.toml
expect_error 1 'under \[defaults\]' "$relief" bake --recipe pristine/r.toml --budget 1MB
expect_error 1 'shard.*K/N' "$relief" bake --recipe pristine/r.toml --shard 5/4
expect_error 1 'shard.*recipe' "$relief" bake bunny.obj -o b.relief --shard 1/4
expect_error 1 'MESH is required' "$relief" bake
expect_error 1 'output is required' "$relief" bake bunny.obj
expect_error 1 'is the input' "$relief" bake --recipe pristine/r.toml --events pristine/r.toml
expect_error 2 'nowhere' "$relief" bake --recipe pristine/r.toml --stamp nowhere/stamp

# A reader of events that goes away does not end the run, but the run reports it.
rm -r out1
python3 - "$relief" <<'P' || die "without a reader of its events a run does not end with 2"
import os, subprocess, sys
reader, writer = os.pipe()
os.close(reader)
run = subprocess.run([sys.argv[1], 'bake', '--recipe', 'pristine/r.toml', '-o', 'out1', '--events', '-'],
                     stdout=writer, stderr=subprocess.PIPE, text=True)
assert run.returncode == 2 and 'cannot write events' in run.stderr, run
P
hashes out1 | cmp - first || die "not everything was baked behind a closed pipe"

# The page's example and the sample are valid recipes.
python3 - "$RELIEF_SOURCE/bake/recipe/README.md" >example.toml <<'P'
import re, sys
print(re.search(r'```toml\n(.*?)```', open(sys.argv[1]).read(), re.S)[1])
P
mkdir -p rocks/test halls plans
tetrahedron rocks/a.obj 1
tetrahedron rocks/b.obj 2
tetrahedron rocks/test/c.obj 3
tetrahedron halls/entrance.obj 4
"$relief" bake halls/entrance.obj -o entrance.relief --budget 20kB --plan-out plans/entrance.toml -q
rm entrance.relief
expect 0 "$relief" bake --recipe example.toml -j 2
[ "$(cd baked && find . -name '*.relief' | sort | tr '\n' ' ')" = "./halls/entrance.relief ./rocks/a.relief ./rocks/b.relief " ] ||
    die "the example bakes $(find baked -name '*.relief')"

mkdir -p sample/meshes/rocks
cp "$RELIEF_SOURCE/samples/recipe/colliders.toml" sample/
cp rocks/a.obj sample/meshes/rocks/
cp rocks/b.obj sample/meshes/rocks/b_lod1.obj
expect 0 "$relief" bake --recipe sample/colliders.toml
[ "$(find sample -name '*.relief')" = sample/colliders/meshes/rocks/a.relief ] ||
    die "the sample bakes $(find sample -name '*.relief')"

# Keys for other caches: known before anything is baked, the same afterwards and elsewhere, and others if anything else is.
keys() { python3 -c "import json,sys; print(*[a['asset'] + '=' + a.get('key', '') for a in json.load(open(sys.argv[1]))['assets']])" "$1"; }
mkdir keys
printf 'mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl a\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' >keys/m.obj
printf 'newmtl a\nKd 1 0 0\n' >keys/m.mtl
tetrahedron keys/t.obj 2
cp plans/entrance.toml keys/plan.toml
printf 'version = 1\n[[asset]]\nmesh = "m.obj"\noutput = "m.relief"\nbudget = "20kB"\n[[asset]]\nmesh = "t.obj"\noutput = "t.relief"\nplan = "plan.toml"\n' >keys/r.toml
expect 0 "$relief" bake --recipe keys/r.toml --dry-run --json
keys stdout >before
grep -qE '^m.relief=[0-9a-f]{32} t.relief=[0-9a-f]{32}$' before || die "keys: $(cat before)"
[ ! -e keys/m.relief ] || die "a dry run bakes"
expect 0 "$relief" bake --recipe keys/r.toml --json
keys stdout | cmp - before || die "the keys are others once baked: $(keys stdout)"
expect 0 "$relief" bake --recipe keys/r.toml --dry-run --json
keys stdout | cmp - before || die "the keys are others once up to date: $(keys stdout)"
cp -r keys elsewhere
rm elsewhere/*.relief elsewhere/.relief-cache.json
touch elsewhere/*
expect 0 "$relief" bake --recipe elsewhere/r.toml --dry-run --json
keys stdout | cmp - before || die "the keys are others elsewhere: $(keys stdout)"
changes() { # WHICH: exactly this asset's key is another now
    expect 0 "$relief" bake --recipe elsewhere/r.toml --dry-run --json
    [ "$(keys stdout | tr ' ' '\n' | grep -vxFf <(tr ' ' '\n' <before) | cut -d= -f1)" = "$1" ] ||
        die "other keys than that of $1: $(keys stdout)"
    cp keys/m.mtl keys/*.obj keys/*.toml elsewhere/
}
echo 'Kd 0 1 0' >>elsewhere/m.mtl
changes m.relief
echo '# ' >>elsewhere/t.obj
changes t.relief
echo '# ' >>elsewhere/plan.toml
changes t.relief
sed -i 's/20kB/21kB/' elsewhere/r.toml
changes m.relief
echo 'no mesh' >elsewhere/t.obj
expect 0 "$relief" bake --recipe elsewhere/r.toml --dry-run --json
json stdout "['key' in a for a in d['assets']] == [True, False]"

# What several assets are warned of is told once, also where only warnings are wanted; lines count.
mkdir warned
cp /usr/share/assimp/models/glTF2/simple_skin/simple_skin.gltf warned/a.gltf
cp warned/a.gltf warned/b.gltf
printf 'version = 1\n[[asset]]\nmesh = "*.gltf"\noutput = "{stem}.relief"\nbudget = "20kB"\n' >warned/r.toml
expect 0 "$relief" bake --recipe warned/r.toml --warnings-only
[ "$(cat stderr)" = "relief: warning: 2 assets (a.relief, b.relief): it is skinned; baked in the pose that its nodes have" ] ||
    die "warnings: $(cat stderr)"
rm warned/*.relief
expect 0 "$relief" bake --recipe warned/r.toml -j 1
grep -qE '^\[1/2\] a.relief: baked, .* s$' stderr && grep -qE '^\[2/2\] b.relief: baked, .* s$' stderr ||
    die "lines: $(cat stderr)"
expect 0 "$relief" bake warned/a.gltf -o warned/c.relief --warnings-only
[ "$(wc -l <stderr)" = 1 ] && grep -q 'it is skinned' stderr || die "one mesh: $(cat stderr)"
expect_error 1 'quiet|warnings-only' "$relief" bake warned/a.gltf -o warned/c.relief --warnings-only -q
