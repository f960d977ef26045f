# SPDX-License-Identifier: Apache-2.0
# The choice of Embree: files that call it compile with the API of Embree 4 (tests/bake/mesh/embree4), and other
# versions are rejected. scripts/nightly.sh embree4 builds everything with it and compares bytes.
. "$(dirname "$0")/lib.sh"

mapfile -t files < <(cd "$RELIEF_SOURCE" && grep -lE '\brtc[A-Z]|\bRTC|RayQuery' bake/*/*.cpp)
[ ${#files[@]} -ge 3 ] || die "only ${files[*]} call Embree"
compile() { # VERSION FILE
    (cd "$RELIEF_SOURCE" &&
        g++ -std=c++20 -fsyntax-only -Wall -Wextra -Werror "-DRELIEF_EMBREE=$1" -I. -isystem tests/bake/mesh/embree4/include "$2") 2>log
}
for file in "${files[@]}"; do
    compile 4 "$file" || die "$file does not compile with Embree 4: $(head -5 log)"
done
! compile 5 bake/mesh/embree_mesh.cpp || die "Embree 5 is accepted"
grep -q 'RELIEF_EMBREE must be 3 or 4' log || die "the wrong version is not named: $(head -5 log)"
# API that only Embree 3 has would be found.
echo '#include "bake/mesh/embree.h"
RTCIntersectContext context;' >old.cpp
! compile 4 "$work/old.cpp" || die "API of Embree 3 compiles as Embree 4"

configure() { # NUMBER OPTION…
    cmake -G Ninja -S "$RELIEF_SOURCE" -B "configured$1" -DRELIEF_EMBREE="$1" -DRELIEF_BUILD_TESTS=OFF \
        -DRELIEF_BUILD_BENCHMARKS=OFF "${@:2}" >log 2>&1
}
! configure 5 || die "RELIEF_EMBREE=5 is accepted"
grep -q "RELIEF_EMBREE is '5'; give 3 or 4" log || die "RELIEF_EMBREE=5: $(tail log)"
configure 4 "-Dembree_DIR=$RELIEF_SOURCE/tests/bake/mesh/embree4" || die "does not configure: $(tail log)"
grep -q 'RELIEF_EMBREE=4' configured4/build.ninja || die "the build does not use Embree 4"
