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

# Every run gives the same bytes.
"$relief" slice b.relief --axis z --at center --size 200 -o again.png
cmp s.png again.png || die "two pictures differ"

# A plane wholly outside also gives a picture.
"$relief" slice b.relief --axis x --at 1000 --size 32 -o far.png
