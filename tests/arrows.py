#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that every #include follows the dependencies of the build files: arrows.py SOURCE FOLDERS_TXT

CMake writes FOLDERS_TXT from relief_folder(): lines "FOLDER: USED USED…". The check also fails on include cycles (a .cpp and
its .h count as one file), on third-party headers outside the folders that may include them, on standard library features
that the WebAssembly build lacks (LLVM 14), and on source files without a licence.
"""
import pathlib
import re
import sys

# Third parties, and the folders that may include them. Headers of the standard library and the system are not restricted.
THIRD_PARTIES = {
    'assimp': ['bake/import'],
    'meshoptimizer.h': ['bake/import'],
    'seccomp.h': ['bake/import'],
    'pugixml.hpp': ['bake/import'],
    'embree3': ['bake/mesh'],
    'embree4': ['bake/mesh'],
    'CGAL': ['bake/repair'],
    'OpenEXR': ['bake/images', 'bake/import'],
    'cairo.h': ['bake/images'],
    'openvdb': ['runtime/vdb'],
    'png.h': ['runtime/files', 'bake/import'],
    'flatbuffers': ['formats', 'formats/animation'],
    'zstd.h': ['formats'],
    'xxhash.h': ['formats/base'],
    'pybind11': ['bake/python'],
    'toml++': ['formats/config'],
    'CLI': ['runtime/command_line', 'runtime/cli', 'runtime/bench', 'bake/cli', 'bake/bench'],
    'spdlog': ['runtime/command_line', 'runtime/cli', 'bake/cli'],
    'nlohmann': ['formats/fields', 'bake/import', 'bake/recipe', 'bake/report', 'bake/cli', 'bake/bench', 'runtime/command_line',
                 'runtime/player', 'runtime/web', 'runtime/bench'],
    'epoxy': ['runtime/gl', 'runtime/collider', 'runtime/picture'],
}
TREES = ('formats', 'shaders', 'runtime', 'bake', 'samples', 'scripts', 'tests')
TOP = {'bake', 'runtime'}  # only main.cpp, which may use every folder


def reachable(folder, uses):
    found, waiting = {folder}, [folder]
    while waiting:
        for used in uses.get(waiting.pop(), []):
            if used not in found:
                found.add(used)
                waiting.append(used)
    return found


def cycles(graph):
    """Groups of files that include each other (Tarjan's algorithm)."""
    index, low, stack, groups = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in sorted(graph.get(node, ())):
            if other not in index:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in stack:
                low[node] = min(low[node], index[other])
        if low[node] == index[node]:
            group = []
            while not group or group[-1] != node:
                group.append(stack.pop())
            if len(group) > 1:
                groups.append(sorted(group))

    sys.setrecursionlimit(10000)
    for node in sorted(graph):
        if node not in index:
            visit(node)
    return groups


# Algorithms of std::ranges (std::ranges::size() and the like are available), and std::bit_cast.
NOT_FOR_WEB = re.compile(r'\bstd::ranges::(?!(?:size|data|begin|end|empty)\b)\w+\(|\bstd::bit_cast\b')


def web_faults(source):
    """Uses of NOT_FOR_WEB in the files of web_sources(FOLDER EXCLUDED_FILE…) in runtime/web/CMakeLists.txt."""
    web = (source / 'runtime/web/CMakeLists.txt').read_text()
    faults, files = [], 0
    for folder, left_out in re.findall(r'^web_sources\(([^\s)]+)([^)]*)\)', web, re.MULTILINE):
        for path in sorted((source / folder).glob('*')):
            if path.suffix not in ('.h', '.cpp') or path.stem + '.cpp' in left_out.split():
                continue
            files += 1
            for number, line in enumerate(path.read_text().split('\n'), 1):
                found = NOT_FOR_WEB.search(line.split('//')[0])
                if found:
                    faults.append(f'{path.relative_to(source)}:{number}: the WebAssembly build lacks {found[0].rstrip("(")}')
    return faults if files >= 50 else [f'runtime/web/CMakeLists.txt: found only {files} files of web_sources()']


def list_faults(source):
    """Folders, two levels deep, that the list in CONTRIBUTING.md lacks, and names in it without a folder."""
    listed = set()
    for tree, jobs in re.findall(r'^- `(\w+)`: (.*\n(?:  .*\n)*)', (source / 'CONTRIBUTING.md').read_text(), re.MULTILINE):
        names = re.findall(r'((?:`[\w/]+`,?\s+)*`[\w/]+`):\s', jobs)
        listed |= {tree} | {f'{tree}/{name}' for some in names for name in re.findall(r'[\w/]+', some)}
    tracked = [path for top in ('formats', 'shaders', 'runtime', 'bake', 'samples', 'scripts') for path in (source / top).rglob('*')
               if path.is_file() and '__pycache__' not in path.parts and 'node_modules' not in path.parts]
    folders = {'/'.join(path.relative_to(source).parts[:-1][:2]) for path in tracked}
    return ([f'CONTRIBUTING.md: the list lacks {folder}' for folder in sorted(folders - listed)]
            + [f'CONTRIBUTING.md: {folder} does not exist' for folder in sorted(listed) if not (source / folder).is_dir()])


SOURCES = set('.c .cmake .comp .cpp .css .fbs .frag .gd .gdshader .gdshaderinc .glsl .h .hpp .html .js .mjs .py .sh .ts .vert'.split())
LICENCE = re.compile(r'(?://|#|/\*|<!--) SPDX-License-Identifier: Apache-2\.0(?: \*/| -->)?')


def licence_faults(source):
    """Source files without an SPDX line among their first two lines."""
    faults, files = [], 0
    for path in sorted(p for top in TREES for p in (source / top).rglob('*')):
        if (path.suffix in SOURCES or path.name == 'CMakeLists.txt') and path.is_file() and 'node_modules' not in path.parts:
            files += 1
            if not any(LICENCE.fullmatch(line) for line in path.read_text().split('\n', 2)[:2]):
                faults.append(f'{path.relative_to(source)}:1: the first or second line must be the comment '
                              'SPDX-License-Identifier: Apache-2.0')
    return faults if files >= 500 else faults + [f'found only {files} source files']


def main(source, folders_file):
    source = pathlib.Path(source)
    uses = {}
    for line in open(folders_file):
        folder, used = line.strip().split(':')
        uses[folder] = used.split()
    faults, graph, files = [], {}, 0
    for path in sorted(p for top in ('formats', 'shaders', 'runtime', 'bake') for p in (source / top).rglob('*')):
        if path.suffix not in ('.h', '.cpp'):
            continue
        files += 1
        name = path.relative_to(source)
        folder = str(name.parent)
        if folder not in uses and folder not in TOP:
            faults.append(f'{name}: no relief_folder() declares {folder}')
            continue
        allowed = set(uses) if folder in TOP else reachable(folder, uses)
        for number, line in enumerate(path.read_text().split('\n'), 1):
            ours = re.match(r'\s*#\s*include\s*"([^"]+)"', line)
            theirs = re.match(r'\s*#\s*include\s*<([^>]+)>', line)
            if theirs and theirs[1].split('/')[0] in THIRD_PARTIES:
                party = theirs[1].split('/')[0]
                if folder not in THIRD_PARTIES[party]:
                    faults.append(f'{name}:{number}: only {", ".join(THIRD_PARTIES[party])} may include {party}')
            if not ours or ours[1].endswith('_generated.h'):
                continue
            target = pathlib.Path(ours[1])
            if not (source / target).is_file():
                faults.append(f'{name}:{number}: {target} does not exist; includes start at the root')
            elif str(target.parent) not in allowed:
                faults.append(f'{name}:{number}: forbidden include: {folder} may not use {target.parent}')
            stem, other = str(name.with_suffix('')), str(target.with_suffix(''))
            if stem != other:
                graph.setdefault(stem, set()).add(other)
    faults += ['include cycle: ' + ', '.join(group) for group in cycles(graph)]
    faults += web_faults(source) + list_faults(source) + licence_faults(source)
    print('\n'.join(faults) if faults else f'{files} files in {len(uses)} folders, no forbidden include')
    return 1 if faults or files < 100 else 0


if __name__ == '__main__':
    sys.exit(main(*sys.argv[1:]))
