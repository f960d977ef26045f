#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the default tier in a separate build. Writes the coverage to out/coverage/index.html, and prints a summary.
# scripts/coverage.sh [CTEST OPTION]…, such as -R Voxels
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh gcovr
build=build/coverage
# Atomic counters: without them, threads can make counters negative, which gcovr rejects.
cmake -G Ninja -S . -B $build -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG='-Og -g1 --coverage -fprofile-update=atomic' \
    -DRELIEF_BUILD_BENCHMARKS=OFF -DRELIEF_BUILD_PYTHON=OFF >&2
cmake --build $build >&2
find $build -name '*.gcda' -delete
ctest --test-dir $build -j "$(nproc)" -LE nightly "$@" >&2
mkdir -p out/coverage
gcovr --root . --filter '(bake|formats|runtime)/' --exclude-throw-branches -j "$(nproc)" \
    --html-details out/coverage/index.html --print-summary $build
