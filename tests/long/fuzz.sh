#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs libFuzzer under sanitizers: tests/long/fuzz.sh [SECONDS [TARGET…]], by default 60 seconds for each target in
# tests/fuzz. Failing inputs are in out/fuzz/: fix the bug, and add the input to tests/fuzz/corpus/.
set -euo pipefail
cd "$(dirname "$0")/../.."

seconds=${1:-60}
targets=("${@:2}")
scripts/setup.sh
if [ ${#targets[@]} -eq 0 ]; then
    for source in tests/fuzz/fuzz_*.cpp; do
        name=$(basename "$source" .cpp)
        targets+=("${name#fuzz_}")
    done
fi
bin=$(scripts/build.sh fuzz "${targets[@]/#/relief_fuzz_}" relief-generate)
"$bin/relief-generate" --dictionaries out/fuzz/dictionaries # keys and words of scenes and recipes

failed=0
for target in "${targets[@]}"; do
    found=out/fuzz/$target
    mkdir -p "$found/corpus"
    corpus=tests/fuzz/corpus/$target
    [ "$target" != single ] || corpus=tests/fuzz/corpus/container
    timeout=10
    [ "$target" != bake ] || timeout=60 # tests several hundred thousand points under sanitizers
    options=(-max_total_time="$seconds" -timeout="$timeout" -rss_limit_mb=2048 -print_final_stats=1 -artifact_prefix="$found/")
    cat {tests/fuzz,out/fuzz/dictionaries}/"$target".dict >"$found/dict" 2>/dev/null || true
    [ ! -s "$found/dict" ] || options+=(-dict="$found/dict")
    status=0
    ASAN_OPTIONS=allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1 \
        "$bin/relief_fuzz_$target" "${options[@]}" "$found/corpus" "$corpus" 2>"$found/log" || status=$?
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$found/log")
    edges=$(grep -o 'cov: [0-9]*' "$found/log" | tail -1 | cut -d' ' -f2)
    echo "fuzz: $target: ${runs:-?} inputs in $seconds s, ${edges:-?} edges, exit code $status"
    [ "$status" = 0 ] || {
        tail -25 "$found/log" >&2
        failed=1
    }
done
exit $failed
