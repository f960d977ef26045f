#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Regenerates all files derived from the fields() of bakes, scenes and reports (formats/fields), and prints their names.
set -euo pipefail
cd "$(dirname "$0")/.."
"$(scripts/build.sh release relief-generate)/relief-generate" .
