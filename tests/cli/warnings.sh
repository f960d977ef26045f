# SPDX-License-Identifier: Apache-2.0
# A valid scene that is probably unintended gets a warning with advice; an intended one gets none.
. "$(dirname "$0")/lib.sh"

box wall.obj 2 2 0.1
"$relief" bake wall.obj -o wall.relief --budget 60kB --no-check -q
"$relief" bake wall.obj -o metres.relief --budget 60kB --no-check --unit m -q

scene() { # LINE…: settings of the particles that hit the wall
    printf '[collider]\nfile = "metres.relief"\n' >scene.toml
    printf '%s\n' "$@" >>scene.toml
}
still=('velocity_spread = [0.0, 0.0, 0.0]')
jet=('[forces]' 'gravity = [0.0, -9.81, 0.0]' 'drag = 0.0' '[emitter]' 'point = [0.0, 0.0, 3.0]' 'lifetime = 5.0' "${still[@]}")
fall=('[emitter]' 'point = [0.0, 100.0, 0.0]' 'velocity = [0.0, 0.0, 0.0]' "${still[@]}")

# warns PATTERN: --check prints this warning as one line on stderr and in JSON, but not with -q. Empty: no warning.
warns() {
    expect 0 "$relief_sim" scene.toml --check
    [ "$(wc -l <stderr)" -eq "$([ -z "$1" ] && echo 0 || echo 1)" ] || die "warned: $(cat stderr)"
    [ -z "$1" ] || grep -qE "^relief-sim: warning: $1" stderr || die "no warning '$1': $(cat stderr)"
    cp stderr warned
    expect 0 "$relief_sim" scene.toml --check --json
    json stdout "len(d['warnings']) == $(wc -l <warned)"
    expect 0 "$relief_sim" scene.toml --check -q
    [ ! -s stderr ] || die "-q warns: $(cat stderr)"
}

# Speed times dt, compared with the wall's thickness: 6 per second is 0.1 per step, 60 is 1.
scene "${jet[@]}" 'velocity = [0.0, 0.0, -6.0]'
warns ''
open=$'[collision]\nsweep = 0.0' # only the ends of a step are tested
scene "${jet[@]}" 'velocity = [0.0, 0.0, -60.0]' "$open"
warns "at a speed of 60 a step is 1 long, but 'metres\.relief' is typically 0\.(199|2) thick.*collision\.sweep = 0\.(0995|1),"
for cure in $'[collision]\nsweep = 0.1' $'[time]\ndt = 0.002' $'[[type]]\ncollides_with = ["ground"]'; do
    scene "${jet[@]}" 'velocity = [0.0, 0.0, -60.0]' "$cure"
    warns ''
done
# A scene without the key gets a sweep that stops them.
count_behind() { # the number of particles behind the wall after 20 steps
    "$relief_sim" scene.toml -q --steps 20 --dump out.ply || die 'relief-sim failed'
    python3 -c 'import ply; print(sum(each["z"] < -0.2 for each in ply.read("out.ply")))'
}
[ "$(count_behind)" -gt 0 ] || die 'no particle passes a wall thinner than a step, so nothing is tested'
scene "${jet[@]}" 'velocity = [0.0, 0.0, -60.0]'
warns ''
[ "$(count_behind)" -eq 0 ] || die 'particles pass a wall despite an automatic sweep'
# A sweep has at most 32 segments.
scene "${jet[@]}" 'velocity = [0.0, 0.0, -900.0]'
warns "at a speed of 900 a step is 0.4[0-9]* long, but 'metres\.relief' is typically 0\.[0-9]* thick: particles may pass through it; set a smaller time\.dt"
# A fall of 100 m ends at 44 m/s; drag lets it fall no faster than 9.81 / 2.5. At a hundredth of gravity it ends at 4.4 m/s.
scene '[forces]' 'gravity = [0.0, -9.81, 0.0]' 'drag = 0.0' "${fall[@]}" "$open"
warns 'at a speed of 44\.3 a step is 0\.738 long'
scene '[forces]' 'gravity = [0.0, -9.81, 0.0]' "${fall[@]}"
warns ''
scene '[forces]' 'gravity = [0.0, -9.81, 0.0]' 'drag = 0.0' "${fall[@]}" '[[type]]' 'gravity = 0.01'
warns ''
# One warning for all colliders; it names the thinnest.
scene "${jet[@]}" 'velocity = [0.0, 0.0, -60.0]' "$open"
sed -i 's/^\[collider\]$/[[collider]]/; 2a[[collider]]\nfile = "wall.relief"\nscale = 0.5\nposition = [0.0, 0.0, -5.0]' scene.toml
warns "at a speed of [0-9.]+ a step is 1[0-9.]* long, but 'wall\.relief' is typically 0\.(09|1|10|11)[0-9]* thick, the thinnest of 2 .*sweep = 0\.0[45]"

# Rejected births are known only after the run.
crowd=('[particles]' 'capacity = 100' '[time]' 'steps = 20' "${jet[@]}" 'velocity = [0.0, 0.0, -1.0]')
scene "${crowd[@]}" 'rate = 3000.0'
warns ''
expect 0 "$relief_sim" scene.toml --json
grep -qE '^relief-sim: warning: 900 of 1000 births .*particles\.capacity' stderr || die "no warning: $(cat stderr)"
json stdout 'len(d["warnings"]) == 1 and d["particles"]["rejected"] == 900'
scene "${crowd[@]}" 'rate = 300.0'
expect 0 "$relief_sim" scene.toml
[ ! -s stderr ] || die "warned: $(cat stderr)"
