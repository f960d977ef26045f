#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures wrong points per byte on the thirteen meshes of bake/measure/README.md: dense and sparse distance volumes, the
# paper's maps and ours, at 0.25, 1 and 4 MB. Prints geometric means, and whether the targets are met. Takes forty minutes
# on two cores. Other arguments are passed to relief-accuracy, such as --budgets 1MB --methods ours for quick rounds.
#
#   scripts/accuracy.sh                  prints the table; README.md and bake/measure/README.md cite its figures
#   scripts/accuracy.sh --json           prints all measurements
#   scripts/accuracy.sh --corpus         sixty artist-made meshes (corpus.txt) at 1 MB, one row each; --help lists --only,
#                                        --steps and other options
#   scripts/accuracy.sh --lot            ten randomly drawn meshes (lot.txt); --draw draws them
set -euo pipefail
cd "$(dirname "$0")/.."

if [ "${1:-}" = --corpus ]; then
    scripts/setup.sh sweethome3d-furniture
    bin=$(scripts/build.sh release relief relief-accuracy relief-bench)
else
    scripts/setup.sh
    bin=$(scripts/build.sh release relief-accuracy)
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

tar -xzf /usr/share/doc/libcgal-dev/data.tar.gz -C "$folder" data/meshes
meshes=(/usr/share/glmark2/models/bunny.obj)
# The program computes which meshes are closed: lion-head is open by design, and some others have a few open edges.
for name in camel ChineseDragon-10kv fandisk anchor_dense cheese knot2 man refined_elephant lion-head couplingdown; do
    meshes+=("$folder/data/meshes/$name.off")
done
models=/usr/share/assimp/models
meshes+=("$models/Collada/duck.dae" "$models/BLEND/HUMAN.blend")

if [ "${1:-}" = --draw ]; then
    python3 scripts/lot.py "$folder/lot" --draw "$bin"
    exit 0
fi
if [ "${1:-}" = --lot ]; then
    python3 scripts/lot.py "$folder/lot" >"$folder/lot.paths"
    mapfile -t meshes <"$folder/lot.paths"
    "$bin/relief-accuracy" "${meshes[@]}" --methods volume,unreal,bricks,fitted,ours "${@:2}" | python3 scripts/accuracy_table.py
    exit 0
fi
if [ "${1:-}" = --corpus ]; then
    shift
    PYTHONDONTWRITEBYTECODE=1 python3 scripts/corpus.py "$bin" "$folder" "${meshes[@]}" -- "$@"
    exit 0
fi
if [ "${1:-}" = --json ]; then
    "$bin/relief-accuracy" "${meshes[@]}" "${@:2}"
    exit 0
fi
"$bin/relief-accuracy" "${meshes[@]}" "$@" | python3 scripts/accuracy_table.py
