# SPDX-License-Identifier: Apache-2.0
# Levels and height maps in recipes: the same bytes as separate bakes. They are baked again only if their files or
# containers change, regardless of other failures. Unit tests cover the rules for folders, links and options, and
# missing or damaged files.
. "$(dirname "$0")/lib.sh"

split_level() { # FILE.gltf [KEY=VALUE…]: a level whose buffer is FILE.bin
    level "$@"
    python3 - "$1" <<'P'
import base64, json, pathlib, sys
path = pathlib.Path(sys.argv[1])
doc = json.loads(path.read_text())
path.with_suffix('.bin').write_bytes(base64.b64decode(doc['buffers'][0]['uri'].partition(',')[2]))
doc['buffers'][0]['uri'] = path.stem + '.bin'
path.write_text(json.dumps(doc))
P
}
mkdir -p in/levels in/parts/old
split_level in/levels/yard.gltf
python3 "$RELIEF_SOURCE/tests/cli/heights.py" in/hills.png 130
tetrahedron in/rock.obj 1
tetrahedron in/parts/a.obj 2
tetrahedron in/parts/b.obj 3
settings=spacing=1,low=0,high=100,tile=64
# Defaults for single meshes do not apply to levels and height maps.
cat >in/r.toml <<T
version = 1
[defaults]
output = "{stem}.relief"
max-error = 20
compress = 1
[[asset]]
mesh = "rock.obj"
[[asset]]
mesh = "levels/*.gltf"
output = "{dir}/{stem}/world.json"
budget = "200kB"
[[asset]]
mesh = "hills.png"
output = "ground/world.json"
heights = "$settings"
[[asset]]
mesh = "*/"
exclude = "levels/"
output = "folders/{stem}/world.json"
budget = "100kB"
T
hashes() { (cd "$1" && find . -type f ! -name .relief-cache.json | sort | xargs sha256sum); }
# Rewritten files have new times; inode numbers can be reused.
inodes() { (cd out && find . -type f ! -name .relief-cache.json | sort | xargs stat -c '%n %i %y'); }
run() { expect 0 "$relief" bake --recipe in/r.toml -o out --json -q "$@"; }
keys() { python3 -c "import json; print([(a['asset'], a['key']) for a in json.load(open('stdout'))['assets']])"; }
rebakes() { # NAMES…: a run bakes exactly these assets
    run
    json stdout "[a['asset'] for a in d['assets'] if a['state'] == 'baked'] == '$*'.split()"
}
expect_reason() { # ASSET REASON: a dry run gives this reason for only this asset, and bakes nothing
    inodes >before
    run --dry-run
    json stdout "[a['asset'] + ' ' + a['reason'] for a in d['assets'] if a['state'] == 'stale'] == ['$1 $2']"
    inodes | cmp - before || die "a dry run writes"
}

# Separate bakes and recipes with any -j give the same files.
"$relief" bake in/rock.obj -o rock.relief --max-error 20 --compress 1 -q
"$relief" bake in/levels/yard.gltf --world yard --budget 200kB --compress 1 -q
"$relief" bake in/hills.png --world ground --heights "$settings" --compress 1 -q
"$relief" bake in/parts --world parts --budget 100kB --compress 1 -q
run --dry-run
keys >keys
[ ! -e out ] || die "a dry run writes files"
run -j 4 --stamp stamp --depfile stamp.d --events events.jsonl
cp stdout report.json
keys | cmp - keys || die "the bake changes the keys"
cmp rock.relief out/rock.relief || die "a recipe gives a different rock"
for pair in yard:levels/yard ground:ground parts:folders/parts; do
    diff -r -x .relief-cache.json "${pair%:*}" "out/${pair#*:}" || die "a recipe gives a different ${pair%:*}"
done
expect 0 "$relief" bake --recipe in/r.toml -o one -j 1
hashes out >first
hashes one | diff first - || die "-j 1 gives different bytes"
for file in out/*/world.json out/*/*/world.json; do expect 0 "$relief" check "$file"; done

# The report lists exactly the containers and bytes that were written.
python3 - <<'P' || die "the report misses files: $(cat report.json)"
import json, os
report = json.load(open('report.json'))
named = {name: os.path.getsize('out/' + name) for a in report['assets'] for name in [a['asset'], *a.get('containers', [])]}
there = {os.path.relpath(os.path.join(at, name), 'out') for at, _, names in os.walk('out') for name in names
         if name not in ('.relief-cache.json', '.relief-curves.json')}
assert set(named) == there, set(named) ^ there
assert sum(named.values()) == report['counts']['bytes'] == sum(a['bytes'] for a in report['assets'])
assert [i['file'] for i in report['assets'][1]['inputs']] == ['levels/yard.gltf', 'levels/yard.bin']
assert [i['file'] for i in report['assets'][3]['inputs']] == ['parts', 'parts/a.obj', 'parts/b.obj']
done = {e['asset']: e for e in map(json.loads, open('events.jsonl')) if e['event'] == 'done'}
assert all(done[a['asset']]['containers'] == a['containers'] for a in report['assets'][1:])
P
tr -d '\\\n' <stamp.d | tr -s ' ' >depfile
grep -q '^stamp: in/r.toml in/rock.obj in/levels/yard.gltf in/levels/yard.bin in/hills.png in/parts/a.obj in/parts/b.obj in in/levels in/parts' depfile ||
    die "depfile: $(cat stamp.d)"
expect 0 "$relief" bake --recipe in/r.toml -o out
[ "$(cat stderr)" = "4 assets up to date" ] || die "the second run bakes assets: $(cat stderr)"

# A level from a separate bake is completed.
mkdir -p hand/levels
cp -r yard hand/levels/yard
rm hand/levels/yard/floor-*
(cd hand && stat -c '%n %i' levels/yard/box-*) >before
expect 0 "$relief" bake --recipe in/r.toml -o hand -q
(cd hand && stat -c '%n %i' levels/yard/box-*) | cmp - before || die "a separate bake is repeated"
hashes hand | diff first - || die "the completed level differs"

# Changed inputs: only the level is baked. If only a node moved, no container changes.
split_level in/levels/yard.gltf x=3
expect_reason levels/yard/world.json "\\'levels/yard.gltf\\' changed"
rebakes levels/yard/world.json
[ "$(inodes | diff before - | grep '^>' | cut -d' ' -f2)" = ./levels/yard/world.json ] || die "a moved node: $(inodes | diff before -)"
split_level in/levels/yard.gltf
rebakes levels/yard/world.json
printf '\0' >>in/levels/yard.bin
expect_reason levels/yard/world.json "\\'levels/yard.bin\\' changed"
rebakes levels/yard/world.json
hashes out | diff first - || die "an unreferenced byte changes the level"
tetrahedron in/parts/c.obj 4
expect_reason folders/parts/world.json "\\'parts\\' changed"
rebakes folders/parts/world.json
rm in/parts/c.obj
rebakes folders/parts/world.json
hashes out | diff first - || die "the folder changed again"

# A level that fails or times out keeps its world and the others.
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n' >in/parts/b.obj
tetrahedron in/rock.obj 1.5
expect 3 "$relief" bake --recipe in/r.toml -o out
grep -q "error: folders/parts/world.json: .*b\.obj" stderr || die "the failed level is not named: $(cat stderr)"
! hashes out | diff first - | grep -v rock.relief | grep '^[<>]' || die "a failed level changes files"
tetrahedron in/parts/b.obj 3
tetrahedron in/rock.obj 1
rebakes rock.relief
sed 's/^budget = "200kB"/&\ntimeout = 0.001/' in/r.toml >in/late.toml
expect 6 "$relief" bake --recipe in/late.toml -o out
grep -q 'levels/yard/world.json: .* raise timeout' stderr || die "the limit is not named: $(cat stderr)"
hashes out | diff first - || die "a level that timed out changes files"

# An option without effect on a level has a position.
printf '%s\n' 'version = 1' '[[asset]]' 'mesh = "levels/yard.gltf"' 'output = "w/world.json"' 'map = "cube:size=16"' >in/wrong.toml
expect_error 3 'wrong\.toml:5:7: map ' "$relief" bake --recipe in/wrong.toml -o wrong

# A world can be in the output folder, or in the folder of its level.
sed 's#w/world#world#' <(printf '%s\n' 'version = 1' '[[asset]]' 'mesh = "levels/yard.gltf"' 'output = "w/world.json"' \
    'budget = "200kB"' 'compress = 1') >in/root.toml
printf '%s\n' 'version = 1' '[[asset]]' 'mesh = "parts/"' 'output = "{dir}/{stem}/world.json"' 'budget = "100kB"' 'compress = 1' >in/own.toml
for state in baked up_to_date; do
    expect 0 "$relief" bake --recipe in/root.toml -o root --json -q
    json stdout "[a['state'] for a in d['assets']] == ['$state']"
    expect 0 "$relief" bake --recipe in/own.toml --json -q
    json stdout "[a['state'] for a in d['assets']] == ['$state']"
done
diff -r -x .relief-cache.json yard root || die "the level in the output folder differs"
diff -r -x '*.obj' -x old parts in/parts || die "the level in its own folder differs"
