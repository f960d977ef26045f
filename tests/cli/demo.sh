# The demo's own collider and scene: no particle ends inside the bunny beyond the bound, and snow lies on it.
#
# The bound is the one for the paper's maps, of eight times the bytes: a point that such a map calls outside lies at most
# half a texel's diagonal from free space (the texel's centre ray), plus the depth's quantum. At 512² that is
# 0.71 · side/510 + side/2048 for front-back maps (half-float depth), and √2/512 · radius for a cube: together below
# 0.25 % of the longest side. Planned maps that prefer the inside must do better.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o bunny.relief --prefer inside -q
cp "$RELIEF_SOURCE/samples/bunny_in_the_snow.toml" .
"$relief_sim" bunny_in_the_snow.toml --steps 300 --dump snow.ply --json >report.json
/usr/bin/python3 "$RELIEF_SOURCE/tests/cli/penetration.py" "$bunny" snow.ply >penetration.json
cat penetration.json
json penetration.json "d['deepest_share_of_longest_side'] <= 0.0025"
# Snow lies on the bunny: thousands of particles rest within three texels of the surface.
json penetration.json "d['resting_on_mesh'] >= 2000"
