#!/usr/bin/env bash
# Long runs, for a night and not for CI: scripts/soak.sh [sweep|rest|bytes|outputs]… (all). Ends with 0 if all hold.
#
#   sweep   a million particles take a thousand swept steps in a closed hollow box, and none gets out; without the
#           sweep most do. In OpenGL 3.3 and in OpenGL ES 3.0. An hour or so on llvmpipe.
#   rest    snow falls on the bunny: after it has come to rest, no bit of a position changes from step 5,000 to step
#           100,000 (RELIEF_SOAK_SETTLED and RELIEF_SOAK_STEPS say others).
#   bytes   204 bakes of ten meshes under all that must not matter give one hash each (scripts/determinism.sh)
#   outputs 20 rounds of kills, errors, signals and eight writers leave no torn file (scripts/all_or_nothing.sh)
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
runs=("$@")
[ ${#runs[@]} -gt 0 ] || runs=(sweep rest bytes outputs)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

sweep() {
    local bin status=0
    bin=$(scripts/build.sh release relief_collision_gl_test) || return 1
    RELIEF_SOAK=1 "$bin/relief_collision_gl_test" --gtest_filter='*ASweptStepNeverTunnels*' \
        --gtest_output="json:$work/sweep.json" >"$work/sweep.log" || status=$?
    [ "$status" = 0 ] || cat "$work/sweep.log" >&2
    python3 - "$work/sweep.json" <<'P'
import json, sys
tests = [test for suite in json.load(open(sys.argv[1]))['testsuites'] for test in suite['testsuite']]
for test in tests:
    print(f"sweep: {test['name']}: {'FAILED' if 'failures' in test else 'none lost'}; 1000000 particles, 1000 steps, "
          f"{test.get('collisions', '?')} contacts; {test['time']}; {test.get('context', '')}")
sys.exit(0 if tests else 'sweep: no such test')
P
    return "$status"
}

rest() {
    local bin
    bin=$(scripts/build.sh release relief relief-sim) || return 1
    "$bin/relief" bake /usr/share/glmark2/models/bunny.obj -o "$work/bunny.relief" -q || return 1
    cat >"$work/rest.toml" <<'T'
[collider]
file = "bunny.relief"
[particles]
capacity = 10000
[emitter]
burst = 10000
rate = 0.0
lifetime = 10000.0
T
    # The same scene gives the same particles, so that two runs are one that was looked at twice.
    local steps
    for steps in "${RELIEF_SOAK_SETTLED:-5000}" "${RELIEF_SOAK_STEPS:-100000}"; do
        "$bin/relief-sim" "$work/rest.toml" --steps "$steps" --dump "$work/$steps.ply" -q || return 1
    done
    python3 - "$work" "${RELIEF_SOAK_SETTLED:-5000}" "${RELIEF_SOAK_STEPS:-100000}" <<'P'
import struct, sys
work, settled, steps = sys.argv[1:]

def positions(name):
    data = open(f'{work}/{name}.ply', 'rb').read()
    body = data[data.index(b'end_header\n') + 11:]
    # x y z vx vy vz age lifetime id type; the bits of x y z, for -0 is not 0.
    return {row[8]: row[:3] for row in struct.iter_unpack('<10I', body)}

before, after = positions(settled), positions(steps)
moved = sum(after.get(id) != at for id, at in before.items())
print(f'rest: {len(before)} particles at step {settled}, {len(after)} at step {steps}; {moved} of them moved')
sys.exit(0 if before and len(before) == len(after) and moved == 0 else 1)
P
}

bytes() { scripts/determinism.sh; }

outputs() { scripts/all_or_nothing.sh; }

failed=0
for run in "${runs[@]}"; do
    case $run in
        sweep | rest | bytes | outputs) "$run" || failed=1 ;;
        *)
            echo "soak.sh: unknown run '$run'; choose sweep, rest, bytes or outputs" >&2
            exit 1
            ;;
    esac
done
exit $failed
