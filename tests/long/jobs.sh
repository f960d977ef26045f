#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The jobs of scripts/nightly.sh. tests/long/jobs.sh JOB runs one job and prints all of its output; without JOB it prints the
# name, group and minutes of each job. A job fails if a command fails, and prints its results as "JOB: …". tests/README.md
# describes the jobs.
set -euo pipefail
cd "$(dirname "$0")/../.."

threads=$(($(nproc) + 1)) # some tests mostly wait
jobs=()

# job GROUP MINUTES NAME: declares the function job_NAME below it.
job() {
    ! declare -F "job_$3" >/dev/null || {
        echo "jobs.sh: two jobs have the name '$3'" >&2
        exit 2
    }
    jobs+=("$3 $1 $2")
}

say() { echo "$name: $*"; }

# built NAME OPTION…: builds another configuration incrementally; sets `build`.
built() {
    build=build/nightly/$1
    cmake -G Ninja -S . -B "$build" -DCMAKE_BUILD_TYPE=RelWithDebInfo "${@:2}"
    cmake --build "$build"
}

# release [TARGET…]: builds release, or only these targets; sets `bin`.
release() { bin=$(scripts/build.sh release "$@"); }

# tested BUILD OPTION…: runs the tests of a build with ctest.
tested() {
    local status=0
    ctest --test-dir "$1" --no-tests=error --output-on-failure -j "$threads" "${@:2}" | tee "$work/ctest.log" || status=$?
    say "$(grep ' tests passed' "$work/ctest.log")"
    return $status
}

# programs FILTER PROGRAM…: runs the matching cases of test programs; a program may have none.
programs() {
    local program count=0 status=0
    for program in "${@:2}"; do
        "$program" --gtest_list_tests --gtest_filter="$1" | grep '^  ' >/dev/null || continue
        python3 tests/run_program.py "$program" --only "$1" | tee "$work/program.log" || status=1
        count=$((count + $(sed -n 's/^\([0-9]*\) cases, .*/\1/p' "$work/program.log")))
    done
    [ "$count" -gt 0 ] || status=1
    say "$count cases"
    return $status
}

# --- nightly ---

# These tests have separate jobs.
strace_tests='^cli[.](atomic_outputs|import_faults)$'
sample_tests='^cli[.](samples|demo|lead_through)$'
other_tests='^(python[.]|fuzz[.]|docs$|bench|vdb[.])|^cli[.]vdb$'

job nightly 20 release
job_release() {
    release
    tested build/release -LE cli -E "$other_tests"
}

job nightly 2 repeats
job_repeats() {
    release
    programs '*/Gles30*:*Compute*:*StepPathGlTest*' "$bin"/relief_*_test
}

job nightly 5 cli
job_cli() {
    release
    tested build/release -L cli -E "$strace_tests|$sample_tests|$other_tests"
}

job nightly 1 faults
job_faults() {
    release
    tested build/release -R "$strace_tests"
}

job nightly 5 samples
job_samples() {
    release
    tested build/release -R "$sample_tests"
}

job nightly 1 python
job_python() {
    release
    tested build/release -R '^python[.]'
}

job nightly 1 vdb
job_vdb() {
    release
    programs '*' "$bin/relief_vdb_test"
    tested build/release -R 'cli[.]vdb'
}

job nightly 3 engines
job_engines() {
    release relief relief_engine_cases relief_vulkan_host relief_engine_shaders
    "$bin/relief" bake /usr/share/glmark2/models/bunny.obj -o "$work/bunny.relief" -q
    python3 tests/engines/vulkan_texts.py "$bin" "$work" "$work/bunny.relief" | sed "s/^/$name: /"
    python3 tests/engines/page_snippets.py | sed "s/^/$name: /"
}

job nightly 2 bench
job_bench() {
    release
    tested build/release -R '^bench$'
    programs '*' "$bin/relief_bench_test"
}

job nightly 2 docs
job_docs() { scripts/docs.sh "$work/docs" | sed "s/^[0-9]* links of/$name: &/"; }

job nightly 12 web
job_web() {
    release
    scripts/build.sh web
    local status=0
    node --test tests/web | tee "$work/node.log" || status=$?
    say "$(sed -n 's/^# pass \([0-9]*\)$/\1/p' "$work/node.log") tests pass"
    return $status
}

job nightly 8 godot
job_godot() {
    release relief relief-import
    scripts/setup.sh web
    scripts/web_modules.sh
    scripts/web_modules.sh godot
    local status=0
    RELIEF_BIN=$bin node --test tests/godot | tee "$work/node.log" || status=$?
    say "$(sed -n 's/^# \(.* inside the mesh\)$/\1/p' "$work/node.log" | paste -sd';')"
    say "$(sed -n 's/^# pass \([0-9]*\)$/\1/p' "$work/node.log") tests pass"
    return $status
}

# sanitized OPTION…: runs tests in a build with all sanitizers, and -O1, because -O0 is too slow.
sanitized() {
    built sanitize --preset sanitize -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG='-O1 -g1'
    export ASAN_OPTIONS=detect_leaks=1:intercept_tls_get_addr=0:strict_string_checks=1:allocator_may_return_null=1
    export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0 UBSAN_OPTIONS=print_stacktrace=1
    tested "$build" "$@"
}

job nightly 33 sanitize
job_sanitize() { sanitized -LE cli; }

job nightly 5 replay
job_replay() {
    local source corpus targets=() status=0
    for source in tests/fuzz/fuzz_*.cpp; do targets+=("relief_replay_$(basename "${source#*/fuzz_}" .cpp)"); done
    bin=$(scripts/build.sh test "${targets[@]}")
    for source in "${targets[@]}"; do
        corpus=tests/fuzz/corpus/${source#relief_replay_}
        [ -d "$corpus" ] || corpus=tests/fuzz/corpus/container # relief_replay_single
        UBSAN_OPTIONS=print_stacktrace=1 "$bin/$source" "$corpus" | tee -a "$work/replay.log" || status=1
    done
    say "$(awk '/^[0-9]+ inputs$/ { sum += $1 } END { print sum + 0 }' "$work/replay.log") inputs for ${#targets[@]} readers"
    return $status
}

job nightly 25 coverage
job_coverage() {
    scripts/coverage.sh | tee "$work/coverage.log"
    say "$(sed -n 's/^\(lines\|branches\): \([0-9.]*%\).*/\2 of \1/p' "$work/coverage.log" | paste -sd, | sed 's/,/, /')"
}

job nightly 5 cases
job_cases() {
    local generator status=0
    release
    for generator in tests/cases/*_cases.py; do
        PYTHONDONTWRITEBYTECODE=1 python3 "$generator" "$bin" ${RELIEF_TEST_SEED:+--seed "$RELIEF_TEST_SEED"} |
            sed "s/^/$name: /" || status=1
    done
    return $status
}

job nightly 5 seeds
job_seeds() {
    local seed=${RELIEF_TEST_SEED:-$(date +%Y%m%d)} suites next
    release relief relief-sim relief_{unit,gl,import,bake}_test
    # The suites of all files that use seedFrom() (tests/seeds.h).
    suites=$(grep -rl 'seedFrom(' tests --include='*_test.cpp' |
        xargs sed -nE 's/^TEST(_[FP])?\((\w+), .*/*\2.*/p' | sort -u | paste -sd:)
    RELIEF_TEST_SEED=$seed programs "$suites" "$bin"/relief_{unit,gl,import,bake}_test
    for next in 1 2 3 4 5 6 7 8 9; do
        RELIEF_TEST_SEED=$((seed + next)) programs 'Voxels.*' "$bin/relief_bake_test" >"$work/voxels.log"
    done
    say "seed $seed, and the next nine for Voxels"
}

job nightly 3 import
job_import() {
    release relief_import_test
    RELIEF_SOAK=1 "$bin/relief_import_test" --gtest_filter='*EveryModelOfThePackage*' --gtest_output="json:$work/import.json"
    python3 - "$work/import.json" <<'P'
import json, sys
test = json.load(open(sys.argv[1]))['testsuites'][0]['testsuite'][0]
print(f"import: {test['tried']} files, {test['read']} of them read, the others rejected")
P
}

job nightly 5 runtime
job_runtime() {
    built runtime -DRELIEF_BUILD_BAKE=OFF
    cmake --install "$build" --prefix "$work/prefix"
    PKG_CONFIG_PATH=$(find "$work/prefix" -name pkgconfig)
    export PKG_CONFIG_PATH
    # shellcheck disable=SC2046
    g++ -std=c++20 samples/glfw/glfw.cpp -o "$work/glfw" $(pkg-config --cflags --libs relief-runtime glfw3)
    [ ! -e "$work/prefix/bin" ]
    printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(p LANGUAGES CXX)' \
        'find_package(Relief REQUIRED COMPONENTS runtime bake)' >"$work/CMakeLists.txt"
    CMAKE_PREFIX_PATH=$work/prefix cmake -G Ninja -S "$work" -B "$work/out" >"$work/cmake.log" 2>&1 && return 1
    grep 'no component bake' "$work/cmake.log"
}

job nightly 10 packages
job_packages() {
    make_bare ca-certificates
    scripts/setup.sh dpkg-dev lintian
    local room=$work/bare/srv/relief names round
    mkdir -p "$room/doc"
    scripts/build.sh web # for the pages of scenes
    scripts/build.sh packages
    # Packages are reproducible.
    for round in 1 2; do
        rm -rf build/packages/deb
        SOURCE_DATE_EPOCH=$(git log -1 --format=%ct) cpack --preset packages
        (cd build/packages/deb && sha256sum ./*.deb) >"$work/sums.$round"
    done
    cmp "$work/sums.1" "$work/sums.2"
    lintian --no-cfg --allow-root --fail-on error build/packages/deb/*.deb
    names=$(cd build/packages/deb && echo *.deb)
    say "$names: lintian finds no errors"
    cp build/packages/deb/*.deb tests/long/try_packages.sh /usr/share/glmark2/models/bunny.obj "$room/"
    python3 tests/cli/level.py "$room/level.glb"
    cp --parents README.md samples/in_python_and_blender.md "$room/doc/"
    # Installs the packages for users, without a compiler or documentation, then those for developers, then removes all.
    in_bare 'cd /srv/relief
        export DEBIAN_FRONTEND=noninteractive
        apt-get update -qq
        user() { su nobody -s /bin/bash -c "$*"; }
        apt-get install -y -qq --install-recommends ./relief_*.deb ./python3-relief_*.deb
        user RELIEF_DOC=/srv/relief/doc ./try_packages.sh /srv/relief/bunny.obj tools python
        apt-get install -y -qq --no-install-recommends ./librelief1_*.deb ./librelief-dev_*.deb cmake g++ ninja-build
        user ./try_packages.sh /srv/relief/bunny.obj development
        apt-get remove -y -qq relief librelief1 librelief-dev python3-relief
        left=$(find /usr -ipath "*relief*" ! -path "/usr/share/doc/*")
        [ -z "$left" ] || { echo "left behind: $left"; exit 1; }'
    say "removal leaves no files"
}

# --- weekly ---

job weekly 45 clang
job_clang() {
    built clang -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_FLAGS_RELWITHDEBINFO='-O2 -g1 -DNDEBUG'
    tested "$build"
    say "built by clang $(clang++ -dumpversion)"
}

# Label `plain` marks scripts that need a build without sanitizers.
job weekly 45 sanitize_cli
job_sanitize_cli() { sanitized -L cli -LE plain; }

job nightly 1 core
job_core() {
    local begun
    cmake --preset core
    cmake --build --preset core --target clean
    begun=$SECONDS
    cmake --build --preset core
    say "builds separately in $((SECONDS - begun)) s"
    programs '*' build/core/bin/relief_core_test
    ! ldd build/core/bin/relief_core_test | grep -E 'assimp|embree|OpenEXR|png|spdlog|tbb'
}

job weekly 45 headers
job_headers() { built headers -DRELIEF_PRECOMPILE=OFF -DRELIEF_UNITY=OFF; }

job weekly 20 embree4
job_embree4() {
    local mesh options
    release relief
    tested build/release -R '^cli[.]embree4$'
    built embree4 -DRELIEF_EMBREE=4 -Dembree_DIR="$PWD/tests/bake/mesh/embree4" -DRELIEF_BUILD_PYTHON=OFF \
        -DRELIEF_BUILD_TESTS=OFF -DRELIEF_BUILD_BENCHMARKS=OFF
    # Solids, shells and cavities; scan conversion and rays.
    for mesh in /usr/share/glmark2/models/bunny.obj /usr/share/glmark2/models/horse.3ds \
        /usr/share/assimp/models/OBJ/spider.obj; do
        for options in '--budget 200kB' '--paper --resolution 64' '--max-error 3%'; do
            # shellcheck disable=SC2086
            "$bin/relief" bake "$mesh" -o "$work/3.relief" -q $options
            # shellcheck disable=SC2086
            "$build/bin/relief" bake "$mesh" -o "$work/4.relief" -q $options
            cmp "$work/3.relief" "$work/4.relief"
        done
    done
    # The report without times.
    checked() { # EXECUTABLE COLLIDER
        "$1" check "$work/$2" --mesh "$mesh" --json | sed "s/$2/the.relief/" |
            python3 -c 'import json, sys; d = json.load(sys.stdin); del d["times_ms"]; print(json.dumps(d, indent=1))'
    }
    checked "$bin/relief" 3.relief >"$work/3.json"
    checked "$build/bin/relief" 4.relief >"$work/4.json"
    diff "$work/3.json" "$work/4.json"
    say "nine bakes of three meshes give equal bytes"
}

job weekly 90 sweep
job_sweep() {
    local status=0
    release relief_gl_test
    RELIEF_SOAK=1 "$bin/relief_gl_test" --gtest_filter='*SweptStepsNeverTunnel*' \
        --gtest_output="json:$work/sweep.json" || status=$?
    python3 - "$work/sweep.json" <<'P'
import json, sys
tests = [test for suite in json.load(open(sys.argv[1]))['testsuites'] for test in suite['testsuite']]
for test in tests:
    print(f"sweep: {test['name']}: {'FAILED' if 'failures' in test else 'none lost'}; 1000000 particles, 1000 steps, "
          f"{test.get('collisions', '?')} contacts; {test['time']}; {test.get('context', '')}")
sys.exit(0 if tests else 'sweep: no such test')
P
    return $status
}

# RELIEF_SOAK_SETTLED and RELIEF_SOAK_STEPS override the steps.
job weekly 60 rest
job_rest() {
    local steps settled=${RELIEF_SOAK_SETTLED:-5000} end=${RELIEF_SOAK_STEPS:-100000}
    release relief relief-sim
    "$bin/relief" bake /usr/share/glmark2/models/bunny.obj -o "$work/bunny.relief" -q
    printf '%s\n' '[collider]' 'file = "bunny.relief"' '[particles]' 'capacity = 10000' '[emitter]' 'burst = 10000' \
        'rate = 0.0' 'lifetime = 10000.0' >"$work/rest.toml"
    # Runs are deterministic, so two runs show one run at two times.
    for steps in "$settled" "$end"; do
        "$bin/relief-sim" "$work/rest.toml" --steps "$steps" --dump "$work/$steps.ply" -q
    done
    python3 - "$work" "$settled" "$end" <<'P'
import struct, sys
work, settled, steps = sys.argv[1:]

def positions(name):
    data = open(f'{work}/{name}.ply', 'rb').read()
    body = data[data.index(b'end_header\n') + 11:]
    # x y z vx vy vz age lifetime id type; x y z are compared bitwise, to distinguish -0 and 0.
    return {row[8]: row[:3] for row in struct.iter_unpack('<10I', body)}

before, after = positions(settled), positions(steps)
moved = sum(after.get(id) != at for id, at in before.items())
print(f'rest: {len(before)} particles at step {settled}, {len(after)} at step {steps}; {moved} of them moved')
sys.exit(0 if before and len(before) == len(after) and moved == 0 else 1)
P
}

job weekly 40 bytes
job_bytes() { tests/long/determinism.sh | sed "s/^\([0-9]* bakes .*\)/$name: \1/"; }

job weekly 10 mutants
job_mutants() {
    release relief
    python3 tests/cases/mutant_cases.py "$bin" --cases 2700
}

job weekly 30 outputs
job_outputs() { tests/long/all_or_nothing.sh; }

job weekly 60 corpus
job_corpus() { scripts/accuracy.sh --corpus | sed "s/^/$name: /"; }

job weekly 120 fuzz
job_fuzz() { tests/long/fuzz.sh 600; }

job weekly 15 characters
job_characters() {
    local clip clips=()
    scripts/setup.sh npm
    release relief relief_gl_test
    (cd "$work" && npm pack @pmndrs/viverse@0.2.20 && tar xzf pmndrs-viverse-*.tgz)
    for clip in mannequin walk run idle jump-up; do
        sed -n 's/.*base64,\([A-Za-z0-9+\/=]*\).*/\1/p' "$work/package/dist/assets/$clip.js" | base64 -d >"$work/$clip.glb"
        [ "$clip" = mannequin ] || clips+=(--clips "$work/$clip.glb")
    done
    "$bin/relief" bake "$work/mannequin.glb" --animated "${clips[@]}" -o "$work/mannequin.relief" -q
    RELIEF_ANIMATED=$work/mannequin.relief "$bin/relief_gl_test" \
        --gtest_filter='*AnimatedColliderGlTest.InsideMatchesThePosedMesh/Gl33Core' |
        sed "s/^.*% wrong/$name: &/"
}

job weekly 120 load
job_load() {
    local round status=0
    scripts/setup.sh stress-ng
    release
    stress-ng --quiet --cpu 2 --vm 1 --vm-bytes 512M --io 1 --temp-path "$work" &
    stress=$!
    for round in 1 2 3 4 5; do
        tested build/release || status=1
    done
    return $status
}

job weekly 5 blender
job_blender() {
    scripts/setup.sh blender
    release relief relief-sim relief_python
    mkdir -p "$work/blender"
    PYTHONPATH=$PWD/build/release/python blender -b --factory-startup --python-exit-code 1 \
        -P tests/samples/blender_addon.py -- "$PWD/samples/blender/relief_collider.py" "$bin/relief" "$bin/relief-sim" \
        "$work/blender" "$work/blender/errors.png"
    [ -s "$work/blender/errors.png" ]
}

job weekly 20 slurm
job_slurm() {
    release relief
    RELIEF=$bin/relief tests/long/slurm.sh "$work"
}

# in_bare COMMAND: runs COMMAND in $work/bare as root. Mounts and processes end with COMMAND.
in_bare() {
    # shellcheck disable=SC2016
    unshare --mount --pid --fork bash -c '
        mount --rbind /dev "$0/dev" && mount -t proc proc "$0/proc" && mount -t sysfs sysfs "$0/sys" &&
            exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 chroot "$0" bash -euc "$1"' \
        "$work/bare" "$1"
}

# make_bare PACKAGES: creates a minimal Debian 12 with PACKAGES in $work/bare.
make_bare() {
    [ "$(id -u)" = 0 ] || {
        say "needs root to create a system; use sudo"
        return 1
    }
    scripts/setup.sh mmdebstrap
    # Uses the package sources of this system.
    # shellcheck disable=SC2016
    apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
        grep -E ' bookworm(-updates|-security)? ' >"$work/sources.list"
    mmdebstrap --quiet --variant=minbase --include="$1" bookworm "$work/bare" - <"$work/sources.list"
    cp /etc/resolv.conf "$work/bare/etc/"
    # Copies the trusted certificates of this system, because a mirror can have its own certificate.
    mkdir -p "$work/bare/etc/ssl/certs"
    cp /etc/ssl/certs/ca-certificates.crt "$work/bare/etc/ssl/certs/"
    echo 'cafile=/etc/ssl/certs/ca-certificates.crt' >"$work/bare/etc/npmrc"
}

# The README's test command on a minimal system, then without root, and without OpenGL.
job nightly 25 bare
job_bare() {
    make_bare ca-certificates,git
    git clone -q --no-hardlinks . "$work/bare/srv/relief"
    in_bare '/srv/relief/.ci/run' 2>&1 | tee "$work/ci.log"
    say ".ci/run passes: $(sed -n 's/^test.sh: //p' "$work/ci.log" | paste -sd, | sed 's/,/, /g')"
    # Uses the existing builds of this tree: permissions affect the tests, not the compiler.
    in_bare 'useradd -m user && chown -R user: /srv/relief && su user -s /bin/bash -c "/srv/relief/scripts/test.sh"'
    say "scripts/test.sh passes without root"
    # Without a driver and EGL, commands that need a GPU fail with one line, and the others work.
    in_bare 'apt-get remove -y -qq libegl-mesa0 libegl1 libgl1-mesa-dri
        cd /root
        bin=/srv/relief/build/test/bin
        bunny=/usr/share/glmark2/models/bunny.obj
        $bin/relief bake $bunny -o bunny.relief -q --budget 200kB
        $bin/relief check bunny.relief --mesh $bunny >/dev/null
        echo 0,0,0 >points.csv
        $bin/relief query bunny.relief --points points.csv -o answers.csv
        code=0
        $bin/relief-sim bunny.relief --steps 3 >out 2>err || code=$?
        # one line that names what to install
        [ $code = 5 ] && [ ! -s out ] && [ "$(wc -l <err)" = 1 ] && grep "error: .*libegl1" err'
    say "without OpenGL, bakes work, and commands that need a GPU name the missing package"
}

if [ $# -eq 0 ]; then
    printf '%s\n' "${jobs[@]}"
    exit
fi
name=$1 stress=
[[ " ${jobs[*]% * *} " == *" $name "* ]] || {
    echo "jobs.sh: unknown job '$name'; choose from: ${jobs[*]% * *}" >&2
    exit 2
}
work=$(mktemp -d)
trap '[ -z "$stress" ] || kill "$stress"; rm -rf "$work"' EXIT
"job_$name"
