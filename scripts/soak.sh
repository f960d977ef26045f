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
#   seeds   the generated cases of the tests are others: of seed RELIEF_TEST_SEED, by default the day's date
#   clang   everything is built by clang too, without a warning, and passes its tests.
#   load    the release tests pass five times while stress-ng keeps processors, memory and disk busy.
#   bare    .ci/run, from nothing, in a minimal Debian 12 that mmdebstrap makes; scripts/test.sh there without root; and
#           what the tools do there without a GL. Needs root, and takes hours.
#   outputs 20 rounds of kills, errors, signals and eight writers leave no torn file (scripts/all_or_nothing.sh)
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
all_runs=(sweep rest import mutants package headers bytes seeds clang load bare outputs corpus fuzz)
runs=("$@")
[ ${#runs[@]} -gt 0 ] || runs=("${all_runs[@]}")
work=$(mktemp -d)
stress=
trap '[ -z "$stress" ] || kill "$stress"; rm -rf "$work"' EXIT

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

seeds() {
    local seed=${RELIEF_TEST_SEED:-$(date +%Y%m%d)}
    scripts/build.sh release >/dev/null || return 1
    # Whatever draws its cases by seedFrom() (tests/seeds.h), and the command lines that do.
    RELIEF_TEST_SEED=$seed RELIEF_MUTANTS=500 RELIEF_SCENES=200 ctest --preset release -j "$(nproc)" \
        -R '^(Voxels|ImportGltf|ImportFormat|ImportParts|ImportMessage|Shape|Winding|Mutated)[.]|^cli[.](mutants|scenes)$' \
        >"$work/seeds.log" || {
        cat "$work/seeds.log" >&2
        return 1
    }
    echo "seeds: seed $seed: none is wrong"
}

clang() {
    scripts/setup.sh clang || return 1
    cmake -G Ninja -S . -B "$work/clang" -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo \
        -DCMAKE_CXX_FLAGS_RELWITHDEBINFO='-O2 -g1 -DNDEBUG' >"$work/clang.log" &&
        cmake --build "$work/clang" >>"$work/clang.log" || {
        grep -m5 -E ' error: ' "$work/clang.log" >&2
        return 1
    }
    ctest --test-dir "$work/clang" -j "$(nproc)" --output-on-failure >"$work/clang.log" || {
        tail -40 "$work/clang.log" >&2
        return 1
    }
    echo "clang: $(clang++ -dumpversion) builds everything, and it passes its tests"
}

load() {
    local round status=0
    scripts/setup.sh stress-ng || return 1
    scripts/build.sh release >/dev/null || return 1
    stress-ng --quiet --cpu 2 --vm 1 --vm-bytes 512M --io 1 --temp-path "$work" &
    stress=$!
    for round in 1 2 3 4 5; do
        if ctest --preset release -j "$(nproc)" >"$work/load.log" 2>&1; then
            echo "load: round $round: all pass"
        else
            status=1
            echo "load: round $round: $(grep -cE '\((Failed|Timeout|SEGFAULT|Subprocess[^)]*)\)$' "$work/load.log") fail" >&2
            cat "$work/load.log" >&2
        fi
    done
    kill "$stress"
    stress=
    return "$status"
}

# in_bare COMMAND: runs it there as root. Its mounts and processes end with it.
in_bare() {
    # shellcheck disable=SC2016
    unshare --mount --pid --fork bash -c '
        mount --rbind /dev "$0/dev" && mount -t proc proc "$0/proc" && mount -t sysfs sysfs "$0/sys" &&
            exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 chroot "$0" bash -euc "$1"' \
        "$work/bare" "$1"
}

bare() {
    [ "$(id -u)" = 0 ] || {
        echo "soak.sh: bare needs root, for it makes a system; use sudo" >&2
        return 1
    }
    scripts/setup.sh mmdebstrap || return 1
    # From where this system has its packages.
    # shellcheck disable=SC2016
    apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
        grep -E ' bookworm(-updates|-security)? ' >"$work/sources.list"
    mmdebstrap --quiet --variant=minbase --include=ca-certificates,git bookworm "$work/bare" - <"$work/sources.list" ||
        return 1
    cp /etc/resolv.conf "$work/bare/etc/"
    git clone -q --no-hardlinks . "$work/bare/root/relief" || return 1
    in_bare '/root/relief/.ci/run' >"$work/bare.log" 2>&1 || {
        tail -60 "$work/bare.log" >&2
        return 1
    }
    echo "bare: .ci/run passes"
    in_bare 'useradd -m user && git clone -q --no-hardlinks /root/relief /home/user/relief &&
        chown -R user: /home/user/relief && su user -s /bin/bash -c "cd && relief/scripts/test.sh"' >"$work/bare.log" 2>&1 || {
        tail -60 "$work/bare.log" >&2
        return 1
    }
    echo "bare: scripts/test.sh passes without root"
    # No driver, and no library of EGL: what needs a GPU says so in a line, and what needs none works.
    in_bare 'apt-get remove -y -qq libegl-mesa0 libegl1 libgl1-mesa-dri
        cd /root
        bin=relief/build/release/bin
        refused() { # COMMAND…: exit code 5 and one line that names what to install
            local code=0
            "$@" >out 2>err || code=$?
            [ $code = 5 ] && [ ! -s out ] && [ "$(wc -l <err)" = 1 ] && grep -q "error: .*libegl1" err && return
            echo "exit code $code: $*" && cat out err
            return 1
        }
        bunny=/usr/share/glmark2/models/bunny.obj
        $bin/relief bake $bunny -o bunny.relief -q --budget 200kB
        $bin/relief check bunny.relief --mesh $bunny >/dev/null
        echo 0,0,0 >points.csv
        $bin/relief query bunny.relief --points points.csv -o answers.csv
        refused $bin/relief query bunny.relief --points points.csv -o gpu.csv --gpu
        refused $bin/relief bake $bunny -o gpu.relief -q --paper --backend raster
        refused $bin/relief-sim bunny.relief --steps 3
        [ ! -e gpu.csv ] && [ ! -e gpu.relief ]' >"$work/bare.log" 2>&1 || {
        tail -20 "$work/bare.log" >&2
        return 1
    }
    echo "bare: without a GL the CPU bakes, and what needs a GPU says what to install"
}

failed=0
for run in "${runs[@]}"; do
    [[ " ${all_runs[*]} " == *" $run "* ]] || {
        echo "soak.sh: unknown run '$run'; choose of: ${all_runs[*]}" >&2
        exit 1
    }
    "$run" || failed=1
done
exit $failed
