#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Formats every C++ file by .clang-format; with --check, only says which are not, and fails.
set -euo pipefail
cd "$(dirname "$0")/.."

arguments=(-i)
[ "${1:-}" != --check ] || arguments=(--dry-run --Werror)
find bake formats runtime samples shaders tests \( -name '*.h' -o -name '*.cpp' \) -print0 |
    xargs -0 -r clang-format "${arguments[@]}"
