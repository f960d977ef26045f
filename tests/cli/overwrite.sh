# SPDX-License-Identifier: Apache-2.0
# No tool overwrites its inputs or writes two outputs to one file, whether by name, symbolic link or hard link. Unit
# tests cover the guard; this script covers every output of both tools, and runs that need a shell.
. "$(dirname "$0")/lib.sh"

page_place >stub.html
export RELIEF_VIEW_PAGE=$work/stub.html

{ echo 'mtllib box.mtl' && cat "$models/OBJ/box.obj"; } >box.obj
printf 'newmtl a\nKd 1 0 0\n' >box.mtl
cp box.obj live.obj
"$relief" bake box.obj -o box.relief --budget 20kB --no-check -q
echo '0,1,0' >points.csv
head -c 96 /dev/zero >flow.raw
convert -size 4x4 xc:red atlas.png
mkdir frames
cp atlas.png frames/frame_0002.png
printf '%s\n' '[collider]' 'file = "box.relief"' '[time]' 'steps = 4' '[[type]]' 'cell = 0' '[render]' \
    'atlas = "frames/frame_0002.png"' 'size = [16, 16]' 'steps_per_frame = 2' >scene.toml
printf '%s\n' '[[collider]]' 'file = "box.relief"' '[[collider]]' 'mesh = "live.obj"' 'resolution = 16' \
    'deform = { amplitude = 0.1, frequency = 2 }' '[emitter]' 'shape = "points"' 'points = "points.csv"' '[flow]' \
    'raw = "flow.raw"' 'size = [2, 2, 2]' 'components = 3' 'box_min = [-1, -1, -1]' 'box_max = [1, 1, 1]' '[[type]]' \
    'cell = 0' '[render]' 'atlas = "atlas.png"' >all.toml
printf '%s\n' '[collider]' 'file = "box.relief"' '[render]' 'mesh = "box.obj"' >drawn.toml
printf 'version = 1\n[[asset]]\nmesh = "box.obj"\noutput = "{stem}.new.relief"\nmap = "cube:size=16"\n' >r.toml
inputs=(box.obj box.mtl box.relief live.obj points.csv flow.raw atlas.png scene.toml all.toml drawn.toml r.toml)
sha256sum "${inputs[@]}" frames/frame_0002.png >before
expect_kept() { # PATTERN COMMAND…: fails with a usage error, and no file changes
    expect_error 1 "$@"
    sha256sum --quiet -c before || die "an input was overwritten: $*"
}

# Every output of a run at each of its inputs, under one name after another. @ stands for the output.
for input in "${inputs[@]}"; do
    ln -s "$input" "symbolic.$input"
    ln "$input" "hard.$input"
done
run=0
while read -r names command; do
    for name in ${names//,/ }; do
        prefixes=('' symbolic. hard.)
        output=${prefixes[$((run++ % 3))]}$name
        # shellcheck disable=SC2086
        expect_kept "'(.*/)?$output'" ${command//@/$output}
    done
done <<C
all.toml,box.relief,live.obj,points.csv,flow.raw,atlas.png $relief_sim all.toml --steps 1 --dump @
all.toml,box.relief,live.obj,points.csv,flow.raw,atlas.png $relief_sim all.toml --steps 1 --events @
drawn.toml,box.relief,box.obj $relief_sim drawn.toml --steps 1 --dump @
box.relief $relief_sim box.relief --steps 1 --dump @
box.obj,box.mtl $relief bake box.obj --map cube:size=8 -o @
box.obj,box.mtl $relief bake box.obj --map cube:size=8 -o new.relief --depfile @
box.relief,box.obj,box.mtl $relief view box.relief --mesh box.obj -o @
box.relief,box.obj,box.mtl $relief check box.relief --mesh box.obj --samples 50 --page @
box.relief,points.csv $relief query box.relief --points points.csv -o @
r.toml,box.obj,box.mtl $relief bake --recipe r.toml -q --stamp @
r.toml,box.obj,box.mtl $relief bake --recipe r.toml -q --depfile @
r.toml,box.obj,box.mtl $relief bake --recipe r.toml -q --events @
C
mkdir dumps engine
ln -s ../points.csv dumps/particles_0001.ply
expect_kept 'particles_0001\.ply' "$relief_sim" all.toml --steps 2 --dump-frames dumps --steps-per-frame 1
ln -s ../box.relief engine/relief.glsl
expect_kept 'relief\.glsl' "$relief" export box.relief --engine c engine

# Two outputs in one place.
expect_kept 'both write' "$relief_sim" scene.toml --dump new --events new
expect_kept 'both write' "$relief_sim" scene.toml --dump - --events /dev/stdout
expect_kept 'shots' "$relief_sim" scene.toml --frames shots --dump shots
expect_kept 'json' "$relief" bake box.obj --map cube:size=8 -o - --json
[ ! -e new ] && [ ! -e new.relief ] || die "a rejected run wrote a file"

# A frame is an input only if its number is written.
expect_kept "frame_0002\.png' is the input" "$relief_sim" scene.toml --first-frame 0 --frames frames
expect 0 "$relief_sim" scene.toml --frames frames -q

# Every file of a scene is an input, even if this run does not read it: meshes of pictures, finer or coarser containers.
mkdir meshes
cp box.obj meshes/stored
ln -s stored meshes/box.obj
printf '%s\n' '[collider]' 'file = "box.relief"' '[render]' 'meshes = "meshes"' >pictured.toml
sha256sum meshes/stored >>before
for output in meshes/box.obj meshes/stored; do
    expect_kept "'$output' is the input" "$relief_sim" pictured.toml --steps 1 --dump $output
    expect_kept "'$output' is the input" "$relief_sim" pictured.toml --steps 1 --events $output
done

# A bake owns the folder of a world: its containers, present or not, and its caches.
python3 "$RELIEF_SOURCE/tests/cli/heights.py" hills.png 33
printf '%s\n' 'version = 1' '[[asset]]' 'mesh = "box.obj"' 'output = "recipe/world.json"' 'budget = "20kB"' >world.toml
level=("$relief" bake box.obj --world level --budget 20kB)
ground=("$relief" bake hills.png --heights spacing=1,low=0,high=9 --world ground)
recipe=("$relief" bake --recipe world.toml)
for bake in level ground recipe; do
    declare -n command=$bake
    expect 0 "${command[@]}" -q
    ln $bake/*.relief $bake.hard
    ln -s "$(echo $bake/*.relief)" $bake.symbolic
    find $bake -type f -exec sha256sum {} + >>before
    for output in $bake/*.relief $bake/new.relief $bake/world.json $bake.hard $bake.symbolic $bake/.relief-cache.json; do
        expect_kept "and --depfile would both write '$output'.*; choose another" "${command[@]}" --depfile $output
    done
done
expect_kept "and --stamp would both write 'recipe.symbolic', which is '.*recipe/.*relief'; choose" "${recipe[@]}" --stamp recipe.symbolic
expect_kept "'box.obj' and --events would both write" "${recipe[@]}" --events "$(echo recipe/*.relief)"
expect_kept "and --depfile would both write" "${level[@]}" --depfile level/.relief-curves.json

# A refused run makes no folder.
expect_error 2 'creates a folder there' "$relief" bake box.obj --world fresh/sub --budget 20kB --depfile fresh
expect_error 2 'creates a folder there' "$relief" bake --recipe world.toml -o fresh/sub --stamp fresh
expect_error 2 'does not exist' "$relief" bake box.obj --world fresh/sub --budget 20kB --depfile missing/d
expect_error 2 "missing.obj': No such file or directory; check the path\$" "$relief" bake missing.obj --world fresh/sub
expect_error 2 'missing.png' "$relief" bake missing.png --heights low=0,high=1 --world fresh
[ ! -e fresh ] || die "a rejected run created a folder"
expect 0 "$relief" bake box.obj --world fresh/sub --budget 20kB --depfile fresh/d -q

# A page of a world, and the report next to a page.
expect_kept "is the input" "$relief" view level/world.json -o "$(echo level/*.relief)"
expect_kept "the report and --page would both write" "$relief" check box.relief --mesh box.obj --page /dev/stdout

# Standard input and output are files, too.
expect_kept "'points.csv' is the input standard input" sh -c "'$relief' query box.relief --points - -o points.csv <points.csv"
code=0
"$relief_sim" scene.toml --events shared >shared 2>stderr </dev/null || code=$?
[ "$code" -eq 1 ] && grep -q 'the report' stderr || die "the report and --events share a file: $code, $(cat stderr)"

# A recipe: dependencies of its meshes, in every shard; its cache, which is neither a recipe nor a link.
for shard in 1/2 2/2; do expect_kept "'box.obj' is the input" "$relief" bake --recipe r.toml --stamp box.obj --shard $shard; done
cp r.toml .relief-cache.json
expect_kept "recipe.s cache" "$relief" bake --recipe .relief-cache.json
cmp r.toml .relief-cache.json || die "the cache overwrote the recipe"
rm .relief-cache.json
mkdir elsewhere
echo precious >elsewhere/precious
ln -s elsewhere/precious .relief-cache.json
expect 0 "$relief" bake --recipe r.toml
grep -q 'not a regular file' stderr || die "a link as cache: $(cat stderr)"
[ "$(cat elsewhere/precious)" = precious ] && [ ! -L .relief-cache.json ] || die "the cache follows a link"
