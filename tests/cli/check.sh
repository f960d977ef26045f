# relief check, with a mesh and without: report, JSON, page and exit codes.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o b.relief --paper --resolution 64 -q
expect 0 "$relief" check b.relief --mesh "$bunny" --samples 5000
grep -q 'near the surface' stdout || die "no report: $(cat stdout)"
expect 0 "$relief" check b.relief --mesh "$bunny" --samples 5000 --json
cp stdout report.json
json report.json 'd["mesh"]["name"] == "bunny.obj" and d["mesh"]["baked_from_it"] and d["warnings"] == []'
json report.json '0 < d["accuracy"]["near"]["wrong_percent"] < 30'
json report.json 'd["accuracy"]["gpu_bytes"] == 3 * 64 * 64 * 8 + 6 * 64 * 64 * 4'
json report.json 'd["sampling"]["samples"] == 5000 and d["sampling"]["seed"] == 1 and d["passed"]'

# The same seed gives the same numbers and the same page, another seed nearly the same numbers.
for i in 1 2; do
    "$relief" check b.relief --mesh "$bunny" --samples 5000 --seed 7 --json --html $i.html |
        grep -v -e '"truth"' -e '"field"' >$i.json
done
cmp 1.json 2.json || die "two runs measure differently"
cmp 1.html 2.html || die "two pages differ"
! grep -qE '(src|href)="?(http|file|/)|@import|<script' 1.html || die "the page refers to something outside it"
grep -q 'src="data:image/png;base64,iVBOR' 1.html || die "the page has no pictures"
[ "$(grep -o '<img' 1.html | wc -l)" -eq $((4 + 3 + 3 * 4 + 6 * 2)) ] || die "heat maps, slices and maps are not all there"

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
