# SPDX-License-Identifier: Apache-2.0
# Slices and exported maps, read with OpenEXR's tools.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o b.relief --paper --resolution 96 -q
"$relief" slice b.relief --axis z --at center --size 200 -o s.png
[ "$(identify -format '%m' s.png)" = PNG ] || die "the slice is not a PNG"

"$relief" export b.relief -o maps
[ "$(find maps -name '*.exr' | wc -l)" -eq 9 ] || die "three front-back maps and six faces, not $(ls maps)"
front_back=$(find maps -name '*front-back*.exr' | sort | head -1)
exrheader "$front_back" >header
for word in 'Z,' ZBack N.X N.Y N.Z worldToCamera worldToNDC; do
    grep -q "$word" header || die "$front_back lacks $word: $(cat header)"
done

# A collider with patches is exported as six views, besides the images of other maps.
"$relief" bake "$bunny" -o p.relief --map patches:budget=20kB --map cube:size=16 -q
"$relief" info p.relief | grep -qE 'patches +per patch +- +[1-9][0-9]+ patches +[0-9.]+ kB' || die "info does not print the number of patches: $("$relief" info p.relief)"
"$relief" export p.relief -o patches --resolution 100
[ "$(find patches -name 'view_[+-][xyz].exr' | wc -l)" -eq 6 ] && [ "$(find patches -type f | wc -l)" -eq 12 ] || die "six views and six faces, not $(ls patches)"
exrheader patches/view_+x.exr >header
for word in 'depth.front, 32-bit floating' 'depth.back, 32-bit floating' normal.Z worldToNDC relief.unit relief.bounds_min ' 99)'; do
    grep -q "$word" header || die "view_+x.exr lacks $word: $(cat header)"
done
"$relief" export p.relief -o small --resolution 40
exrheader small/view_-y.exr | matches '(39 ' || die "not 40 texels along the longer side: $(exrheader small/view_-y.exr)"
"$relief" export - -o again --resolution 40 <p.relief
diff -r small again || die "two exports differ"
expect_error 1 'resolution has no effect without -o' "$relief" export p.relief --mesh gpu --resolution 40
expect_error 1 'no patches.*remove --resolution' "$relief" export b.relief -o none --resolution 40
expect_error 1 '--resolution' "$relief" export p.relief -o none --resolution 5000
[ ! -e none ] || die "a rejected export created a folder"
ln -s ../p.relief small/view_+z.exr.link && mv small/view_+z.exr.link small/view_+z.exr
expect_error 1 'view_.z.exr' "$relief" export p.relief -o small

# Distances as numbers, selected by the extension of the output.
"$relief" slice p.relief --axis y --size 200 -o d.EXR
exrheader d.EXR >header
for word in 'distance, 32-bit floating' 'relief.plane .*"y = ' worldToNDC '(199 '; do
    grep -q -- "$word" header || die "d.EXR lacks $word: $(cat header)"
done
expect_error 1 'out.jpg. must end in .png or .exr' "$relief" slice p.relief -o out.jpg
cp p.relief p.exr
expect_error 1 'output' "$relief" slice p.exr -o p.exr

# Files for other engines. Texts state their licence, and pages have no links to files that are not there.
"$relief" bake "$bunny" -o engine.relief -q --budget 20kB
"$relief" export engine.relief --engine c engine_c/deep
cmp engine.relief engine_c/deep/engine.relief || die "the exported collider differs"
tetrahedron level.obj
"$relief" bake level.obj --world city.1.0 -q --budget 20kB
(cd city.1.0 && "$relief" export ./world.json --engine godot ../level -q)
[ "$(find level -name 'city.1.0.*' | sort | tr '\n' ' ')" = 'level/city.1.0.bodies level/city.1.0.cells level/city.1.0.texels ' ] || die "$(ls level)"
grep -q 'city\|NAME.bodies' level/RELIEF.md || die "the page of a level does not describe it"
[ "$(stat -c %s engine_c/deep/engine.constants)" -eq 80 ] || die "80 bytes of constants"
[ "$(($(stat -c %s engine_c/deep/engine.texels) % 16384))" -eq 0 ] || die "texels are not whole rows"
for engine in c godot unity unreal three playcanvas; do
    "$relief" export engine.relief --engine $engine engine_$engine -q
    find engine_$engine -name '*.h' -o -name '*.glsl' -o -name '*.hlsl' -o -name '*.wgsl' -o -name '*.gd*' | while read -r file; do
        head -2 "$file" | grep -q 'SPDX-License-Identifier: Apache-2.0' || die "$file has no licence"
    done
    page=engine_$engine/RELIEF.md
    [ -s $page ] && ! grep -qE '\]\(\.|scripts/|tests/' $page || die "$engine has no page, or one that needs the project: $(cat $page)"
    for file in $(find engine_$engine \( -name '*.js' -o -name '*.html' \) -exec grep -ohE "[\"'][a-z./_]+\.(js|relief)[\"']" {} + |
        grep -v node_modules | tr -d \"\'); do
        [ -n "$(find engine_$engine -name "${file##*/}")" ] || die "$engine lacks $file"
    done
done
# Commands of the pages find the exported files.
cp engine.relief bunny.relief
for page in own_engine unity unreal; do
    mkdir "steps_$page"
    grep -E '^ *(cc|cd|mkdir|relief export|\./)' "$RELIEF_SOURCE/samples/$page/README.md" >"steps_$page/commands"
    [ "$(wc -l <"steps_$page/commands")" -ge 2 ] || die "the page of $page has no commands"
    (cd "steps_$page" && cp ../bunny.relief . && PATH=$RELIEF_BIN:$PATH sh -e commands) >log 2>&1 || die "$page: $(tail log)"
done
expect_error 1 "engine is 'quake' but must be one of c|godot" "$relief" export engine.relief --engine quake none
expect_error 1 'engine' "$relief" export engine.relief --engine c
expect_error 1 'b.relief.*: engines read one map of patches.* bake it again without --map' "$relief" export b.relief --engine c none
expect_error 1 'only --engine exports worlds' "$relief" export level/world.json -o none
[ ! -e none ] || die "a rejected export created a folder"

# Outputs are deterministic.
"$relief" slice b.relief --axis z --at center --size 200 -o again.png
cmp s.png again.png || die "two pictures differ"

# A plane outside the collider also gives a picture.
"$relief" slice b.relief --axis x --at 1000 --size 32 -o far.png
