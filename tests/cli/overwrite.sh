# No tool writes over what it reads, nor two outputs into one file: by the same name, a symbolic link, or a hard one.
. "$(dirname "$0")/lib.sh"

{ echo 'mtllib box.mtl' && cat "$models/OBJ/box.obj"; } >box.obj
printf 'newmtl a\nKd 1 0 0\n' >box.mtl
"$relief" bake box.obj -o box.relief --map cube:size=16 -q
echo '0,1,0' >points.csv
python3 -c "import struct; open('flow.raw', 'wb').write(struct.pack('<24f', *range(24)))"
convert -size 4x4 xc:red atlas.png
cat >scene.toml <<'T'
[time]
steps = 4
[[collider]]
file = "box.relief"
[[collider]]
mesh = "box.obj"
deform = { amplitude = 0.1, frequency = 2 }
resolution = 16
[particles]
capacity = 100
[emitter]
shape = "points"
points = "points.csv"
rate = 10
[flow]
raw = "flow.raw"
size = [2, 2, 2]
components = 3
box_min = [-1, -1, -1]
box_max = [1, 1, 1]
[[type]]
cell = 0
[render]
atlas = "atlas.png"
size = [16, 16]
every = 2
T
printf '[collider]\nfile = "box.relief"\n[render]\nmesh = "box.obj"\n' >drawn.toml
inputs=(scene.toml box.relief box.obj points.csv flow.raw atlas.png)
expect 0 "$relief_sim" scene.toml --check
sha256sum "${inputs[@]}" box.mtl >before
# kept COMMAND…: refused as a usage error, in one line that names the cure, and no file has changed.
kept() { # PATTERN COMMAND…
    expect_error 1 "$@"
    sha256sum --quiet -c before || die "an input is lost: $*"
}

# Every output of relief-sim, onto every file that the scene names.
mkdir frames
for input in "${inputs[@]}"; do
    ln -s "../$input" "frames/frame_0001.png"
    kept "frames/frame_0001\.png' is the input '$input'; choose another place for --frames" "$relief_sim" scene.toml --frames frames
    rm frames/*
    ln "$input" frames/particles_0000.ply
    kept "particles_0000\.ply' is the input '$input'" "$relief_sim" scene.toml --dump-frames frames
    rm frames/*
    ln -s "$input" symbolic && ln "$input" hard
    for option in dump events; do
        kept "'$input' is the input.*--$option" "$relief_sim" scene.toml --$option "$input"
        kept "'symbolic' is the input '$input'.*--$option" "$relief_sim" scene.toml --$option symbolic
    done
    kept "'hard' is the input '$input'" "$relief_sim" scene.toml --events hard
    rm symbolic hard
done
kept "'box.obj' is the input.*--dump" "$relief_sim" drawn.toml --dump box.obj
kept "'box.relief' is the input" "$relief_sim" box.relief --dump box.relief
cp atlas.png frames/frame_0002.png
sed 's|"atlas.png"|"frames/frame_0002.png"|' scene.toml >framed.toml
kept "frame_0002\.png' is the input" "$relief_sim" framed.toml --first-frame 0 --frames frames
expect 0 "$relief_sim" framed.toml --frames frames -q # two frames: that number is not written

# Two outputs of one name, one of them a frame, a folder, or standard output.
ln -s fresh dangling
kept '--dump and --events would both write' "$relief_sim" scene.toml --dump x --events ./x
kept '--dump and --events would both write' "$relief_sim" scene.toml --dump fresh --events dangling
kept '--dump and --frames would both write' "$relief_sim" scene.toml --dump frames/frame_0001.png --frames frames
kept '--dump and --frames would both write' "$relief_sim" scene.toml --dump new --frames new
kept '--json and --dump would both write standard output' "$relief_sim" scene.toml --dump - --json
code=0
"$relief_sim" scene.toml --events shared >shared 2>stderr </dev/null || code=$?
[ "$code" -eq 1 ] && grep -q 'the report' stderr || die "the report and --events share a file: $code, $(cat stderr)"
kept "--dump and --events would both write '/dev/stdout'" "$relief_sim" scene.toml --dump - --events /dev/stdout
[ ! -e fresh ] && [ ! -e x ] && [ ! -e new ] || die "something was written"

# Every verb of relief, a mesh's material, and a file behind standard input.
cp box.relief slice.png
kept "'slice.png' is the input" "$relief" slice slice.png -o slice.png
cmp slice.png box.relief || die "slice has replaced its input"
echo '<script type="application/json" id="relief-page-data">null</script>' >page.html
export RELIEF_VIEW_PAGE=$work/page.html
kept "'box.mtl' is the input" "$relief" check box.relief --mesh box.obj --samples 50 --html box.mtl
kept "'box.mtl' is the input" "$relief" view box.relief --mesh box.obj -o box.mtl
kept "'box.mtl' is the input" "$relief" bake box.obj -o new.relief --depfile box.mtl --map cube:size=16
kept '--json and -o would both write standard output' "$relief" bake box.obj -o - --json
kept "'points.csv' is the input standard input" sh -c "'$relief' query box.relief --points - -o points.csv <points.csv"
mkdir maps
ln -s ../box.relief maps/map0_cube_+x.exr
kept "is the input 'box.relief'; choose another place for -o" "$relief" export box.relief -o maps
ln -s ../box.relief maps/gpu.json
kept "gpu\.json' is the input 'box.relief'.*--gpu" "$relief" export box.relief --gpu maps

# A recipe: what its meshes refer to, its cache, other shards.
printf 'version = 1\n[[asset]]\nmesh = "box.obj"\noutput = "{stem}.new.relief"\nmap = "cube:size=16"\n' >r.toml
sha256sum r.toml >>before
kept "'box.mtl' holds no events" "$relief" bake --recipe r.toml --events box.mtl
for option in --events --stamp --depfile; do
    kept "'box.obj' is the input" "$relief" bake --recipe r.toml $option box.obj --shard 1/2
    kept "'box.obj' is the input" "$relief" bake --recipe r.toml $option box.obj --shard 2/2
done
cp r.toml .relief-cache.json
kept 'is the recipe.s cache' "$relief" bake --recipe .relief-cache.json
cmp r.toml .relief-cache.json || die "a recipe is lost to its cache"
rm .relief-cache.json
kept "'box.mtl' is the input" "$relief" bake --recipe r.toml --stamp box.mtl -q
mkdir elsewhere
echo precious >elsewhere/precious
rm -f .relief-cache.json
ln -s elsewhere/precious .relief-cache.json
expect 0 "$relief" bake --recipe r.toml
grep -q 'not a regular file; everything is baked again' stderr || die "a cache that is a link: $(cat stderr)"
[ "$(cat elsewhere/precious)" = precious ] && [ ! -L .relief-cache.json ] || die "the cache follows a link"
