# SPDX-License-Identifier: Apache-2.0
# relief view and relief-sim --page: self-contained pages of colliders, meshes, worlds and scenes, and their errors. A
# stub replaces the page of scenes, which needs another build; tests/web tests the real pages.
. "$(dirname "$0")/lib.sh"

# extract PAGE: writes the page's data to data.json and the rest to rest.html; fails if the page references external files
extract() {
    python3 - "$1" <<'P' || die "$1 is not a page with data"
import json, re, sys
before, data, after = re.fullmatch('(.*id="relief-page-data"[^>]*>)(.*?)(</script>.*)', open(sys.argv[1]).read(), re.S).groups()
assert '<' not in data and '\n' not in data, 'data that could end its script'
assert not re.search(r'https?:|src=|@import|url\(', before + after), 'the page refers to something else'
json.dump(json.loads(data), open('data.json', 'w'))
open('rest.html', 'w').write(before + 'null' + after)
P
}
contains() { # FILE BASE64_EXPRESSION: the bytes in data.json equal those of the file
    json data.json "__import__('base64').b64decode($2, validate=True) == open('$1', 'rb').read()"
}

"$relief" bake "$bunny" -o b.relief --paper --resolution 48 -q

# The page is next to the collider and is deterministic. It needs no web build: RELIEF_VIEW_PAGE is for scenes.
RELIEF_VIEW_PAGE=$work/none.html expect 0 "$relief" view b.relief
[ ! -s stdout ] && [ ! -s stderr ] || die "it prints output: $(cat stdout stderr)"
extract b.html
json data.json 'list(d) == ["format", "name", "bytes", "collider", "shows", "mesh", "check", "scene", "files"]'
json data.json '[d["format"], d["name"]] == [3, "b.relief"] and {d[k] for k in list(d)[4:]} == {None} and not d["collider"]["animated"]'
json data.json "d['bytes'] == $(stat -c %s b.relief)"
cp rest.html page.html
"$relief" view - -o - <b.relief >standard_input.html
sed 's/"name":"b.relief"/"name":"standard input"/' b.html | cmp - standard_input.html || die "standard input gives a different page"

# Pages of all kinds of maps differ only in their data.
"$relief" bake "$bunny" -o kinds.relief -q --map float:dir=+x,size=16 --map fixed8:dir=-z,size=16 --map cube:size=8 --map front-back:dir=+y,size=16 --map patches:budget=10kB
"$relief" view kinds.relief -o page_of.html
extract page_of.html
cmp rest.html page.html || die "the page of kinds.relief differs outside its data"
json data.json '[t["texels"] is not None for t in d["collider"]["textures"]] == [True] * 3'

# With its mesh: the report of `relief check`.
expect 0 "$relief" view b.relief --mesh "$bunny" --samples 5000 --seed 7 -o mesh.html
"$relief" check b.relief --mesh "$bunny" --samples 5000 --seed 7 --json >check.json
"$relief" check b.relief --mesh "$bunny" --samples 5000 --seed 7 >check.txt
extract mesh.html
python3 - <<'P' || die "the page and relief check have different reports"
import base64, json, struct
d, check = json.load(open('data.json')), json.load(open('check.json'))
c = d['check']
del check['times_ms']
assert c['verdict']['text'].endswith(c['verdict']['grade']) and c['parts'].pop('text') in open('check.txt').read()
assert all(abs(sum(x * x for x in place.pop('normal')) - 1) < 1e-5 for place in c['worst_places'])
assert check.pop('advice') and c.pop('advice') == [] and c == check and len(c['worst_places']) == 3
assert d['mesh']['name'] == 'bunny.obj'
corners = base64.b64decode(d['mesh']['triangles'], validate=True)
corners = struct.unpack(f'<{len(corners) // 4}I', corners)
vertices = base64.b64decode(d['mesh']['vertices'], validate=True)
vertices = struct.unpack(f'<{len(vertices) // 4}f', vertices)
assert len(corners) == 3 * check['mesh']['triangles'] and max(corners) == len(vertices) // 3 - 1
assert abs(min(vertices[1::3]) + 1) < 2 and abs(max(vertices[1::3]) - 1) < 2
P

# Names that would end a script, or are not UTF-8.
for name in '<script><!--.relief' $'\xff.relief'; do
    cp b.relief "$name"
    expect 0 "$relief" view "$name" -o name.html
    extract name.html
done

# A scene and its files. For a deforming body the panel has maps without a surface.
printf '%s\n' '<!doctype html>' '<title>stub</title>' "$(page_place)" '<p>the end</p>' >stub.html
export RELIEF_VIEW_PAGE=$work/stub.html
mkdir -p scene/sub
cp b.relief scene/sub/
printf '0,2,0\n' >scene/points.csv
printf '%s\n' '[collider]' 'file = "./sub/b.relief"' '[[emitter]]' 'points = "points.csv"' 'direction = [0, -1, 0]' 'speed = 1.0' >scene/s.toml
expect 0 "$relief_sim" scene/s.toml --page scene/s.html
[ ! -s stdout ] && [ ! -s stderr ] || die "--page prints output: $(cat stdout stderr)"
extract scene/s.html
cmp rest.html stub.html || die "the page is not the stub with data"
contains b.relief 'd["files"]["sub/b.relief"]'
contains scene/points.csv 'd["files"]["points.csv"]'
json data.json '[d["collider"], d["shows"], d["name"], len(d["files"])] == [None, "sub/b.relief", "s.toml", 2]'
json data.json 'd["scene"] == open("scene/s.toml").read()'
box box.obj 1 1 1
cp box.obj scene/
printf '[collider]\nmesh = "box.obj"\ndeform = { amplitude = 0.1, frequency = 1.0 }\nresolution = 32\n' >scene/live.toml
expect 0 "$relief_sim" scene/live.toml --page scene/live.html
extract scene/live.html
contains box.obj 'd["files"]["box.obj"]'
python3 -c 'import base64, json; open("rest.relief", "wb").write(base64.b64decode(json.load(open("data.json"))["collider"]))'
expect 0 "$relief" check rest.relief
expect_error 1 'relief-sim scene/s.toml --page scene/s.html' "$relief" view scene/s.toml
expect_error 1 'relief view' "$relief_sim" b.relief --page o.html
expect_error 1 'page' "$relief_sim" scene/s.toml --page o.html --dump o.ply

# Errors: one line, and nothing is written.
mkdir errors
rejects() { # CODE PATTERN ARGUMENT…
    expect_error "$1" "$2" "$relief" view "${@:3}"
    [ -z "$(ls -A errors)" ] || die "left behind by 'view ${*:3}': $(ls -A errors)"
}
pages() {
    expect_error "$1" "$2" "$relief_sim" "${@:3}"
    [ -z "$(ls -A errors)" ] || die "left behind by 'relief-sim ${*:3}': $(ls -A errors)"
}
head -c 3000 b.relief >short.relief
truncate -s 200M large.relief
rejects 3 "short.relief" short.relief -o errors/o.html
rejects 6 'large.relief' large.relief -o errors/o.html
rejects 2 "missing.relief" missing.relief -o errors/o.html
rejects 2 "missing.obj" b.relief --mesh missing.obj -o errors/o.html
rejects 3 'box.obj' b.relief --mesh box.obj -o errors/o.html
pages 1 'stub.html' scene/s.toml --page stub.html
pages 1 'points.csv' scene/s.toml --page scene/points.csv
rejects 2 'nowhere' b.relief -o nowhere/o.html
rejects 1 '-o' -
rejects 1 'samples' b.relief --samples 10 -o errors/o.html
rejects 6 'samples' b.relief --mesh "$bunny" --samples 1000000000000 -o errors/o.html
rejects 6 'triangles' b.relief --mesh "$bunny" --max-triangles 10 -o errors/o.html
printf '[collider]\nfile = "../b.relief"\n' >scene/outside.toml
pages 3 'outside.toml:2' scene/outside.toml --page errors/o.html

# The page of scenes: first the variable, then the installed page, then the adjacent build.
RELIEF_VIEW_PAGE=$work/none.html pages 2 none.html scene/s.toml --page errors/o.html
RELIEF_VIEW_PAGE=$work/box.obj pages 3 'scripts/build.sh web' scene/s.toml --page errors/o.html
cat stub.html stub.html >twice.html
RELIEF_VIEW_PAGE=$work/twice.html pages 3 'scripts/build.sh web' scene/s.toml --page errors/o.html
# A player whose data has another format or precedes format versions.
for mark in 's/data-format="/&1/' 's/ data-format="[^"]*"//'; do
    sed "$mark" stub.html >other.html
    RELIEF_VIEW_PAGE=$work/other.html pages 3 'other.html.*scripts/build.sh web' scene/s.toml --page errors/o.html
done
mkdir -p tree/release/bin tree/web/bin tree/release/share/relief
cp "$relief" "$relief_sim" "$RELIEF_BIN/relief-import" tree/release/bin/
unset RELIEF_VIEW_PAGE
expect_error 5 'scripts/build.sh web' tree/release/bin/relief-sim scene/s.toml --page errors/o.html
expect 0 tree/release/bin/relief view b.relief -o found.html
cmp found.html b.html || die "an installed tool writes a different page"
for place in web/bin release/share/relief; do
    sed "s#stub#$place#" stub.html >tree/$place/view.html
    expect 0 tree/release/bin/relief-sim scene/s.toml --page found.html
    grep -q "<title>$place" found.html || die "the page in $place is not found"
done

# A world: its text and colliders, and a scene that uses it.
export RELIEF_VIEW_PAGE=$work/stub.html
level level.gltf
"$relief" bake level.gltf --world w --budget 60kB --no-check -q
expect 0 "$relief" view w/world.json
extract w/world.html
json data.json "d['scene'] == 'world = \"world.json\"\\n' and len(d['files']) >= 4 and d['shows'] in d['files']"
contains w/world.json 'd["files"]["world.json"]'
rm w/box-*.relief
expect_error 2 "world.json" "$relief" view w/world.json
