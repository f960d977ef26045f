#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Bakes and plays samples without a window: scripts/samples.sh [NAME…] (default: all). Writes frames and a contact sheet of
# six of them (contact_sheet.png and .jpg) to out/samples/NAME, and a film of the village. Needs no GPU, but is faster with one.
# With RELIEF_QUIET, which scripts/demo.sh sets, packages and the build print one line each.
set -euo pipefail
cd "$(dirname "$0")/.."

all=(bunny_in_the_snow catherine_wheel fountain kitchen linked_tori rain village walker wobbling_torus)
names=("$@")
[ ${#names[@]} -gt 0 ] || names=("${all[@]}")
for name in "${names[@]}"; do
    [[ " ${all[*]} " == *" $name "* ]] || {
        echo "samples.sh: unknown sample '$name'; choose from: ${all[*]}" >&2
        exit 1
    }
done

scripts/setup.sh tools
bin=$(scripts/build.sh tools relief relief-sim)
models=/usr/share/glmark2/models

# mesh NAME: writes $out/NAME with samples/meshes.py.
mesh() { python3 samples/meshes.py "${1%.*}" "$out/$1"; }
bake() { "$bin/relief" bake "$@"; }

# prepare: writes the scene $name and its files to $out.
prepare() {
    mkdir -p "$out"
    case $name in
    bunny_in_the_snow)
        cp "$models/bunny.obj" "$out/"
        bake "$out/bunny.obj" -o "$out/bunny.relief" --prefer inside
        ;;
    catherine_wheel)
        mesh torus.obj
        bake "$out/torus.obj" -o "$out/torus.relief" --budget 200kB
        bake "$models/bunny.obj" -o "$out/bunny.relief" --prefer inside
        ;;
    fountain)
        mesh basin.obj
        bake "$models/horse.3ds" -o "$out/horse.relief" --budget 500kB
        bake "$out/basin.obj" -o "$out/basin.relief" --map front-back:dir=-y,size=400x400
        ;;
    linked_tori)
        mesh torus.obj
        cp samples/linked_tori.csv "$out/"
        bake "$out/torus.obj" -o "$out/torus.relief" --budget 200kB
        ;;
    kitchen)
        python3 samples/kitchen.py "$out/kitchen.gltf"
        bake "$out/kitchen.gltf" -o "$out/kitchen.relief"
        ;;
    village)
        python3 samples/village.py "$out"
        python3 samples/walker.py "$out/walker.gltf"
        bake "$out/village.glb" --world "$out/world" --budget 8MB
        bake "$out/walker.gltf" --animated -o "$out/walker.relief"
        ;;
    walker)
        python3 samples/walker.py "$out/walker.gltf"
        bake "$out/walker.gltf" --animated -o "$out/walker.relief"
        ;;
    wobbling_torus)
        mesh torus.obj
        ;;
    rain)
        mesh terrain.obj
        # Solid down to the bottom of the map's box: y = -1.5, well below the valleys.
        bake "$out/terrain.obj" -o "$out/terrain.relief" --map fixed8:dir=-y,size=512x512,box=-4/-1.5/-4/4/1.5/4
        ;;
    esac
    cp "samples/$name.toml" "$out/"
}

# caption: prints the number of particles and the time of a step.
caption() {
    python3 - "$out/report.json" <<'P'
import json, sys
report = json.load(open(sys.argv[1]))
gpu = report["device"].split(", ")[1].split("/")[0].split(" (")[0]
print(f"{report['particles']['alive']:,} particles, {report['ms_per_step_median']:.2g} ms a step on {gpu}")
P
}

# sheet: six frames spread over the run, then the slices, if any, and the caption.
sheet() {
    local frames=("$out"/frames/frame_*.png) chosen=() paper='#f4f5f7' i tile=3x2 size=640x480
    local font=/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf
    if [ "$name" = village ]; then  # wide, larger frames
        tile=2x3 size=960x540
    fi
    for i in 1 2 3 4 5 6; do
        chosen+=("${frames[$(((${#frames[@]} - 1) * i / 6))]}")
    done
    {
        montage "${chosen[@]}" -tile "$tile" -geometry "$size+6+6" -background "$paper" miff:-
        [ ! -f "$out/slice_x.png" ] ||
            montage "$out"/slice_[xyz].png -tile 3x1 -geometry '640x>+6+6' -background "$paper" miff:-
        convert -background "$paper" -fill '#3b4148' -font "$font" -pointsize 34 label:"$(caption)" -bordercolor "$paper" -border 0x10 miff:-
    } | convert miff:- -background "$paper" -gravity center -append \
        -bordercolor "$paper" -border 12 -depth 8 -strip "$out/contact_sheet.png"
}

# play: writes the frames and the contact sheet.
play() {
    rm -rf "$out/frames"
    if [ "$name" = bunny_in_the_snow ]; then
        for axis in x y z; do
            "$bin/relief" slice "$out/bunny.relief" --axis $axis --at center --size 480 -o "$out/slice_$axis.png"
        done
    fi
    local every=()
    [ -z "${RELIEF_QUIET-}" ] || every=(--steps-per-frame 50)  # only the six frames of the sheet
    "$bin/relief-sim" "$out/$name.toml" --frames "$out/frames" "${every[@]}" --json >"$out/report.json"
    sheet
    convert "$out/contact_sheet.png" -resize 1200x -define jpeg:extent=150kB "$out/contact_sheet.jpg"
    if [ "$name" = village ]; then
        "$bin/relief-sim" "$out/$name.toml" --size 640x360 --steps-per-frame 4 --frames "$out/film"
        img2webp -loop 0 -lossy -q 40 -m 6 -d 67 "$out"/film/frame_*.png -o "$out/film.webp" >&2
    fi
    echo "Look at $out/contact_sheet.png"
}

for name in "${names[@]}"; do
    out=out/samples/$name
    prepare
    play
done
