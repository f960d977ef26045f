#!/usr/bin/env bash
# Installs what is missing, builds everything and runs every test: the release build, then the same tests, but
# for those labelled slow, under the address and undefined-behaviour sanitizers. Needs no GPU.
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=$(nproc)

scripts/setup.sh
scripts/format.sh --check
scripts/build.sh release
ctest --preset release -j "$jobs"
scripts/build.sh sanitize
ctest --preset sanitize -j "$jobs"
