#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""filter.py FILE: converts a page, a header or the types of the npm package for Doxygen.

The title of a page gets its path as id, links between pages become references, and other links (to sources, to folders
without a page) become plain text. The comment at the head of a header becomes the file's documentation."""
import os
import pathlib
import re
import sys


def page_id(path):
    return 'mainpage' if path == 'README.md' else 'page_' + re.sub(r'\W', '_', path)


def header(text):
    if text.startswith('/*'):  # C: a comment documents the next line, or the code before it on its line
        text = re.sub(r'^(.*[;,{].*?)/\* ', r'\1/**< ', text, flags=re.M)
        text = re.sub(r'^( *)/\* (?!---)', r'\1/** ', text, flags=re.M)
        return text.replace('#version', '\\#version').replace('/** ', '/** @file\n * ', 1)
    head = re.match(r'(//[^\n]*\n)+', text)
    if not head:
        return text
    return '/// @file\n' + re.sub(r'^//', '///', head[0], flags=re.M).replace('#', '\\#') + text[head.end():]


def guide(page, text):
    text = re.sub(r'^# (.*)$', lambda found: f'# {found[1].replace("`", "")} {{#{page_id(page)}}}', text, count=1, flags=re.M)

    # Doxygen parses <word> as HTML even in code.
    text = re.sub(r'`[^`\n]*`', lambda code: code[0].replace('<', '\\<') if re.search(r'<[a-z]+>', code[0]) else code[0], text)

    def link(found):
        words, target = found[1], found[2]
        if re.match(r'[a-z]+:', target):
            return found[0]
        there = os.path.normpath(os.path.join(os.path.dirname(page), target.partition('#')[0])) if target[0] != '#' else page
        if os.path.isdir(there):
            there = os.path.join(there, 'README.md')
        if not os.path.isfile(there) or not there.endswith(('.md', '.d.ts')):
            return words
        return f'[{words.replace("`", "")}](@ref {page_id(there)})'

    # Doxygen finds images by file name only (IMAGE_PATH). A linked image becomes a plain image.
    text = re.sub(r'\[(!\[[^\]]*\]\([^)]*\))\]\([^)]*\)', r'\1', text)
    text = re.sub(r'(!\[[^\]]*\]\()[^)\s]*/', r'\1', text)
    text = re.sub(r'(?<!!)\[([^\]]+)\]\(([^)\s]+)\)', link, text)
    return text


def declarations(page, text):
    """The types of the npm package as a page: a section for each exported declaration, with its comment above its code."""
    blocks = re.split(r'\n\n(?=/\*\*|export)', text)
    parts = ['# JavaScript API', re.sub(r'^// ?', '', blocks[0].split('\n', 1)[1], flags=re.M)]
    for block in blocks[1:]:
        comment, code = re.fullmatch(r'(?:/\*\*(.*?)\*/\n)?(.*)', block, re.S).groups()
        name = re.search(r'^export (?:declare )?(?:abstract )?\w+ (\w+)', code, re.M)
        parts.append(f'## {name[1]}\n\n' + re.sub(r'^ *\* ?|(?=\b\w+\(\))', lambda found: '' if found[0] else '%', comment or '', flags=re.M).strip())
        parts.append(f'```js\n{code.strip()}\n```')
    return guide(page, '\n\n'.join(parts) + '\n')


path = os.path.relpath(sys.argv[1])
text = pathlib.Path(path).read_text()
read = {'.md': guide, '.ts': declarations}.get(os.path.splitext(path)[1], lambda page, source: header(source))
sys.stdout.write(read(path, text))
