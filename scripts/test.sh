#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs missing packages, builds the product once, and tests it. Needs no GPU. scripts/test.sh [--quick|--gpu]
#
#   (nothing)  the default tier: every area of the product, sanitizers on all readers of untrusted bytes, and the page of a
#              collider and the collision function for other engines in a real browser
#   --quick    after an edit: builds what changed; skips slow cases, scripts longer than a few seconds, and the browser
#   --gpu      every GL test on this machine's GPU: scripts/gpu_test.sh
#
# scripts/nightly.sh runs all other jobs; tests/README.md describes them.
set -euo pipefail
cd "$(dirname "$0")/.."

tier=default
case ${1-} in
    "") ;;
    --quick) tier=quick ;;
    --gpu) exec scripts/gpu_test.sh "${@:2}" ;;
    *)
        echo "test.sh: unknown option '$1'; use --quick, --gpu or none" >&2
        exit 1
        ;;
esac

# stage NAME COMMAND…: runs COMMAND, and prints its time.
stage() {
    local name=$1 begun=$SECONDS
    shift
    "$@"
    echo "test.sh: $name took $((SECONDS - begun)) s" >&2
}

stage setup scripts/setup.sh test
stage format scripts/format.sh --check
stage build scripts/build.sh test
stage tests ctest --preset $tier -j "$(nproc)"
[ $tier = default ] || exit 0
stage 'web setup' scripts/setup.sh web
stage 'web build' scripts/build.sh web
export RELIEF_BIN=$PWD/build/test/bin LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0
stage 'browser test' node --test tests/web/collider_page_test.mjs
stage 'collision function in a browser' node --test tests/web/engines_test.mjs
stage 'particles in a browser' node --test --test-name-pattern='^particles meet the body' tests/web/view_test.mjs
