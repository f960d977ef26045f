# SPDX-License-Identifier: Apache-2.0
# relief.h compiles without warnings as C and C++, for Linux, Windows and WebAssembly. Everywhere it gives the same bits,
# which are those of `relief query`.
. "$(dirname "$0")/lib.sh"

header=$RELIEF_SOURCE/formats/single
cp "$RELIEF_SOURCE/tests/cli/single.c" "$RELIEF_SOURCE/samples/own_engine/bounce.c" .
[ "$(wc -l <"$header/relief.h")" -le 1500 ] || die "relief.h has more than 1,500 lines"
warnings=(-Wall -Wextra -pedantic -Werror -I"$header")
"$relief" bake "$bunny" -q -o bunny.relief --budget 300kB
"$relief" bake "${bunny%/*}/horse.3ds" -q -o horse.relief --budget 50kB
"$relief" bake "${bunny%/*}/cat.3ds" -q -o cat.relief --budget 50kB

# needs PROGRAM PACKAGE: fails if a program is missing.
needs() { command -v "$1" >/dev/null || die "$1 is missing; install $2 (scripts/setup.sh)"; }

needs node nodejs
node --input-type=module -e "import { writeTrees } from '$RELIEF_SOURCE/tests/web/lib/trees.mjs'; writeTrees('.')"
colliders=(bunny horse cat tree{1..7})
files=("${colliders[@]/%/.relief}")

# compiled NAME COMMAND…: compiles a program, which must print what the first one printed.
compiled() {
    local name=$1
    shift
    "$@" "${warnings[@]}" -o "$name" single.c -lm || die "relief.h does not compile: $*"
    "./$name" "${files[@]}" >"$name.out" || die "$name fails: $(cat "$name.out")"
    cmp "$name.out" c99.out || die "results differ: $*"
}

compiled c99 gcc -std=c99 -O2
needs clang clang
compiled c99_plain gcc -std=c99 -O0
compiled c11 gcc -std=c11 -O3 -Wconversion -Wsign-conversion -Wshadow -Wstrict-prototypes
compiled clang_c99 clang -std=c99 -O2
compiled clang_c11 clang -std=c11 -O3
compiled cpp g++ -x c++ -std=c++11 -O2 -fno-exceptions -fno-rtti
compiled clang_cpp clang++ -x c++ -std=c++11 -O2 -fno-exceptions -fno-rtti
compiled sanitized clang -std=c99 -O1 -fsanitize=address,undefined -fno-sanitize-recover=undefined
# Processors that can fuse a*b + c.
if grep -qw fma /proc/cpuinfo; then
    compiled fma_gcc gcc -std=c99 -O2 -mfma
    compiled fma_clang clang -std=gnu11 -O2 -mfma
else
    echo "not tested: fused operations, which this processor lacks"
fi
echo "linux: $(wc -l <c99.out) lines, the same from every compiler"

# The library gives the same numbers.
python3 - "${colliders[@]}" <<'P'
import struct, sys
single = lambda word: struct.unpack('>f', bytes.fromhex(word))[0]
lines = open('c99.out').read().splitlines()
assert len(lines) == 20_001 * len(sys.argv[1:])
for i, name in enumerate(sys.argv[1:]):
    with open(name + '.csv', 'w') as out:
        for line in lines[20_001 * i + 1:20_001 * (i + 1)]:
            out.write(','.join('%.9g' % single(word) for word in line.split()[:3]) + '\n')
P
for name in "${colliders[@]}"; do
    "$relief" query "$name.relief" --points "$name.csv" -o "$name.reference.csv" --distance plane
done
python3 - "${colliders[@]}" <<'P' || die "relief.h and relief query disagree"
import csv, struct, sys
single = lambda word: struct.unpack('>f', bytes.fromhex(word))[0]
rounded = lambda text: struct.unpack('f', struct.pack('f', float(text)))[0]
lines = open('c99.out').read().splitlines()
for i, name in enumerate(sys.argv[1:]):
    reference = list(csv.DictReader(open(name + '.reference.csv')))
    assert len(reference) == 20_000
    near = inside = hit = 0
    for line, b in zip(lines[20_001 * i + 1:], reference):
        words = line.split()
        values = [single(word) for word in words]
        if b['f'] in ('', 'inf'):
            assert values[3] == rounded('1e30') and values[4:7] == [0, 0, 0], (name, line, b)
        else:
            assert values[3:7] == [rounded(b[key]) for key in ('f', 'nx', 'ny', 'nz')], (name, line, b)
            near += 1
        inside += values[3] < 0
        hit += words[:3] != words[7:10]
    print(f'{name}: {near} near, {inside} inside, {hit} hit')
    assert near > 5000 and inside > 500 and hit > inside
P

# Balls come to rest on the surface.
gcc -std=c99 -O2 "${warnings[@]}" bounce.c -o bounce -lm
./bounce bunny.relief >rest.csv || die "bounce fails"
"$relief" query bunny.relief --points rest.csv -o rest_reference.csv --distance plane
python3 - <<'P' || die "balls do not rest on the surface"
import csv
depths = [float(row['f']) for row in csv.DictReader(open('rest_reference.csv'))]
print(f'bounce: {len(depths)} balls rest, at {min(depths):.4f} to {max(depths):.4f}')
assert len(depths) > 50 and min(depths) > 0 and max(depths) < 0.04
P

# Without stdio, and beside the other header.
echo '#define RELIEF_NO_STDIO
#define RELIEF_IMPLEMENTATION
#include "relief.h"' >no_stdio.c
gcc -std=c99 "${warnings[@]}" -c no_stdio.c || die "it does not compile without stdio"
! nm no_stdio.o | matches -E 'U (fopen|fread)' || die "RELIEF_NO_STDIO uses stdio"
for order in 'relief.h relief_runtime.h' 'relief_runtime.h relief.h'; do
    # shellcheck disable=SC2086
    printf '#include "%s"\n' $order >both.c
    ! gcc -c "${warnings[@]}" -I"$RELIEF_SOURCE/runtime/c_api" both.c 2>message || die "both headers compile together"
    grep -q 'include them in different source files' message || die "$(head -3 message)"
done

# Windows.
needs x86_64-w64-mingw32-gcc gcc-mingw-w64-x86-64
wine=$(command -v wine64 || command -v wine || echo /usr/lib/wine/wine64)
needs "$wine" wine64
x86_64-w64-mingw32-gcc -std=c99 -O2 "${warnings[@]}" single.c -o single.exe || die "it does not compile for Windows"
export WINEPREFIX=$work/wine WINEDEBUG=-all DISPLAY=
"$wine" single.exe "${files[@]}" >windows.out 2>log || die "single.exe fails: $(tail -5 log windows.out)"
tr -d '\r' <windows.out | cmp - c99.out || die "results differ on Windows"
server=$(command -v wineserver || echo /usr/lib/wine/wineserver64)
"$server" -k || true # it would outlive its folder
"$server" -w
echo "windows: the same"

# WebAssembly.
needs emcc "emscripten (scripts/setup.sh web)"
NODE_PATH=/usr/share/nodejs emcc -std=c99 -O2 "${warnings[@]}" single.c -o single.js -sNODERAWFS=1 \
    -sALLOW_MEMORY_GROWTH=1 -sSINGLE_FILE=1 2>log || die "it does not compile to WebAssembly: $(tail -5 log)"
node single.js "${files[@]}" >web.out 2>log || die "single.js fails: $(tail -c 500 log web.out)"
cmp web.out c99.out || die "results differ in WebAssembly"
echo "wasm: the same"
