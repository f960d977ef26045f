# Small parts of large meshes: what a bake warns of and a check judges by each part's own size; strays; shells.
. "$(dirname "$0")/lib.sh"

# A slab of 5 km with nine pillars of 2 x 9 x 2: by area the pillars are nothing.
python3 - <<'P'
def box(low, high, first, name, lines):
    lines.append(f'o {name}')
    lines += ['v %.9g %.9g %.9g' % (x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    for face in (0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5):
        lines.append('f ' + ' '.join(str(first + i + 1) for i in face))
    return first + 8

def save(name, boxes):
    lines, first = [], 0
    for low, high, part in boxes:
        first = box(low, high, first, part, lines)
    open(name, 'w').write('\n'.join(lines) + '\n')

slab = ((-2500, -10, -2500), (2500, 0, 2500), 'slab')
pillars = [((x, 0.5, z), (x + 2, 9.5, z + 2), f'pillar_{x}_{z}') for x in (-2000, 0, 2000) for z in (-2000, 0, 2000)]
save('slab.obj', [slab] + pillars)
save('unit.obj', [((0, 0, 0), (1, 1, 1), 'a'), ((2, 0, 0), (3, 1, 1), 'b')])
for name, far in ('stray.obj', 1e3), ('lost.obj', 1e9):
    save(name, [((0, 0, 0), (10, 10, 10), 'body'), ((far, 0, 0), (far + 1, 1, 1), 'helper')])
# A sheet of 10 and, on its own, one of 0.2.
def sheet(x, y, side, first):
    corners = [(x, y, 0), (x + side, y, 0), (x + side, y, side), (x, y, side)]
    return ['v %g %g %g' % c for c in corners] + ['f ' + ' '.join(str(first + i) for i in (1, 2, 3, 4))]
open('sheets.obj', 'w').write('\n'.join(['g floor'] + sheet(0, 0, 10, 0) + ['g leaf'] + sheet(4, 3, 0.2, 4)) + '\n')
P
# What is lost has its name, and the advised bytes lose less.
expect 0 "$relief" bake slab.obj -o more.relief --unit m --json
grep -qE "slab\.obj: 9 of 10 parts are lost, the largest pillar_[-0-9_]+, 9 m long at .*; its patches' heights are [0-9.]+ m apart; try --budget [0-9.]+MB, or a bake of its node by itself" stderr ||
    die "the bake does not name what it loses: $(cat stderr)"
json stdout 'd["parts"]["lost"] == 9'
budget=$(grep -oE -- '--budget [0-9.]+MB' stderr)
# shellcheck disable=SC2086
expect 0 "$relief" bake slab.obj -o more.relief --unit m --json $budget
json stdout 'd["parts"]["lost"] < 5'

expect 0 "$relief" bake slab.obj -o slab.relief --unit m --layout views --json
cp stdout slab.json
grep -qE 'slab\.obj: 9 of 10 parts are lost, the largest pillar_[-0-9_]+, 9 m long at .* take --budget [0-9.]+MB, or a bake of its node by itself' stderr ||
    die "the bake does not name what it loses: $(cat stderr)"
json slab.json 'd["parts"]["lost"] == 9 and d["parts"]["worst"][0]["node"].startswith("pillar") and d["wrong_percent"] < 1'
expect 0 "$relief" check slab.relief --mesh slab.obj --unit m --samples 20000
head -1 stdout | matches -xE 'slab\.relief: 0(\.[0-9]+)? % wrong near the surface, but 9 of 10 parts are lost: poor' || die "the verdict: $(head -1 stdout)"
grep -q '^The worst parts, each by its own size:$' stdout && grep -q '^The worst nodes:$' stdout || die "no parts: $(cat stdout)"
printf '<script type="application/json" id="relief-page-data">null</script>\n' >stub.html
RELIEF_VIEW_PAGE=stub.html expect 0 "$relief" check slab.relief --mesh slab.obj --unit m --samples 20000 --json --html slab.html
cp stdout check.json
json check.json 'd["verdict"]["grade"] == "poor" and d["verdict"]["lost_parts"] == 9 and d["verdict"]["wrong_percent"] < 1'
json check.json 'len(d["parts"]["groups"]) == 10 and d["parts"]["groups"][-1]["name"] == "slab"'
json check.json 'all(p["size"] == 9 and p["state"] == "lost" and p["texel"] > 2 for p in d["parts"]["worst"][:9])'
grep -q 'The worst parts, each by its own size' slab.html || die "the page does not show the parts"

# --max-error is about lost parts too, and --detail says which count.
expect 7 "$relief" check slab.relief --mesh slab.obj --unit m --samples 20000 --max-error 2
grep -q -- '--detail LENGTH' stderr || die "no cure: $(cat stderr)"
expect 0 "$relief" check slab.relief --mesh slab.obj --unit m --samples 20000 --max-error 2 --detail 10 --json
json stdout 'd["verdict"]["grade"] == "good" and d["parts"]["small"] == 9 and d["parts"]["detail"] == 10 and d["passed"]'
expect_error 1 'detail' "$relief" check slab.relief --mesh slab.obj --detail -1
expect_error 1 'mesh' "$relief" check slab.relief --detail 1

# Where every part is held nothing is said; the advice keeps what it promises: one pillar by itself is good.
expect 0 "$relief" bake unit.obj -o unit.relief --budget 100kB
! grep -q lost stderr || die "parts are held, but: $(cat stderr)"
expect 0 "$relief" check unit.relief --mesh unit.obj --samples 20000
head -1 stdout | matches 'good$' || die "two boxes: $(head -1 stdout)"
! grep -q 'The worst part' stdout || die "all parts are held, but: $(cat stdout)"

# A stray is named, and shells have the size of their parts whatever the box.
expect 0 "$relief" bake stray.obj -o stray.relief --budget 64kB
grep -qE 'stray\.obj: helper \(12 triangles\) lies astray at .*; delete it from the mesh' stderr || die "no word of the stray: $(cat stderr)"
expect_error 4 'lost\.obj: helper \([0-9]+ triangles\) lies astray' "$relief" bake lost.obj -o stray.relief --budget 64kB
expect 0 "$relief" bake sheets.obj -o sheets.relief --budget 64kB --json
json stdout 'abs(d["shape"]["thickness_least"] - 0.05) < 1e-6 and 0.1 < d["shape"]["thickness"] <= 0.4 and not d["shape"]["thickness_asked"]'
expect 0 "$relief" check sheets.relief --mesh sheets.obj --samples 20000
head -1 stdout | matches 'poor$' || die "a leaf a quarter as thick as it is long: $(head -1 stdout)"
# What was asked for is right, and is said where it swallows a part.
expect 0 "$relief" bake sheets.obj -o thick.relief --thickness 0.1 --budget 1MB
grep -qE 'sheets\.obj: shells of --thickness 0\.1 swallow 1 sheet: leaf, 0\.2 long' stderr || die "no word of the leaf: $(cat stderr)"
expect 0 "$relief" check thick.relief --mesh sheets.obj --samples 20000 --json
json stdout 'd["parts"]["lost"] == 0 and d["mesh"]["shape"]["thickness_asked"]'
# The least thickness goes by the smallest sheet, not by the box.
expect 0 "$relief" bake sheets.obj -o thin.relief --thickness 0.0005 --no-check
expect_error 1 'no thinner than' "$relief" bake sheets.obj -o thin.relief --thickness 1e-6
