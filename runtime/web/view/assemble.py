#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Assembles the page of `relief view` into one HTML file: a page that is opened from disk may import no other file.

    assemble.py VIEW_FOLDER SCRIPT RELIEF_WASM OUTPUT
"""
import base64
import gzip
import pathlib
import sys

folder, script, wasm, output = (pathlib.Path(one) for one in sys.argv[1:])
page = (folder / "index.html").read_text(encoding="utf-8")
for mark, text in (("/* style.css */", (folder / "style.css").read_text(encoding="utf-8")),
                   ("/* relief_wasm.wasm */", base64.b64encode(gzip.compress(wasm.read_bytes(), 9, mtime=0)).decode()),
                   ("/* main.js */", script.read_text(encoding="utf-8"))):
    if page.count(mark) != 1:
        sys.exit(f"index.html must hold '{mark}' once")
    page = page.replace(mark, text)
output.write_text(page, encoding="utf-8")
