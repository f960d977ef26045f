#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds one preset of CMakePresets.json: scripts/build.sh release|tools|packages|debug|sanitize|fuzz|web [TARGET]…
# Prints the folder of the executables. web builds the runtime as WebAssembly (runtime/web/README.md), and installs the
# packages it needs.
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:-release}
shift || true
if [ "$preset" = web ]; then
    scripts/setup.sh web
    scripts/web_modules.sh >&2
fi
# tools builds a part of release in the same folder, which release then configures again.
folder=build/${preset/tools/release}
if [ ! -f "$folder/build.ninja" ] ||
    { [ "$preset" = release ] && grep -q '^RELIEF_BUILD_TESTS:.*=OFF' "$folder/CMakeCache.txt"; }; then
    scripts/quietly.sh cmake --preset "$preset" >&2
fi
[ -z "${RELIEF_QUIET-}" ] || echo "Compiling ${*:-$preset}" >&2
scripts/quietly.sh cmake --build --preset "$preset" ${1:+--target "$@"} >&2
echo "$PWD/$folder/bin"
