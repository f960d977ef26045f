#!/usr/bin/env bash
# Installs what is missing, builds everything and runs every test. Needs no GPU. scripts/test.sh [--quick]
#
#   (nothing)  the release build and all tests; the runtime as WebAssembly, and its tests in a real browser; then the
#              sanitizer build, and what a sanitizer can find: no slow tests, and none of numbers and pictures
#   --quick    for the work in between: the release build, and its tests but for the slow ones and those that only
#              repeat another in OpenGL ES, or by compute shaders
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=$(($(nproc) + 1)) # some tests wait more than they work

quick=0
case ${1-} in
    "") ;;
    --quick) quick=1 ;;
    *)
        echo "test.sh: unknown option '$1'; use --quick, or none" >&2
        exit 1
        ;;
esac

# stage NAME COMMAND…: runs it, and says how long it took.
stage() {
    local name=$1 begun=$SECONDS
    shift
    "$@"
    echo "test.sh: $name took $((SECONDS - begun)) s" >&2
}

stage setup scripts/setup.sh
stage format scripts/format.sh --check
stage 'release build' scripts/build.sh release
if [ $quick = 1 ]; then
    stage 'quick tests' ctest --preset quick -j "$jobs"
    exit
fi
stage 'release tests' ctest --preset release -j "$jobs"
stage 'web build' scripts/build.sh web
stage 'browser tests' node --test tests/web
stage 'sanitizer build' scripts/build.sh sanitize
stage 'sanitizer tests' ctest --preset sanitize -j "$jobs"
