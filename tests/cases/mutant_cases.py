#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Broken meshes, and files of assimp-testmodels: `relief bake` writes a collider that `relief check` accepts, or fails with one
line that names the mesh. It leaves no other file and no process."""

import collections
import copy
import ctypes
import json
import os
import pathlib
import re
import signal
import struct
import sys

from cases import Cases

MODELS = pathlib.Path('/usr/share/assimp/models')
# A path below MODELS, and a file that it needs.
PACKAGED = [('OBJ/box.obj', None), ('PLY/cube.ply', None), ('PLY/cube_binary.ply', None), ('STL/Spider_ascii.stl', None),
            ('STL/Spider_binary.stl', None), ('glTF2/BoxTextured-glTF-Binary/BoxTextured.glb', None),
            ('glTF2/BoxTextured-glTF-Embedded/BoxTextured.gltf', None), ('glTF2/BoxTextured-glTF/BoxTextured.gltf', 'BoxTextured0.bin')]
TEXTS = ('box.obj', 'cube.ply', 'Spider_ascii.stl', 'BoxTextured.gltf')
OPTIONS = ('-o', 'out.relief', '--map', 'fixed8:size=16', '-q', '--import-timeout', '10', '--max-import-memory', '1GB')
UNSEEN = 'no map sees the surface'  # a flat mesh seen edge-on by its only map: exit code 4, not a failure
PR_SET_CHILD_SUBREAPER = 36


def glb(text, rest):
    """Returns a binary glTF with this JSON text; `rest` follows the JSON chunk."""
    text += b' ' * (-len(text) % 4)
    return struct.pack('<4sIIII', b'glTF', 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest


NUMBERS = [b'0', b'-1', b'1e39', b'-1e38', b'1e-320', b'nan', b'inf', b'-inf', b'4294967295', b'4294967296', b'2147483648',
           b'99999999999999999999', b'1e999', b'0x10', b'', b'1.', b'.', b'-', b'1e', b'9' * 5000, b'true', b'null', b'3']
WORDS = [0, 1, 3, 0xFF, 0xFFFF, 0x10000, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFE, 0xFFFFFFFF, 0x7F800000, 0x7FC00000,
         0x7F7FFFFF, 0x00000001, 0x10000000]
VALUES = [0, 1, 2, 3, -1, 0.5, 24, 5120, 5121, 5123, 5125, 5126, 2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**53, 2**63, 2**64,
          1e15, 1e38, 1e39, -1e300, 1e-320, None, True, '', 'SCALAR', 'VEC2', 'VEC4', 'MAT4', 'x' * 5000, [], {}, [0],
          [[[]]], '../x', '/dev/zero', 'data:;base64,AAAA', 'data:;base64,?']
NUMBER = re.compile(rb'-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?')


def flip(data, r):
    for _ in range(r.choice([1, 1, 2, 8])):
        data[r.randrange(len(data))] ^= 1 << r.randrange(8)


def truncate(data, r):
    del data[r.randrange(len(data)):]


def overwrite_word(data, r):
    """Changes 32 bits, mostly near the beginning, where headers are."""
    end = min(len(data), r.choice([32, 256, len(data)])) - 4
    if end > 0:
        struct.pack_into(r.choice(['<I', '>I']), data, r.randrange(end), r.choice(WORDS))


def change_float(data, r):
    if len(data) > 4:
        value = r.choice([0.0, r.uniform(-2, 2), r.uniform(-2, 2), 1e6, -1e20, 3e38, 1e-40])
        struct.pack_into(r.choice('<>') + 'f', data, r.randrange(len(data) - 4), value)


def splice(data, r):
    """Deletes a piece, copies it elsewhere, or inserts noise."""
    begin = r.randrange(len(data))
    piece = bytes(data[begin:begin + r.choice([1, 4, 50, 1000])])
    what = r.randrange(3)
    if what == 0:
        del data[begin:begin + len(piece)]
    else:
        at = r.randrange(len(data))
        data[at:at] = piece if what == 1 else bytes(r.randrange(256) for _ in piece)


def change_number(data, r):
    found = list(NUMBER.finditer(data))
    if found:
        match = r.choice(found[:20] if r.randrange(3) == 0 else found)  # counts come first
        other = [r.choice(NUMBERS), r.choice(found).group(), b'%.3f' % r.uniform(-3, 3)]
        data[match.start():match.end()] = r.choice(other)


def swap_tokens(data, r):
    found = list(re.finditer(rb'[^\s,]+', data))
    if len(found) > 1:
        first, second = sorted(r.sample(range(len(found)), 2))
        a, b = found[first], found[second]
        data[a.start():b.end()] = b.group() + data[a.end():b.start()] + a.group()


def change_lines(data, r):
    lines = data.split(b'\n')
    at = r.randrange(len(lines))
    what = r.randrange(4)
    if what == 0:
        del lines[at]
    elif what == 1:
        lines[at:at] = [lines[at]] * r.choice([1, 2, 1000])
    elif what == 2:
        other = r.randrange(len(lines))
        lines[at], lines[other] = lines[other], lines[at]
    else:
        del lines[at:at + r.choice([2, 10, 100])]
    data[:] = b'\n'.join(lines)


def nest(data, r):
    at = r.randrange(len(data))
    data[at:at] = r.choice([b'[', b'{"a":', b'(', b'\0', b'"', b'\\\n', b'\xff\xfe', b' ']) * r.choice([1, 100, 100000])


def mutate_json(text, r):
    """Changes values of the document; the syntax stays valid."""
    document = json.loads(text)
    for _ in range(r.choice([1, 1, 2, 4])):
        places = []  # pairs of a container and a key
        open_ = [document]
        while open_:
            node = open_.pop()
            for key in list(node) if isinstance(node, dict) else range(len(node)):
                places.append((node, key))
                if isinstance(node[key], (dict, list)):
                    open_.append(node[key])
        if not places:
            break
        node, key = r.choice(places)
        what = r.randrange(6)
        if what == 0:
            del node[key]
        elif what == 1:
            other, place = r.choice(places)
            node[key] = copy.deepcopy(other[place])
        elif what == 2 and isinstance(node, list):
            node[key:key] = [node[key]] * r.choice([1, 2, 1000])
        else:
            node[key] = r.choice(VALUES)
        document = json.loads(json.dumps(document))  # copy shared parts
    return json.dumps(document).encode()


BYTES = [flip, truncate, overwrite_word, overwrite_word, change_float, change_float, splice, change_number]
TEXT = [flip, truncate, splice, change_number, change_number, change_number, swap_tokens, change_lines, change_lines,
        nest]


def mutate(data, text, r):
    """Applies several mutations."""
    data = bytearray(data)
    for _ in range(r.choice([1, 1, 1, 2, 3])):
        if data:
            r.choice(TEXT if text else BYTES)(data, r)
    return bytes(data)


def write_mutant(folder, number, r):
    """Writes the mesh and returns its path."""
    path, beside = PACKAGED[number % len(PACKAGED)]
    path = MODELS / path
    data = path.read_bytes()
    other = (path.parent / beside).read_bytes() if beside else b''
    if number < len(PACKAGED):
        pass  # unchanged
    elif other and r.randrange(4) == 0:
        other = mutate(other, False, r)
    elif path.suffix == '.gltf' and r.randrange(4) != 0:
        data = mutate_json(data, r)
    elif path.suffix == '.glb' and r.randrange(2) == 0:  # the lengths are fixed up, so that the document is read
        size = struct.unpack_from('<I', data, 12)[0]
        document = data[20:20 + size]
        data = glb(mutate(document, True, r) if r.randrange(4) == 0 else mutate_json(document, r), data[20 + size:])
    else:
        data = mutate(data, path.name in TEXTS, r)
    if beside:
        (folder / beside).write_bytes(other)
    mesh = folder / f'mutant-{number}{path.suffix}'
    mesh.write_bytes(data)
    return mesh


def orphans():
    """Kills processes that outlived a bake; returns their ids."""
    children = [int(pid) for pid in pathlib.Path(f'/proc/self/task/{os.getpid()}/children').read_text().split()]
    for pid in children:
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)
    return children


def check(cases, folder, mesh, must_bake):
    """Returns the outcome."""
    given = set(os.listdir(folder))
    (folder / 'tmp').mkdir()
    done = cases.run('relief', 'bake', mesh, *OPTIONS, seconds=15, cwd=folder, env={**os.environ, 'TMPDIR': folder / 'tmp'})
    left = orphans()
    cases.expect(not left, f'{mesh.name}: processes are still running: {left}')
    if not done:
        return 'hung'
    files = sorted(set(os.listdir(folder)) - given - {'tmp'}) + os.listdir(folder / 'tmp')
    cases.expect(files == (['out.relief'] if done.returncode == 0 else []), f'{mesh.name}: exit code {done.returncode}, files {files}')
    if done.returncode == 0:
        sound = cases.run('relief', 'check', 'out.relief', cwd=folder)
        cases.expect(sound and sound.returncode == 0, f'{mesh.name}: baked, but invalid: {sound and sound.stdout}')
        return 'baked'
    lines = done.stderr.splitlines()
    cases.expect(len(lines) == 1 and lines[0].startswith('relief: error: ') and mesh.name in lines[0], f'{mesh.name}: {done.stderr}')
    cases.expect(not must_bake and (done.returncode in (3, 5, 6) or UNSEEN in done.stderr), f'{mesh.name}: exit code {done.returncode}: {done.stderr}')
    return f'exit code {done.returncode}'


def main():
    cases = Cases('mutants', 80)
    if ctypes.CDLL(None, use_errno=True).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0) != 0:
        sys.exit('mutant_cases.py: prctl: ' + os.strerror(ctypes.get_errno()))
    models = sorted(path for path in MODELS.rglob('*') if path.is_file())
    ends = collections.Counter()
    for number, folder in cases.each():
        packaged = number % 4 == 3 and number >= len(PACKAGED)  # every file in turn
        mesh = models[number // 4 % len(models)] if packaged else write_mutant(folder, number, cases.random)
        ends[check(cases, folder, mesh, number < len(PACKAGED))] += 1
    print('mutants: ' + ', '.join(f'{count} {end}' for end, count in sorted(ends.items())))
    cases.expect(cases.only is not None or {'baked', 'exit code 3'} <= set(ends), f'the mutants test nothing: {ends}')
    cases.finish()


main()
