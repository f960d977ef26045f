#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs every GL test on a real driver: OpenGL 3.3 and OpenGL ES 3.0, fragment and compute shaders. Builds the runtime
# without the baker. scripts/gpu_test.sh [--allow-software] [build|run [FOLDER]]
#
#   (nothing)      build, then run
#   build          builds the tests, and copies them with their shared libraries to FOLDER (default: build/gpu_tests), which
#                  can be copied to a machine with a GPU
#   run            runs the tests of FOLDER; needs only python3 and the driver
#   --allow-software  accepts software renderers such as Mesa's llvmpipe, which otherwise fail with exit status 5
set -euo pipefail
cd "$(dirname "$0")/.."

programs=(relief_gl_test)      # of tests/CMakeLists.txt
only='*Gl*:CApi*:NoContext*'   # their cases that create a context

software=0
verb=
folder=
for argument; do
    case $argument in
        --allow-software) software=1 ;;
        build | run) verb=$argument ;;
        -*)
            echo "gpu_test.sh: unknown option '$argument'; use --allow-software, or none" >&2
            exit 1
            ;;
        *) folder=$argument ;;
    esac
done
folder=${folder:-build/gpu_tests}

build() {
    scripts/setup.sh
    [ -f build/gpu/build.ninja ] ||
        cmake -S . -B build/gpu -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE='-O2 -DNDEBUG' \
            -DRELIEF_BUILD_BAKE=OFF -DRELIEF_BUILD_PLAYER=ON -DRELIEF_BUILD_TESTS=ON -DRELIEF_BUILD_OPENVDB=OFF \
            -DRELIEF_BUILD_PYTHON=OFF -DRELIEF_WARNINGS_AS_ERRORS=OFF >&2
    cmake --build build/gpu --target "${programs[@]}" >&2
    rm -rf "$folder"
    mkdir -p "$folder/lib" "$folder/loaders"
    for program in "${programs[@]}"; do
        strip -o "$folder/$program" "build/gpu/bin/$program"
    done
    # The target's own C library is used, because its driver needs it.
    ldd "$folder"/relief_* | awk '$2 == "=>" { print $3 }' | sort -u |
        grep -Ev '/(libc|libm|libdl|libpthread|librt)\.so' | xargs -I{} cp -L {} "$folder/lib"
    # The dispatch libraries that load a driver; run uses them if the machine has none.
    for library in libEGL.so.1 libGLdispatch.so.0 libOpenGL.so.0 libGLESv2.so.2; do
        cp -L "$(ldconfig -p | awk -v name=$library '$1 == name { print $NF; exit }')" "$folder/loaders"
    done
    printf '%s\n' "${programs[@]}" >"$folder/programs.txt"
    strip "$folder"/lib/* "$folder"/loaders/*
    du -sh "$folder" >&2
}

# Prints the driver of both APIs, and fails on software renderers.
describe() {
    local program=$1 report cases
    report=$(mktemp)
    # One case of each API: its report contains the description of the context.
    cases=$("$program" --gtest_list_tests --gtest_filter='Apis/*GlTest.*' | awk '
        /^[^ ]/ { suite = $1 }
        /^  / { split($1, parts, "/"); if (!seen[parts[2]]++) print suite $1 }' | paste -sd:)
    "$program" --gtest_filter="$cases" --gtest_output="json:$report" >/dev/null || true
    contexts=$(grep -o '"context": "[^"]*"' "$report" | cut -d'"' -f4 | sort -u || true)
    rm -f "$report"
    if [ -z "$contexts" ]; then
        echo "gpu_test.sh: no OpenGL context; install the GPU's driver with its EGL library" >&2
        exit 5
    fi
    echo "$contexts"
    if [ $software = 0 ] && grep -qE 'llvmpipe|softpipe|swrast|SwiftShader|Software Rasterizer' <<<"$contexts"; then
        echo "gpu_test.sh: found only a software renderer; install the GPU's driver, or pass --allow-software" >&2
        exit 5
    fi
}

run() {
    [ -f "$folder/programs.txt" ] || {
        echo "gpu_test.sh: $folder contains no tests; run scripts/gpu_test.sh build" >&2
        exit 1
    }
    mapfile -t programs <"$folder/programs.txt"
    export LD_LIBRARY_PATH="$folder/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
    [[ $(ldconfig -p) == *libOpenGL.so.0*libEGL.so.1* || $(ldconfig -p) == *libEGL.so.1*libOpenGL.so.0* ]] ||
        LD_LIBRARY_PATH+=:$folder/loaders
    describe "$folder/${programs[0]}"

    local logs jobs=$(($(nproc) < 8 ? $(nproc) : 8)) failed=0 program cases shards i
    logs=$(mktemp -d)
    for program in "${programs[@]}"; do
        cases=$("$folder/$program" --gtest_list_tests --gtest_filter="$only" | grep -c '^  ' || true)
        [ "$cases" -gt 0 ] || continue
        shards=$((cases < jobs ? cases : jobs))
        local pids=()
        for ((i = 1; i <= shards; i++)); do
            python3 tests/run_program.py "$folder/$program" --shard "$i/$shards" --only "$only" \
                >"$logs/$program.$i" 2>&1 &
            pids+=($!)
        done
        for ((i = 1; i <= shards; i++)); do
            wait "${pids[$((i - 1))]}" || failed=1
            cat "$logs/$program.$i"
        done
    done
    echo "gpu_test.sh: $(awk '/ cases, .* failed, / { cases += $1; bad += $3 } END { print cases " cases, " bad " failed" }' \
        "$logs"/*) in $SECONDS s"
    rm -rf "$logs"
    return $failed
}

[ "$verb" = run ] || build
[ "$verb" = build ] || run
