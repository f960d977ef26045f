#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Broken mesh files, the same ones on every machine: mutant N is of the seed mesh N mod (their number).

    mutate.py N FOLDER    writes mutant N, and what it refers to, into FOLDER
"""
import copy
import json
import os
import random
import re
import struct
import sys

MODELS = '/usr/share/assimp/models/'
# Path below MODELS, what a table calls it, and the file beside it.
PACKAGED = [('OBJ/box.obj', 'OBJ', None), ('PLY/cube.ply', 'PLY, text', None),
            ('PLY/cube_binary.ply', 'PLY, binary', None), ('STL/Spider_ascii.stl', 'STL, text', None),
            ('STL/Spider_binary.stl', 'STL, binary', None), ('glTF2/BoxTextured-glTF-Binary/BoxTextured.glb', 'glb', None),
            ('glTF2/BoxTextured-glTF-Embedded/BoxTextured.gltf', 'glTF', None),
            ('glTF2/BoxTextured-glTF/BoxTextured.gltf', 'glTF', 'BoxTextured0.bin')]


def glb(text, rest):
    """The chunks of a binary glTF: JSON text, and everything behind it."""
    text += b' ' * (-len(text) % 4)
    return struct.pack('<4sIIII', b'glTF', 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest


def seeds():
    """Each a name, what a table calls it, bytes, and the files beside it by name."""
    def read(path):
        with open(MODELS + path, 'rb') as file:
            return file.read()

    return [(os.path.basename(path), kind, read(path), {beside: read(os.path.join(os.path.dirname(path), beside))} if beside else {})
            for path, kind, beside in PACKAGED]


# --- mutations ---

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
    """32 bits; most often near the beginning, where headers are."""
    end = min(len(data), r.choice([32, 256, len(data)])) - 4
    if end > 0:
        struct.pack_into(r.choice(['<I', '>I']), data, r.randrange(end), r.choice(WORDS))


def change_float(data, r):
    if len(data) > 4:
        value = r.choice([0.0, r.uniform(-2, 2), r.uniform(-2, 2), 1e6, -1e20, 3e38, 1e-40])
        struct.pack_into(r.choice('<>') + 'f', data, r.randrange(len(data) - 4), value)


def splice(data, r):
    """Cuts a piece out, or puts it in elsewhere, or noise."""
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
    """Another document, whose syntax is right."""
    document = json.loads(text)
    for _ in range(r.choice([1, 1, 2, 4])):
        places = []  # a container and a key each
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
        document = json.loads(json.dumps(document))  # no part is there twice
    return json.dumps(document).encode()


BYTES = [flip, truncate, overwrite_word, overwrite_word, change_float, change_float, splice, change_number]
TEXT = [flip, truncate, splice, change_number, change_number, change_number, swap_tokens, change_lines, change_lines,
        nest]


def mutate(data, text, r):
    """Some mutations one after another."""
    data = bytearray(data)
    for _ in range(r.choice([1, 1, 1, 2, 3])):
        if data:
            r.choice(TEXT if text else BYTES)(data, r)
    return bytes(data)


def mutant(number, meshes):
    """Name, kind, bytes and files beside it."""
    name, kind, data, beside = meshes[number % len(meshes)]
    r = random.Random(number)
    beside = dict(beside)
    if beside and r.randrange(4) == 0:
        other = sorted(beside)[0]
        beside[other] = mutate(beside[other], False, r)
    elif kind == 'glTF' and r.randrange(4) != 0:
        data = mutate_json(data, r)
    elif kind == 'glb' and r.randrange(2) == 0:  # the lengths fit, so that the document is looked at
        size = struct.unpack_from('<I', data, 12)[0]
        document = data[20:20 + size]
        document = mutate(document, True, r) if r.randrange(4) == 0 else mutate_json(document, r)
        data = glb(document, data[20 + size:])
    else:
        data = mutate(data, kind in ('OBJ', 'STL, text', 'PLY, text', 'glTF'), r)
    return 'mutant-%d%s' % (number, os.path.splitext(name)[1]), kind, data, beside


def write(folder, name, data, beside):
    for file, content in [(name, data), *beside.items()]:
        with open(os.path.join(folder, file), 'wb') as out:
            out.write(content)


if __name__ == '__main__':
    name_, _, data_, beside_ = mutant(int(sys.argv[1]), seeds())
    write(sys.argv[2], name_, data_, beside_)
    print(os.path.join(sys.argv[2], name_))
