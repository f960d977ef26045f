#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the reference of the public headers and the Python package, with all pages: scripts/docs.sh [FOLDER] (default:
# out/docs). Fails on Doxygen warnings and dead links.
set -euo pipefail
cd "$(dirname "$0")/.."
out=$(realpath -m "${1:-out/docs}")

scripts/setup.sh
rm -rf "$out"
mkdir -p "$out"
{
    cat scripts/docs/Doxyfile
    echo "OUTPUT_DIRECTORY = $out"
    echo "PROJECT_NUMBER = $(sed -n 's/^project(Relief VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)"
} | doxygen -
python3 tests/html_links.py "$out/html"
echo "$out/html/index.html"
