# relief check, with a mesh and without: report, JSON, page and exit codes.
. "$(dirname "$0")/lib.sh"

printf '<!doctype html>\n<script type="application/json" id="relief-page-data">null</script>\n' >stub.html
export RELIEF_VIEW_PAGE=$work/stub.html # tests/web looks at the real one
"$relief" bake "$bunny" -o b.relief --paper --resolution 64 --json >bake.json 2>/dev/null
expect 0 "$relief" check b.relief --mesh "$bunny" --samples 5000
grep -q 'near the surface' stdout || die "no report: $(cat stdout)"
expect 0 "$relief" check b.relief --mesh "$bunny" --samples 5000 --json
cp stdout report.json
json report.json 'd["mesh"]["name"] == "bunny.obj" and d["mesh"]["baked_from_it"] and d["warnings"] == []'
json report.json '0 < d["accuracy"]["near"]["wrong_percent"] < 30'
bytes=$(python3 -c 'import json; print(json.load(open("bake.json"))["texel_bytes"])')
json report.json "d['accuracy']['gpu_bytes'] == $bytes"
json report.json "6 * 64 * 64 * 4 < $bytes < 3 * (62 * 62 + 64) * 8 + 6 * 64 * 64 * 4"

json report.json 'd["sampling"]["samples"] == 5000 and d["sampling"]["seed"] == 1 and d["passed"]'

# The same seed gives the same numbers and the same page, another seed nearly the same numbers.
for i in 1 2; do
    "$relief" check b.relief --mesh "$bunny" --samples 5000 --seed 7 --json --html $i.html |
        grep -v -e '"truth"' -e '"field"' >$i.json
done
cmp 1.json 2.json || die "two runs measure differently"
cmp 1.html 2.html || die "two pages differ"
# The page is that of `relief view`, with the report in it.
"$relief" check b.relief --mesh "$bunny" --samples 5000 --seed 7 --json >7.json
"$relief" check b.relief --mesh "$bunny" --samples 5000 --seed 7 >7.txt
python3 - <<'P' || die "the page does not hold what the report says"
import base64, json
page, stub, report = open('1.html').read(), open('stub.html').read(), json.load(open('7.json'))
before, after = stub.split('>null<')
assert page.startswith(before + '>') and page.endswith('<' + after)
d = json.loads(page[len(before) + 1:len(page) - len(after) - 1])
assert base64.b64decode(d['collider']) == open('b.relief', 'rb').read() and d['mesh']['name'] == 'bunny.obj'
check = d['check']
assert check['verdict'].pop('text').endswith(': poor') and check['parts'].pop('text') in open('7.txt').read()
assert all(abs(sum(x * x for x in place.pop('normal')) - 1) < 1e-5 for place in check['worst_places'])
report.pop('times_ms')
assert check == report and len(check['worst_places']) == 3 and check['advice'][0]['helps']
P

# A verdict in the first line, the worst places, and what to do about them: tried, and as good as was said.
head -1 <(expect 0 "$relief" check b.relief --mesh "$bunny" --samples 5000 && cat stdout) >first
grep -qxE 'b\.relief: [0-9.]+ % wrong near the surface: (good|fair|poor)' first || die "no verdict: $(cat first)"
grep -q '^The worst places:$' stdout || die "no places: $(cat stdout)"
grep -qE '^  relief bake .*bunny.obj -o b.relief --budget [0-9.]+[kM]B$' stdout || die "no advice: $(cat stdout)"
json report.json '[len(d["worst_places"]), d["verdict"]["grade"]] == [3, "poor"]'
json report.json 'd["verdict"]["wrong_percent"] == d["accuracy"]["near"]["wrong_percent"] and d["repaired"] is None'
json report.json 'all(0 < p["size"] < 0.6 and 0 <= p["map"] < 4 and p["share_percent"] > 0.5 for p in d["worst_places"])'
json report.json 'd["advice"][0]["helps"] and d["advice"][0]["wrong_percent"] < d["verdict"]["wrong_percent"] / 2'
advised() { # REPORT: runs the first command that it advises
    bash -c "$(python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["advice"][0]["command"])' "$1" |
        sed "s#^relief#'$relief'#") -q"
}
keeps_promise() { # REPORT AFTER: what the second measures is what the first promised
    python3 - "$1" "$2" <<'P' || die "the advice of $1 is not worth what it says"
import json, sys
before, after = (json.load(open(f)) for f in sys.argv[1:])
said, found = before["advice"][0]["wrong_percent"], after["verdict"]["wrong_percent"]
print(said, found)
sys.exit(0 if abs(said - found) <= 0.15 * said + 0.2 else 1)
P
}
"$relief" bake "$bunny" -o few.relief --budget 20kB -q
"$relief" check few.relief --mesh "$bunny" --samples 20000 --json >few.json
json few.json '{p["cause"] for p in d["worst_places"]} == {"texel"} and d["advice"][0]["command"].endswith("--budget 40kB")'
advised few.json
"$relief" check few.relief --mesh "$bunny" --samples 20000 --json >more.json
keeps_promise few.json more.json

# Patches are told of bytes alone, for nothing is out of their sight; views are held against patches of as many bytes.
json few.json '[a["about"] for a in d["advice"]] == ["patches of twice the bytes"]'
expect 0 "$relief" check few.relief --mesh "$bunny" --samples 5000
grep -q 'finer than the patches: map 0 (patches) decides, whose heights are [0-9.]* apart there' stdout || die "no cause: $(cat stdout)"
"$relief" bake "$bunny" -o views.relief --layout views --budget 100kB -q
"$relief" check views.relief --mesh "$bunny" --samples 20000 --json >views.json
python3 - <<'P' >same.json || die "no advice of patches: $(cat views.json)"
import json
d = json.load(open('views.json'))
d['advice'] = [a for a in d['advice'] if a['about'] == 'patches of as many bytes']
assert d['advice'] and d['advice'][0]['wrong_percent'] < 0.6 * d['verdict']['wrong_percent']
print(json.dumps(d))
P
advised same.json
"$relief" check views.relief --mesh "$bunny" --samples 20000 --json >after.json
json after.json 'd["accuracy"]["gpu_bytes"] <= 1e5 and [p["map"] for p in d["worst_places"]] == [0] * 3'
keeps_promise same.json after.json
# Where holes are kept, views of twice the bytes are what helps.
"$relief" bake "$bunny" -o kept.relief --budget 100kB --holes keep -q
"$relief" check kept.relief --mesh "$bunny" --samples 20000 --json >kept.json
json kept.json '[a["about"] for a in d["advice"]] == ["planned maps of twice the bytes"] and d["advice"][0]["helps"]'

# A cavity that no map sees: a ball in a box. A cube at each place helps.
python3 - >hollow.obj <<'P'
import math
points = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
first, n = len(points), 32
for j in range(n + 1):
    for i in range(n):
        t, p = math.pi * j / n, 2 * math.pi * i / n
        points.append((0.2 + 0.5 * math.sin(t) * math.cos(p), 0.5 * math.cos(t), 0.5 * math.sin(t) * math.sin(p)))
for j in range(n):
    for i in range(n):
        a, b = first + j * n + i, first + j * n + (i + 1) % n
        faces.append((a, b, b + n, a + n))
for p in points:
    print('v', *(round(c, 6) + 0.0 for c in p))
for f in faces:
    print('f', *(v + 1 for v in f))
P
"$relief" bake hollow.obj -o h.relief -q --map front-back:dir=-x,size=64 --map front-back:dir=-y,size=64 --map front-back:dir=-z,size=64
"$relief" check h.relief --mesh hollow.obj --samples 20000 --max-error 0.1 --json >hollow.json || [ $? -eq 7 ]
json hollow.json '{p["cause"] for p in d["worst_places"]} == {"unseen"} and d["accuracy"]["unseen_area_percent"] > 9'
json hollow.json 'all(abs(math.dist(p["position"], (0.2, 0, 0)) - 0.5) < 0.06 for p in d["worst_places"])'
json hollow.json 'any(a["helps"] and a["command"].count("--map cube") == 3 for a in d["advice"])'
python3 - <<'P' >cubes.json
import json
d = json.load(open('hollow.json'))
d['advice'] = [a for a in d['advice'] if '--map cube' in a['command']]
print(json.dumps(d))
P
advised cubes.json
"$relief" check h.relief --mesh hollow.obj --samples 20000 --json >cured.json
keeps_promise cubes.json cured.json
json hollow.json 'all(a["tried"] and a["untried"] is None for a in d["advice"])'

# An open mesh that was to stay open: a solid helps.
tar -xzf /usr/share/doc/libcgal-dev/data.tar.gz data/meshes/mushroom.off data/meshes/joint.off data/meshes/cheese.off
mv data/meshes/mushroom.off "a mesh's.off"
"$relief" bake "a mesh's.off" -o m.relief --budget 100kB --holes keep -q 2>/dev/null
"$relief" check m.relief --mesh "a mesh's.off" --samples 20000 --json >open.json 2>/dev/null
json open.json 'd["verdict"]["grade"] == "poor" and d["worst_places"][0]["cause"] == "open"'
json open.json 'd["advice"][0]["helps"] and "--holes" not in d["advice"][0]["command"]'
advised open.json 2>/dev/null
"$relief" check m.relief --mesh "a mesh's.off" --samples 20000 --json >solid.json 2>/dev/null
keeps_promise open.json solid.json

# The collider of a repaired mesh is measured against that, and against the original.
"$relief" bake "a mesh's.off" -o m.relief --budget 100kB --repair wrap=0.05 -q 2>/dev/null
"$relief" check m.relief --mesh "a mesh's.off" --samples 20000 --json >wrapped.json 2>/dev/null
json wrapped.json 'd["repaired"]["repair"] == "wrap=0.05" and d["repaired"]["triangles"] != d["mesh"]["triangles"]'
json wrapped.json 'd["verdict"]["wrong_percent"] == d["repaired"]["accuracy"]["near"]["wrong_percent"] < 3'
json wrapped.json 'd["accuracy"]["near"]["wrong_percent"] > d["verdict"]["wrong_percent"] + 1'
"$relief" check m.relief --mesh "a mesh's.off" --samples 5000 2>/dev/null | matches 'repaired by wrap=0.05.*as it came: ' || die "no word of the repair"

# Bake and check agree on how much of the surface no map sees, walls along the lines of sight included.
for mesh in joint cheese; do
    "$relief" bake data/meshes/$mesh.off -o seen.relief --budget 250kB --json >plan.json
    "$relief" check seen.relief --mesh data/meshes/$mesh.off --samples 20000 --json >seen.json
    planned=$(python3 -c 'import json; print(json.load(open("plan.json"))["plan"]["unseen_percent"])')
    json seen.json "abs(d['accuracy']['unseen_area_percent'] - $planned) < 0.5"
done

# --max-error: the report is printed, and the exit code says "difference".
expect 7 "$relief" check b.relief --mesh "$bunny" --samples 5000 --max-error 0.01 --json
json stdout 'd["max_error_percent"] == 0.01 and not d["passed"]'
grep -q 'max-error' stderr || die "no reason given: $(cat stderr)"
expect 0 "$relief" check b.relief --mesh "$bunny" --samples 5000 --max-error 50%

# The same surface in another file is a warning, another mesh an error.
(cat "$bunny" && echo '# touched') >touched.obj
expect 0 "$relief" check b.relief --mesh touched.obj --samples 1000 --json
grep -q 'warning: .*touched.obj is not the file' stderr || die "no warning: $(cat stderr)"
json stdout 'not d["mesh"]["baked_from_it"] and len(d["warnings"]) == 1'
expect_error 3 'bounds' "$relief" check b.relief --mesh "$models/OBJ/box.obj"

expect_error 1 'max-error' "$relief" check b.relief --mesh "$bunny" --max-error few
expect_error 1 'samples' "$relief" check b.relief --mesh "$bunny" --samples 0
expect_error 6 'limit' "$relief" check b.relief --mesh "$bunny" --samples 99999999999
expect_error 1 'html' "$relief" check b.relief --mesh "$bunny" --html -
expect_error 2 'missing' "$relief" check b.relief --mesh "$bunny" --html missing/page.html
expect_error 1 'the output .* is the input' "$relief" check b.relief --mesh "$bunny" --html stub.html
RELIEF_VIEW_PAGE=$work/none.html expect_error 2 none.html "$relief" check b.relief --mesh "$bunny" --samples 50 --html page.html
expect_error 2 'missing.relief' "$relief" check missing.relief --mesh "$bunny"
for option in '--samples 5' '--seed 5' '--max-error 5' '--html page.html'; do
    # shellcheck disable=SC2086
    expect_error 1 '--mesh' "$relief" check b.relief $option
done

# Without a mesh: every issue of the file is listed by its code, with what is left of the file.
expect 0 "$relief" check b.relief
[ ! -s stderr ] && grep -q '^b.relief: sound$' stdout || die "a sound file: $(cat stdout stderr)"
expect 0 "$relief" check b.relief --json
json stdout 'd["verdict"] == "sound" and d["issues"] == [] and [m["state"] for m in d["maps"]] == ["sound"] * 4'
"$relief" check - --json <b.relief | cmp <(sed 's/"b.relief"/"standard input"/' stdout) - || die "standard input differs"
offset=$("$relief" info b.relief --json | python3 -c 'import json, sys; print(json.load(sys.stdin)["maps"][2]["offset"])')
cp b.relief damaged.relief
printf 'DAMAGE' | dd of=damaged.relief bs=1 seek="$offset" conv=notrunc status=none
expect 3 "$relief" check damaged.relief
grep -q "^RLF-1407 error: map 2: .*(byte $offset)$" stdout || die "the damage is not named: $(cat stdout)"
grep -q '^Can be trusted: what describes the maps, and of them 0, 1, 3\.$' stdout || die "what is left: $(cat stdout)"
[ "$(wc -l <stderr)" -eq 1 ] && grep -q "error: 'damaged.relief' .*RLF-1407" stderr || die "stderr: $(cat stderr)"
expect 3 "$relief" check damaged.relief --json
json stdout 'd["errors"] == 2 and [m["state"] for m in d["maps"]] == ["sound", "sound", "damaged", "sound"]'
head -c $((offset + 100)) b.relief >cut.relief
expect 3 "$relief" check cut.relief --json
json stdout '[i["code"] for i in d["issues"]] == ["RLF-1006", "RLF-1404", "RLF-1404"]'
json stdout '[m["state"] for m in d["maps"]] == ["sound", "sound", "unreadable", "unreadable"]'
expect 3 "$relief" check "$bunny"
grep -q '^RLF-1002 fatal' stdout || die "a mesh is no container: $(cat stdout)"
expect_error 2 'nowhere' "$relief" check nowhere.relief
cp b.relief later.relief
printf '\2' | dd of=later.relief bs=1 seek=12 conv=notrunc status=none
expect 5 "$relief" check later.relief

# Fresh bakes have no issues, not even boxes whose faces lie at the end of their maps.
rm data/meshes/*.off
tar -xzf /usr/share/doc/libcgal-dev/data.tar.gz data/meshes/P.off data/meshes/cube.off
for mesh in data/meshes/*.off "$models/OBJ/box.obj"; do
    for options in '--budget 60kB' '--paper --resolution 32' \
        '--map float:size=32 --map fixed8:dir=1/2/3,size=32,compare=greater --map cube:size=16'; do
        # shellcheck disable=SC2086
        "$relief" bake "$mesh" -o other.relief -q $options 2>/dev/null
        expect 0 "$relief" check other.relief
        ! grep RLF stdout || die "$mesh $options is suspicious"
    done
done
