#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""links.py FOLDER: checks that every relative link of every .md below FOLDER leads to an existing file and #heading, and that every
row that starts with | belongs to a table with a header."""
import pathlib
import re
import sys


def prose(text):
    """The text without code, in which brackets are not links."""
    text = re.sub(r'^ *```.*?^ *```', '', text, flags=re.S | re.M)
    return re.sub(r'`[^`]*`', 'code', text)


def headings(text):
    """The anchors of a Markdown page, as Git hosts create them."""
    words = [re.sub(r'[^\w\- ]', '', line.lower()) for line in re.findall(r'^#+ +(.*?)\s*$', text, flags=re.M)]
    return {line.replace(' ', '-') for line in words}


def main(folder):
    pages, links, dead = 0, 0, []
    for page in sorted(pathlib.Path(folder).rglob('*.md')):
        pages += 1
        text = page.read_text()
        # [words](target), ![words](target) and [words]: target.
        targets = re.findall(r'\]\(\s*<?([^)\s>]+)>?[^)]*\)', prose(text))
        targets += re.findall(r'^ {0,3}\[[^\]]+\]:\s*<?([^\s>]+)', prose(text), flags=re.M)
        lines = [''] + prose(text).split('\n') + ['']
        for before, row, behind in zip(lines, lines[1:], lines[2:]):
            if row.startswith('| ') and not before.startswith('|') and not behind.startswith('| --'):
                dead.append(f'{page}: the row "{row}" is outside its table')
        for target in targets:
            if re.match(r'[a-z][a-z0-9+.-]*:', target):
                continue
            links += 1
            path, _, anchor = target.partition('#')
            there = page.parent / path if path else page
            if not there.exists():
                dead.append(f'{page}: {target} does not exist')
            elif anchor and there.suffix == '.md' and anchor not in headings(there.read_text()):
                dead.append(f'{page}: {there.name} has no heading #{anchor}')
    print('\n'.join(dead) if dead else f'{links} links of {pages} pages')
    return 1 if dead or pages < 20 or links < 60 else 0


if __name__ == '__main__':
    sys.exit(main(*sys.argv[1:]))
