# What `relief bake` says of broken meshes, --strict and --repair.
. "$(dirname "$0")/lib.sh"

# A ball of 2 × 16 × 8 triangles as a list of `f` lines; argument: which of them are left out, turned.
cat >ball.py <<'P'
import math, sys
drop, turn, file = set(map(int, sys.argv[1].split())), set(map(int, sys.argv[2].split())), sys.argv[3]
M, N = 16, 9
v = [(0, 1, 0)] + [(math.sin(math.pi * i / N) * math.cos(2 * math.pi * j / M), math.cos(math.pi * i / N),
                    math.sin(math.pi * i / N) * math.sin(2 * math.pi * j / M)) for i in range(1, N) for j in range(M)] + [(0, -1, 0)]
at = lambda i, j: 1 + (i - 1) * M + j % M
f = []
for j in range(M):
    f.append((0, at(1, j + 1), at(1, j)))
    for i in range(1, N - 1):
        f += [(at(i, j), at(i, j + 1), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i + 1, j))]
    f.append((len(v) - 1, at(N - 1, j), at(N - 1, j + 1)))
with open(file, 'w') as out:
    out.writelines('v %.9g %.9g %.9g\n' % p for p in v)
    for k, t in enumerate(f):
        if k not in drop:
            a, b, c = (t[0], t[2], t[1]) if k in turn else t
            out.write(f'f {a + 1} {b + 1} {c + 1}\n')
P
python3 ball.py '' '' ball.obj
python3 ball.py '5 6 100' '' holed.obj
python3 ball.py '' "$(seq 0 3 255 | tr '\n' ' ')" turned.obj
small=(--paper --resolution 32)

# A sound mesh: one line, and --strict says nothing.
expect 0 "$relief" bake ball.obj -o ball.relief "${small[@]}" --strict
grep -q '^mesh: a closed solid; 1 component$' stderr || die "the report says: $(cat stderr)"
expect 0 "$relief" bake ball.obj -o ball.relief "${small[@]}" --json
json stdout "d['mesh_health']['solid'] and d['mesh_health']['closed'] and d['mesh_health']['triangles'] == 256"
json stdout "d['repair'] is None and d['turned_triangles'] == 0"

# Holes.
expect 0 "$relief" bake holed.obj -o holed.relief "${small[@]}" -v
grep -q '^mesh: 7 boundary edges; 1 component, 0 closed$' stderr || die "the report says: $(cat stderr)"
grep -q '  first fault: a boundary edge at ' stderr || die "-v names no fault"
expect_error 3 'holed\.obj: not a closed solid: 7 boundary edges; the first is a boundary edge at .*/' \
    "$relief" bake holed.obj -o strict.relief "${small[@]}" --strict
[ ! -e strict.relief ] || die "--strict wrote a collider"

# Turned triangles do not change the maps.
expect 0 "$relief" bake turned.obj -o turned.relief "${small[@]}"
grep -q '^turned 86 triangles to look outwards$' stderr || die "the report says: $(cat stderr)"
"$relief" export ball.relief -o a -q
"$relief" export turned.relief -o b -q
diff -r a b || die "a mesh with turned triangles bakes to other maps"
expect_error 3 'turned\.obj: not a closed solid: [0-9]+ edges wound inconsistently' \
    "$relief" bake turned.obj -o strict.relief "${small[@]}" --strict

# A wrap is a solid, is recorded, has the same bytes each time, and is measured against the original mesh.
expect 0 "$relief" bake holed.obj -o wrap.relief "${small[@]}" --repair wrap=0.1 --strict --json
json stdout "d['repair']['method'] == 'wrap=0.1' and d['repair']['mesh_health']['solid']"
json stdout "d['mesh_health']['boundary_edges'] == 7"
json stdout "d['provenance']['options'].endswith(' --repair wrap=0.1') and d['provenance']['mesh_name'] == 'holed.obj'"
expect 0 "$relief" bake holed.obj -o again.relief "${small[@]}" --repair wrap=0.1 -j 1 -q
cmp wrap.relief again.relief || die "two wraps of the same mesh differ"
expect 0 "$relief" check wrap.relief --mesh ball.obj --samples 2000 --json

# Usage.
expect_error 1 'warp.*must be wrap' "$relief" bake ball.obj -o x.relief --repair warp
expect_error 1 'alpha' "$relief" bake ball.obj -o x.relief --repair wrap=2
expect_error 1 'alpha' "$relief" bake ball.obj -o x.relief --repair wrap=nan
expect_error 1 'holes.*must be wrap' "$relief" bake ball.obj -o x.relief --repair holes
