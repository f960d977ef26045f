#!/usr/bin/env bash
# Puts six frames, and below them the slices if there are any, on one sheet: scripts/contact_sheet.sh FOLDER
set -euo pipefail
cd "$1"

shopt -s nullglob
frames=(frames/frame_*.png)
[ ${#frames[@]} -gt 0 ] || {
    echo "contact_sheet.sh: no frames in $1/frames; run scripts/demo.sh or scripts/samples.sh" >&2
    exit 1
}
# Six frames spread over the run, the last one among them.
chosen=()
for i in 1 2 3 4 5 6; do
    chosen+=("${frames[$(((${#frames[@]} - 1) * i / 6))]}")
done

paper='#f4f5f7'
montage "${chosen[@]}" -tile 3x2 -geometry 640x480+6+6 -background "$paper" .frames.png
rows=(.frames.png)
if [ -f slice_x.png ]; then
    montage slice_x.png slice_y.png slice_z.png -tile 3x1 -geometry '640x>+6+6' -background "$paper" .slices.png
    rows+=(.slices.png)
fi
convert "${rows[@]}" -background "$paper" -gravity center -append \
    -bordercolor "$paper" -border 12 -depth 8 -strip contact_sheet.png
rm -f .frames.png .slices.png
