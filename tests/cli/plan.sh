# SPDX-License-Identifier: Apache-2.0
# Planned bakes: the report, writing and reading plan files, --max-error, and which options go together. Unit tests show the
# planners, the search and the errors of plan files.
. "$(dirname "$0")/lib.sh"

mesh=$models/OBJ/spider.obj

# By default patches are planned, for 1 MB.
expect 0 "$relief" bake "$mesh" -o default.relief --plan-out default.toml --json
cp stdout report.json
json report.json 'd["settings"]["budget"] == d["plan"]["budget"] == 10**6 and 0.9e6 < d["plan"]["bytes"] == d["texel_bytes"] <= 10**6'
json report.json 'len(d["plan"]["maps"]) == len(d["maps"]) and all(m["reason"] for m in d["plan"]["maps"])'
json report.json 'd["settings"]["maps"] == ["patches:bytes=1000000"] and d["settings"]["resolution"] is None and d["times_ms"]["fit"] > 0'
expect 0 "$relief" bake "$mesh" -o budget.relief --budget 1MB
cmp default.relief budget.relief || die "the default is not a budget of 1 MB"
grep -qE 'planned for 1.0 MB' stderr && grep -qE 'ms: .*import [0-9].*plan [0-9].*fitting [0-9].*writing [0-9]' stderr ||
    die "the report has no plan and no times: $(cat stderr)"

# Views are planned on request, and for a surface that is baked as it is.
expect 0 "$relief" bake "$mesh" -o views.relief --layout views --plan-out views.toml --json
json stdout '0.9e6 < d["plan"]["bytes"] <= 10**6 and len(d["plan"]["maps"]) == len(d["maps"]) > 1 and 0 <= d["plan"]["unseen_percent"] < 20'
json stdout 'all("decode=plane" in m for m in d["settings"]["maps"])'
expect 0 "$relief" bake "$mesh" -o keep.relief --holes keep --no-check --json
json stdout 'all("decode=plane" in m for m in d["settings"]["maps"])'

# The collider records the budget, which is of the GPU; --compress changes the file only.
for options in "" "--compress 9"; do
    # shellcheck disable=SC2086
    expect 0 "$relief" bake "$mesh" -o recorded.relief --budget 60kB $options --json
    json stdout '" --budget 60000" in d["provenance"]["options"] and 50000 < d["texel_bytes"] <= 60000'
    json stdout "d['file_size'] == $(stat -c %s recorded.relief)"
done
[ "$(stat -c %s recorded.relief)" -lt 60000 ] || die "compressed, the file is larger than its maps on the GPU"

# A plan file gives the same bytes as its plan, and has no path; the quality and the preference are the file's.
expect 0 "$relief" bake "$mesh" -o again.relief --plan default.toml -q
cmp default.relief again.relief || die "the plan's file bakes other bytes than the plan"
printf '%s\n' 'v 0 0 0' 'v 9 0 0' 'v 9 4 0' 'v 0 4 0' 'v 0 0 5' 'v 1 0 5' 'v 1 0 6' 'f 1 2 3 4' 'f 5 6 7' >open.obj
while read -r file options; do
    # shellcheck disable=SC2086
    expect 0 "$relief" bake "${file/spider.obj/$mesh}" -o q.relief $options --plan-out q.toml -q --threads 1
    expect 0 "$relief" bake "${file/spider.obj/$mesh}" -o q2.relief --plan q.toml -q
    cmp q.relief q2.relief || die "the plan's file bakes other bytes than the plan: $file $options"
    ! grep -q "$work" q.toml || die "the plan holds a path"
done <<'O'
open.obj --budget 60kB
open.obj --max-error 4%
spider.obj --budget 60kB --prefer inside
spider.obj --budget 60kB --quality fast
spider.obj --budget 60kB --quality best
O
grep -q 'quality = "best"' q.toml || die "the plan does not name its quality"
expect 0 "$relief" bake "$mesh" -o q3.relief --plan q.toml --quality fast -q
! cmp -s q.relief q3.relief || die "--quality does not override the plan's"

# An edited plan is followed; one whose maps are larger records no budget.
sed -e '0,/^size = .*/s//size = "33x44"/' -e '0,/^depth = .*/s//depth = "half"/' views.toml >edited.toml
expect 0 "$relief" bake "$mesh" -o edited.relief --plan edited.toml -q
expect 0 "$relief" info edited.relief --json
json stdout '(d["maps"][0]["width"], d["maps"][0]["height"]) == (33, 44)'
json stdout '"size=33x44,depth=half," in d["provenance"]["options"]'
expect 0 "$relief" bake "$mesh" -o small.relief --budget 20kB --layout views --plan-out small.toml -q
sed -i 's/^size = .*/size = "128x128"/' small.toml
expect 0 "$relief" bake "$mesh" -o enlarged.relief --plan small.toml --json
json stdout '"--budget" not in d["provenance"]["options"] and d["texel_bytes"] > 20000'

# Wrong plans have their line; an older output stays as it was.
echo precious >old.relief
echo precious >old.toml
bake_fails() { # CODE PATTERN ARGUMENT…
    expect_error "$1" "$2" "$relief" bake "$mesh" "${@:3}"
    [ "$(cat old.relief old.toml)" = "$(printf 'precious\nprecious')" ] || die "an older output was touched: ${*:3}"
}
bake_fails 2 'none\.toml' -o old.relief --plan none.toml
sed 's/^dir = .*/dir = "up"/' views.toml >wrong.toml
bake_fails 3 "wrong\.toml:$(grep -n -m1 '^dir' wrong.toml | cut -d: -f1):7: " -o old.relief --plan wrong.toml
printf 'version = 1\n[[map]]\nformat = "float"\nsize = 9\nbox = "9e3/9e3/9e3/9.1e3/9.1e3/9.1e3"\n' >wrong.toml
bake_fails 4 'wrong\.toml' -o old.relief --plan wrong.toml
head -c 2000000 /dev/zero >wrong.toml
bake_fails 6 'wrong\.toml' -o old.relief --plan wrong.toml
bake_fails 1 'two outputs' -o new.relief --plan-out ./new.relief
bake_fails 2 'missing' -o old.relief --plan-out missing/plan.toml
bake_fails 1 'standard output' -o old.relief --plan-out -

# --max-error holds as relief check measures it, on other points; if it cannot, nothing is written.
expect 0 "$relief" bake "$bunny" -o b.relief --max-error 0.5% --plan-out b.toml --json
json stdout 'd["plan"]["search"]["wrong_percent"] <= 0.5 and d["texel_bytes"] < 250000'
json stdout 'len(d["plan"]["search"]["tries"]) >= 3 and d["plan"]["search"]["max_error_percent"] == 0.5'
[ "$(grep -c 'on the wrong side' stderr)" -ge 3 ] || die "the tries are not told: $(cat stderr)"
expect 0 "$relief" check b.relief --mesh "$bunny" --samples 100000 --seed 5 --max-error 0.57
expect 0 "$relief" bake "$bunny" -o b2.relief --plan b.toml -q
cmp b.relief b2.relief || die "the found plan's file bakes other bytes"
bake_fails 7 'max-error' -o old.relief --max-error 0.001 --budget 40kB --quality fast -q --plan-out old.toml

# Options that exclude each other; unit tests show the others.
bake_fails 1 budget -o old.relief --map float --budget 1MB
bake_fails 1 budget -o old.relief --budget 5B
