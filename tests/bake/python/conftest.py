# SPDX-License-Identifier: Apache-2.0
"""Keeps a preloaded sanitizer runtime from the programs that the package starts: these have their own."""
import os

os.environ.pop('LD_PRELOAD', None)
