# SPDX-License-Identifier: Apache-2.0
# No tool overwrites its inputs or writes two outputs to one file, whether by name, symbolic link or hard link.
# tests/cases/overwrite_cases.py draws combinations; this script covers those that need a shell or several runs.
. "$(dirname "$0")/lib.sh"

page_place >stub.html
export RELIEF_VIEW_PAGE=$work/stub.html

PYTHONPATH=$RELIEF_SOURCE/tests/cases python3 "$RELIEF_SOURCE/tests/cases/overwrite_cases.py" "$RELIEF_BIN" --seed "${RELIEF_TEST_SEED:-1}" --cases 40

{ echo 'mtllib box.mtl' && cat "$models/OBJ/box.obj"; } >box.obj
printf 'newmtl a\nKd 1 0 0\n' >box.mtl
"$relief" bake box.obj -o box.relief --map cube:size=16 -q
echo '0,1,0' >points.csv
convert -size 4x4 xc:red atlas.png
mkdir frames
cp atlas.png frames/frame_0002.png
printf '%s\n' '[collider]' 'file = "box.relief"' '[time]' 'steps = 4' '[[type]]' 'cell = 0' '[render]' \
    'atlas = "frames/frame_0002.png"' 'size = [16, 16]' 'steps_per_frame = 2' >scene.toml
printf 'version = 1\n[[asset]]\nmesh = "box.obj"\noutput = "{stem}.new.relief"\nmap = "cube:size=16"\n' >r.toml
sha256sum box.* points.csv atlas.png scene.toml r.toml frames/frame_0002.png >before
expect_kept() { # PATTERN COMMAND…: fails with a usage error, and no file changes
    expect_error 1 "$@"
    sha256sum --quiet -c before || die "an input was overwritten: $*"
}

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
