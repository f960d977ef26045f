# SPDX-License-Identifier: Apache-2.0
# Levels: each distinct mesh is baked once, only changes are baked again, and the world file is written last. Also
# checks of worlds. Unit tests cover budget shares, tiles and invalid world files.
. "$(dirname "$0")/lib.sh"

level level.gltf
expect 0 "$relief" bake level.gltf --world w --budget 200kB --json --depfile w.d
json stdout "d['written'] and d['bodies'] == 5 and d['baked'] == 3 and d['up_to_date'] == d['failed'] == 0"
json stdout "[(c['mesh'], c['bodies'], round(c['largest_scale'], 9)) for c in d['colliders']] == [('floor', 1, 1), ('box', 3, 2), ('box', 1, 1)]"
json stdout "sum(c['gpu_bytes'] for c in d['colliders']) == d['gpu_bytes'] <= 200000 and all(c['wrong_percent'] < 1 for c in d['colliders'])"
json w/world.json "d['format'] == 'relief-world' and d['version'] == 1 and d['unit'] == 'm'"
json w/world.json "[(b['node'], b['collider']) for b in d['bodies']] == [('ground', 0), ('first', 1), ('second', 1), ('third', 1), ('wide', 2)]"
json w/world.json "d['bodies'][2]['scale'] == 2 and d['bodies'][2]['rotation'] == [0, 0.6, 0, 0.8] and d['bodies'][2]['position'] == [5, 0, 5]"
[ "$(tr -d '\\\n' <w.d | tr -s ' ')" = 'w/world.json: level.gltf' ] || die "depfile: $(cat w.d)"
container_hashes w >first

# The contents, and checks with and without the level.
expect 0 "$relief" info w/world.json --json
json stdout "d['file'] == 'w/world.json' and d['unit'] == 'm' and [c['bodies'] for c in d['colliders']] == [1, 3, 1]"
json stdout "d['bytes'] == sum(__import__('os').path.getsize('w/' + c['file']) for c in d['colliders'])"
json stdout "all(c['provenance']['mesh_name'] == c['mesh'] and '--budget' in c['provenance']['options'] for c in d['colliders'])"
expect 0 "$relief" info w/world.json
grep -q '^Relief world of 5 bodies of 3 colliders' stdout && [ "$(wc -l <stdout)" -eq 8 ] || die "info: $(cat stdout)"
grep -q '^meshes   3' stdout && grep -q '^baked    by relief [0-9.]*' stdout || die "info does not show the origin: $(cat stdout)"
expect 0 "$relief" check w/world.json
grep -q '^world.json: 5 bodies of 3 colliders' stdout || die "check: $(cat stdout)"
expect 0 "$relief" check w/world.json --mesh level.gltf --max-error 1 --samples 5000 --json
json stdout "d['accuracy']['wrong_percent'] < 0.5 and [b['node'] for b in d['accuracy']['bodies']] == ['ground', 'first', 'second', 'third', 'wide']"
json stdout "len(d['accuracy']['places']) == len(d['accuracy']['worst']) and all(p['cause'] == 'texel' and p['advice'] == '' for p in d['accuracy']['places'])"

# A moved node is wrong at its old and new position. It changes only the world file.
level level.gltf x=3
expect 7 "$relief" check w/world.json --mesh level.gltf --samples 5000 --max-error 1
grep -q 'warning: level.gltf: 1 node ' stderr && grep -qE '^  1 +first' stdout || die "the moved node is not the worst: $(cat stdout stderr)"
cp w/world.json before.json
expect 0 "$relief" bake level.gltf --world w --budget 200kB
grep -q ' 0 baked, 3 up to date' stderr || die "a moved node causes a bake: $(cat stderr)"
container_hashes w | diff first - || die "a moved node changes a container"
[ "$(diff before.json w/world.json | grep -c '^>')" -eq 1 ] || die "a moved node changes more than its line"

# A changed mesh replaces its containers. The larger box also has a coarse container.
level level.gltf x=3 high=1.01
expect_error 3 "level.gltf.*'box'" "$relief" check w/world.json --mesh level.gltf
expect 0 "$relief" bake level.gltf --world w --budget 200kB --json
json stdout "d['baked'] == 2 and d['up_to_date'] == 1 and len(d['removed']) == 3 and sum('-coarse-' in file for file in d['removed']) == 1 and d['colliders'][0]['state'] == 'up_to_date'"
[ "$(find w -name '*.relief' | wc -l)" -eq 4 ] && [ "$(find w -name 'box-coarse-*' | wc -l)" -eq 1 ] || die "containers are left over: $(ls w)"

# A damaged or missing container is baked again, with the same bytes.
container_hashes w >now
for file in w/box-*.relief; do printf x >>"$file"; done
expect_error 3 'w/world.json.*hash' "$relief" check w/world.json
expect 0 "$relief" bake level.gltf --world w --budget 200kB
grep -q ' 2 baked, 1 up to date' stderr || die "damaged containers: $(cat stderr)"
rm w/box-coarse-*.relief
expect_error 2 'colliders\[1\]\.coarse' "$relief" check w/world.json
expect 0 "$relief" bake level.gltf --world w --budget 200kB
grep -q ' 1 baked, 2 up to date' stderr || die "a missing coarse container: $(cat stderr)"
container_hashes w | diff now - || die "a repeated bake gives different bytes"

# If a mesh fails, the world is kept. Foreign files are never changed.
echo mine >w/mine.relief
cp w/world.json before.json
expect_error 1 "1 of 3 colliders failed.*'box': --thickness" "$relief" bake level.gltf --world w --budget 200kB --as shell --thickness 1.5
cmp before.json w/world.json || die "a failed bake changes the world"
expect 0 "$relief" check w/world.json
level other.gltf box=0
expect 0 "$relief" bake other.gltf --world w --budget 60kB --json
json stdout "len(d['removed']) >= 3 and d['bodies'] == 1"
[ "$(cat w/mine.relief)" = mine ] || die "a foreign file is gone"

# A folder is a level of its files.
mkdir parts
cp other.gltf parts/a.gltf
level parts/b.gltf box=0 floor=10
expect 0 "$relief" bake parts --world of_parts --budget 60kB -q
json of_parts/world.json "[b['node'] for b in d['bodies']] == ['a.gltf', 'b.gltf']"
expect 0 "$relief" check of_parts/world.json --mesh parts --samples 1000 --max-error 2 -q

# Options that conflict with levels, or require one.
expect_error 1 "--max-error" "$relief" bake level.gltf --world v --max-error 1
expect_error 1 "both name the output" "$relief" bake level.gltf --world v -o x.relief
expect_error 1 "recipe" "$relief" bake --recipe r.toml --world v
expect_error 1 "24576" "$relief" bake level.gltf --world v --budget 10kB
expect_error 1 "--min-part" "$relief" check w/world.json --min-part 1 --mesh other.gltf
expect_error 1 "--within" "$relief" check "$(ls w/floor-*.relief | head -1)" --within 1 --mesh other.gltf
ln -s "$(ls "$PWD"/of_parts/*.relief | head -1)" w/link.relief
sed "s/\"file\": *\"floor[^\"]*\"/\"file\": \"link.relief\"/" w/world.json >w/linked.json
mv w/linked.json w/world.json
expect_error 3 "leads out" "$relief" check w/world.json
