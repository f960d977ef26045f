# SPDX-License-Identifier: Apache-2.0
# Slices and exported maps, read back with OpenEXR's own tool.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o b.relief --paper --resolution 96 -q
"$relief" slice b.relief --axis z --at center --size 200 -o s.png
[ "$(identify -format '%m' s.png)" = PNG ] || die "the slice is no PNG"

"$relief" export b.relief -o maps
[ "$(find maps -name '*.exr' | wc -l)" -eq 9 ] || die "three front-back maps and six faces, not $(ls maps)"
front_back=$(find maps -name '*front-back*.exr' | sort | head -1)
exrheader "$front_back" >header
for word in 'Z,' ZBack N.X N.Y N.Z worldToCamera worldToNDC; do
    grep -q "$word" header || die "$front_back lacks $word: $(cat header)"
done

# A map of patches has no view: its words are exported, beside the images of other maps.
"$relief" bake "$bunny" -o p.relief --map patches:bytes=20kB --map cube:size=16 -q
"$relief" info p.relief | grep -qE 'patches +per patch +- +[1-9][0-9]+ patches +[0-9.]+ kB' || die "info does not say how many patches there are: $("$relief" info p.relief)"
"$relief" export p.relief -o patches
[ "$(find patches -name '*.exr' | wc -l)" -eq 7 ] || die "a tree and six faces, not $(ls patches)"
exrheader patches/map0_patches.exr >header
for word in 'low, 32-bit unsigned' 'high, 32-bit unsigned' relief.roots relief.object_to_map; do
    grep -q "$word" header || die "map0_patches.exr lacks $word: $(cat header)"
done

# An exported shader states its licence, is ASCII, and has no constant that it does not use.
"$relief" export b.relief --gpu gpu
python3 - <<'P' || die "collider.glsl: $(head -5 gpu/collider.glsl)"
import re
text = open('gpu/collider.glsl', 'rb').read().decode('ascii')
assert text.startswith('// SPDX-License-Identifier: Apache-2.0\n')
head = text[text.index('#define RELIEF_ALL'):text.index('struct ReliefMap')]
unused = [n for n in re.findall(r'(?m)^#define (RELIEF_[A-Z0-9_]+) \S', head) if len(re.findall(rf'\b{n}\b', text)) < 2]
assert not unused, unused
P

# Every run gives the same bytes.
"$relief" slice b.relief --axis z --at center --size 200 -o again.png
cmp s.png again.png || die "two pictures differ"

# A plane wholly outside also gives a picture.
"$relief" slice b.relief --axis x --at 1000 --size 32 -o far.png
