"""Writes height maps: heights.py FILE SIDE [KIND] with KIND hills, flat, step or rgb; by the name of FILE a PNG or raw samples."""
import math
import struct
import sys
import zlib


def sample(kind, x, z):
    if kind == 'flat':
        return 1234
    if kind == 'step':
        return 1000 if x < 20 else 3000
    return round(20000 + 9000 * math.sin(x / 11) + 6000 * math.cos(z / 7))


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
    main(*sys.argv[1:])
