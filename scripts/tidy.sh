#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs clang-tidy on C++ files: scripts/tidy.sh [COMMIT | --all]
# Checks the files that differ from COMMIT (default: main), committed or not. --all takes about an hour.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh clang clang-tidy
build=build/tidy
[ -f $build/build.ninja ] || cmake -G Ninja -S . -B $build -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_COMPILER=clang++ \
    -DRELIEF_PRECOMPILE=OFF -DRELIEF_UNITY=OFF >&2
ninja -C $build formats/collider_generated.h formats/animated_mesh_generated.h >&2
base=${1:-main}
if [ "$base" = --all ]; then
    list=(git ls-files)
else
    list=(git diff --name-only --diff-filter=d "$(git merge-base "$base" HEAD)")
fi
mapfile -t files < <("${list[@]}" -- 'bake/*.cpp' 'formats/*.cpp' 'runtime/*.cpp' ':!runtime/web' ':!bake/python')
echo "tidy.sh: ${#files[@]} files" >&2
printf '%s\0' "${files[@]}" | xargs -0 -r -n 4 -P "$(nproc)" clang-tidy -p $build --quiet
