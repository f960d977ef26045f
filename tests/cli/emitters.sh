# SPDX-License-Identifier: Apache-2.0
# Files of runs that start before time 0, of frame ranges, and of emitters. Unit tests cover the births themselves.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o bunny.relief --paper --resolution 64 -q
scene() { # LINES…: an emitter whose particles hit nothing
    printf '%s\n' '[[collider]]' 'file = "bunny.relief"' 'position = [0.0, -50.0, 0.0]' "$@" '[particles]' 'capacity = 4000' \
        '[forces]' 'gravity = [0.0, 0.0, 0.0]' 'drag = 0.0' '[ground]' 'enabled = false' '[render]' 'size = [64, 48]' 'first_frame = 0' 'steps_per_frame = 64'
}

# Prewarm gives the particles of a longer run at the time of a shorter one. Hits before time 0 are not written.
fall=('[emitter]' 'rate = 300.0' 'point = [0.0, 1.0, 0.0]' 'seed = 7' 'lifetime = [0.2, 0.9]')
scene '[time]' 'dt = 0.0078125' 'steps = 192' "${fall[@]}" >long.toml
scene '[time]' 'dt = 0.0078125' 'steps = 128' 'prewarm = 0.5' "${fall[@]}" >warm.toml
expect 0 "$relief_sim" long.toml -q --dump-frames long
expect 0 "$relief_sim" warm.toml -q --dump-frames warm
[ "$(ls long | xargs)" = "$(printf 'particles_%04d.ply\n' 0 1 2 3 | xargs)" ] || die "frames: $(ls long)"
for i in 0 1 2; do
    cmp "warm/particles_000$i.ply" "long/particles_000$((i + 1)).ply" || die "prewarmed frame $i differs"
done
printf '%s\n' '[collider]' 'file = "bunny.relief"' 'position = [0, -50, 0]' '[time]' 'dt = 0.0078125' 'steps = 64' 'prewarm = 1.0' '[emitter]' \
    'burst = 100' 'rate = 0.0' 'box_min = [-1.0, 1.0, -1.0]' 'box_max = [1.0, 1.5, 1.0]' 'velocity = [0.0, -4.0, 0.0]' '[ground]' 'height = 0.0' \
    '[[type]]' 'on_collision = "stop"' >hits.toml
expect 0 "$relief_sim" hits.toml -q --events hits.jsonl
[ ! -s hits.jsonl ] || die "hits before time 0 are written: $(head -1 hits.jsonl)"

# Frames in a range of steps.
expect 0 "$relief_sim" long.toml -q --dump-frames all --first-frame 0 --steps-per-frame 1
expect 0 "$relief_sim" long.toml -q --dump-frames some --first-frame 10 --last-frame 25 --steps-per-frame 7 --frames pictures
[ "$(ls all | wc -l)" -eq 193 ] && [ "$(ls some | wc -l)" -eq 4 ] && [ "$(ls pictures | wc -l)" -eq 4 ] || die "steps 10, 17, 24 and 25: $(ls some pictures)"
i=0
for step in 10 17 24 25; do
    cmp "some/particles_000$i.ply" "$(printf 'all/particles_%04d.ply' $step)" || die "frame $i is not that of step $step"
    i=$((i + 1))
done
expect_error 1 '--first-frame' "$relief_sim" long.toml --first-frame 3
expect_error 1 '--last-frame' "$relief_sim" long.toml --frames f --first-frame 3 --last-frame 2
[ ! -e f ] || die "a rejected run created its folder"

# A mesh file of an emitter is an input of the scene.
tetrahedron t.obj
"$relief" bake t.obj -q -o t.relief
printf '%s\n' '[[collider]]' 'file = "t.relief"' '[[emitter]]' 'shape = "surface"' 'attach = 0' 'mesh = "t.obj"' >sparks.toml
expect 0 "$relief_sim" sparks.toml --check
matches "mesh '.*t.obj'" <stdout || die "--check does not mention the surface: $(cat stdout)"
sed -i 's/t.obj/absent.obj/' sparks.toml
expect_error 2 "absent.obj" "$relief_sim" sparks.toml -q
