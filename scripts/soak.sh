#!/usr/bin/env bash
# Long runs, for a night and not for CI: scripts/soak.sh [RUN]…, all of these by default. Ends with 0 if all pass.
#
#   sweep   a million particles take a thousand swept steps in a closed hollow box, and none gets out; without the
#           sweep most do. In OpenGL 3.3 and in OpenGL ES 3.0. An hour or so on llvmpipe.
#   rest    snow falls on the bunny: after it has come to rest, no bit of a position changes from step 5,000 to step
#           100,000 (RELIEF_SOAK_SETTLED and RELIEF_SOAK_STEPS say others).
#   import  every file of assimp-testmodels is read or refused, and none crashes the worker.
#   mutants 2,000 broken mesh files and every file of assimp-testmodels are baked soundly or refused (scripts/mutants.sh)
#   package a build without the baker, from nothing, installs a runtime that samples/embed builds with.
#   headers a build of each file alone, without precompiled headers: every file includes what it uses, and no warning of
#           GCC is off.
#   bytes   204 bakes of ten meshes in surroundings that must not matter give one hash each (scripts/determinism.sh)
#   corpus  536 meshes as artists make them are baked at 1 MB and measured, or refused in one line. An hour or so.
#   fuzz    libFuzzer looks at containers, scenes, plans, recipes, points and import messages, ten minutes each (scripts/fuzz.sh)
#   outputs 20 rounds of kills, errors, signals and eight writers leave no torn file (scripts/all_or_nothing.sh)
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
all_runs=(sweep rest import mutants package headers bytes outputs corpus fuzz)
runs=("$@")
[ ${#runs[@]} -gt 0 ] || runs=("${all_runs[@]}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

sweep() {
    local bin status=0
    bin=$(scripts/build.sh release relief_runtime_particles_test) || return 1
    RELIEF_SOAK=1 "$bin/relief_runtime_particles_test" --gtest_filter='*ASweptStepNeverTunnels*' \
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

package() {
    cmake -G Ninja -S . -B "$work/runtime" -DRELIEF_BUILD_BAKE=OFF -DRELIEF_BUILD_TESTS=OFF \
        -DRELIEF_BUILD_BENCHMARKS=OFF >"$work/package.log" &&
        cmake --build "$work/runtime" >>"$work/package.log" &&
        cmake --install "$work/runtime" --prefix "$work/prefix" >>"$work/package.log" || {
        tail -20 "$work/package.log" >&2
        return 1
    }
    local modules
    modules=$(find "$work/prefix" -name pkgconfig)
    # shellcheck disable=SC2046
    g++ -std=c++20 samples/embed/embed.cpp -o "$work/embed" \
        $(PKG_CONFIG_PATH=$modules pkg-config --cflags --libs relief-runtime) &&
        "$work/prefix/bin/relief-sim" --version >/dev/null && echo "package: a build without the baker installs"
}

headers() {
    cmake -G Ninja -S . -B "$work/headers" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DRELIEF_PRECOMPILE=OFF \
        -DRELIEF_UNITY=OFF >"$work/headers.log" &&
        cmake --build "$work/headers" >>"$work/headers.log" || {
        grep -m5 -E ' error: ' "$work/headers.log" >&2
        return 1
    }
    echo "headers: builds without precompiled headers"
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
    # The same scene gives the same particles, so two runs are the same run, looked at twice.
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
    # x y z vx vy vz age lifetime id type; compares the bits of x y z, because -0 is not 0.
    return {row[8]: row[:3] for row in struct.iter_unpack('<10I', body)}

before, after = positions(settled), positions(steps)
moved = sum(after.get(id) != at for id, at in before.items())
print(f'rest: {len(before)} particles at step {settled}, {len(after)} at step {steps}; {moved} of them moved')
sys.exit(0 if before and len(before) == len(after) and moved == 0 else 1)
P
}

import() {
    local bin
    bin=$(scripts/build.sh release relief_bake_import_test) || return 1
    RELIEF_SOAK=1 "$bin/relief_bake_import_test" --gtest_filter='*EveryModelOfThePackage*' \
        --gtest_output="json:$work/import.json" >"$work/import.log" || {
        cat "$work/import.log" >&2
        return 1
    }
    python3 - "$work/import.json" <<'P'
import json, sys
test = json.load(open(sys.argv[1]))['testsuites'][0]['testsuite'][0]
print(f"import: {test['tried']} files, {test['read']} of them read, the others refused")
P
}

bytes() { scripts/determinism.sh; }

mutants() { scripts/mutants.sh 2000; }

outputs() { scripts/all_or_nothing.sh; }

corpus() { scripts/accuracy.sh --corpus --all --csv "$work/corpus.csv" | sed 's/^/corpus: /'; }

fuzz() { scripts/fuzz.sh 600; }

failed=0
for run in "${runs[@]}"; do
    [[ " ${all_runs[*]} " == *" $run "* ]] || {
        echo "soak.sh: unknown run '$run'; choose of: ${all_runs[*]}" >&2
        exit 1
    }
    "$run" || failed=1
done
exit $failed
