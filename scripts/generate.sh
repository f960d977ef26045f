#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Writes anew all files that are derived from the fields() of bakes, scenes and reports (formats/fields), and names them.
set -euo pipefail
cd "$(dirname "$0")/.."
"$(scripts/build.sh release relief-generate)/relief-generate" .
