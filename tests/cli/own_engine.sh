# SPDX-License-Identifier: Apache-2.0
# samples/own_engine: a loader in C without Relief's library, compiled as its page shows. Its results equal those of
# `relief query` for every format, and its particles come to rest on the surface. The example of LAYOUT.md matches the
# tool's output.
. "$(dirname "$0")/lib.sh"

sample=$RELIEF_SOURCE/samples/own_engine
cp "$sample"/*.c .
[ "$(wc -l <minimal.c)" -le 80 ] || die "minimal.c has more than 80 lines"
sed -n 's/^ *\(cc -std.*\)/\1/p' "$sample/README.md" | while read -r command; do
    sh -c "$command -Wall -Wextra -Wpedantic -Werror" || die "it does not compile as its page shows: $command"
done

random_points points.csv

while read -r specs; do
    rm -rf body.relief gpu
    # shellcheck disable=SC2086
    "$relief" bake "$bunny" -o body.relief -q $specs
    "$relief" export body.relief --gpu gpu -q
    ./own_engine gpu points.csv >own.csv
    ./own_engine gpu points.csv --fall >fallen.csv
    "$relief" query body.relief --points points.csv -o reference.csv --distance plane
    "$relief" query body.relief --points fallen.csv -o fallen_reference.csv --distance plane
    for row in 1000 5000; do
        # shellcheck disable=SC2046
        ./minimal gpu $(sed -n "${row}p" points.csv | tr ',' ' ') | cmp - <(sed -n "${row}p" own.csv | cut -d, -f4-7) ||
            die "minimal and own_engine disagree at point $row: $specs"
    done
    python3 - "$specs" <<'P' || die "own_engine and relief query disagree: $specs"
import csv, sys
own = [[float(x) for x in row] for row in csv.reader(open('own.csv'))]
reference = list(csv.DictReader(open('reference.csv')))
assert len(own) == len(reference) == 10_000
near = bad = 0
for a, b in zip(own, reference):
    expected = -1 if b['map'] == '' else int(b['map'])
    same = a[7] == expected
    if same and b['f'] not in ('', 'inf'):
        near += 1
        same = abs(a[3] - float(b['f'])) <= 1e-5 and all(
            abs(a[4 + i] - float(b[key])) <= 1e-5 for i, key in enumerate(('nx', 'ny', 'nz')))
    bad += not same
depths = [float(b['f']) for b in csv.DictReader(open('fallen_reference.csv')) if b['f'] not in ('', 'inf')]
deep = sum(depth < -0.02 for depth in depths)
lying = sum(abs(depth) < 0.02 for depth in depths)
print(f"{sys.argv[1]:40s} near {near}  differing {bad}  lying on it {lying}  fallen in {deep}")
sys.exit(0 if near > 3000 and bad <= 1 and lying > 100 and deep <= 20 else 1)
P
done <<'S'
--budget 200kB
--paper --resolution 128
--resolution 128 --decode projected --map float:dir=+x
--map float:dir=+x,size=128 --map fixed8:dir=-y,size=128 --map front-back:dir=1/1/1,size=100x50 --map cube:size=48
S

cat >box.obj <<'O'
v 0 0 0
v 2 0 0
v 2 1 0
v 0 1 0
v 0 0 1
v 2 0 1
v 2 1 1
v 0 1 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
O
"$relief" bake box.obj -q -o box.relief --map front-back:dir=-z,size=6x4
"$relief" export box.relief --gpu box -q
python3 - "$RELIEF_SOURCE/runtime/layout/LAYOUT.md" <<'P' || die "the example of LAYOUT.md differs"
import itertools, json, struct, sys
block = open('box/block.bin', 'rb').read()
said = json.load(open('box/gpu.json'))
number = lambda x: format(x, '.7g')
heads = struct.unpack('<4i', block[:16])
lines = [f'block: {len(block)} bytes', 'maps {}, widths {} {} {}'.format(*heads)]
names = ['row[0]', 'row[1]', 'row[2]', 'column[0]', 'column[1]', 'column[2]', 'object_per_map']
for i, name in enumerate(names):
    values = struct.unpack('<4f', block[16 + 16 * i:32 + 16 * i])
    lines.append(name + ' ' + ' '.join(number(x + 0.0) for x in values))
lines.append('place {} {} {} {}'.format(*struct.unpack('<4i', block[128:144])))
lines.append('info {} {} {} {}'.format(*struct.unpack('<4i', block[144:160])))
texture = said['textures'][2]
lines.append('{sampler}: {width} x {height} texels'.format(**texture))
texels = open('box/' + texture['file'], 'rb').read()
assert len(texels) == texture['bytes'] and said['block']['bytes'] == len(block)
at = 0
for texel, run in itertools.groupby(struct.iter_unpack('<4H', texels)):
    first, at = at, at + len(list(run))
    lines.append(f'{first}-{at - 1}: ' + ' '.join(map(str, texel)))
assert at == texture['width'] * texture['height']
page = open(sys.argv[1]).read()
example = page.split('<!-- layout:example -->\n```\n')[1].split('```')[0].splitlines()
for is_, should in zip(lines, example):
    if is_ != should:
        print(f'{is_!r} where the page has {should!r}')
sys.exit(lines != example)
P

# Rejected inputs.
"$relief" export box.relief 2>message && die 'export wrote and printed nothing'
grep -q 'add -o DIR, --gpu DIR' message || die "$(cat message)"
