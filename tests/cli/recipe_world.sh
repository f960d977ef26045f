# Levels and height maps in recipes: the same bytes as by hand, baked again when a file of theirs or a container changed and
# never else, whatever else fails; and no output in another's folder.
. "$(dirname "$0")/lib.sh"

# level FILE.gltf [KEY=VALUE…]: with its buffer in FILE.bin.
level() {
    python3 "$RELIEF_SOURCE/tests/cli/level.py" "$@"
    python3 - "$1" <<'P'
import base64, json, pathlib, sys
path = pathlib.Path(sys.argv[1])
doc = json.loads(path.read_text())
path.with_suffix('.bin').write_bytes(base64.b64decode(doc['buffers'][0]['uri'].partition(',')[2]))
doc['buffers'][0]['uri'] = path.stem + '.bin'
path.write_text(json.dumps(doc))
P
}
# box FILE.obj SIZE: a tetrahedron.
box() { printf 'v 0 0 0\nv %s 0 0\nv 0 %s 0\nv 0 0 %s\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' "$2" "$2" "$2" >"$1"; }
mkdir -p in/levels in/parts/old
level in/levels/yard.gltf
python3 "$RELIEF_SOURCE/tests/cli/heights.py" in/hills.png 130
box in/rock.obj 1
box in/parts/a.obj 2
box in/parts/b.obj 3
settings=spacing=1,low=0,high=100,tile=64
# What the defaults have for single meshes is none of a level's or a height map's.
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

baked() { (cd "$1" && find . -type f ! -name .relief-cache.json | sort | xargs sha256sum); }
# Files that were written anew have other times; their numbers may come again.
numbers() { (cd out && find . -type f ! -name .relief-cache.json | sort | xargs stat -c '%n %i %y'); }
run() { expect 0 "$relief" bake --recipe in/r.toml -o out --json -q "$@"; }
all='rock.relief levels/yard/world.json ground/world.json folders/parts/world.json'
# rebakes NAMES…: a run bakes these and nothing else.
rebakes() {
    run
    json stdout "[a['asset'] for a in d['assets'] if a['state'] == 'baked'] == '$*'.split()"
}
# because ASSET REASON: a dry run has this one for an asset, and bakes nothing.
because() {
    numbers >before
    expect 0 "$relief" bake --recipe in/r.toml -o out --dry-run --json -q
    json stdout "[a['asset'] + ' ' + a['reason'] for a in d['assets'] if a['state'] == 'stale'] == ['$1 $2']"
    numbers | cmp - before || die "a dry run writes"
}

# By hand and by recipes of any -j, the same.
"$relief" bake in/rock.obj -o rock.relief --max-error 20 --compress 1 -q
"$relief" bake in/levels/yard.gltf --world yard --budget 200kB --compress 1 -q
"$relief" bake in/hills.png --world ground --heights "$settings" --compress 1 -q
"$relief" bake in/parts --world parts --budget 100kB --compress 1 -q
run --dry-run
keys() { python3 -c "import json; print([(a['asset'], a['key']) for a in json.load(open('stdout'))['assets']])"; }
keys >keys
[ ! -e out ] || die "a dry run writes something"
run -j 4 --stamp stamp --depfile stamp.d --events events.jsonl
cp stdout report.json
cmp rock.relief out/rock.relief || die "a recipe bakes another rock"
diff -r yard out/levels/yard || die "a recipe bakes another level"
diff -r -x .relief-cache.json ground out/ground || die "a recipe bakes other ground"
diff -r parts out/folders/parts || die "a recipe bakes another level of a folder"
expect 0 "$relief" bake --recipe in/r.toml -o one -j 1
baked out >first
baked one | diff first - || die "-j 1 gives other bytes"
grep -qE '^\[2/4\] levels/yard/world.json: baked, .* kB, ' stderr || die "no line: $(cat stderr)"
for file in out/*/world.json out/*/*/world.json; do expect 0 "$relief" check "$file"; done

# The report, whose containers and bytes are all that was written; the events; the keys, known before.
json report.json "[a['asset'] for a in d['assets']] == '$all'.split() and d['counts']['baked'] == 4"
python3 - <<'P' || die "the report misses files: $(cat report.json)"
import json, os
report = json.load(open('report.json'))
named = {name: os.path.getsize('out/' + name) for a in report['assets'] for name in [a['asset'], *a.get('containers', [])]}
there = {os.path.relpath(os.path.join(at, name), 'out') for at, _, names in os.walk('out') for name in names
         if name not in ('.relief-cache.json', '.relief-curves.json')}
assert set(named) == there, set(named) ^ there
assert sum(named.values()) == report['counts']['bytes'] == sum(a['bytes'] for a in report['assets'])
assert [a['mesh'] for a in report['assets']] == ['rock.obj', 'levels/yard.gltf', 'hills.png', 'parts']
assert [i['file'] for i in report['assets'][1]['inputs']] == ['levels/yard.gltf', 'levels/yard.bin']
assert [i['file'] for i in report['assets'][3]['inputs']] == ['parts', 'parts/a.obj', 'parts/b.obj']
assert 'containers' not in report['assets'][0] and len(report['assets'][3]['containers']) == 2
done = {e['asset']: e for e in map(json.loads, open('events.jsonl')) if e['event'] == 'done'}
assert all(done[a['asset']]['containers'] == a['containers'] for a in report['assets'][1:])
P
cp report.json stdout
keys | cmp - keys || die "the keys are others once baked"
tr -d '\\\n' <stamp.d | tr -s ' ' >depfile
grep -q '^stamp: in/r.toml in/rock.obj in/levels/yard.gltf in/levels/yard.bin in/hills.png in/parts/a.obj in/parts/b.obj in in/levels in/parts' depfile ||
    die "depfile: $(cat stamp.d)"
[ "$(cut -d' ' -f3 stamp)" = "$(tr ' ' '\n' <<<"$all")" ] || die "stamp: $(cat stamp)"

# Nothing to do, also after a bake by hand into the world's folder.
numbers >before
expect 0 "$relief" bake --recipe in/r.toml -o out
[ "$(cat stderr)" = "4 assets up to date" ] || die "the second run bakes: $(cat stderr)"
"$relief" bake in/parts --world out/folders/parts --budget 100kB --compress 1 -q
run
json stdout "d['counts']['up_to_date'] == 4 and d['assets'][1]['containers'] and d['counts']['bytes'] == json.load(open('report.json'))['counts']['bytes']"
keys | cmp - keys || die "the keys are others once up to date"
numbers | grep -v folders/parts/world.json | diff <(grep -v folders/parts/world.json before) - || die "files were written"

# A level that was baked by hand is completed.
mkdir -p hand/levels
cp -r yard hand/levels/yard
rm hand/levels/yard/floor-*
(cd hand && stat -c '%n %i' levels/yard/box-*) >before
expect 0 "$relief" bake --recipe in/r.toml -o hand -q
(cd hand && stat -c '%n %i' levels/yard/box-*) | cmp - before || die "what was baked by hand is baked again"
baked hand | diff first - || die "completed, it is another"

# A container, a coarse one, or the world's file that is gone or changed: that world again, and of a level just what is missing.
for file in levels/yard/box-*.relief levels/yard/box-coarse-*.relief levels/yard/world.json ground/hills-1-1-*.relief; do
    file=$(cd out && ls $file | head -n 1)
    asset=$(dirname "$file")/world.json
    rm "out/$file"
    case $file in # and how many files are written anew, the world's own included
    *.json) because "$asset" 'the output is gone' && anew=1 ;;
    *-coarse-*) because "$asset" "its \\'$(basename "$file")\\' is gone" && anew=3 ;;
    ground/*) because "$asset" "its \\'$(basename "$file")\\' is gone" && anew=$(ls out/ground | wc -l) anew=$((anew + 1)) ;;
    *) because "$asset" "its \\'$(basename "$file")\\' is gone" && anew=3 ;; # with its coarse one
    esac
    rebakes "$asset"
    baked out | diff first - || die "$file is not made good"
    [ "$(numbers | diff before - | grep -c '^>')" = "$anew" ] || die "not $anew files are new: $(numbers | diff before -)"
    printf x >>"out/$file"
    rebakes "$asset"
    baked out | diff first - || die "$file, damaged, is not made good"
    rebakes ''
done

# Other files: the level alone, and no container where a node moved.
numbers >before
level in/levels/yard.gltf x=3
because levels/yard/world.json "\\'levels/yard.gltf\\' changed"
rebakes levels/yard/world.json
[ "$(numbers | diff before - | grep '^>' | cut -d' ' -f2)" = ./levels/yard/world.json ] || die "a moved node: $(numbers | diff before -)"
level in/levels/yard.gltf x=3 high=1.01
because levels/yard/world.json "\\'levels/yard.gltf\\' changed"
rebakes levels/yard/world.json
level in/levels/yard.gltf
rebakes levels/yard/world.json
baked out | diff first - || die "the level is another again"
sed -i 's/200kB/210kB/' in/r.toml
rebakes levels/yard/world.json
sed -i 's/210kB/200kB/' in/r.toml
rebakes levels/yard/world.json
printf '\0' >>in/levels/yard.bin
because levels/yard/world.json "\\'levels/yard.bin\\' changed"
rebakes levels/yard/world.json
baked out | diff first - || die "a byte that nothing refers to changes the level"
# A folder: a file more, a file less.
box in/parts/c.obj 4
because folders/parts/world.json "\\'parts\\' changed"
rebakes folders/parts/world.json
json out/folders/parts/world.json "len(d['bodies']) == 3"
rm in/parts/c.obj
rebakes folders/parts/world.json
baked out | diff first - || die "the folder is another again"

# A level that fails leaves its world and the others.
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n' >in/parts/b.obj
box in/rock.obj 1.5
expect 3 "$relief" bake --recipe in/r.toml -o out --events e.jsonl
grep -q "error: folders/parts/world.json: .*b\.obj" stderr || die "the failed level is not named: $(cat stderr)"
grep -q "1 of 4 assets failed, first 'folders/parts/world.json'" stderr || die "no last word: $(cat stderr)"
baked out | diff first - | grep -v rock.relief | grep '^[<>]' && die "a level that fails changes something"
box in/parts/b.obj 3
box in/rock.obj 1
rebakes rock.relief
baked out | diff first - || die "mended, it gives other bytes"
sed 's/^budget = "200kB"/&\ntime-limit = 0.001/' in/r.toml >in/late.toml
expect 6 "$relief" bake --recipe in/late.toml -o out
grep -q 'levels/yard/world.json: .*--time-limit' stderr || die "the limit is not named: $(cat stderr)"
baked out | diff first - || die "a level that is late changes something"

# A level's options are those that levels have, and each world has a folder for itself.
wrong() { # PATTERN, LINE…: of the recipe
    printf '%s\n' 'version = 1' '[[asset]]' "${@:2}" >in/wrong.toml
    expect_error 3 "wrong\.toml:$1" "$relief" bake --recipe in/wrong.toml -o wrong_out
    [ ! -e wrong_out ] || die "something was written for a wrong recipe"
}
yard='mesh = "levels/yard.gltf"'
wrong '5:7: --map is for one mesh, and a level has many; leave it out' "$yard" 'output = "w/world.json"' 'map = "cube:size=16"'
wrong '5:13: --max-error is for one mesh' "$yard" 'output = "w/world.json"' 'max-error = 1'
wrong '5:8: --plan is for one mesh' "$yard" 'output = "w/world.json"' 'plan = "p.toml"'
wrong '6:10: --budget is for meshes' 'mesh = "hills.png"' 'output = "w/world.json"' 'heights = "low=0"' 'budget = "1MB"'
wrong "4:10: the output 'w/level.json' must end in .relief, or for a level in /world.json" "$yard" 'output = "w/level.json"'
wrong "3:8: mesh 'parts' matches no file in 'in'; it is a folder: end it with / for a level" 'mesh = "parts"' 'output = "w/world.json"'
wrong "3:8: mesh 'parts/' names folders, which are levels" 'mesh = "parts/"' 'output = "w.relief"'
wrong "3:8: mesh 'none/' matches no folder" 'mesh = "none/"' 'output = "w/world.json"'
wrong "2:1: exclude 'parts/' names folders, and mesh names files" 'mesh = "*.obj"' 'exclude = "parts/"' 'output = "{stem}.relief"'
wrong "7:10: 'levels/yard.gltf' and 'rock.obj' would both be baked into 'w/world.json'" \
    "$yard" 'output = "w/world.json"' '[[asset]]' 'mesh = "rock.obj"' 'output = "./w//world.json"'
for inner in w/deep/world.json w/rock.relief w/a/b/rock.relief; do
    wrong "7:10: the output '$inner' lies in the folder of the world 'w/world.json', which has it for itself" \
        "$yard" 'output = "w/world.json"' '[[asset]]' 'mesh = "rock.obj"' "output = \"$inner\""
done
wrong "4:10: the output 'w/deep/world.json' lies in the folder of the world 'w/world.json'" \
    "$yard" 'output = "w/deep/world.json"' '[[asset]]' 'mesh = "rock.obj"' 'output = "w/world.json"'
# Links that lead out, whether they are read or written; and the world's cache, which is no input.
link() { # PATTERN: of the error
    expect_error 3 "wrong\.toml:$1" "$relief" bake --recipe in/wrong.toml -o linked
    [ "$(cat secret.obj secret.relief)" = "$secret" ] || die "a file elsewhere was written"
}
box secret.obj 9
echo precious >secret.relief
secret=$(cat secret.obj secret.relief)
printf '%s\n' 'version = 1' '[[asset]]' "$yard" 'output = "w/world.json"' 'budget = "200kB"' 'compress = 1' >in/wrong.toml
mkdir -p linked/w
name=$(cd yard && ls box-*.relief | head -n 1)
ln -s ../../secret.relief "linked/w/$name"
link "4:10: the folder of the output 'w/world.json' has a link '$name', which leads out of the output folder"
rm "linked/w/$name"
ln -s "mine.relief" linked/w/in_place.relief
ln -s ../../secret.relief linked/w/.relief-cache.json
expect 0 "$relief" bake --recipe in/wrong.toml -o linked -q
[ "$(cat secret.relief)" = precious ] && [ ! -L linked/w/.relief-cache.json ] || die "the link of a cache was followed"
rm linked/w/in_place.relief
diff -r -x .relief-cache.json yard linked/w || die "another level beside a link"
printf '%s\n' 'version = 1' '[[asset]]' 'mesh = "parts/"' 'output = "w/world.json"' >in/wrong.toml
ln -s ../../secret.obj in/parts/secret.obj
link "3:8: mesh 'parts' has a link 'secret.obj', which leads out of the recipe's folder; remove it"
rm in/parts/secret.obj
cp in/rock.obj in/.relief-cache.json
printf '%s\n' 'version = 1' '[[asset]]' 'mesh = ".relief-cache.json"' 'output = "w/world.json"' '[[asset]]' \
    "$yard" 'output = "x/world.json"' >in/wrong.toml
mkdir hidden && ln -s ../in hidden/x
expect_error 3 "wrong\.toml:7:10: .*leads out of the output folder" "$relief" bake --recipe in/wrong.toml -o hidden
rm in/.relief-cache.json
mkdir in/x
cp in/rock.obj in/x/.relief-cache.json
sed -i 's/".relief-cache.json"/"x\/.relief-cache.json"/' in/wrong.toml
expect_error 3 "wrong\.toml:7:10: 'in/x/.relief-cache.json' is where the world 'x/world.json' keeps its cache" \
    "$relief" bake --recipe in/wrong.toml -o in
cmp in/rock.obj in/x/.relief-cache.json || die "an input was lost to a cache"
rm -r in/x

# The output folder may be a world's, which then is all of it; and a level's own folder may get its world.
printf '%s\n' 'version = 1' '[[asset]]' "$yard" 'output = "world.json"' 'budget = "200kB"' 'compress = 1' >in/root.toml
printf '%s\n' 'version = 1' '[[asset]]' 'mesh = "parts/"' 'output = "{dir}/{stem}/world.json"' 'budget = "100kB"' 'compress = 1' >in/own.toml
for state in baked 'up to date'; do
    expect 0 "$relief" bake --recipe in/root.toml -o root --json -q
    json stdout "[a['state'] for a in d['assets']] == ['$state']"
    expect 0 "$relief" bake --recipe in/own.toml --json -q --depfile own.d
    json stdout "[a['state'] for a in d['assets']] == ['$state']"
done
diff -r -x .relief-cache.json yard root || die "another level in the output folder"
diff -r -x '*.obj' -x old parts in/parts || die "another level in its own folder"
[ "$(tr -d '\\\n' <own.d | tr -s ' ' | sed 's/in\/parts\/a.obj:.*//')" = 'in/parts/world.json: in/own.toml in/parts/a.obj in/parts/b.obj' ] ||
    die "depfile: $(cat own.d)"
