"""Writes height maps: heights.py FILE SIDE [KIND] with KIND hills, flat, step (before sample 20), step65 or rgb; by the name of FILE a PNG or raw samples.

heights.py --below DUMP.ply HIGH: how far any particle lies below such hills at 1 m, whose sample 65535 is HIGH; and the highest y.
"""
import math
import struct
import sys
import zlib


def sample(kind, x, z):
    if kind == 'flat':
        return 1234
    if kind in ('step', 'step65'):
        return 1000 if x < (65 if kind == 'step65' else 20) else 3000
    return round(20000 + 9000 * math.sin(x / 11) + 6000 * math.cos(z / 7))


def surface(x, z):
    """Bilinear between samples."""
    i, j = math.floor(x), math.floor(z)
    s, t = x - i, z - j
    return ((1 - t) * ((1 - s) * sample('hills', i, j) + s * sample('hills', i + 1, j)) +
            t * ((1 - s) * sample('hills', i, j + 1) + s * sample('hills', i + 1, j + 1)))


def below(dump, high):
    with open(dump, 'rb') as file:
        head, body = file.read().split(b'end_header\n', 1)
    words = [line.split() for line in head.decode().splitlines()]
    count = next(int(line[2]) for line in words if line[:2] == ['element', 'vertex'])
    form = '<' + ''.join({'float': 'f', 'int': 'i', 'uint': 'I', 'uchar': 'B'}[line[1]] for line in words if line[0] == 'property')
    names = [line[2] for line in words if line[0] == 'property']
    deepest = highest = -math.inf
    for values in struct.iter_unpack(form, body[:count * struct.calcsize(form)]):
        at = dict(zip(names, values))
        deepest = max(deepest, surface(at['x'], at['z']) * float(high) / 65535 - at['y'])
        highest = max(highest, at['y'])
    print(count, deepest, highest)


def chunk(name, data):
    return struct.pack('>I', len(data)) + name + data + struct.pack('>I', zlib.crc32(name + data))


def main(file, side, kind='hills'):
    side = int(side)
    rows = [[sample(kind, x, z) for x in range(side)] for z in range(side)]
    with open(file, 'wb') as out:
        if not file.endswith('.png'):
            for row in rows:
                out.write(struct.pack(f'<{side}H', *row))
            return
        colour = kind == 'rgb'
        lines = b''.join(b'\0' + struct.pack(f'>{side}H', *row) * (3 if colour else 1) for row in rows)
        header = struct.pack('>IIBBBBB', side, side, 16, 2 if colour else 0, 0, 0, 0)
        out.write(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) + chunk(b'IDAT', zlib.compress(lines)) + chunk(b'IEND', b''))


if __name__ == '__main__':
    below(*sys.argv[2:]) if sys.argv[1] == '--below' else main(*sys.argv[1:])
