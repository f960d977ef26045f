# SPDX-License-Identifier: Apache-2.0
# GPU devices: selected, missing, and hanging.
. "$(dirname "$0")/lib.sh"

"$relief" bake "$bunny" -o bunny.relief -q --paper --resolution 32

# --device selects a device; a missing device is an error.
number=0
until "$relief_sim" bunny.relief --steps 0 --device "$number" --json 2>stderr | grep -q llvmpipe; do
    grep -q 'there is no device' stderr && die "llvmpipe is not a device"
    number=$((number + 1))
done
expect 0 "$relief_sim" bunny.relief --steps 3 --device "$number" --json
json stdout 'd["device"].endswith(", device '"$number"'")'
expect 0 "$relief_sim" bunny.relief --steps 3 --device "$number" --api gles --json
expect_error 1 'no device 97.*EGL has [1-9]' "$relief_sim" bunny.relief --steps 3 --device 97
expect_error 1 '--device is .first. but must be the index of a device' "$relief_sim" bunny.relief --steps 3 --device first
expect_error 1 'gpu-timeout.*seconds' "$relief_sim" bunny.relief --steps 3 --gpu-timeout soon
expect_error 1 'gpu-timeout.*seconds' "$relief_sim" bunny.relief --steps 3 --gpu-timeout -1
expect_error 1 'excludes' "$relief_sim" bunny.relief --check --device 0

# Without a driver, EGL or GL library: one line and exit code 5. Commands that need no GPU still work.
mkdir no_egl no_gl
: >no_egl/libEGL.so.1
: >no_gl/libOpenGL.so.0
: >no_gl/libGL.so.1
for missing in __EGL_VENDOR_LIBRARY_DIRS=/nonexistent LD_LIBRARY_PATH=no_egl LD_LIBRARY_PATH=no_gl; do
    expect_error 5 'no OpenGL 3.3 context.*install' env $missing "$relief_sim" bunny.relief --steps 3
    expect 0 env $missing "$relief" bake "$bunny" -o again.relief -q --paper --resolution 32
    cmp bunny.relief again.relief || die "the collider differs without a GPU"
    rm again.relief
done
grep -q libopengl0 <(LD_LIBRARY_PATH=no_gl "$relief_sim" bunny.relief --steps 3 2>&1) || die "the GL package is not named"
expect_error 1 'EGL has 0' env __EGL_VENDOR_LIBRARY_DIRS=/nonexistent "$relief_sim" bunny.relief --steps 3 --device 0

# A hanging GPU: the watchdog reports the stalled operation, and no incomplete file is left.
stalled=(env LD_PRELOAD="$RELIEF_BIN/librelief-test-stall.so"
    ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}verify_asan_link_order=0")
mkdir empty
# The limit also covers work before the stall: contexts and shaders on a busy machine.
stall_fails() { # WHERE PATTERN COMMAND…
    expect_error 4 "the GPU has not finished $2 within 5 seconds.*--gpu-timeout" \
        "${stalled[@]}" RELIEF_TEST_STALL="$1" "${@:3}" --gpu-timeout 5
}
stall_fails wait 'steps 1 to 10' "$relief_sim" bunny.relief --frames empty --size 16x16 --dump empty/x.ply --dump-frames empty/d
stall_fails read 'picture 0' "$relief_sim" bunny.relief --frames empty --size 16x16 --dump empty/x.ply
[ -z "$(find empty -type f)" ] || die "left behind: $(find empty -type f)"

# Without a limit the watchdog stays silent: `timeout` ends the run.
code=0
timeout 2 "${stalled[@]}" RELIEF_TEST_STALL=wait "$relief_sim" bunny.relief --steps 3 --gpu-timeout 0 >stdout 2>stderr || code=$?
[ "$code" -eq 124 ] || die "exit code $code instead of an endless wait"
