#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Formats every C++ file by .clang-format. With --check, changes nothing; lists files that are not formatted and lines that
# break the rules of prose in CONTRIBUTING.md that a program can see, and fails if there are any.
set -euo pipefail
cd "$(dirname "$0")/.."

arguments=(-i)
[ "${1:-}" != --check ] || arguments=(--dry-run --Werror)
find bake formats runtime samples shaders tests \( -name '*.h' -o -name '*.cpp' \) -print0 |
    xargs -0 -r clang-format "${arguments[@]}"
[ "${1:-}" = --check ] || exit 0

sources='\.(h|hpp|cpp|c|glsl|vert|frag|comp|js|mjs|ts|py|sh|cmake)$|CMakeLists\.txt$'
opening='^ *(//|#|/?\*|""")[/!<*]* *(Of|What|Where|Whatever|Whoever|Who) |[;,{] +(//|/\*)[/!<]* *(Of|Where|Whatever|Whoever|Who) '
words='\b(alone|heed(s|ed)?|mend(s|ed|ing)?|has (it|them))\b'
quoted="((^|[^:])//|#|\"|^ *\*).*$words"
conflict='^(<{7}|>{7}) '
found=0
while IFS= read -r file; do
    case $file in
        scripts/format.sh | ./CONTRIBUTING.md | *node_modules*) continue ;;
        *.md) pattern="$words|$conflict" ;;
        *) pattern="$opening|$quoted|$conflict" ;;
    esac
    ! grep -nHE "$pattern" "$file" || found=1
done < <(find CMakeLists.txt ./*.md .github bake formats runtime samples scripts shaders tests -type f |
    grep -E "$sources|\.md$|/hooks/" | sort)
[ "$found" = 0 ] || {
    echo "format.sh: fix the lines above: a comment must not open with Of, What or Where; write 'only', not 'alone'," \
        "and 'fix', not 'mend'; remove conflict markers" >&2
    exit 1
}
