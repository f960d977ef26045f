#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Formats every C++ file with clang-format. --check only reports unformatted files, and fails if there are any.
set -euo pipefail
cd "$(dirname "$0")/.."

arguments=(-i)
[ "${1:-}" != --check ] || arguments=(--dry-run --Werror)
find bake formats runtime samples shaders tests \( -name '*.h' -o -name '*.cpp' \) -print0 |
    xargs -0 -r clang-format "${arguments[@]}"
