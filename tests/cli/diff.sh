# relief diff: identical, equal, different and damaged files; limits, JSON and exit codes.
. "$(dirname "$0")/lib.sh"

bake() { "$relief" bake "$bunny" -o "$1" -q --paper --resolution "${@:2}"; }
bake a.relief 48
bake again.relief 48
expect 0 "$relief" diff a.relief again.relief
grep -q "'a.relief' and 'again.relief' are identical" stdout || die "said: $(cat stdout)"
expect 0 "$relief" diff a.relief again.relief --json
json stdout 'd["identical"] and d["same_collider"] and d["within_limits"] and d["points"] is None'
json stdout 'list(d) == ["a", "b", "identical", "same_collider", "within_limits", "max_sides", "max_distance", "header", "provenance", "maps", "points"]'
json stdout 'd["maps"] == [[], [], [], []]'

# Compression changes the bytes and not the collider. Another origin is reported, and does not count.
bake packed.relief 48 --compress 19
expect 0 "$relief" diff a.relief packed.relief
grep -q 'the same collider, stored differently' stdout || die "said: $(cat stdout)"
(cat "$bunny" && echo '# touched') >touched.obj
"$relief" bake touched.obj -o touched.relief -q --paper --resolution 48
expect 0 "$relief" diff a.relief touched.relief
grep -q 'mesh_hash' stdout || die "the other mesh is not named: $(cat stdout)"

# A moved vertex changes texels; limits above that change let it pass, and the order of the two files does not matter.
awk '/^v / && !done { $2 += 0.02; done = 1 } { print }' "$bunny" >moved.obj
"$relief" bake moved.obj -o moved.relief -q --paper --resolution 48
expect 7 "$relief" diff a.relief moved.relief --json
cp stdout there.json
[ "$(wc -l <stderr)" -eq 1 ] && grep -qE '^relief: error: .*differ: ' stderr || die "no reason given: $(cat stderr)"
expect 7 "$relief" diff moved.relief a.relief --json
cp stdout back.json
python3 - <<'P' || die "diff(A, B) is no mirror of diff(B, A)"
import json, sys
there, back = (json.load(open(name)) for name in ('there.json', 'back.json'))
def mirrored(d):
    if isinstance(d, list):
        return [mirrored(x) for x in d]
    if not isinstance(d, dict):
        return d
    swap = {'a': 'b', 'b': 'a', 'only_a': 'only_b', 'only_b': 'only_a'}
    return {swap.get(k, k): mirrored(v) for k, v in d.items()}
sys.exit(0 if mirrored(there) == back and not there['same_collider'] and there['points']['mean'] > 0 else 1)
P
expect 7 "$relief" diff a.relief moved.relief
grep -q '^  map 1: texels$' stdout || die "said: $(cat stdout)"
expect 0 "$relief" diff a.relief moved.relief --max-sides 5 --max-distance 0.1
grep -q 'within the limits' stdout || die "said: $(cat stdout)"
expect 7 "$relief" diff a.relief moved.relief --max-sides 0 --max-distance 0.1

# Maps of another size are named, and differ; and so do fewer maps.
bake larger.relief 50
expect 7 "$relief" diff a.relief larger.relief
grep -q 'map 0: width, height, .*texels' stdout || die "said: $(cat stdout)"
grep -q 'differ: map 0: width' stderr || die "said: $(cat stderr)"
"$relief" bake "$bunny" -o one.relief -q --map fixed8:size=48
expect 7 "$relief" diff a.relief one.relief --json
json stdout 'd["header"][0] == {"what": "maps", "a": "4", "b": "1"} and len(d["maps"]) == 1 and "texels" in d["maps"][0]'

# One of the two files may be standard input.
"$relief" diff - again.relief <a.relief >said || die "standard input as A"
grep -q "standard input and 'again.relief' are identical" said || die "said: $(cat said)"
"$relief" diff a.relief - <again.relief >said || die "standard input as B"
[ -z "$("$relief" diff a.relief again.relief -q)" ] || die "-q says something"

# Damaged files and wrong options.
head -c 1000 a.relief >truncated.relief
cp a.relief altered.relief
printf '\x55' | dd of=altered.relief bs=1 seek=1700 conv=notrunc status=none
for file in truncated altered; do
    expect_error 3 "$file\.relief" "$relief" diff a.relief $file.relief
    expect_error 3 "$file\.relief" "$relief" diff $file.relief a.relief
done
expect_error 2 'missing\.relief' "$relief" diff a.relief missing.relief
expect_error 1 'standard input' "$relief" diff - -
expect_error 1 'max-sides' "$relief" diff a.relief a.relief --max-sides few
expect_error 1 'B' "$relief" diff a.relief
expect_error 2 '/dev/full|standard output' sh -c "'$relief' diff a.relief moved.relief >/dev/full"

# Two plans are compared at the same points. A scaled box has another surface: one percent more of its
# half sides of 1, 2 and 3.
cat >box.obj <<'O'
v -1 -2 -3
v 1 -2 -3
v 1 2 -3
v -1 2 -3
v -1 -2 3
v 1 -2 3
v 1 2 3
v -1 2 3
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 3 4 8 7
f 2 3 7 6
f 1 5 8 4
O
awk '/^v / { $2 *= 1.1; $3 *= 1.1; $4 *= 1.1 } { print }' box.obj >larger.obj
"$relief" bake box.obj -o planned.relief -q --budget 60kB
"$relief" bake box.obj -o cube.relief -q --map cube:size=128
"$relief" bake larger.obj -o larger_box.relief -q --map cube:size=128
expect 7 "$relief" diff planned.relief cube.relief
grep -qE '^  near the surfaces, [0-9]+ points: .* on another side .*; distances differ by .* object units' stdout ||
    die "said: $(cat stdout)"
expect 0 "$relief" diff planned.relief cube.relief --max-sides 2% --max-distance 0.06
grep -q 'within the limits' stdout || die "said: $(cat stdout)"
expect 0 "$relief" diff planned.relief cube.relief --max-sides 2 --json
json stdout 'd["within_limits"] and d["max_sides"] == 2 and d["max_distance"] is None'
json stdout 'd["points"]["sides_percent"] < 2 and d["points"]["points"] > 15000'
json stdout 'd["points"]["mean"] < 0.01'
expect 7 "$relief" diff planned.relief larger_box.relief --max-sides 2% --json
json stdout 'd["points"]["only_b"] > 0 == d["points"]["only_a"]'
grep -q '% of the points near the surfaces are on another side' stderr || die "said: $(cat stderr)"
expect 7 "$relief" diff planned.relief larger_box.relief --max-distance 0.06
grep -q 'distances near the surfaces differ by' stderr || die "said: $(cat stderr)"
"$relief" bake box.obj -o metres.relief -q --map cube:size=128 --unit m
expect 7 "$relief" diff cube.relief metres.relief --max-sides 2%
grep -q 'units differ' stderr || die "said: $(cat stderr)"
grep -q '^  unit: "" and "m"$' stdout || die "said: $(cat stdout)"
expect_error 1 'max-distance.*must be a length' "$relief" diff a.relief a.relief --max-distance -1
