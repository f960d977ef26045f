#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds one searchable site: guides, options, method, file format, and the API of C++, C, Python and JavaScript.
# scripts/docs.sh [FOLDER] (default: out/docs). Fails on any warning from Doxygen and on any broken link.
set -euo pipefail
cd "$(dirname "$0")/.."
out=$(realpath -m "${1:-out/docs}")

scripts/setup.sh
bin=$(scripts/build.sh tools relief relief-sim)
rm -rf "$out"
mkdir -p "$out"
{
    printf 'Options of the tools {#page_options}\n====================\n'
    for verb in $("$bin/relief" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p'); do
        printf '\n## relief %s\n\n```text\n%s\n```\n' "$verb" "$("$bin/relief" "$verb" --manual)"
    done
    printf '\n## relief-sim\n\n```text\n%s\n```\n' "$("$bin/relief-sim" --help)"
} >"$out/options.md"
{
    cat scripts/docs/Doxyfile
    echo "INPUT += $out/options.md"
    echo "OUTPUT_DIRECTORY = $out"
    echo "PROJECT_NUMBER = $(sed -n 's/^project(Relief VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)"
} | doxygen -
python3 tests/html_links.py "$out/html"
echo "$out/html/index.html"
