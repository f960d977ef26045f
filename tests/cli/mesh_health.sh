# SPDX-License-Identifier: Apache-2.0
# The report of `relief bake` on broken meshes, --strict and --repair, and lost parts, judged at their own size. Unit
# tests cover faults, repairs and the accuracy of parts.
. "$(dirname "$0")/lib.sh"

python3 - <<'P'
import math
M, N = 16, 9  # a ball of 2 x 16 x 8 triangles
v = [(0, 1, 0)] + [(math.sin(math.pi * i / N) * math.cos(2 * math.pi * j / M), math.cos(math.pi * i / N),
                    math.sin(math.pi * i / N) * math.sin(2 * math.pi * j / M)) for i in range(1, N) for j in range(M)] + [(0, -1, 0)]
at = lambda i, j: 1 + (i - 1) * M + j % M
f = []
for j in range(M):
    f.append((0, at(1, j + 1), at(1, j)))
    for i in range(1, N - 1):
        f += [(at(i, j), at(i, j + 1), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i + 1, j))]
    f.append((len(v) - 1, at(N - 1, j), at(N - 1, j + 1)))
for name, drop, turn in (('ball', (), ()), ('holed', (5, 6, 100), ()), ('turned', (), range(0, 256, 3))):
    with open(name + '.obj', 'w') as out:
        out.writelines('v %.9g %.9g %.9g\n' % p for p in v)
        out.writelines('f %d %d %d\n' % tuple(i + 1 for i in (t[::-1] if k in turn else t)) for k, t in enumerate(f) if k not in drop)

def save(name, boxes):
    lines, first = [], 0
    for low, high, part in boxes:
        lines.append(f'o {part}')
        lines += ['v %.9g %.9g %.9g' % (x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
        for face in (0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5):
            lines.append('f ' + ' '.join(str(first + i + 1) for i in face))
        first += 8
    open(name, 'w').write('\n'.join(lines) + '\n')

# A slab of 5 km with nine pillars of 2 x 9 x 2, whose area is negligible, and an outlier part.
save('slab.obj', [((-2500, -10, -2500), (2500, 0, 2500), 'slab')] +
     [((x, 0.5, z), (x + 2, 9.5, z + 2), f'pillar_{x}_{z}') for x in (-2000, 0, 2000) for z in (-2000, 0, 2000)])
for name, far in ('stray.obj', 1e3), ('lost.obj', 1e9):
    save(name, [((0, 0, 0), (10, 10, 10), 'body'), ((far, 0, 0), (far + 1, 1, 1), 'helper')])
P
small=(--paper --resolution 32)

# A closed mesh has one line, and --strict accepts it. A hole is counted, and --strict rejects it.
expect 0 "$relief" bake ball.obj -o ball.relief "${small[@]}" --strict
grep -q '^mesh: a closed solid; 1 component$' stderr || die "the report: $(cat stderr)"
expect 0 "$relief" bake holed.obj -o holed.relief "${small[@]}" -v
grep -q '^mesh: 7 boundary edges; 1 component, 0 closed$' stderr && grep -q '  first fault: ' stderr || die "the report: $(cat stderr)"
expect_error 3 'holed\.obj: .*7 boundary edges' "$relief" bake holed.obj -o strict.relief "${small[@]}" --strict
[ ! -e strict.relief ] || die "--strict wrote a collider"

# Reversed triangles do not change the maps.
expect 0 "$relief" bake turned.obj -o turned.relief "${small[@]}" --json
json stdout "d['flipped_triangles'] == 86 and d['repair'] is None"
"$relief" export ball.relief -o a -q
"$relief" export turned.relief -o b -q
diff -r a b || die "reversed triangles change the maps"

# A wrap is a solid, is recorded, and is deterministic.
expect 0 "$relief" bake holed.obj -o wrap.relief "${small[@]}" --repair wrap=0.1 --strict --json
json stdout "d['repair']['method'] == 'wrap=0.1' and d['repair']['mesh_health']['solid'] and d['mesh_health']['boundary_edges'] == 7"
json stdout "d['provenance']['options'].endswith(' --repair wrap=0.1') and d['provenance']['mesh_name'] == 'holed.obj'"
expect 0 "$relief" bake holed.obj -o again.relief "${small[@]}" --repair wrap=0.1 -j 1 -q
cmp wrap.relief again.relief || die "two wraps of one mesh differ"
for repair in warp wrap=2; do expect_error 1 'repair' "$relief" bake ball.obj -o x.relief --repair $repair; done

# Lost parts are named, and the suggested budget loses fewer. --max-error fails because of them, and --min-part selects
# which count.
expect 0 "$relief" bake slab.obj -o slab.relief --unit m --json
json stdout 'd["parts"]["lost"] == 9 and d["parts"]["worst"][0]["node"].startswith("pillar") and d["wrong_percent"] < 1'
grep -qE "slab\.obj: 9 of 10 parts are lost, the largest pillar_.*--budget [0-9.]+MB" stderr || die "the bake does not name the lost parts: $(cat stderr)"
budget=$(grep -oE -- '--budget [0-9.]+MB' stderr)
# shellcheck disable=SC2086
expect 0 "$relief" bake slab.obj -o more.relief --unit m --json $budget
json stdout 'd["parts"]["lost"] < 5'
expect 7 "$relief" check slab.relief --mesh slab.obj --unit m --samples 20000 --max-error 2 --json
json stdout 'd["verdict"]["grade"] == "poor" and d["verdict"]["lost_parts"] == 9 and d["verdict"]["wrong_percent"] < 1'
json stdout 'len(d["parts"]["groups"]) == 10 and all(p["size"] == 9 and p["state"] == "lost" for p in d["parts"]["worst"][:9])'
grep -q -- '--min-part' stderr || die "no advice: $(cat stderr)"
expect 0 "$relief" check slab.relief --mesh slab.obj --unit m --samples 20000 --max-error 2 --min-part 10 --json
json stdout 'd["verdict"]["grade"] == "good" and d["parts"]["minor"] == 9 and d["passed"]'
json stdout 'd["verdict"]["ignored_parts"]["lost"] == 9 and "; 9 of 10 parts, at most 9 m long, are not represented" in d["verdict"]["text"]'

# An outlier part is named, and so are the parts that no map sees because of it.
expect 0 "$relief" bake stray.obj -o stray.relief --budget 64kB
grep -q 'stray\.obj: helper ' stderr || die "the outlier is not named: $(cat stderr)"
expect_error 4 'lost\.obj: helper ' "$relief" bake lost.obj -o stray.relief --budget 64kB
# A thickness too large for a part gives a warning.
printf '%s\n' 'v 0 0 0' 'v 10 0 0' 'v 10 0 10' 'v 0 0 10' 'v 4 3 0' 'v 4.2 3 0' 'v 4.2 3 0.2' 'v 4 3 0.2' 'g floor' 'f 1 2 3 4' 'g leaf' 'f 5 6 7 8' >sheets.obj
expect 0 "$relief" bake sheets.obj -o thick.relief --thickness 0.1 --budget 1MB
grep -q 'sheets\.obj: .*leaf' stderr || die "the leaf is not named: $(cat stderr)"
