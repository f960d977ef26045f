# SPDX-License-Identifier: Apache-2.0
# Invalid calls and hostile files: one line names the option or file, the exit code is as documented, and existing
# outputs are unchanged. Unit tests cover which values and files are rejected; this script covers every code, verb and
# kind of file once.
. "$(dirname "$0")/lib.sh"

tetrahedron good.obj
"$relief" bake good.obj -o good.relief --paper --resolution 16 -q
echo precious >old.relief
echo '0,0,0' >points.csv

bake_fails() { # CODE PATTERN ARGUMENT…
    expect_error "$1" "$2" "$relief" bake "${@:3}"
    [ "$(cat old.relief)" = precious ] || die "an existing output was changed: ${*:3}"
}

# Meshes.
bake_fails 2 'missing\.obj' missing.obj -o old.relief
bake_fails 2 'folder|directory' . -o old.relief
echo hello >mesh.xyzzy
printf 'PK\3\4' >box.3mf
: >empty.obj
printf 'v 0 0 0\nv 1 0 0\nl 1 2\n' >lines.obj
printf 'v 0 0 1e999\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >inf.obj
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n' >flat.obj
head -c 4096 /dev/urandom >garbage.ply
head -c 4096 /dev/urandom >garbage.glb
for mesh in mesh.xyzzy box.3mf; do bake_fails 5 "$mesh" $mesh -o old.relief; done
for mesh in empty.obj lines.obj inf.obj flat.obj garbage.ply garbage.glb; do bake_fails 3 "$mesh" $mesh -o old.relief; done

# Outputs.
mkdir out_dir
bake_fails 2 nowhere good.obj -o nowhere/out.relief
bake_fails 2 out_dir good.obj -o out_dir
bake_fails 2 /dev/full good.obj -o /dev/full
expect_error 2 /dev/full "$relief" query good.relief --points points.csv -o /dev/full
expect_error 2 nowhere "$relief" slice good.relief --axis x --at 0 -o nowhere/out.png
expect_error 2 'good\.obj' "$relief" export good.relief -o good.obj
expect_error 2 'good\.obj' "$relief_sim" good.relief --steps 1 --frames good.obj
expect_error 2 /dev/full "$relief_sim" good.relief --steps 1 --dump /dev/full

# Options.
bake_fails 6 16384 good.obj -o old.relief --map fixed8:size=20000
bake_fails 1 resolution good.obj -o old.relief --resolutoin 16
bake_fails 1 holes good.obj -o old.relief --holes fill
expect_error 1 bake "$relief" bkae good.obj
expect_error 1 '' "$relief"
expect_error 1 'png or .exr' "$relief" slice good.relief --axis x --at 0 -o out.bmp
expect_error 1 axis "$relief" slice good.relief --axis w --at 0 -o out.png
expect_error 1 steps "$relief_sim" good.relief --steps -1
expect_error 6 99999 "$relief_sim" good.relief --steps 1 --frames frames --size 99999x99999

# Containers: every verb that reads them.
head -c 1000 good.relief >truncated.relief
cp good.relief altered.relief
printf '\x55' | dd of=altered.relief bs=1 seek=700 conv=notrunc status=none
: >empty.relief
for file in truncated altered empty; do
    expect_error 3 "$file\.relief" "$relief" info $file.relief
    expect_error 3 "$file\.relief" "$relief" query $file.relief --points points.csv -o out.csv
    expect_error 3 "$file\.relief" "$relief" slice $file.relief --axis x --at 0 -o out.png
    expect_error 3 "$file\.relief" "$relief" export $file.relief -o out
    expect_error 3 "$file\.relief" "$relief_sim" $file.relief --check
done
expect_error 2 'missing\.relief' "$relief" info missing.relief
expect_error 2 'missing\.relief' "$relief_sim" missing.relief

# A mesh in place of a collider: each verb suggests the bake. The contents matter, not the name.
bake_first="'good\.obj' is a mesh.*relief bake 'good\.obj' -o 'good\.relief'"
expect_error 3 "$bake_first" "$relief" info good.obj
expect 3 "$relief" check good.obj
grep -q '^RLF-1002 fatal' stdout && grep -qE "$bake_first" stderr || die "check of a mesh: $(cat stdout stderr)"
expect_error 3 "$bake_first" "$relief" check good.obj --mesh good.obj
expect_error 3 "$bake_first" "$relief" slice good.obj -o s.png
expect_error 3 "$bake_first" "$relief" export good.obj -o maps
expect_error 3 "$bake_first" "$relief" query good.obj --points points.csv -o out.csv
expect_error 3 "$bake_first" "$relief" view good.obj -o page.html
expect_error 3 "$bake_first" "$relief_sim" good.obj --check
cp good.relief collider.ply
expect 0 "$relief" info collider.ply

# Points and scenes.
printf '0,0,0\n1,2\n' >short.csv
expect_error 3 'short\.csv:2' "$relief" query good.relief --points short.csv -o out.csv
expect_error 2 'missing\.csv' "$relief" query good.relief --points missing.csv -o out.csv
scene_fails() { # CODE PATTERN TEXT
    printf '%s\n' "$3" >scene.toml
    expect_error "$1" "scene\.toml:$2" "$relief_sim" scene.toml --steps 1
}
scene_fails 2 '2:8.*missing\.relief' $'[collider]\nfile = "missing.relief"'
scene_fails 3 '2:8.*good\.obj' $'[collider]\nfile = "good.obj"'
scene_fails 3 '3:1.*gravty' $'[collider]\nfile = "good.relief"\ngravty = 1'
scene_fails 3 '4:.*restitution' $'[collider]\nfile = "good.relief"\n[collision]\nrestitution = 7'
scene_fails 3 '2:' $'[collider]\nfile = '
expect_error 2 'missing\.toml' "$relief_sim" missing.toml

# Files that would block forever.
mkfifo waits.obj waits.relief waits.toml
for command in "bake waits.obj -o w.relief" "info waits.relief" "check waits.relief" "query waits.relief --points 0/0/0" \
    "bake --recipe waits.toml"; do
    code=0
    # shellcheck disable=SC2086
    timeout 20 "$relief" $command >/dev/null 2>stderr || code=$?
    [ "$code" -ge 1 ] && [ "$code" -le 5 ] || die "relief $command: exit code $code, $(cat stderr)"
done
code=0
timeout 20 "$relief_sim" waits.toml >/dev/null 2>stderr || code=$?
[ "$code" -eq 2 ] && grep -q waits.toml stderr || die "a pipe as scene: $code, $(cat stderr)"

# For every verb, help starts with an example and is at most 120 columns wide.
for command in "$relief" "$relief_sim" "$relief bake" "$relief info" "$relief check" "$relief query" "$relief slice" "$relief view" "$relief export"; do
    # shellcheck disable=SC2086
    expect 0 $command --help
    head -8 stdout | matches "${command#"$RELIEF_BIN"/} " || die "help of $command does not start with an example"
    ! awk 'length > 120 && !/^  relief/' stdout | grep . || die "too wide: $command --help"
done
expect 0 "$relief" --version
grep -qE '[0-9]+\.[0-9]+\.[0-9]+' stdout || die "no version"
