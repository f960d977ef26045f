# SPDX-License-Identifier: Apache-2.0
# The demo's collider and scene: no particle ends deeper in the bunny than the bound, and snow lies on it.
#
# The bound is that of the paper's maps, which use eight times the bytes. A point that such a map votes outside is
# within half a texel diagonal of free space (the texel's centre ray), plus the depth quantum. At 512² this is 0.71 ·
# side/510 + side/2048 for front-back maps (half-float depth), and √2/512 · radius for a cube: together below 0.25 % of
# the longest side. Planned maps that prefer the inside must be better.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o bunny.relief --prefer inside -q
cp "$RELIEF_SOURCE/samples/bunny_in_the_snow.toml" .
"$relief_sim" bunny_in_the_snow.toml --steps 300 --dump snow.ply --json >report.json
/usr/bin/python3 "$RELIEF_SOURCE/tests/cli/penetration.py" "$bunny" snow.ply >penetration.json
cat penetration.json
json penetration.json "d['deepest_share_of_longest_side'] <= 0.0025"
# Snow lies on the bunny: thousands of particles rest within three texels of the surface.
json penetration.json "d['resting_on_mesh'] >= 2000"

# scripts/demo.sh with built tools: it prints its duration first and at most 20 lines in all. It creates a picture, and
# the files used by the commands in README.md.
mkdir demo
cp -r "$RELIEF_SOURCE/scripts" "$RELIEF_SOURCE/samples" demo/
printf '#!/bin/sh\n' >demo/scripts/setup.sh
printf '#!/bin/sh\necho "%s"\n' "$RELIEF_BIN" >demo/scripts/build.sh
demo/scripts/demo.sh >log 2>&1 || die "the demo fails: $(cat log)"
[ "$(wc -l <log)" -le 20 ] && head -2 log | grep -q 'minutes on two cores' || die "the demo prints: $(cat log)"
grep -q 'wrong near the surface: ' log || die "the demo prints no verdict: $(cat log)"
[ -s demo/out/samples/bunny_in_the_snow/contact_sheet.png ] || die "the demo creates no picture"
sed -n '/^After the demo/,/^With your own files/s/^    \(relief.*[^ ]\)  *#.*/\1/p' "$RELIEF_SOURCE/README.md" >commands
[ "$(wc -l <commands)" -ge 5 ] || die "README.md has $(wc -l <commands) commands for the demo's files"
while read -r line; do
    (cd demo/out/samples/bunny_in_the_snow && PATH=$RELIEF_BIN:$PATH bash -euc "$line") >said 2>&1 </dev/null || die "$line: $(tail -5 said)"
done <commands
