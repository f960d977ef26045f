# Planned bakes: the report, writing and reading plan files, --max-error, and which options go together.
. "$(dirname "$0")/lib.sh"

mesh=$models/OBJ/spider.obj

# By default patches are planned, for 1 MB; the report says so.
expect 0 "$relief" bake "$mesh" -o default.relief --plan-out default.toml --json
cp stdout report.json
json report.json 'd["settings"]["budget"] == 10**6 and d["plan"]["budget"] == 10**6'
json report.json '0.9e6 < d["plan"]["bytes"] == d["texel_bytes"] <= 10**6'
json report.json 'len(d["plan"]["maps"]) == len(d["maps"]) and all(m["reason"] for m in d["plan"]["maps"])'
json report.json 'd["plan"]["texel"] > 0 and d["plan"]["unseen_percent"] == 0'
json report.json 'd["settings"]["maps"] == ["patches:bytes=1000000"]'
json report.json 'd["settings"]["resolution"] is None and d["times_ms"]["fit"] > 0'
expect 0 "$relief" bake "$mesh" -o budget.relief --budget 1MB
cmp default.relief budget.relief || die "the default is not a budget of 1 MB"
grep -qE 'planned for 1.0 MB on the GPU, where the patches take [0-9.]+ [kM]B: ' stderr || die "the report does not say what was planned: $(cat stderr)"
grep -q 'in an octree' stderr || die "the report does not say why: $(cat stderr)"
for time in import plan fitting writing; do
    grep -q "ms: .*$time [0-9]" stderr || die "the report does not say how long $time took: $(cat stderr)"
done

# Views are planned where they are asked for, and where the surface is baked as it is.
expect 0 "$relief" bake "$mesh" -o views.relief --layout views --plan-out views.toml --json
cp stdout report.json
json report.json '0.9e6 < d["plan"]["bytes"] == d["texel_bytes"] <= 10**6'
json report.json 'len(d["plan"]["maps"]) == len(d["maps"]) > 1 and all(m["reason"] for m in d["plan"]["maps"])'
json report.json 'd["plan"]["texel"] > 0 and 0 <= d["plan"]["unseen_percent"] < 20 and d["times_ms"]["plan"] > 0'
json report.json 'all("decode=plane" in m for m in d["settings"]["maps"])'
expect 0 "$relief" bake "$mesh" -o views.relief --layout views
grep -qE 'where the maps take [0-9.]+ [kM]B: texels of ' stderr || die "the report does not say what was planned: $(cat stderr)"
grep -q 'both sides along' stderr || die "the report does not say why: $(cat stderr)"
for time in import plan fitting refining writing; do
    grep -q "ms: .*$time [0-9]" stderr || die "the report does not say how long $time took: $(cat stderr)"
done
expect 0 "$relief" bake "$mesh" -o keep.relief --holes keep --no-check --json
json stdout 'all("decode=plane" in m for m in d["settings"]["maps"])'
expect_error 1 'max-maps.*--layout views' "$relief" bake "$mesh" -o keep.relief --max-maps 3
expect_error 1 'layout.*leave it out' "$relief" bake "$mesh" -o keep.relief --layout views --paper

# The collider records the budget, and what counts is what the maps take on the GPU; --compress changes the file alone.
json report.json '" --budget 1000000" in d["provenance"]["options"]'
for options in "" "--compress 9"; do
    expect 0 "$relief" bake "$mesh" -o recorded.relief --budget 60kB $options --json
    json stdout '" --budget 60000" in d["provenance"]["options"] and 50000 < d["texel_bytes"] <= 60000'
    json stdout "d['file_size'] == $(stat -c %s recorded.relief)"
done
[ "$(stat -c %s recorded.relief)" -lt 60000 ] || die "compressed, the file is larger than its maps on the GPU"
expect 0 "$relief" check recorded.relief --mesh "$mesh" --samples 2000
! matches -- '--budget 60000' <stdout || die "advice repeats the recorded budget: $(cat stdout)"
expect 0 "$relief" bake "$mesh" -o named.relief --map cube:size=16 --json
json stdout '"--budget" not in d["provenance"]["options"]'
# Maps that someone has enlarged are no longer those that were planned.
expect 0 "$relief" bake "$mesh" -o small.relief --budget 20kB --layout views --plan-out small.toml -q
sed 's/^size = .*/size = "128x128"/' small.toml >enlarged.toml
expect 0 "$relief" bake "$mesh" -o enlarged.relief --plan enlarged.toml --json
json stdout '"--budget" not in d["provenance"]["options"] and d["texel_bytes"] > 20000'

# A plan file gives the same bytes as its plan; the quality is the file's.
expect 0 "$relief" bake "$mesh" -o again.relief --plan default.toml -q
cmp default.relief again.relief || die "the plan's file bakes other bytes than the plan"
for quality in fast best; do
    expect 0 "$relief" bake "$mesh" -o q.relief --budget 60kB --quality $quality --plan-out q.toml -q --threads 1
    grep -q "quality = \"$quality\"" q.toml || die "the plan does not name its quality"
    expect 0 "$relief" bake "$mesh" -o q2.relief --plan q.toml -q
    cmp q.relief q2.relief || die "the plan's file bakes other bytes than the plan, at quality $quality"
done
expect 0 "$relief" bake "$mesh" -o p.relief --budget 60kB --prefer inside --plan-out p.toml -q
grep -q 'prefer = "inside"' p.toml || die "the plan does not name its preference"
expect 0 "$relief" bake "$mesh" -o p2.relief --plan p.toml -q
cmp p.relief p2.relief || die "the plan's file bakes other bytes than the plan, with a preference"
"$relief" info p.relief --json | matches -- '--prefer inside' || die "the provenance does not name the preference"
expect 1 "$relief" bake "$mesh" -o p.relief --prefer sideways
expect 0 "$relief" bake "$mesh" -o q3.relief --plan q.toml --quality fast -q
! cmp -s q.relief q3.relief || die "--quality does not go before the plan's"
expect 0 "$relief" bake "$mesh" -o q.relief --budget 60kB --plan-out q2.toml --quality best -q
cmp q.toml q2.toml || die "two runs plan differently"
! grep -q "$work" q.toml || die "the plan holds a path"

# Shells are as thick by the plan as they were when it was made, whatever the budget.
printf '%s\n' 'v 0 0 0' 'v 9 0 0' 'v 9 4 0' 'v 0 4 0' 'v 0 0 5' 'v 1 0 5' 'v 1 0 6' 'f 1 2 3 4' 'f 5 6 7' >open.obj
for how in '--budget 60kB' '--max-error 4%'; do
    # shellcheck disable=SC2086
    expect 0 "$relief" bake open.obj -o o.relief $how --plan-out o.toml -q
    expect 0 "$relief" bake open.obj -o o2.relief --plan o.toml -q
    cmp o.relief o2.relief || die "the plan's file bakes other bytes than the plan, of sheets and $how"
done

# A changed plan is followed.
sed -e '0,/^size = .*/s//size = "33x44"/' -e '0,/^depth = .*/s//depth = "half"/' views.toml >edited.toml
expect 0 "$relief" bake "$mesh" -o edited.relief --plan edited.toml -q
expect 0 "$relief" info edited.relief --json
json stdout '(d["maps"][0]["width"], d["maps"][0]["height"]) == (33, 44)'
json stdout '"size=33x44,depth=half," in d["provenance"]["options"]'

# Wrong plans are refused at their line; an older output stays as it was.
echo precious >old.relief
echo precious >old.toml
bake_fails() {
    local code=$1 pattern=$2
    shift 2
    expect_error "$code" "$pattern" "$relief" bake "$mesh" "$@"
    [ "$(cat old.relief old.toml)" = "$(printf 'precious\nprecious')" ] || die "an older output was touched: $*"
}
bake_fails 2 'none\.toml' -o old.relief --plan none.toml
sed 's/^dir = .*/dir = "up"/' views.toml >wrong.toml
bake_fails 3 "wrong\.toml:$(grep -n -m1 '^dir' wrong.toml | cut -d: -f1):7: dir is 'up'" -o old.relief --plan wrong.toml
sed 's/^decode/decoed/' views.toml >wrong.toml
bake_fails 3 "wrong\.toml:[0-9]+:1: .*did you mean 'decode'" -o old.relief --plan wrong.toml
sed 's/^size = .*/size = "20000"/' views.toml >wrong.toml
bake_fails 6 'wrong\.toml:[0-9]+:8: .*16384' -o old.relief --plan wrong.toml
(echo version = 1 && for _ in 1 2; do printf '[[map]]\nformat = "float"\nsize = 16384\n'; done) >wrong.toml
bake_fails 6 'wrong\.toml.*bytes' -o old.relief --plan wrong.toml
printf 'version = 1\n[[map]]\nformat = "float"\nsize = 9\nbox = "9e3/9e3/9e3/9.1e3/9.1e3/9.1e3"\n' >wrong.toml
bake_fails 4 'wrong\.toml.*no map sees' -o old.relief --plan wrong.toml
head -c 2000000 /dev/zero >wrong.toml
bake_fails 6 'wrong\.toml' -o old.relief --plan wrong.toml
bake_fails 1 'two outputs' -o old.relief --plan-out old.relief
bake_fails 1 'two outputs' -o new.relief --plan-out ./new.relief
cp "$mesh" mesh.obj
expect_error 1 'is the input' "$relief" bake mesh.obj -o new.relief --plan-out mesh.obj
cmp "$mesh" mesh.obj || die "the mesh was replaced"
expect_error 1 'is the input' "$relief" bake mesh.obj --plan views.toml -o views.toml
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
expect_error 7 'max-error.*best is .* bytes' "$relief" bake "$bunny" -o old.relief --max-error 0.001 --budget 40kB \
    --quality fast -q --plan-out old.toml
[ "$(cat old.relief old.toml)" = "$(printf 'precious\nprecious')" ] || die "an older output was touched"

# Only one option may choose the maps.
bake_fails 1 '--map and --budget' -o old.relief --map float --budget 1MB
bake_fails 1 '--map and --paper' -o old.relief --map float --paper
bake_fails 1 '--paper and --plan' -o old.relief --plan views.toml --paper
bake_fails 1 '--plan and --max-error' -o old.relief --plan views.toml --max-error 1
bake_fails 1 'resolution.*planned' -o old.relief --resolution 64
bake_fails 1 'resolution.*planned' -o old.relief --resolution 64 --budget 1MB
bake_fails 1 'plan-out' -o old.relief --paper --plan-out p.toml
bake_fails 1 'decode does nothing' -o old.relief --decode projected
bake_fails 1 'depth does nothing' -o old.relief --depth half --paper
bake_fails 1 'max-error' -o old.relief --max-error few
bake_fails 1 'budget' -o old.relief --budget 1XB
bake_fails 1 'too small|least' -o old.relief --budget 5B
