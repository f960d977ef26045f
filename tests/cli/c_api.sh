# SPDX-License-Identifier: Apache-2.0
# The installed relief_runtime.h, librelief.so and librelief_c.a: a C99 program links with either and gives the results
# of `relief query`. The shared library exports exactly the functions of the header.
. "$(dirname "$0")/lib.sh"

for component in development library; do
    cmake --install "$RELIEF_BIN/.." --prefix "$work/installed" --component $component >log || die "cannot install: $(tail log)"
done
PKG_CONFIG_PATH=$(find "$work/installed" -name pkgconfig)
export PKG_CONFIG_PATH
read -ra flags < <(pkg-config --cflags --libs relief)
cc -std=c99 -Wall -Wextra -Wpedantic -Werror "$RELIEF_SOURCE/tests/cli/c_api.c" -o c_api "${flags[@]}" 2>log ||
    die "does not compile: $(head -20 log)"
library=$(find "$work/installed" -name 'librelief.so')
echo '#include <relief_runtime.h>
int main() { return relief_api_version() >= RELIEF_API_VERSION ? 0 : 1; }' >in_cpp.cpp
g++ -std=c++11 -Wall -Wextra -Werror in_cpp.cpp -o in_cpp "${flags[@]}" || die "does not compile as C++"

random_points points.csv
"$relief" bake "$bunny" -q -o bunny.relief --budget 200kB
export LD_LIBRARY_PATH
LD_LIBRARY_PATH=$(dirname "$library")
./in_cpp || die "the library version does not match the header"
./c_api points.csv bunny.relief >own.csv || die "c_api failed"
"$relief" query bunny.relief --points points.csv -o reference.csv --distance plane
python3 - <<'P' || die "c_api and relief query disagree"
import csv, struct, sys
single = lambda text: struct.unpack('f', struct.pack('f', float(text)))[0]
own = list(csv.reader(open('own.csv')))
reference = list(csv.DictReader(open('reference.csv')))
assert len(own) == len(reference) == 10_000
for a, b in zip(own, reference):
    assert int(a[7]) == (-1 if b['map'] == '' else int(b['map'])), (a, b)
    if b['f'] not in ('', 'inf'):
        assert [single(x) for x in a[3:7]] == [single(b[k]) for k in ('f', 'nx', 'ny', 'nz')], (a, b)
P

# The static library by pkg-config and by CMake gives the same results, without the shared library.
unset LD_LIBRARY_PATH
cat >CMakeLists.txt <<'C'
cmake_minimum_required(VERSION 3.25)
project(c LANGUAGES C CXX)
find_package(Relief REQUIRED)
foreach(name c c_static)
    add_executable(by_${name} ${SOURCE})
    target_compile_features(by_${name} PRIVATE c_std_99)
    target_link_libraries(by_${name} PRIVATE Relief::${name})
endforeach()
C
cmake -G Ninja -S . -B by_cmake -DCMAKE_PREFIX_PATH="$work/installed" -DSOURCE="$RELIEF_SOURCE/tests/cli/c_api.c" >log 2>&1 &&
    cmake --build by_cmake >>log 2>&1 || die "cannot build C with CMake: $(tail -20 log)"
read -ra flags < <(pkg-config --cflags --libs relief-static)
cc -std=c99 "$RELIEF_SOURCE/tests/cli/c_api.c" -o c_api_static "${flags[@]}" 2>log || die "does not link: $(head -20 log)"
for program in ./c_api_static by_cmake/by_c_static by_cmake/by_c; do
    "$program" points.csv bunny.relief >again.csv || die "$program failed"
    cmp own.csv again.csv || die "$program gives different results"
    case $(ldd "$program" | grep -c 'librelief') in
        0) [ "$program" != by_cmake/by_c ] || die "Relief::c is not the shared library" ;;
        *) [ "$program" = by_cmake/by_c ] || die "$program needs the shared library" ;;
    esac
done

# The ABI: every function of the header, and no other symbol.
grep -oE '\brelief_[a-z_]+\(' "$RELIEF_SOURCE/runtime/c_api/relief_runtime.h" | tr -d '(' | sort -u >declared
nm -D --defined-only "$library" | awk '$2 != "A" { print $3 }' | sed 's/@.*//' | sort -u >exported
diff declared exported >log || die "the header and the library differ: $(cat log)"
[ "$(wc -l <exported)" -ge 37 ] || die "only $(wc -l <exported) functions"
readelf -d "$library" | grep -q 'SONAME.*librelief.so.1' || die "the library has a different SONAME"
