# What is easily mixed up is named, with the cure: meshes given as colliders, planes beside the object, several files at
# once.
. "$(dirname "$0")/lib.sh"

cat >box.obj <<'O'
v -1 -2 -3
v 1 -2 -3
v 1 2 -3
v -1 2 -3
v -1 -2 3
v 1 -2 3
v 1 2 3
v -1 2 3
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 3 4 8 7
f 2 3 7 6
f 1 5 8 4
O
"$relief" bake box.obj -o box.relief --map cube:size=16 -q

# A mesh where a collider is needed.
bake_first="'box\.obj' is a mesh, and no collider; bake it first: relief bake 'box\.obj' -o 'box\.relief'"
printf '0,0,0\n' >points.csv
expect_error 3 "$bake_first" "$relief" info box.obj
expect 3 "$relief" check box.obj
grep -q "^RLF-1002 fatal" stdout && grep -qE "$bake_first" stderr || die "check of a mesh: $(cat stdout stderr)"
expect_error 3 "$bake_first" "$relief" check box.obj --mesh box.obj
expect_error 3 "$bake_first" "$relief" slice box.obj -o s.png
expect_error 3 "$bake_first" "$relief" export box.obj -o maps
expect_error 3 "$bake_first" "$relief" query box.obj --points points.csv -o out.csv
expect_error 3 "$bake_first" "$relief" view box.obj -o page.html
expect_error 3 "$bake_first" "$relief_sim" box.obj --check
printf '[collider]\nfile = "box.obj"\n' >scene.toml
expect_error 3 "scene\.toml'?:2.*collider\.file: '.*box\.obj' is a mesh.*relief bake '.*box\.obj' -o '.*box\.relief'" \
    "$relief_sim" scene.toml --check
cp box.obj BOX.OBJ
expect_error 3 "'BOX\.OBJ' is a mesh.*-o 'BOX\.relief'" "$relief" info BOX.OBJ
# Contents count more than a name; a missing mesh is missing, and other files stay what they were.
cp box.relief collider.ply
expect 0 "$relief" info collider.ply
expect_error 2 'missing\.obj' "$relief" info missing.obj
expect_error 3 'no \.relief container' "$relief" info points.csv

# A plane beside the object is drawn, and said to be beside it; the edges of the box belong to it.
expect 0 "$relief" slice box.relief --axis x --at 1.5 --size 16 -o far.png
grep -qF "warning: 'box.relief': --at 1.5 lies outside of the collider's box, which goes from x = -1 to 1;" stderr ||
    die "said: $(cat stderr)"
[ -s far.png ] || die "no picture"
expect 0 "$relief" slice box.relief --axis y --at -3 --size 16 -o far.png
grep -q 'from y = -2 to 2' stderr || die "said: $(cat stderr)"
for at in "x -1" "z 3" "y center"; do
    expect 0 "$relief" slice box.relief --axis ${at% *} --at ${at#* } --size 16 -o near.png
    [ ! -s stderr ] || die "said of --at $at: $(cat stderr)"
done

# Lists of options: a line for each in `info`. Help is no wider than 120 columns.
"$relief" bake box.obj -o maps.relief --map cube:size=16 --map fixed8:dir=-y,size=16 --quality fast -q
expect 0 "$relief" info maps.relief
grep -qx 'baked    by relief [0-9.]* with' stdout || die "said: $(cat stdout)"
grep -qE '^         --map cube:[^ ]*$' stdout || die "options are not folded: $(cat stdout)"
grep -qx '         --quality fast' stdout || die "options are not folded: $(cat stdout)"
for help in "$relief --help" "$relief_sim --help" $(for v in bake check info query slice view export; do echo "$relief $v --help" | tr ' ' '~'; done); do
    expect 0 ${help//\~/ }
    ! awk 'length > 120 && !/^  relief/' stdout | grep . || die "too wide: $help"
done

# The box with its unit; a unit that was probably forgotten is named with what it would make, once it is said no more.
expect 0 "$relief" bake box.obj -o unit.relief --map cube:size=16
grep -qx 'box 2 x 4 x 6 object units, from (-1, -2, -3) to (1, 2, 3)' stderr || die "said: $(cat stderr)"
! grep -q 'warning' stderr || die "said: $(cat stderr)"
awk '/^v / { $2 *= 30; $3 *= 30; $4 *= 30 } { print }' box.obj >large.obj
expect 0 "$relief" bake large.obj -o unit.relief --map cube:size=16 --json
grep -qF 'large.obj: no unit is named, and the box is 60 x 120 x 180: with --unit cm 0.6 x 1.2 x 1.8 m, with --unit mm 0.06 x 0.12 x 0.18 m; say which, or --unit m if these are metres' stderr ||
    die "said: $(cat stderr)"
json stdout 'any("no unit is named" in w for w in d["warnings"])'
for unit in cm mm m; do
    expect 0 "$relief" bake large.obj -o unit.relief --map cube:size=16 --unit $unit
    ! grep -q 'warning' stderr || die "said with $unit: $(cat stderr)"
    grep -qE '^box [0-9.]+ x [0-9.]+ x [0-9.]+ m, from' stderr || die "said with $unit: $(cat stderr)"
done
