# `query` and `query --gpu` on RELIEF_QUERY_POINTS points of the bunny's box (20,000; tests/long/soak.sh query: 100,000), for
# every format and compare: the simulation's own shader against the C++ that defines it.
#
# Tolerance: distance within 1e-5 of the box's longest side and normal within 1e-5 on all points but one in 10,000;
# those may lie on a texel's edge and have fallen to the neighbour (tests/runtime/collider/field_query_gl_test.cpp looks
# at such points one by one). On llvmpipe no point differs.
. "$(dirname "$0")/lib.sh"

export RELIEF_QUERY_POINTS=${RELIEF_QUERY_POINTS:-20000}
python3 - <<'P'
import os, random
random.seed(5)
lo, hi = [-1.2] * 3, [1.2] * 3
with open('/usr/share/glmark2/models/bunny.obj') as f:
    v = [[float(x) for x in line.split()[1:4]] for line in f if line.startswith('v ')]
lo = [min(p[i] for p in v) for i in range(3)]
hi = [max(p[i] for p in v) for i in range(3)]
with open('points.csv', 'w') as out:
    out.write('x,y,z\n')
    for _ in range(int(os.environ['RELIEF_QUERY_POINTS'])):
        out.write(','.join(repr(random.uniform(lo[i] - 0.1 * (hi[i] - lo[i]), hi[i] + 0.1 * (hi[i] - lo[i]))) for i in range(3)) + '\n')
open('side', 'w').write(repr(max(hi[i] - lo[i] for i in range(3))))
P

expect_error 1 'gpu evaluates planes' "$relief" query b.relief --points points.csv -o gpu.csv --gpu --distance nearest
i=0
while read -r specs; do
    i=$((i + 1))
    # shellcheck disable=SC2086
    "$relief" bake "$bunny" -o "$i.relief" -q $specs
    "$relief" query "$i.relief" --points points.csv -o cpu.csv --distance plane
    "$relief" query "$i.relief" --points points.csv -o gpu.csv --distance plane --gpu
    python3 - "$specs" <<'P' || die "CPU and GPU disagree: $specs"
import csv, os, sys
points = int(os.environ['RELIEF_QUERY_POINTS'])
side = float(open('side').read())
cpu, gpu = (list(csv.DictReader(open(name))) for name in ('cpu.csv', 'gpu.csv'))
assert len(cpu) == len(gpu) == points
bad = votes = inside = 0
for a, b in zip(cpu, gpu):
    same = a['map'] == b['map'] and (a['f'] == '') == (b['f'] == '')
    if same and a['f'] != '':
        votes += 1
        inside += float(a['f']) < 0
        same = a['f'] == b['f'] or abs(float(a['f']) - float(b['f'])) <= 1e-5 * side
        same = same and all(abs(float(a[k]) - float(b[k])) <= 1e-5 for k in ('nx', 'ny', 'nz'))
    bad += not same
print(f"{sys.argv[1] or 'planned':40s} votes {votes}  inside {inside}  differing {bad}")
sys.exit(0 if bad <= points / 10_000 and votes > points / 100 and inside > points / 100 else 1)
P
done <<'S'

--paper --resolution 256
--resolution 256 --decode projected --map float:dir=+x
--resolution 256 --map float:dir=-y,compare=greater,up=1/2/3
--resolution 256 --decode projected --map fixed8:dir=+z
--resolution 256 --map fixed8:dir=1/2/3,compare=greater
--resolution 256 --decode projected --depth half --map front-back:dir=-z
--resolution 256 --map front-back:dir=-z
--resolution 256 --decode projected --map cube:compare=greater
--resolution 256 --map cube:center=0/10/0,compare=less
--map float:dir=+x,size=256 --map fixed8:dir=-y,size=256 --map front-back:dir=1/1/1,size=200x100 --map cube:size=64 --map cube:size=96,decode=projected
S
