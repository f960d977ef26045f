# SPDX-License-Identifier: Apache-2.0
"""Hides a preloaded sanitizer runtime from the programs that the package starts, which have their own."""
import os

os.environ.pop('LD_PRELOAD', None)
