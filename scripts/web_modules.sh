#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the packages of tests/NAME/package-lock.json from the npm registry into build/NAME: scripts/web_modules.sh [NAME]
# NAME is web (default) or godot. Does nothing, and needs no network, if they are installed. Prints the folder that contains
# node_modules.
set -euo pipefail
cd "$(dirname "$0")/.."

name=${1-web}
folder=$PWD/build/$name
mkdir -p "$folder"
if ! cmp -s "tests/$name/package-lock.json" "$folder/node_modules/.installed"; then
    cp "tests/$name/package.json" "tests/$name/package-lock.json" "$folder/"
    npm ci --prefix "$folder" --no-audit --no-fund --ignore-scripts --legacy-peer-deps --loglevel=error >&2
    cp "tests/$name/package-lock.json" "$folder/node_modules/.installed"
fi
echo "$folder"
