#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds one searchable site: guides, options, method, file format, and the API of C++, C, Python and JavaScript.
# scripts/docs.sh [FOLDER] (default: out/docs). Fails on any warning from Doxygen and on any broken link.
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
