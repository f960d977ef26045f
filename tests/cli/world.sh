# Levels: each different mesh baked once, only what has changed again, the world file last; and checks of worlds.
. "$(dirname "$0")/lib.sh"

level() { python3 "$RELIEF_SOURCE/tests/cli/level.py" "$@"; }
containers() { (cd "$1" && find . -name '*.relief' | sort | xargs sha256sum); }

level level.gltf
expect 0 "$relief" bake level.gltf --world w --budget 200kB --json --depfile w.d
cp stdout report.json
json report.json "d['written'] and d['bodies'] == 5 and d['baked'] == 3 and d['up_to_date'] == d['failed'] == 0"
json report.json "[(c['mesh'], c['bodies'], round(c['largest_scale'], 9)) for c in d['colliders']] == [('floor', 1, 1), ('box', 3, 2), ('box', 1, 1)]"
json report.json "sum(c['gpu_bytes'] for c in d['colliders']) == d['gpu_bytes'] <= 200000 and all(c['wrong_percent'] < 1 for c in d['colliders'])"
# Three boxes at up to twice the size count for more than one, and a floor is flat.
json report.json "d['colliders'][1]['budget'] > d['colliders'][2]['budget'] > d['colliders'][0]['budget'] >= 7500"
json w/world.json "d['format'] == 'relief-world' and d['version'] == 1 and d['unit'] == 'm'"
json w/world.json "[b['node'] for b in d['bodies']] == ['ground', 'first', 'second', 'third', 'wide']"
json w/world.json "[b['collider'] for b in d['bodies']] == [0, 1, 1, 1, 2]"
json w/world.json "d['bodies'][2]['scale'] == 2 and d['bodies'][2]['rotation'] == [0, 0.6, 0, 0.8] and d['bodies'][2]['position'] == [5, 0, 5]"
json w/world.json "d['colliders'][1]['min'] == [-0.5, 0, -0.25] and d['colliders'][2]['max'] == [1.5, 1, 0.25]"
[ "$(tr -d '\\\n' <w.d | tr -s ' ')" = 'w/world.json: level.gltf' ] || die "depfile: $(cat w.d)"
for file in w/*.relief; do expect 0 "$relief" check "$file"; done

# The same with other threads, and with nothing to do.
expect 0 "$relief" bake level.gltf --world one --budget 200kB -j 1 -q
diff -r -x .relief-cache.json w one || die "threads change the world"
containers w >first
expect 0 "$relief" bake level.gltf --world w --budget 200kB
grep -q '5 bodies of 3 colliders: 0 baked, 3 up to date' stderr || die "not up to date: $(cat stderr)"

# A moved node changes the world file alone; a changed mesh its containers, and those from before go.
cp w/world.json before.json
level level.gltf x=3
expect 0 "$relief" bake level.gltf --world w --budget 200kB
grep -q ' 0 baked, 3 up to date' stderr || die "a moved node bakes something: $(cat stderr)"
containers w | diff first - || die "a moved node changes a container"
[ "$(diff before.json w/world.json | grep -c '^>')" -eq 1 ] || die "a moved node changes more than its line"
level level.gltf x=3 high=1.01
expect 0 "$relief" bake level.gltf --world w --budget 200kB --json
json stdout "d['baked'] == 2 and d['up_to_date'] == 1 and len(d['removed']) == 4"
json stdout "d['colliders'][0]['state'] == 'up to date' and d['colliders'][0]['wrong_percent'] is None"
# A box is large enough for a coarse one beside it.
[ "$(find w -name '*.relief' | wc -l)" -eq 4 ] && [ "$(find w -name 'box-coarse-*' | wc -l)" -eq 1 ] || die "containers are left over: $(ls w)"
# A container that was damaged is baked again, with the same bytes.
containers w >now
for file in w/box-*.relief; do printf x >>"$file"; done
expect 0 "$relief" bake level.gltf --world w --budget 200kB
grep -q ' 2 baked, 1 up to date' stderr || die "damaged containers: $(cat stderr)"
containers w | diff now - || die "baked again, the bytes differ"
rm w/box-coarse-*.relief
expect_error 2 'colliders\[1\]\.coarse' "$relief" check w/world.json
expect 0 "$relief" bake level.gltf --world w --budget 200kB
grep -q ' 1 baked, 2 up to date' stderr || die "a coarse container is missing: $(cat stderr)"
containers w | diff now - || die "baked again, the bytes differ"

# Where a mesh fails, the world stays, and what was baked is not lost. Others' files are never touched.
echo mine >w/mine.relief
cp w/world.json before.json
expect_error 1 "1 of 3 colliders failed, first that of the mesh 'box': --thickness is 1.5 .*world.json' is left as it was" \
    "$relief" bake level.gltf --world w --budget 200kB --as shell --thickness 1.5
cmp before.json w/world.json || die "a failed bake changes the world"
expect 0 "$relief" check w/world.json
level other.gltf box=0
expect 0 "$relief" bake other.gltf --world w --budget 200kB --as shell --thickness 1.5 --json
json stdout "len(d['removed']) == 4 and d['bodies'] == 1"
[ "$(cat w/mine.relief)" = mine ] || die "a file of somebody else is gone"

# The contents.
level level.gltf
expect 0 "$relief" bake level.gltf --world w --budget 200kB -q
expect 0 "$relief" info w/world.json --json
json stdout "d['file'] == 'w/world.json' and d['unit'] == 'm' and d['bodies'] == 5 and [c['bodies'] for c in d['colliders']] == [1, 3, 1]"
json stdout "d['bytes'] == sum(__import__('os').path.getsize('w/' + c['file']) for c in d['colliders'])"
json stdout "d['min'][0] == -20 and abs(d['max'][1] - 2) < 1e-5 and d['colliders'][1]['min'] == [-0.5, 0, -0.25] and 0 < d['gpu_bytes'] <= 200000"
expect 0 "$relief" info w/world.json
grep -q '^Relief world of 5 bodies of 3 colliders' stdout && [ "$(wc -l <stdout)" -eq 6 ] || die "info: $(cat stdout)"
expect_error 2 "none.json" "$relief" info none.json

# Checks: against the level, and without.
expect 0 "$relief" check w/world.json
grep -q '^world.json: 5 bodies of 3 colliders' stdout || die "check: $(cat stdout)"
expect 0 "$relief" check w/world.json --mesh level.gltf --max-error 1 --json
cp stdout check.json
json check.json "d['accuracy']['wrong_percent'] < 0.5 and [b['node'] for b in d['accuracy']['bodies']] == ['ground', 'first', 'second', 'third', 'wide']"
expect 0 "$relief" check w/world.json --mesh level.gltf --within 0.5 -q
# What to do about each place, and its picture in a page, which relief view makes as well.
json check.json "len(d['accuracy']['places']) == len(d['accuracy']['worst']) and all(p['distance'] < p['texel'] and p['cause'] == 'texel' for p in d['accuracy']['places'])"
json check.json "all(p['advice'] == '' for p in d['accuracy']['places'])"
printf '<script type="application/json" id="relief-page-data">null</script>' >template.html
export RELIEF_VIEW_PAGE=$PWD/template.html
expect 0 "$relief" check w/world.json --mesh level.gltf --html page.html --samples 5000
expect 0 "$relief" view w/world.json --mesh level.gltf -o view.html --samples 5000
cmp page.html view.html || die "check and view make different pages"
sed 's/.*page-data">//; s/<.script>.*//' page.html >page.json
json page.json "d['check']['verdict']['grade'] == 'good' and all(p['picture'].startswith('iVBORw0KGgo') for p in d['check']['accuracy']['places'])"
expect_error 1 "--detail is for one collider" "$relief" view w/world.json --mesh level.gltf --detail 1
# A node that moved is wrong where it was and where it is, and the message has it.
level moved.gltf x=3
expect 7 "$relief" check w/world.json --mesh moved.gltf --max-error 1
grep -q 'warning: moved.gltf: 1 node of it stand elsewhere' stderr || die "moved: $(cat stderr)"
grep -q '^1: the world has it elsewhere than the level: bake the level again' stdout || die "no advice: $(cat stdout)"
grep -qE '^  1 +first' stdout || die "the moved node is not the worst: $(cat stdout)"
level higher.gltf high=1.01
expect_error 3 "higher.gltf has a mesh 'box' that no collider of the world was baked from; bake" \
    "$relief" check w/world.json --mesh higher.gltf

# Names choose what parts are, and only the meshes that have them are baked for it, where no share of a budget moves with it.
expect 0 "$relief" bake level.gltf --world named --texel 0.02 -q
expect 0 "$relief" bake level.gltf --world named --texel 0.02 --as wide=shell --json
json stdout "d['baked'] == 1 and d['up_to_date'] == 2"
expect 0 "$relief" check named/world.json --mesh level.gltf --max-error 2 -q
expect_error 1 "it names no triangles 'wid'.*did you mean 'wide'" \
    "$relief" bake level.gltf --world named --as wid=shell

# By a texel, in units of the level: as fine in the world at any scale, and as many bytes as that takes.
expect 0 "$relief" bake level.gltf --world by_texel --texel 0.02 --json
json stdout "d['budget'] is None and all(c['budget'] is None for c in d['colliders'])"
cp stdout texel.json
expect 0 "$relief" check by_texel/world.json --mesh level.gltf --max-error 0.5 -q
expect 0 "$relief" info "by_texel/$(python3 -c "import json; print(json.load(open('texel.json'))['colliders'][1]['file'])")"
grep -q -- '--texel 0.01' stdout || die "a mesh at scale 2 has another texel: $(cat stdout)"
expect 0 "$relief" bake level.gltf --world by_texel --texel 2cm
grep -q '5 bodies of 3 colliders: 0 baked, 3 up to date' stderr || die "by texel, not up to date: $(cat stderr)"
# With a budget as well, what does not get there is named.
expect 0 "$relief" bake level.gltf --world by_texel --texel 0.0005 --budget 60kB --json
json stdout "d['gpu_bytes'] <= 60000"
grep -q 'warning: box: its texel is .* where 0.00025 is wanted, which takes more than its' stderr || die "not named: $(cat stderr)"
expect_error 1 "two ways" "$relief" bake level.gltf -o v.relief --texel 0.1 --max-error 1
expect_error 1 "of patches" "$relief" bake level.gltf --world v --texel 0.1 --layout views
expect_error 1 "finer than floats resolve there; give at least" "$relief" bake level.gltf -o v.relief --texel 1e-9
# A plan of it makes the same shells and patches.
expect 0 "$relief" bake level.gltf -o t.relief --texel 0.05 --as shell --plan-out t.toml -q
expect 0 "$relief" bake level.gltf -o u.relief --plan t.toml --as shell -q
python3 - <<'P' || die "a plan by texel makes something else"
a, b = open('t.relief', 'rb').read(), open('u.relief', 'rb').read()
raise SystemExit(0 if a == b else 1)
P

# A folder is a level of its files.
mkdir parts
cp level.gltf parts/b.gltf
level parts/a.gltf box=0
expect 0 "$relief" bake parts --world of_parts --budget 100kB -q
json of_parts/world.json "[b['node'] for b in d['bodies']] == ['a.gltf', 'b.gltf'] and len(d['colliders']) == 2"
expect 0 "$relief" check of_parts/world.json --mesh parts --max-error 2 -q

# Bad calls and bad files: one line, and nothing changes.
for option in --max-error=1 --map=cube:size=32 --paper --plan-out=p.toml --resolution=64 --decode=plane; do
    expect_error 1 "${option%%=*} .*for one mesh|--decode" "$relief" bake level.gltf --world v $option
done
expect_error 1 "two ways" "$relief" bake level.gltf --world v -o x.relief
expect_error 1 "excludes" "$relief" bake --recipe r.toml --world v
expect_error 1 "too few for 3 colliders; give at least 24576" "$relief" bake level.gltf --world v --budget 10kB
expect_error 2 "none.gltf" "$relief" bake none.gltf --world v
expect_error 1 "is the input" "$relief" bake w/world.json --world w
expect_error 1 "is the input" "$relief" check w/world.json --html level.gltf --mesh level.gltf
expect_error 1 "--html requires --mesh" "$relief" check w/world.json --html x.html
expect_error 1 "for one collider" "$relief" check w/world.json --detail 1 --mesh level.gltf
expect_error 1 "--within is for worlds and ground" "$relief" check "$(ls w/floor-*.relief | head -1)" --within 1 --mesh level.gltf
bad() { # bad CODE PATTERN PYTHON: of a world after a change
    mkdir -p bad && rm -rf bad/* && cp w/*.relief bad/
    python3 -c "
import json
d = json.load(open('w/world.json'))
$3
json.dump(d, open('bad/world.json', 'w'))"
    expect_error "$1" "bad/world.json.*$2.*;" "$relief" check bad/world.json
}
bad 3 'bodies.1..rotation is no rotation' "d['bodies'][1]['rotation'] = [0, 0, 0, 0.5]"
bad 3 'bodies.1..scale = 0 is out of range' "d['bodies'][1]['scale'] = 0"
bad 3 'bodies.1..collider = 3 is none of the 3' "d['bodies'][1]['collider'] = 3"
bad 3 'must be a path inside' "d['colliders'][1]['file'] = '../w/' + d['colliders'][1]['file']"
bad 3 'other contents than its hash' "d['colliders'][1]['hash'] = '0' * 32"
bad 3 'another box' "d['colliders'][1]['max'][0] = 9"
bad 3 'bodies has 65537 elements' "d['bodies'] = d['bodies'][:1] * 65537"
bad 5 'newer than this program' "d['version'] = 2"
bad 3 "unknown key 'colour'" "d['bodies'][0]['colour'] = 1"
mkdir -p bad && rm -f bad/*.relief && cp w/world.json bad/
expect_error 2 "bad/world.json.*colliders.0..*No such file" "$relief" check bad/world.json
floor=$(python3 -c "import json; print(json.load(open('w/world.json'))['colliders'][0]['file'])")
ln -s "$PWD/w/$floor" bad/
expect_error 3 "leads out of the world's folder" "$relief" check bad/world.json
echo '{}' >bad/world.json
expect_error 3 "is no world" "$relief" check bad/world.json
