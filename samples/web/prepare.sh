#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Writes the sample as a static folder: samples/web/prepare.sh [FOLDER] (default: out/samples/web)
# Serve it with `python3 -m http.server -d out/samples/web`. RELIEF_BIN is the folder of `relief`.
set -euo pipefail
cd "$(dirname "$0")/../.."

folder=${1:-out/samples/web}
bin=${RELIEF_BIN:-build/release/bin}
modules=${RELIEF_WEB_BUILD:-build/web}/node_modules
body=/usr/share/glmark2/models/bunny.obj
mkdir -p "$folder/modules/three/examples/jsm/"{controls,loaders} "$folder/modules/three/build" "$folder/modules/fzstd/esm" \
    "$folder/modules/relief-particles"
cp samples/web/index.html samples/web/main.js "$folder"
cp "$body" "$folder/body.obj"
cp "$modules"/three/build/three.module.js "$modules"/three/build/three.core.js "$folder/modules/three/build"
cp "$modules/three/examples/jsm/controls/OrbitControls.js" "$folder/modules/three/examples/jsm/controls"
cp "$modules/three/examples/jsm/loaders/OBJLoader.js" "$folder/modules/three/examples/jsm/loaders"
cp "$modules/fzstd/esm/index.mjs" "$folder/modules/fzstd/esm"
cp out/npm/* "$folder/modules/relief-particles"
"$bin/relief" bake "$body" -q -o "$folder/body.relief" --budget 200kB
echo "$folder"
