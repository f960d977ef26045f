#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Puts standard input between the lines <!-- NAME --> and <!-- /NAME --> of a page: tests/long/page_part.sh PAGE NAME
set -euo pipefail
sed -i -e "/^<!-- $2 -->\$/,/^<!-- \/$2 -->\$/{//!d}" -e "/^<!-- $2 -->\$/r /dev/stdin" "$1"
