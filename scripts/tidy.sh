#!/usr/bin/env bash
# Checks C++ files by clang-tidy and .clang-tidy: scripts/tidy.sh [COMMIT | --all]
# By default those that differ from main, committed or not; --all takes an hour or so.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh clang-tidy
[ -f build/release/compile_commands.json ] || cmake --preset release >&2
base=${1:-main}
if [ "$base" = --all ]; then
    mapfile -t files < <(git ls-files 'bake/*.cpp' 'formats/*.cpp' 'runtime/*.cpp' ':!runtime/web')
else
    mapfile -t files < <(git diff --name-only --diff-filter=d "$(git merge-base "$base" HEAD)" -- 'bake/*.cpp' 'formats/*.cpp' \
        'runtime/*.cpp' ':!runtime/web')
fi
echo "tidy.sh: ${#files[@]} files" >&2
# The build is GCC's, some of whose warnings clang does not know.
printf '%s\0' "${files[@]}" |
    xargs -0 -r -n 4 -P "$(nproc)" clang-tidy -p build/release --quiet --extra-arg=-Wno-unknown-warning-option
