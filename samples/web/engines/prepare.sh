#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Writes the pages as a static folder: samples/web/engines/prepare.sh [FOLDER] (default: out/samples/engines)
# Serve it with `python3 -m http.server -d out/samples/engines`. RELIEF_BIN is the folder of `relief`.
set -euo pipefail
cd "$(dirname "$0")/../../.."

folder=${1:-out/samples/engines}
bin=${RELIEF_BIN:-build/release/bin}
modules=${RELIEF_WEB_BUILD:-build/web}/node_modules
mkdir -p "$folder/modules/"{three/build,three/examples/jsm/misc,three/examples/jsm/postprocessing,playcanvas/build,relief-particles}
cp samples/web/engines/*.{html,js} "$folder"
cp "$modules"/three/build/three.{module,core,webgpu,tsl}.js "$folder/modules/three/build"
cp "$modules/three/examples/jsm/misc/GPUComputationRenderer.js" "$folder/modules/three/examples/jsm/misc"
cp "$modules/three/examples/jsm/postprocessing/Pass.js" "$folder/modules/three/examples/jsm/postprocessing"
cp "$modules/playcanvas/build/playcanvas.mjs" "$folder/modules/playcanvas/build"
cp out/npm/engines.js "$folder/modules/relief-particles"
"$bin/relief" bake /usr/share/glmark2/models/bunny.obj -q -o "$folder/body.relief" --budget 200kB
echo "$folder"
