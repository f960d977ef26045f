# Every mistake gets one clear line that names the file and the cure, and the right exit code; an older output stays as
# it was.
. "$(dirname "$0")/lib.sh"

cat >good.obj <<'O'
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 3 2
f 1 2 4
f 2 3 4
f 3 1 4
O
"$relief" bake good.obj -o good.relief --paper --resolution 16 -q
echo "precious" >old.relief

bake_fails() {
    local code=$1 pattern=$2
    shift 2
    expect_error "$code" "$pattern" "$relief" bake "$@"
    [ "$(cat old.relief)" = precious ] || die "an older output was touched: $*"
}

# Meshes.
bake_fails 2 'missing\.obj' missing.obj -o old.relief
bake_fails 2 'a folder|is a directory' . -o old.relief
echo hello >mesh.xyzzy
bake_fails 5 'mesh\.xyzzy' mesh.xyzzy -o old.relief
: >empty.obj
bake_fails 3 'empty\.obj' empty.obj -o old.relief
printf 'v 0 0 0\nv 1 0 0\nl 1 2\n' >lines.obj
bake_fails 3 'lines\.obj' lines.obj -o old.relief
printf 'v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >nan.obj
bake_fails 3 'nan\.obj' nan.obj -o old.relief
printf 'v 0 0 1e999\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >inf.obj
bake_fails 3 'inf\.obj' inf.obj -o old.relief
head -c 4096 /dev/urandom >garbage.ply
bake_fails 3 'garbage\.ply' garbage.ply -o old.relief
head -c 4096 /dev/urandom >garbage.glb
bake_fails 3 'garbage\.glb' garbage.glb -o old.relief
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n' >flat.obj
bake_fails 3 'flat\.obj' flat.obj -o old.relief

# Outputs.
bake_fails 2 'nowhere' good.obj -o nowhere/out.relief
bake_fails 2 'out_dir' good.obj -o out_dir/ 2>/dev/null || true
mkdir out_dir
bake_fails 2 'out_dir' good.obj -o out_dir
bake_fails 2 '/dev/full.*space' good.obj -o /dev/full
bake_fails 1 'output' good.obj

# Sizes, keys, options.
bake_fails 1 'size|resolution' good.obj -o old.relief --paper --resolution 0
bake_fails 6 '16384' good.obj -o old.relief --paper --resolution 16385
bake_fails 6 '16384' good.obj -o old.relief --map fixed8:size=20000
bake_fails 1 'size' good.obj -o old.relief --map fixed8:size=0
bake_fails 1 'size' good.obj -o old.relief --map fixed8:size=-4
bake_fails 1 "fixed8" good.obj -o old.relief --map fixd8
bake_fails 1 "compare" good.obj -o old.relief --map fixed8:comare=less
bake_fails 1 'less.*greater|greater.*less' good.obj -o old.relief --map fixed8:compare=lesser
bake_fails 1 'dir' good.obj -o old.relief --map fixed8:dir=0/0/0
bake_fails 1 'dir' good.obj -o old.relief --map fixed8:dir=up
bake_fails 1 'dir' good.obj -o old.relief --map cube:dir=+x
bake_fails 1 'compare' good.obj -o old.relief --map front-back:compare=less
bake_fails 1 'center' good.obj -o old.relief --map fixed8:center=0/0/0
bake_fails 1 'size' good.obj -o old.relief --map fixed8:size=4,size=8
bake_fails 1 'parallel' good.obj -o old.relief --map fixed8:dir=+x,up=-x
bake_fails 1 'decode.*plane' good.obj -o old.relief --map fixed8 --decode plain
bake_fails 1 'depth.*unorm16' good.obj -o old.relief --map front-back --depth 16
bake_fails 1 'resolution' good.obj -o old.relief --resolutoin 16
expect_error 1 'bake' "$relief" bkae good.obj
expect_error 1 '' "$relief"

# Containers: every verb that reads one.
head -c 1000 good.relief >truncated.relief
cp good.relief altered.relief
printf '\x55' | dd of=altered.relief bs=1 seek=700 conv=notrunc status=none
: >empty.relief
echo points >points.csv
echo "0,0,0" >points.csv
for file in truncated altered empty; do
    expect_error 3 "$file\.relief" "$relief" info $file.relief
    expect_error 3 "$file\.relief" "$relief" query $file.relief --points points.csv -o out.csv
    expect_error 3 "$file\.relief" "$relief" slice $file.relief --axis x --at 0 -o out.png
    expect_error 3 "$file\.relief" "$relief" export $file.relief -o out
    expect_error 3 "$file\.relief" "$relief_sim" $file.relief --steps 1
done
expect_error 2 'missing\.relief' "$relief" info missing.relief
expect_error 2 'missing\.relief' "$relief_sim" missing.relief
expect_error 3 'good\.obj' "$relief" info good.obj

# Points.
printf '0,0,0\n1,2\n' >short.csv
expect_error 3 'short\.csv:2' "$relief" query good.relief --points short.csv -o out.csv
printf '0,0,0\n1,2,x\n' >word.csv
expect_error 3 'word\.csv:2' "$relief" query good.relief --points word.csv -o out.csv
printf '0,nan,0\n' >nan.csv
expect_error 3 'nan\.csv:1' "$relief" query good.relief --points nan.csv -o out.csv
expect_error 2 'missing\.csv' "$relief" query good.relief --points missing.csv -o out.csv
expect_error 2 '/dev/full' "$relief" query good.relief --points points.csv -o /dev/full

# Slices and exports.
expect_error 1 'w' "$relief" slice good.relief --axis w --at 0 -o out.png
expect_error 1 'size' "$relief" slice good.relief --axis x --at 0 --size 0 -o out.png
expect_error 1 'png|exr' "$relief" slice good.relief --axis x --at 0 -o out.bmp
expect_error 2 'nowhere' "$relief" slice good.relief --axis x --at 0 -o nowhere/out.png
expect_error 2 'good\.obj' "$relief" export good.relief -o good.obj

# Scenes.
scene_fails() {
    local code=$1 pattern=$2
    printf '%s\n' "$3" >scene.toml
    expect_error "$code" "$pattern" "$relief_sim" scene.toml --steps 1
}
scene_fails 2 'scene\.toml.*missing\.relief|missing\.relief.*scene\.toml' $'[collider]\nfile = "missing.relief"'
scene_fails 3 'scene\.toml:3:1.*gravty' $'[collider]\nfile = "good.relief"\ngravty = 1'
scene_fails 3 'scene\.toml:4:' $'[collider]\nfile = "good.relief"\n[collision]\nrestitution = 7'
scene_fails 3 'scene\.toml:4:' $'[collider]\nfile = "good.relief"\n[collision]\nrestitution = "much"'
scene_fails 3 'scene\.toml:2:' $'[collider]\nfile = '
expect_error 2 'missing\.toml' "$relief_sim" missing.toml
expect_error 1 'steps' "$relief_sim" good.relief --steps -1
expect_error 1 'size' "$relief_sim" good.relief --steps 1 --frames frames --size 0x10
expect_error 6 '[0-9]{4,}' "$relief_sim" good.relief --steps 1 --frames frames --size 99999x99999
expect_error 2 'good\.obj' "$relief_sim" good.relief --steps 1 --frames good.obj
expect_error 2 '/dev/full' "$relief_sim" good.relief --steps 1 --dump /dev/full

# --- inputs that would wait for ever, and inputs that an output would destroy ---

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
[ "$code" -eq 2 ] && grep -q "waits.toml.*it is a pipe" stderr || die "a scene that is a pipe: $code, $(cat stderr)"

mkdir refers && cd refers
cp /usr/share/assimp/models/glTF2/BoxTextured-glTF/BoxTextured* .
printf 'newmtl m\n' >m.mtl
printf 'mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n' >m.obj
sha256sum ./* >before
for outputs in "-o BoxTextured0.bin" "-o x.relief --plan-out BoxTextured0.bin" "-o x.relief --depfile BoxTextured0.bin"; do
    # shellcheck disable=SC2086
    expect 1 "$relief" bake BoxTextured.gltf $outputs -q
    grep -q "'BoxTextured0.bin' is the input" ../stderr || die "a buffer as an output: $(cat ../stderr)"
done
expect 1 "$relief" bake m.obj -o m.mtl -q
sha256sum --quiet -c before || die "an input was destroyed"
[ ! -e x.relief ] || die "half of a bake was written"
cd ..
