#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Replaces the lines between <!-- NAME --> and <!-- /NAME --> in a page by standard input: tests/long/page_part.sh PAGE NAME
set -euo pipefail
sed -i -e "/^<!-- $2 -->\$/,/^<!-- \/$2 -->\$/{//!d}" -e "/^<!-- $2 -->\$/r /dev/stdin" "$1"
