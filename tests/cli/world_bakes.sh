# SPDX-License-Identifier: Apache-2.0
# Levels by name, texel and thread count, and their pages: the slower part of tests/cli/world.sh.
. "$(dirname "$0")/lib.sh"

level level.gltf
expect 0 "$relief" bake level.gltf --world w --budget 200kB -q
expect 0 "$relief" bake level.gltf --world one --budget 200kB -j 1 -q
diff -r -x .relief-cache.json w one || die "the number of threads changes the world"

# The page of a check equals that of relief view.
page_place >template.html
RELIEF_VIEW_PAGE=$PWD/none.html expect_error 2 none.html "$relief" check w/world.json --mesh level.gltf --page page.html --samples 50
export RELIEF_VIEW_PAGE=$PWD/template.html
sed 's/data-format="/&1/' template.html >other.html
RELIEF_VIEW_PAGE=$PWD/other.html expect_error 3 'other.html.*scripts/build.sh web' "$relief" check w/world.json --mesh level.gltf --page page.html
[ ! -e page.html ] || die "a page was written for a player of another format"
expect 0 "$relief" check w/world.json --mesh level.gltf --page page.html --samples 5000
expect 0 "$relief" view w/world.json --mesh level.gltf -o view.html --samples 5000
cmp page.html view.html || die "check and view write different pages"
sed 's/.*page-data"[^>]*>//; s/<.script>.*//' page.html >page.json
json page.json "d['check']['verdict']['grade'] == 'good' and all(p['picture'].startswith('iVBORw0KGgo') for p in d['check']['accuracy']['places'])"

# Names select the kinds of parts. Only meshes with such names are baked again, if their share of the budget is
# unchanged.
expect 0 "$relief" bake level.gltf --world named --texel 0.02 -q
expect 0 "$relief" bake level.gltf --world named --texel 0.02 --as wide=shell --json
json stdout "d['baked'] == 1 and d['up_to_date'] == 2"
expect 0 "$relief" check named/world.json --mesh level.gltf --max-error 2 -q
expect_error 1 "'wid'.*'wide'" "$relief" bake level.gltf --world named --as wid=shell

# By texel, in units of the level: equally fine at any scale, with as many bytes as needed.
expect 0 "$relief" bake level.gltf --world by_texel --texel 0.02 --json
json stdout "d['budget'] is None and all(c['budget'] is None for c in d['colliders'])"
cp stdout texel.json
expect 0 "$relief" check by_texel/world.json --mesh level.gltf --max-error 0.5 -q
expect 0 "$relief" info "by_texel/$(python3 -c "import json; print(json.load(open('texel.json'))['colliders'][1]['file'])")"
grep -q -- '--texel 0.01' stdout || die "a mesh at scale 2 has a different texel: $(cat stdout)"
expect 0 "$relief" bake level.gltf --world by_texel --texel 2cm
grep -q '5 bodies of 3 colliders: 0 baked, 3 up to date' stderr || die "not up to date by texel: $(cat stderr)"
# With a budget, meshes with coarser texels are named.
expect 0 "$relief" bake level.gltf --world by_texel --texel 0.0005 --budget 60kB --json
json stdout "d['gpu_bytes'] <= 60000"
grep -q 'warning: box: the texel is ' stderr || die "not named: $(cat stderr)"
expect_error 1 "both choose the size" "$relief" bake level.gltf -o v.relief --texel 0.1 --max-error 1
