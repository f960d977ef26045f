# SPDX-License-Identifier: Apache-2.0
"""Reads binary PLY files of relief-sim without its code: read(path) returns a list of rows, each a dict of properties."""
import struct

KINDS = {'float': 'f', 'int': 'i', 'uint': 'I', 'uchar': 'B', 'ushort': 'H'}


def read(path):
    with open(path, 'rb') as file:
        head, body = file.read().split(b'end_header\n', 1)
    lines = [line.split() for line in head.decode().splitlines()]
    assert lines[:2] == [['ply'], ['format', 'binary_little_endian', '1.0']], lines
    count = next(int(line[2]) for line in lines if line[:2] == ['element', 'vertex'])
    properties = [line for line in lines if line[0] == 'property']
    record = struct.Struct('<' + ''.join(KINDS[line[1]] for line in properties))
    assert len(body) == count * record.size, f'{path}: {len(body)} bytes for {count} particles'
    names = [line[2] for line in properties]
    return [dict(zip(names, row)) for row in record.iter_unpack(body)]
