# SPDX-License-Identifier: Apache-2.0
"""Writes containers (formats/README.md) with maps of any size in a few kilobytes."""

import ctypes
import struct

_ZSTD = ctypes.CDLL("libzstd.so.1")
_XXHASH = ctypes.CDLL("libxxhash.so.0")
_XXHASH.XXH3_64bits.restype = ctypes.c_uint64
_ZSTD.ZSTD_compressBound.restype = _ZSTD.ZSTD_compress.restype = ctypes.c_size_t

FIXED8, FRONT_BACK = 1, 4  # values of collider.fbs
LESS, BOTH = 0, 2
NONE, ZSTD = 0, 1
TEXEL = {FIXED8: 4, FRONT_BACK: 8}


def xxh3(data):
    return _XXHASH.XXH3_64bits(data, ctypes.c_size_t(len(data)))


def zstd(data, level=3):
    room = _ZSTD.ZSTD_compressBound(ctypes.c_size_t(len(data)))
    buffer = ctypes.create_string_buffer(room)
    size = _ZSTD.ZSTD_compress(buffer, ctypes.c_size_t(room), data, ctypes.c_size_t(len(data)), level)
    return buffer.raw[:size]


def zeros(size):
    """A zstd frame of `size` zeros, a multiple of 128 KiB, with four bytes for each 128 KiB."""
    block = 1 << 17
    blocks = size // block
    assert blocks * block == size
    frame = struct.pack("<IBBQ", 0xFD2FB528, 0xC0, 0x38, size)  # an 8-byte content size, a window of 128 KiB
    return frame + b"".join(struct.pack("<I", block << 3 | 2 | (i + 1 == blocks))[:3] + b"\0" for i in range(blocks))


class _Builder:
    """A minimal FlatBuffers writer. Children follow their parents, and their offsets are filled in later."""

    def __init__(self):
        self.bytes = bytearray(8)

    def align(self, to=8):
        self.bytes += bytes(-len(self.bytes) % to)

    def table(self, fields):
        """fields: (id, bytes or None, alignment); None reserves an offset. Returns the position of each field."""
        at, end = {}, 4
        for number, value, alignment in sorted(fields, key=lambda field: -field[2]):
            end += -end % alignment
            at[number] = end
            end += 4 if value is None else len(value)
        end += -end % 8
        count = max(at) + 1
        vtable = struct.pack("<HH", 4 + 2 * count, end) + b"".join(
            struct.pack("<H", at.get(i, 0)) for i in range(count))
        # The size of the table is a multiple of 8.
        self.bytes += bytes((-len(self.bytes) - len(vtable)) % 8) + vtable
        start = len(self.bytes)
        self.bytes += bytes(end)
        struct.pack_into("<i", self.bytes, start, len(vtable))
        for number, value, _ in fields:
            if value is not None:
                self.bytes[start + at[number]:start + at[number] + len(value)] = value
        return start, {number: start + place for number, place in at.items()}

    def point(self, place, to):
        struct.pack_into("<I", self.bytes, place, to - place)

    def string(self, place, text):
        self.align(4)
        self.point(place, len(self.bytes))
        self.bytes += struct.pack("<I", len(text)) + text.encode() + b"\0"


def _metadata(maps, offsets):
    build = _Builder()
    box = [struct.pack("<3f", -1, -1, -1), struct.pack("<3f", 1, 1, 1)]
    root, at = build.table([(0, box[0], 4), (1, box[1], 4), (2, None, 4), (3, None, 4), (4, None, 4)])
    build.point(0, root)
    build.bytes[4:8] = b"RLF2"
    build.string(at[2], "m")
    provenance, of = build.table([(0, None, 4), (1, None, 4), (2, struct.pack("<Q", 12), 8), (3, None, 4)])
    build.point(at[3], provenance)
    for field, text in [(0, "a.obj"), (1, "0" * 32), (3, "relief 0.1.0")]:
        build.string(of[field], text)
    build.align(4)
    build.point(at[4], len(build.bytes))
    build.bytes += struct.pack("<I", len(maps))
    vector = len(build.bytes)
    build.bytes += bytes(4 * len(maps))
    for i, (one, offset) in enumerate(zip(maps, offsets)):
        transform = struct.pack("<12f", .4, 0, 0, .5, 0, .4, 0, .5, 0, 0, .4, .5)
        payload = struct.pack("<4Q", offset, len(one["stored"]), one["raw_size"], xxh3(one["stored"]))
        table, _ = build.table([(0, bytes([one["format"]]), 1), (1, bytes([one["compare"]]), 1),
                                (2, struct.pack("<I", one["width"]), 4), (3, struct.pack("<I", one["height"]), 4),
                                (4, transform, 4), (5, struct.pack("<3f", 2.5, 2.5, 2.5), 4), (6, b"\1", 1),
                                (7, b"\1", 1), (8, bytes([one["packing"]]), 1), (9, payload, 8), (10, b"\1", 1)])
        build.point(vector + 4 * i, table)
    return bytes(build.bytes)


def empty_map(width, height, form=FRONT_BACK):
    """A map without a surface, which zstd compresses best."""
    raw = width * height * TEXEL[form]
    stored = zeros(raw) if raw % (1 << 17) == 0 else zstd(bytes(raw))
    packing = ZSTD if len(stored) < raw else NONE
    return {"format": form, "compare": BOTH if form == FRONT_BACK else LESS, "width": width, "height": height,
            "raw_size": raw, "stored": stored if packing == ZSTD else bytes(raw), "packing": packing}


def plain_map(width, height, texels, form=FRONT_BACK):
    """A map with these texels, uncompressed."""
    return {"format": form, "compare": BOTH if form == FRONT_BACK else LESS, "width": width, "height": height,
            "raw_size": len(texels), "stored": texels, "packing": NONE}


def container(maps):
    """The bytes of a valid container."""
    size = len(_metadata(maps, [0] * len(maps)))
    end, offsets = 64 + size, []
    for one in maps:
        offsets.append(-(-end // 64) * 64)
        end = offsets[-1] + len(one["stored"])
    metadata = _metadata(maps, offsets)
    header = b"\xabRELIEF\xbb\r\n\x1a\n" + struct.pack("<HHIIQQQQ", 2, 0, 64, 0, end, 64, size, xxh3(metadata))
    whole = bytearray(header + struct.pack("<Q", xxh3(header)) + metadata)
    for one, offset in zip(maps, offsets):
        whole += bytes(offset - len(whole)) + one["stored"]
    return bytes(whole)
