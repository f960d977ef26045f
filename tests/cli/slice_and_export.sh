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
"$relief" bake "$bunny" -o p.relief --map patches:bytes=20kB --map cube:size=16 -q
"$relief" info p.relief | grep -qE 'patches +per patch +- +[1-9][0-9]+ patches +[0-9.]+ kB' || die "info does not print the number of patches: $("$relief" info p.relief)"
"$relief" export p.relief -o patches
[ "$(find patches -name 'view_[+-][xyz].exr' | wc -l)" -eq 6 ] && [ "$(find patches -type f | wc -l)" -eq 12 ] || die "six views and six faces, not $(ls patches)"
exrheader patches/view_+x.exr >header
for word in 'depth.front, 32-bit floating' 'depth.back, 32-bit floating' normal.Z worldToNDC relief.unit relief.bounds_min '511)'; do
    grep -q "$word" header || die "view_+x.exr lacks $word: $(cat header)"
done
"$relief" export p.relief -o small --resolution 40
exrheader small/view_-y.exr | matches '(39 ' || die "not 40 texels along the longer side: $(exrheader small/view_-y.exr)"
"$relief" export - -o again --resolution 40 <p.relief
diff -r small again || die "two exports differ"
expect_error 1 'resolution has no effect without -o' "$relief" export p.relief --gpu gpu --resolution 40
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

# An exported shader states its licence, is ASCII, and has no unused constants.
"$relief" export b.relief --gpu gpu
python3 - <<'P' || die "collider.glsl: $(head -5 gpu/collider.glsl)"
import re
text = open('gpu/collider.glsl', 'rb').read().decode('ascii')
assert text.startswith('// SPDX-License-Identifier: Apache-2.0\n')
head = text[text.index('#define RELIEF_ALL'):text.index('struct ReliefMap')]
unused = [n for n in re.findall(r'(?m)^#define (RELIEF_[A-Z0-9_]+) \S', head) if len(re.findall(rf'\b{n}\b', text)) < 2]
assert not unused, unused
P

# Outputs are deterministic.
"$relief" slice b.relief --axis z --at center --size 200 -o again.png
cmp s.png again.png || die "two pictures differ"

# A plane outside the collider also gives a picture.
"$relief" slice b.relief --axis x --at 1000 --size 32 -o far.png
