# SPDX-License-Identifier: Apache-2.0
# Recipes: which assets are baked, and one bad asset among good ones. Unit tests cover the contents of recipes and the
# changes that count.
. "$(dirname "$0")/lib.sh"

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
events() { python3 -c "import json,sys; print(*[json.loads(l)['event'] for l in open(sys.argv[1])])" "$1"; } # names of events

# A dry run writes nothing. A run bakes everything, and a second run reports that nothing changed.
expect 0 "$relief" bake --recipe in/r.toml --dry-run
grep -q 'baked/d.relief.*rocks/deep/d.obj.*new' stdout || die "the dry run gives no reason: $(cat stdout)"
[ ! -e in/baked ] || die "a dry run wrote files"
expect 0 "$relief" bake --recipe in/r.toml --events events.jsonl --json -j 2
json stdout "d['counts']['baked'] == 5 and [a['state'] for a in d['assets']] == ['baked'] * 5"
json stdout "[a['asset'] for a in d['assets']] == ['baked/%s.relief' % n for n in ('d', 'r1', 'r2', 'r3', 'hill')]"
json stdout "all(len(a['hash']) == 32 and a['bytes'] > 0 and a['ms'] > 0 for a in d['assets'])"
grep -q '5 assets: 5 baked;' stderr || die "no summary: $(cat stderr)"
[ "$(events events.jsonl | tr ' ' '\n' | sort | uniq -c | xargs)" = '5 done 1 run_started 5 started 1 summary' ] || die "events: $(events events.jsonl)"
[ "$(ls -A in/baked)" = "$(printf '%s\n' d.relief hill.relief r1.relief r2.relief r3.relief)" ] || die "files: $(ls -A in/baked)"
"$relief" bake in/rocks/r1.obj -o single.relief --map cube:size=32 -q
cmp single.relief in/baked/r1.relief || die "recipe and command line give different bytes"
container_hashes in >first
expect 0 "$relief" bake --recipe in/r.toml --events -
[ "$(events stdout)" = "run_started skipped skipped skipped skipped skipped summary" ] || die "events: $(cat stdout)"
[ "$(cat stderr)" = "5 assets up to date" ] || die "the second run reports something else: $(cat stderr)"

rebakes() { # NAMES…: a run bakes exactly these assets
    expect 0 "$relief" bake --recipe in/r.toml --json -q
    [ ! -s stderr ] || die "-q prints output"
    json stdout "sorted(a['asset'] for a in d['assets'] if a['state'] == 'baked') == sorted('baked/%s.relief' % n for n in '$*'.split())"
}
touch in/rocks/*.obj in/r.toml
rebakes ''
rm in/baked/r2.relief
printf x >>in/baked/r3.relief
rebakes r2 r3
container_hashes in | cmp - first || die "a damaged output was not restored"
tetrahedron in/rocks/r1.obj 1.5
sed -i 's/compress = 3/compress = 4/' in/r.toml
rebakes r1 hill
echo '{' >in/.relief-cache.json
expect 0 "$relief" bake --recipe in/r.toml
grep -q 'warning: .*\.relief-cache\.json' stderr && grep -q '5 baked' stderr || die "an invalid cache: $(cat stderr)"

# An asset with a damaged mesh fails: it is named, its existing output is kept, and the others are baked.
cp in/baked/r1.relief older.relief
rm -r in && cp -r pristine in
mkdir in/baked
cp older.relief in/baked/r2.relief
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n' >in/rocks/r2.obj
expect 3 "$relief" bake --recipe in/r.toml --events e.jsonl -j 2
grep -q 'error: baked/r2.relief: .*r2\.obj' stderr && grep -q "error: 1 of 5 assets failed, first 'baked/r2.relief'" stderr ||
    die "the failed asset is not named: $(cat stderr)"
cmp in/baked/r2.relief older.relief || die "an existing output was changed"
grep '"event":"failed"' e.jsonl >failed.json
json failed.json "d['code'] == 3 and 'r2.obj' in d['error'] and d['asset'] == 'baked/r2.relief'"
cp pristine/rocks/r2.obj in/rocks/
rebakes r2
container_hashes in | cmp - first || die "the fixed asset gives different bytes"

# The error of each collider, even if it is up to date. A world has that of its worst collider; without a measurement it
# is null.
printf '%s\n' 'version = 1' '[[asset]]' 'mesh = "hill.obj"' 'output = "a.relief"' 'budget = "20kB"' '[[asset]]' 'mesh = "hill.obj"' \
    'output = "b.relief"' 'map = "cube:size=16"' '[[asset]]' 'mesh = "hill.obj"' 'output = "w/world.json"' 'budget = "20kB"' >in/wrong.toml
for state in baked up_to_date; do
    expect 0 "$relief" bake --recipe in/wrong.toml --json --events wrong.jsonl
    json stdout "[(a['state'], a['wrong_percent'] is not None) for a in d['assets']] == [('$state', w) for w in (True, False, True)]"
    grep '"asset":"a.relief".*"wrong_percent":' wrong.jsonl >/dev/null || die "no error in events: $(cat wrong.jsonl)"
    [ "$state" != baked ] || grep -qE '/3\] a.relief: baked, .* % wrong, ' stderr || die "no error in progress: $(cat stderr)"
done

# A bake that exceeds its time is stopped, and the exit code signals a limit.
printf '%s\n' 'version = 1' '[[asset]]' "mesh = \"bunny.obj\"" 'output = "late.relief"' 'budget = "16MB"' 'timeout = 0.2' >late.toml
cp "$bunny" bunny.obj
expect 6 "$relief" bake --recipe late.toml
grep -q 'late.relief: .* raise timeout' stderr || die "the limit is not named: $(cat stderr)"

# Errors in a recipe have a position, and nothing is baked. Also options that conflict with recipes or require one.
printf '%s\n' 'version = 1' '[[asset]]' 'mesh = "hill.obj"' 'output = "h.relief"' 'budgte = 1' >in/wrong.toml
expect_error 3 "wrong\.toml:5:1: .*'budget'" "$relief" bake --recipe in/wrong.toml -o wrong_out
[ ! -e wrong_out ] || die "an invalid recipe wrote files"
expect_error 2 'none\.toml' "$relief" bake --recipe none.toml
expect_error 1 'recipe' "$relief" bake bunny.obj --recipe in/r.toml
expect_error 1 'budget|defaults' "$relief" bake --recipe in/r.toml --budget 1MB
expect_error 1 'shard' "$relief" bake --recipe in/r.toml --shard 5/4
expect_error 1 'shard' "$relief" bake bunny.obj -o b.relief --shard 1/4
expect_error 2 'nowhere' "$relief" bake --recipe in/r.toml --stamp nowhere/stamp
