#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds the product once, and tests it. Needs no GPU. scripts/test.sh [--quick|--gpu]
#
#   (nothing)  the default tier: every area of the product, the sanitizers over everything that reads untrusted bytes, and the
#              page of a collider in a real browser
#   --quick    after an edit: builds what changed; no slow cases, no scripts longer than some seconds, no browser
#   --gpu      every GL test on this machine's GPU: scripts/gpu_test.sh
#
# scripts/nightly.sh has everything else. tests/README.md lists each job, its tier and its minutes.
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

# stage NAME COMMAND…: runs it, and prints its time.
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
stage 'particles in a browser' node --test --test-name-pattern='^particles meet the body' tests/web/view_test.mjs
