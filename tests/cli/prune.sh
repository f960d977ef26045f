# relief bake --recipe --prune: what the recipe has baked and no longer names goes, all else stays.
. "$(dirname "$0")/lib.sh"

mkdir in
for mesh in a b c; do cp "$models/OBJ/box.obj" in/$mesh.obj; done
printf 'version = 1\n[[asset]]\nmesh = "*.obj"\noutput = "{stem}.relief"\nmap = "cube:size=8"\n' >in/r.toml
sed 's/{stem}/other_{stem}/' in/r.toml >in/other.toml
names() { (cd out && echo *.relief); }
run() { expect 0 "$relief" bake --recipe in/r.toml -o out "$@"; }
run -q
expect 0 "$relief" bake --recipe in/other.toml -o out -q
cp out/a.relief out/by_hand.relief
rm in/b.obj
run -q
[ "$(names)" = 'a.relief b.relief by_hand.relief c.relief other_a.relief other_b.relief other_c.relief' ] ||
    die "without --prune: $(names)"
run --prune --dry-run
grep -q '^ *b.relief  *b.obj  *to be removed, as the recipe no longer names it$' stdout || die "dry run: $(cat stdout)"
run --prune --dry-run --json
json stdout "[(p['asset'], p['mesh'], p['state']) for p in d['pruned']] == [('b.relief', 'b.obj', 'to remove')]"
[ -e out/b.relief ] || die "a dry run has removed something"
# Not while something failed, nor by another shard, nor of a recipe without a name.
echo nonsense >in/c.obj
expect 3 "$relief" bake --recipe in/r.toml -o out --prune
grep -q 'prune removes nothing' stderr && [ -e out/b.relief ] || die "pruned beside a failure: $(cat stderr)"
cp "$models/OBJ/box.obj" in/c.obj
expect_error 1 'prune.*name a file' "$relief" bake --recipe - -o out --prune
for shard in 1/2 2/2; do run --prune --shard $shard --json -q && cp stdout shard_${shard%/2}.json; done
python3 -c "
import json
print(*sorted(p['asset'] for i in '12' for p in json.load(open(f'shard_{i}.json'))['pruned']))" >pruned
[ "$(cat pruned)" = b.relief ] && [ ! -e out/b.relief ] || die "shards: $(cat pruned)"
# One that was changed by hand stays, with a word; its sibling goes, and events tell of both.
rm in/a.obj in/c.obj
cp "$models/OBJ/box.obj" in/d.obj
echo changed >>out/a.relief
run --prune --events events.jsonl --json
grep -q '^relief: warning: a.relief: .*it stays: it is not what was baked; remove it yourself' stderr || die "$(cat stderr)"
grep -q '^c.relief: removed, as the recipe no longer names it$' stderr || die "not told: $(cat stderr)"
json stdout "[(p['asset'], p['state']) for p in d['pruned']] == [('a.relief', 'kept'), ('c.relief', 'removed')]"
grep -c '"event":"pruned"' events.jsonl >count
[ "$(cat count)" -eq 2 ] && tail -n 1 events.jsonl | matches '"event":"summary"' || die "events: $(cat events.jsonl)"
[ "$(names)" = 'a.relief by_hand.relief d.relief other_a.relief other_b.relief other_c.relief' ] || die "left: $(names)"
run --prune
[ "$(names)" = 'a.relief by_hand.relief d.relief other_a.relief other_b.relief other_c.relief' ] || die "left: $(names)"

# A forgotten unit is told of once.
sed -E 's/^v (.*) (.*) (.*)$/v \1e3 \2e3 \3e3/' "$models/OBJ/box.obj" >in/large.obj
sed -E 's/^v (.*) (.*) (.*)$/v \1e2 \2e2 \3e2/' "$models/OBJ/box.obj" >in/larger.obj
run
[ "$(grep -c 'no unit is named' stderr)" -eq 1 ] || die "warnings: $(cat stderr)"

# An asset that moved to another recipe is that one's, although nothing had to be baked.
mkdir moved
for mesh in a b; do cp "$models/OBJ/box.obj" moved/$mesh.obj; done
asset() { printf '[[asset]]\nmesh = "%s.obj"\noutput = "{stem}.relief"\nmap = "cube:size=8"\n' "$1"; }
moved() { expect 0 "$relief" bake --recipe moved/$1.toml -o moved/out "${@:2}"; }
{ echo 'version = 1' && asset a && asset b; } >moved/x.toml
moved x -q
{ echo 'version = 1' && asset a; } >moved/x.toml
{ echo 'version = 1' && asset b; } >moved/y.toml
moved y -q
moved x --prune
[ -e moved/out/b.relief ] || die "x.toml removed the collider of y.toml: $(cat stderr)"
