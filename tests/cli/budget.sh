# SPDX-License-Identifier: Apache-2.0
# Patches for a budget and for --max-error, the maps of --holes keep, and conflicting options. Unit tests cover the
# planner and the search.
. "$(dirname "$0")/lib.sh"

mesh=$models/OBJ/spider.obj

# By default patches use up to 1 MB.
expect 0 "$relief" bake "$mesh" -o default.relief --json
cp stdout report.json
json report.json 'd["settings"]["budget"] == d["patches"]["budget"] == 10**6 and 0.9e6 < d["patches"]["bytes"] == d["gpu_bytes"] <= 10**6'
json report.json 'd["settings"]["maps"] == ["patches:budget=1000000"] and d["settings"]["resolution"] is None and d["times_ms"]["fit"] > 0'
expect 0 "$relief" bake "$mesh" -o budget.relief --budget 1MB
cmp default.relief budget.relief || die "the default is not a budget of 1 MB"
grep -qE '^patches for 1.0 MB' stderr && grep -qE 'ms: import [0-9].*fitting [0-9].*writing [0-9]' stderr ||
    die "the report contains no patches or times: $(cat stderr)"

# An open surface that is kept has three front-back maps.
expect 0 "$relief" bake "$mesh" -o keep.relief --holes keep --resolution 64 --json
json stdout '[(m["format"], m["width"]) for m in d["maps"]] == [("front-back", 64)] * 3 and d["patches"] is None'
json stdout 'all("decode=plane" in m for m in d["settings"]["maps"]) and d["provenance"]["options"].endswith(" --holes keep")'

# The collider records the budget of GPU bytes, and a bake with the recorded options has the same bytes. --compress
# changes only the file.
for options in "" "--compress 9"; do
    # shellcheck disable=SC2086
    expect 0 "$relief" bake "$mesh" -o recorded.relief --budget 60kB $options --json
    json stdout '" --budget 60000" in d["provenance"]["options"] and 50000 < d["gpu_bytes"] <= 60000'
    json stdout "d['file_bytes'] == $(stat -c %s recorded.relief)"
    recorded=$(python3 -c 'import json; print(json.load(open("stdout"))["provenance"]["options"])')
    # shellcheck disable=SC2086
    expect 0 "$relief" bake "$mesh" -o again.relief $recorded $options -q
    cmp recorded.relief again.relief || die "a bake with '$recorded' has other bytes"
done
[ "$(stat -c %s recorded.relief)" -lt 60000 ] || die "the compressed file is larger than its maps on the GPU"

# relief check confirms --max-error. If it is unreachable, nothing is written.
echo precious >old.relief
bake_fails() { # CODE PATTERN ARGUMENT…
    expect_error "$1" "$2" "$relief" bake "$mesh" -o old.relief "${@:3}"
    [ "$(cat old.relief)" = precious ] || die "an existing output was changed: ${*:3}"
}
bake_fails 4 'lower the texel$' --texel 1e6
expect 0 "$relief" bake "$bunny" -o b.relief --max-error 0.5% --json
json stdout 'd["patches"]["search"]["wrong_percent"] <= 0.5 and d["gpu_bytes"] < 250000'
json stdout 'len(d["patches"]["search"]["trials"]) >= 3 and d["patches"]["search"]["max_error_percent"] == 0.5'
[ "$(grep -c 'on the wrong side' stderr)" -ge 3 ] || die "the trials are not reported: $(cat stderr)"
budget=$(python3 -c 'import json; print(json.load(open("stdout"))["patches"]["budget"])')
expect 0 "$relief" check b.relief --mesh "$bunny" --max-error 0.5 -q
expect 0 "$relief" bake "$bunny" -o b2.relief --budget "$budget" -q
cmp b.relief b2.relief || die "the reported budget gives different bytes"
bake_fails 7 'max-error' --max-error 0.001 --budget 40kB --quality fast -q

# Mutually exclusive options; unit tests cover the others.
bake_fails 1 budget --map float --budget 1MB
bake_fails 1 budget --budget 5B
bake_fails 1 'holes keep' --holes keep --budget 1MB
