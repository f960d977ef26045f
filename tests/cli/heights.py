# SPDX-License-Identifier: Apache-2.0
"""Writes height maps: heights.py FILE SIDE [KIND], with KIND hills or step65 (at sample 65), as a PNG or raw samples by extension.

heights.py --below DUMP.ply HIGH MOST: fails if any of at least 3,001 particles is MOST or more below these hills, with a spacing of
1 m and with sample 65535 at HIGH.
"""
import math
import struct
import sys
import zlib

import ply


def sample(kind, x, z):
    if kind == 'step65':
        return 1000 if x < 65 else 3000
    return round(20000 + 9000 * math.sin(x / 11) + 6000 * math.cos(z / 7))


def surface(x, z):
    """The bilinear surface."""
    i, j = math.floor(x), math.floor(z)
    s, t = x - i, z - j
    return ((1 - t) * ((1 - s) * sample('hills', i, j) + s * sample('hills', i + 1, j)) +
            t * ((1 - s) * sample('hills', i, j + 1) + s * sample('hills', i + 1, j + 1)))


def below(dump, high, most):
    particles = ply.read(dump)
    deepest = max(surface(at['x'], at['z']) * float(high) / 65535 - at['y'] for at in particles)
    if len(particles) <= 3000 or deepest >= float(most):
        sys.exit(f'{len(particles)} particles, the deepest {deepest} below the hills')


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
        lines = b''.join(b'\0' + struct.pack(f'>{side}H', *row) for row in rows)
        header = struct.pack('>IIBBBBB', side, side, 16, 0, 0, 0, 0)
        out.write(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) + chunk(b'IDAT', zlib.compress(lines)) + chunk(b'IEND', b''))


if __name__ == '__main__':
    below(*sys.argv[2:]) if sys.argv[1] == '--below' else main(*sys.argv[1:])
