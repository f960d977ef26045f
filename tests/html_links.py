#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""html_links.py FOLDER: checks that links of the HTML files in FOLDER lead to existing files and #anchors."""
import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.targets, self.anchors = [], set()
        self.feed(path.read_text())

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name in ('href', 'src') and value:
                self.targets.append(value)
            elif name == 'id' or (name == 'name' and tag == 'a'):
                self.anchors.add(value)


folder = pathlib.Path(sys.argv[1])
pages = {path.name: Page(path) for path in sorted(folder.glob('*.html'))}
dead = []
links = 0
for name, page in pages.items():
    for target in page.targets:
        url = urllib.parse.urlsplit(target)
        if url.scheme:
            continue
        links += 1
        there = urllib.parse.unquote(url.path) or name
        if not (folder / there).exists():
            dead.append(f'{name}: {target} does not exist')
        # Doxygen links from the head of a class to its list of private classes, which it omits.
        elif url.fragment not in ('', 'nested-classes') and there in pages and url.fragment not in pages[there].anchors:
            dead.append(f'{name}: {there} has no anchor #{url.fragment}')
print('\n'.join(sorted(set(dead))) if dead else f'{links} links of {len(pages)} pages')
sys.exit(1 if dead or links < 1000 else 0)
