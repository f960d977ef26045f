#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Adds the scene player to the page of `relief view`: relief-particles and its WebAssembly module.

    assemble.py PAGE PLAYER_SCRIPT RELIEF_WASM OUTPUT
"""
import base64
import gzip
import pathlib
import sys

page, player, wasm, output = (pathlib.Path(one) for one in sys.argv[1:])
text = page.read_text(encoding="utf-8")
mark = '<script type="module">'
if text.count(mark) != 1:
    sys.exit(f"{page} must contain '{mark}' once")
packed = base64.b64encode(gzip.compress(wasm.read_bytes(), 9, mtime=0)).decode()
text = text.replace(mark, f'<script type="text/plain" id="relief-wasm">{packed}</script>\n'
                          f'{mark}\n{player.read_text(encoding="utf-8")}</script>\n{mark}')
output.write_text(text, encoding="utf-8")
