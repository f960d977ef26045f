#!/usr/bin/env bash
# "Bunny in the snow": bakes the Stanford bunny, lets 300 steps of snow fall on it without a window, and leaves
# a contact sheet of frames and slices, out/demo/contact_sheet.png. Needs no GPU.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
bin=$(scripts/build.sh release relief relief-sim)
out=${1:-out/demo}
mkdir -p "$out"

"$bin/relief" bake /usr/share/glmark2/models/bunny.obj -o "$out/bunny.relief" --prefer inside
for axis in x y z; do
    "$bin/relief" slice "$out/bunny.relief" --axis $axis --at center --size 480 -o "$out/slice_$axis.png"
done

cp samples/bunny_in_the_snow.toml "$out/"
"$bin/relief-sim" "$out/bunny_in_the_snow.toml" --steps 300 --frames "$out/frames" --dump "$out/particles.ply"

scripts/contact_sheet.sh "$out"
echo "Look at $out/contact_sheet.png"
