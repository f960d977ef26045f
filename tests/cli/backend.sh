# `relief bake --backend`: which backend bakes, what the report and the container say about it, and what happens without
# OpenGL.
. "$(dirname "$0")/lib.sh"

maps=(--map front-back:size=96,dir=-x --map float:size=64,decode=projected --map cube:size=48)
"$relief" bake "$bunny" -o rays.relief -q --quality fast "${maps[@]}"
expect 0 "$relief" bake "$bunny" -o raster.relief --json --backend raster "${maps[@]}"
mv stdout raster.json
json raster.json "d['settings']['backend'] == 'raster' and d['settings']['device'] and d['times_ms']['raster'] > 0"
json raster.json "d['settings']['quality'] == 'fast' and d['times_ms']['trace'] == 0"
"$relief" info raster.relief | matches -- '--backend raster' || die "the container does not say who baked it"
cmp -s rays.relief raster.relief && die "both bakes are the same to the byte: the GPU was not asked"
# The rasterizer is as accurate as one ray per texel, on the bunny's own points.
for name in rays raster; do
    "$relief" check $name.relief --mesh "$bunny" --json >$name.check.json
done
python3 - <<'P' || die "the GPU's collider is worse than the rays'"
import json
rays, raster = (json.load(open(f'{n}.check.json'))['accuracy']['near']['wrong_percent'] for n in ('rays', 'raster'))
print(f'near the surface: rays {rays:.3f} %, raster {raster:.3f} %')
raise SystemExit(0 if 0 < raster < 1.25 * rays else 1)
P

# The paper's maps, and a plan of quality fast.
expect 0 "$relief" bake "$bunny" -o paper.relief --paper --resolution 32 --backend raster
expect 0 "$relief" bake "$bunny" -o planned.relief --budget 20kB --quality fast --plan-out plan.toml
expect 0 "$relief" bake "$bunny" -o again.relief --plan plan.toml --backend raster
sed -i 's/^quality.*/quality = "normal"/' plan.toml
expect_error 1 'quality normal.*--quality fast' "$relief" bake "$bunny" -o x.relief --plan plan.toml --backend raster
expect 0 "$relief" bake "$bunny" -o again.relief --plan plan.toml --quality fast --backend raster

# Options that need rays are refused, and the message names the cure.
expect_error 1 "'vulkan'.*raycast" "$relief" bake "$bunny" -o x.relief --backend vulkan "${maps[@]}"
expect_error 1 'did you mean' "$relief" bake "$bunny" -o x.relief --backend rastr "${maps[@]}"
expect_error 1 'planning.*--map' "$relief" bake "$bunny" -o x.relief --backend raster
expect_error 1 '--quality best.*--quality fast' \
    "$relief" bake "$bunny" -o x.relief --backend raster --quality best "${maps[@]}"
expect_error 1 '--prefer inside.*leave --prefer out' \
    "$relief" bake "$bunny" -o x.relief --backend raster --prefer inside "${maps[@]}"
[ ! -e x.relief ] || die "a failed bake left a file"

# auto says what it chose and why: rays for planned maps, on every machine.
expect 0 "$relief" bake "$bunny" -o auto.relief --backend auto --budget 20kB --quality fast
grep -q 'backend raycast: planning' stderr || die "auto does not say why"
cmp auto.relief planned.relief || die "auto planned other maps"
expect 0 "$relief" bake "$bunny" -o auto.relief --backend auto --json "${maps[@]}"
json stdout "d['settings']['backend'] in ('raycast', 'raster') and 'OpenGL' in d['settings']['backend_reason']"

# Without any OpenGL.
mkdir none
without_gl=(env __EGL_VENDOR_LIBRARY_DIRS="$work/none" __EGL_VENDOR_LIBRARY_FILENAMES=)
expect_error 5 '--backend raster: .*OpenGL.*raycast' \
    "${without_gl[@]}" "$relief" bake "$bunny" -o x.relief --backend raster "${maps[@]}"
expect 0 "${without_gl[@]}" "$relief" bake "$bunny" -o bare.relief -q --quality fast "${maps[@]}"
cmp bare.relief rays.relief || die "the ray caster's bytes depend on the OpenGL"
expect 0 "${without_gl[@]}" "$relief" bake "$bunny" -o bare.relief --backend auto --quality fast "${maps[@]}"
grep -q 'backend raycast: no OpenGL' stderr || die "auto does not say that there is no OpenGL"
cmp bare.relief rays.relief || die "auto without an OpenGL is not the ray caster"
# Only rays find what lies between solids.
expect 1 "$relief" bake "$bunny" -o gaps.relief --backend raster --map front-back:compare=gap
matches 'leave out compare=gap' < stderr
expect 0 "$relief" bake "$bunny" -o gaps.relief --backend auto --map front-back:size=16 --map front-back:compare=gap,size=16 -q
