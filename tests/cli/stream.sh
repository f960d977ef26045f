# Scenes that stream their world: all that is needed is there, runs are alike, and what is missing is said once.
. "$(dirname "$0")/lib.sh"

python3 "$RELIEF_SOURCE/tests/cli/heights.py" hills.r16 560
expect 0 "$relief" bake hills.r16 --heights low=0,high=100,tile=256 --world w --json
json stdout "len(d['tiles']) == 9 and sum(t['coarse'] is not None for t in d['tiles']) == 8"
json w/world.json "[c['file'].count('coarse') for c in d['colliders']] == [0] * 9 and 'coarse' in d['colliders'][0]"
expect 0 "$relief" check w/world.json

# A shower that moves over all tiles, of which a few are wanted at a time.
scene() {
    printf 'world = "w/world.json"\n%s\n[time]\nsteps = 120\n[particles]\ncapacity = 4096\n[forces]\ngravity = [0, -9.81, 0]\n' "$1"
    printf '[ground]\nenabled = false\n[camera]\neye = [1, 90, 1]\ntarget = [20, 0, 20]\n[[emitter]]\nbox_min = [0, 62, 0]\n'
    printf 'box_max = [40, 66, 40]\nvelocity = [0, -30, 0]\nlifetime = 100\n[[emitter.key]]\ntime = 0\nposition = [30, 0, 30]\n'
    printf '[[emitter.key]]\ntime = 2\nposition = [480, 0, 480]\n'
}
scene '' >all.toml
scene $'[stream]\nradius = 30' >stream.toml
scene $'[stream]\nradius = 30\nmemory = 0.65' >little.toml
for name in all stream little; do
    expect 0 "$relief_sim" $name.toml --dump $name.ply --json
    json stdout "d['warnings'] == []"
    python3 "$RELIEF_SOURCE/tests/cli/heights.py" --below $name.ply 100 >below
    # Of the coarse ones the hills are up to 3 m off.
    python3 -c "
count, below, highest = map(float, open('below').read().split())
assert count > 3000 and below < (3 if '$name' == 'little' else 0.05), (count, below)" || die "$name: $(cat below)"
done
cmp all.ply stream.ply || die "where all that is needed is there, the run is another"
expect 0 "$relief_sim" little.toml --dump again.ply -q
cmp little.ply again.ply || die "two runs of one scene differ"

fine=$(python3 -c "import json; print(json.load(open('w/world.json'))['colliders'][0]['file'])")
coarse=$(python3 -c "import json; print(json.load(open('w/world.json'))['colliders'][0]['coarse']['file'])")
mv "w/$fine" kept
expect 0 "$relief_sim" stream.toml --dump gone.ply --json
json stdout "len(d['warnings']) == 1 and '$fine' in d['warnings'][0] and 'coarse likeness stays' in d['warnings'][0]"
head -c 1000 kept >"w/$fine"
expect 0 "$relief_sim" stream.toml --json
json stdout "len(d['warnings']) == 1 and 'has other contents than its hash' in d['warnings'][0]"
mv kept "w/$fine"
mv "w/$coarse" kept
expect_error 2 "stream.toml:1:9: world: .*$coarse" "$relief_sim" stream.toml
expect_error 2 "colliders\[0\]\.coarse.*$coarse" "$relief" check w/world.json
expect 0 "$relief_sim" all.toml -q
mv kept "w/$coarse"

scene $'[stream]\nradius = 30\nmemory = 0.01' >none.toml
expect_error 6 'always there.*allow more' "$relief_sim" none.toml
scene $'[stream]' >none.toml
expect_error 3 'stream.radius is missing' "$relief_sim" none.toml
scene $'[stream]\nradius = 0' >none.toml
expect_error 3 'stream.radius = 0 is out of range' "$relief_sim" none.toml
printf '[collider]\nfile = "w/%s"\n[stream]\nradius = 3\n' "$fine" >none.toml
expect_error 3 'stream needs world' "$relief_sim" none.toml
