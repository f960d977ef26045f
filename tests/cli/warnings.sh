# A scene that is valid and probably not meant is warned of, with the cure, and one that is meant is not.
. "$(dirname "$0")/lib.sh"

# A wall of 4 x 4 x 0.2, across z.
cat >wall.obj <<'O'
v -2 -2 -0.1
v 2 -2 -0.1
v 2 2 -0.1
v -2 2 -0.1
v -2 -2 0.1
v 2 -2 0.1
v 2 2 0.1
v -2 2 0.1
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 3 4 8 7
f 2 3 7 6
f 1 5 8 4
O
"$relief" bake wall.obj -o wall.relief --budget 60kB -q
"$relief" bake wall.obj -o metres.relief --budget 60kB --unit m -q

# scene FILE LINES…: what plays against it.
scene() {
    local collider=$1
    shift
    printf '[collider]\nfile = "%s"\n' "$collider" >scene.toml
    printf '%s\n' "$@" >>scene.toml
}
quiet_jet=('[forces]' 'gravity = [0.0, -9.81, 0.0]' 'drag = 0.0' '[emitter]' 'point = [0.0, 0.0, 3.0]' 'lifetime = 5.0')

# warns PATTERN: --check says just this, on standard error and as JSON; with -q nothing. An empty PATTERN: nothing at all.
warns() {
    expect 0 "$relief_sim" scene.toml --check
    grep -q 'is valid' stdout || die "said: $(cat stdout)"
    if [ -z "$1" ]; then
        [ ! -s stderr ] || die "warned: $(cat stderr)"
    else
        [ "$(wc -l <stderr)" -eq 1 ] && grep -qE "^relief-sim: warning: $1" stderr || die "not '$1': $(cat stderr)"
    fi
    cp stderr warned
    expect 0 "$relief_sim" scene.toml --check --json
    json stdout "len(d['warnings']) == $(wc -l <warned)"
    expect 0 "$relief_sim" scene.toml --check -q
    [ ! -s stderr ] || die "-q warns: $(cat stderr)"
}

# Speed times dt: 6 a second is 0.1 a step, 60 is 1.
scene metres.relief "${quiet_jet[@]}" 'velocity = [0.0, 0.0, -6.0]' 'velocity_spread = [0.0, 0.0, 0.0]'
warns ''
scene metres.relief "${quiet_jet[@]}" 'velocity = [0.0, 0.0, -60.0]' 'velocity_spread = [0.0, 0.0, 0.0]'
warns "at a speed of 60 a step is 1 long, and 'metres\.relief' mostly 0\.(19|2|20|21|22|23)[0-9]* thick.*collision\.sweep = 0\.1"
scene metres.relief "${quiet_jet[@]}" 'velocity = [0.0, 0.0, -60.0]' 'velocity_spread = [0.0, 0.0, 0.0]' '[collision]' 'sweep = 0.1'
warns ''
scene metres.relief "${quiet_jet[@]}" 'velocity = [0.0, 0.0, -60.0]' 'velocity_spread = [0.0, 0.0, 0.0]' '[time]' 'dt = 0.002'
warns ''
# A fall of 100 m ends at 44 m/s.
scene metres.relief '[forces]' 'gravity = [0.0, -9.81, 0.0]' 'drag = 0.0' '[emitter]' 'point = [0.0, 100.0, 0.0]' \
    'velocity = [0.0, 0.0, 0.0]' 'velocity_spread = [0.0, 0.0, 0.0]'
warns 'at a speed of 44\.3 a step is 0\.738 long'
# Drag lets it fall no faster than 9.81 / 2.5.
scene metres.relief '[forces]' 'gravity = [0.0, -9.81, 0.0]' '[emitter]' 'point = [0.0, 100.0, 0.0]' \
    'velocity = [0.0, 0.0, 0.0]' 'velocity_spread = [0.0, 0.0, 0.0]'
warns ''

# One line for all: the thinnest decides.
{
    printf '[[collider]]\nfile = "metres.relief"\n[[collider]]\nfile = "wall.relief"\nscale = 0.5\nposition = [0.0, 0.0, -5.0]\n'
    printf '%s\n' "${quiet_jet[@]}" 'velocity = [0.0, 0.0, -60.0]' 'velocity_spread = [0.0, 0.0, 0.0]'
} >scene.toml
warns "at a speed of [0-9.]+ a step is 1[0-9.]* long, and 'wall\.relief' mostly 0\.(09|1|10|11)[0-9]* thick, the thinnest of 2 such colliders: particles may pass through them; set collision\.sweep = 0\.0[45]"

# Refused: known after the run alone.
crowd=('[particles]' 'capacity = 100' '[time]' 'steps = 20' "${quiet_jet[@]}" 'velocity = [0.0, 0.0, -1.0]')
scene metres.relief "${crowd[@]}" 'rate = 3000.0'
warns ''
expect 0 "$relief_sim" scene.toml
grep -qE '^relief-sim: warning: 900 of 1000 births found no free place; raise particles\.capacity \(now 100\)' stderr ||
    die "said: $(cat stderr)"
expect 0 "$relief_sim" scene.toml --json
json stdout 'len(d["warnings"]) == 1 and d["particles"]["refused"] == 900'
expect 0 "$relief_sim" scene.toml -q
[ ! -s stderr ] || die "-q warns: $(cat stderr)"
scene metres.relief "${crowd[@]}" 'rate = 300.0'
expect 0 "$relief_sim" scene.toml
[ ! -s stderr ] || die "warned: $(cat stderr)"

# The scenes to copy from are meant.
expect 0 "$relief_sim" wall.relief --check
[ ! -s stderr ] || die "a collider alone is warned of: $(cat stderr)"

# A type that goes through the body is not warned of.
scene metres.relief "${quiet_jet[@]}" 'velocity = [0.0, 0.0, -60.0]' 'velocity_spread = [0.0, 0.0, 0.0]' '[[type]]' 'collides = ["ground"]'
warns ''
# Gravity by type: a fall of 100 m at a hundredth of it ends at 4.4 m/s.
scene metres.relief '[forces]' 'gravity = [0.0, -9.81, 0.0]' 'drag = 0.0' '[emitter]' 'point = [0.0, 100.0, 0.0]' \
    'velocity = [0.0, 0.0, 0.0]' 'velocity_spread = [0.0, 0.0, 0.0]' '[[type]]' 'gravity = 0.01'
warns ''
