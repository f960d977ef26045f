# A collider measured against its mesh: report, JSON, page and exit codes.
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

# The same seed measures the same, another one something near it; the page is the same bytes.
for i in 1 2; do
    "$relief" check b.relief --mesh "$bunny" --samples 5000 --seed 7 --json --html $i.html |
        grep -v -e '"truth"' -e '"field"' >$i.json
done
cmp 1.json 2.json || die "two runs measure differently"
cmp 1.html 2.html || die "two pages differ"
! grep -qE '(src|href)="?(http|file|/)|@import|<script' 1.html || die "the page refers to something outside it"
grep -q 'src="data:image/png;base64,iVBOR' 1.html || die "the page has no pictures"
[ "$(grep -o '<img' 1.html | wc -l)" -eq $((4 + 3 + 3 * 4 + 6 * 2)) ] || die "heat maps, slices and maps are not all there"

# --max-error: the report is printed, and the exit code is that of a difference.
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
expect_error 1 'mesh' "$relief" check b.relief
