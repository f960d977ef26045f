#!/usr/bin/env bash
# Builds one preset of CMakePresets.json: scripts/build.sh release|debug|sanitize|fuzz [TARGET]…
# Prints the folder of the executables.
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:-release}
shift || true
[ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" >&2
cmake --build --preset "$preset" ${1:+--target "$@"} >&2
echo "$PWD/build/$preset/bin"
