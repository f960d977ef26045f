# SPDX-License-Identifier: Apache-2.0
# Build options: without the baker only the runtime library is built. Errors about missing parts suggest a fix.
. "$(dirname "$0")/lib.sh"

configure() { cmake -G Ninja -S "$RELIEF_SOURCE" -B "$1" "${@:2}" >log 2>&1; }
prints() { tr -s ' \n' ' ' <log | matches -F "$1" || die "'$1' is not printed: $(cat log)"; }

configure runtime -DRELIEF_BUILD_BAKE=OFF || die "the runtime does not configure: $(tail log)"
! grep -oE '^build bin/[^ :]+' runtime/build.ninja || die "the runtime's build makes programs"
! cmake --install runtime --prefix prefix >log 2>&1 || die "parts that are not built are installed"
prints "is not built; build all with: cmake --build $work/runtime"
[ ! -e prefix ] || die "an incomplete installation is left: $(find prefix)"

for part in BAKE BENCHMARKS; do
    ! configure runtime -DRELIEF_BUILD_$part=ON -DRELIEF_BUILD_PLAYER=OFF || die "$part does not require the player"
    prints "RELIEF_BUILD_$part needs RELIEF_BUILD_PLAYER: configure with -DRELIEF_BUILD_PLAYER=ON"
    configure runtime -DRELIEF_BUILD_$part=OFF || die "the runtime does not configure again: $(tail log)"
done

# Layers: a missing dependency of a layer is an error, and the core without layers is not installed.
! configure layers -DRELIEF_BUILD_BAKE=OFF -DRELIEF_LAYER_BODIES=OFF -DRELIEF_LAYER_C_API=OFF || die "pictures do not require bodies"
prints 'RELIEF_LAYER_PICTURE needs RELIEF_LAYER_BODIES: configure with -DRELIEF_LAYER_BODIES=ON'
configure layers -DRELIEF_BUILD_BAKE=OFF -DRELIEF_LAYER_{AIR,EVENTS,BODIES,BIRTHS,LIVE,STREAM,PICTURE,C_API}=OFF \
    || die "the core does not configure: $(tail log)"
! cmake --install layers --prefix prefix >log 2>&1 || die "an incomplete runtime is installed"
prints 'a runtime without all layers is not installed'

# Optional parts name their package and option. CMake finds only the headers in /usr/include that are given.
configure vdb -DRELIEF_BUILD_BAKE=OFF -DRELIEF_BUILD_PLAYER=ON -DRELIEF_BUILD_OPENVDB=ON -DCMAKE_IGNORE_PATH=/usr/include \
    -DTOMLPLUSPLUS_INCLUDE_DIR=/usr/include -DPNG_PNG_INCLUDE_DIR=/usr/include -DZLIB_INCLUDE_DIR=/usr/include && die "OpenVDB is not required"
prints 'OpenVDB is not found: install libopenvdb-dev, or configure with -DRELIEF_BUILD_OPENVDB=OFF'
configure tests -DRELIEF_BUILD_BAKE=OFF -DRELIEF_BUILD_PLAYER=ON -DRELIEF_BUILD_TESTS=ON -DRELIEF_BUILD_OPENVDB=OFF \
    -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON && die "GoogleTest is not required"
prints 'GoogleTest is not found: install libgtest-dev, or configure with -DRELIEF_BUILD_TESTS=OFF'
