# SPDX-License-Identifier: Apache-2.0
# samples/own_engine: bounce.c compiles as its page shows. Balls that fall on a box rest on its top.
. "$(dirname "$0")/lib.sh"

sample=$RELIEF_SOURCE/samples/own_engine
cp "$sample/bounce.c" "$RELIEF_SOURCE/formats/single/relief.h" .
[ "$(wc -l <bounce.c)" -le 60 ] || die "bounce.c has more than 60 lines"
command=$(sed -n 's/^    \(cc .*\)/\1/p' "$sample/README.md")
sh -c "$command" || die "it does not compile as its page shows: $command"
sh -c "$command -std=c99 -Wall -Wextra -pedantic -Werror" || die "it compiles with warnings"

box box.obj 1 0.5 2
"$relief" bake box.obj -q -o box.relief --budget 20kB
./bounce box.relief >rest.csv 2>message || die "$(cat message)"
grep -qx '400 of 400 balls rest on it' message || die "$(cat message)"
python3 - <<'P' || die "balls do not rest on the top"
rows = [[float(x) for x in line.split(',')] for line in open('rest.csv')]
worst = max(abs(y - 0.51) for _, y, _ in rows)  # half the height, and the radius
print(f'{len(rows)} balls, at most {worst:.2g} from their place')
assert len(rows) == 400 and worst < 1e-3
assert all(abs(x) < 1 and abs(z) < 2 for x, _, z in rows)
P

# One line for each error.
printf 'v 0 0 0\n' >mesh.relief
head -c 1000 box.relief >short.relief
"$relief" bake box.obj -q -o named.relief --map fixed8:dir=+y,size=16
"$relief" bake box.obj -q -o compressed.relief --budget 20kB --compress 9
while read -r file words; do
    ! ./bounce "$file" >out 2>message || die "bounce accepts $file"
    [ "$(wc -l <message)" -eq 1 ] && grep -q "^bounce: $file: .*$words" message || die "$file: $(cat message)"
    [ ! -s out ] || die "bounce prints results for $file"
done <<'S'
missing.relief cannot be read
mesh.relief relief bake MESH
short.relief truncated
named.relief without --map
compressed.relief without --compress
S
