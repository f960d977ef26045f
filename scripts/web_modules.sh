#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the packages of tests/web/package-lock.json from the npm registry into build/web. Does nothing, and needs no
# network, if they are installed. Prints the folder that contains node_modules.
set -euo pipefail
cd "$(dirname "$0")/.."

folder=$PWD/build/web
mkdir -p "$folder"
if ! cmp -s tests/web/package-lock.json "$folder/node_modules/.installed"; then
    cp tests/web/package.json tests/web/package-lock.json "$folder/"
    npm ci --prefix "$folder" --no-audit --no-fund --ignore-scripts --loglevel=error >&2
    cp tests/web/package-lock.json "$folder/node_modules/.installed"
fi
echo "$folder"
