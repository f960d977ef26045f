#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Random height maps of every format, compared with bilinear interpolation of their samples: the ground is correct within the
reported error, holes have no ground, and `check` agrees. Raw samples read with another type or byte order are rejected, or give a
warning."""

import json
import math
import struct
import zlib

from cases import Cases
from solids import bake, query

POINTS = 2000
STEEPEST = 2.9  # rise over a side above which a square counts as steep
FLOOR = 0.05  # depth below the lowest point, as a fraction of the longest side
# Types of --heights, with the codes of struct.
TYPES = {"uint16": "H", "int16": "h", "float32": "f"}
ORDERS = {"little": "<", "big": ">"}


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def png(rows, most):
    letter, bits = ("B", 8) if most == 255 else ("H", 16)
    lines = b"".join(b"\0" + struct.pack(f">{len(row)}{letter}", *row) for row in rows)
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), bits, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b"")


def exr(rows):
    """An EXR with one float channel, one line per block, uncompressed."""
    columns = len(rows[0])
    window = struct.pack("<4i", 0, 0, columns - 1, len(rows) - 1)
    channel = b"Y\0" + struct.pack("<iB3xii", 2, 0, 1, 1) + b"\0"
    head = struct.pack("<II", 20000630, 2)
    for name, kind, value in (("channels", "chlist", channel), ("compression", "compression", b"\0"),
                              ("dataWindow", "box2i", window), ("displayWindow", "box2i", window), ("lineOrder", "lineOrder", b"\0"),
                              ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", bytes(8)),
                              ("screenWindowWidth", "float", struct.pack("<f", 1))):
        head += name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(value)) + value
    head += b"\0"
    first, size = len(head) + 8 * len(rows), 8 + 4 * columns
    table = b"".join(struct.pack("<Q", first + i * size) for i in range(len(rows)))
    return head + table + b"".join(struct.pack(f"<iI{columns}f", i, 4 * columns, *row) for i, row in enumerate(rows))


def raw(rows, kind, order):
    return b"".join(struct.pack(f"{ORDERS[order]}{len(row)}{TYPES[kind]}", *row) for row in rows)


def single(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


class Ground:
    """Waves of random size, sampled in a random format. heights[row][column] is None in a hole."""

    def __init__(self, random):
        self.format = random.choice(("png", "png", "exr", "raw", "raw", "raw", "raw", "hgt"))
        self.columns, self.rows = random.randint(9, 90), random.randint(9, 90)
        self.spacing = single(10 ** random.uniform(-1, 1.5))
        waves = [(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(0, 6)) for _ in range(3)]
        # Sometimes so steep that squares count as steep.
        size = self.spacing * random.choice((0.3, 1.0, 1.0, 4.0))
        base = random.uniform(-10, 10) * size
        shape = [[sum(math.sin(a * x + b * z + c) for a, b, c in waves) for x in range(self.columns)] for z in range(self.rows)]
        self.kind, self.order = "", ""
        if self.format in ("raw", "hgt"):
            self.kind = "int16" if self.format == "hgt" else random.choice(sorted(TYPES))
            self.order = "big" if self.format == "hgt" else random.choice(sorted(ORDERS))
        holes = random.random() < 0.4
        self.settings = [f"spacing={self.spacing!r}"]
        if self.format == "png" or self.kind == "uint16":
            most = random.choice((255, 65535)) if self.format == "png" else 65535
            low, high = base - 3.5 * size, base + 3.5 * size
            self.settings += [f"low={low!r}", f"high={high!r}"]
            hole, first = 0, 1
            samples = [[first + round((s + 3.2) / 6.4 * (most - first)) for s in row] for row in shape]
            height = lambda s: low + s * (high - low) / most
        elif self.kind == "int16":
            # Heights in whole metres need large waves.
            self.spacing = single(max(self.spacing, 5.0))
            self.settings = [f"spacing={self.spacing!r}"]
            size = self.spacing * random.choice((1.0, 4.0))
            hole = -32768
            samples = [[round(20 * size / self.spacing + size * s) for s in row] for row in shape]
            height = float
        else:
            most, hole = 0, -9999.0
            samples = [[single(base + size * s) for s in row] for row in shape]
            height = float
        if self.format == "png":
            self.data = lambda: png(samples, most)
        elif self.format == "exr":
            hole = math.nan if random.random() < 0.5 else hole
            self.data = lambda: exr(samples)
        else:
            self.data = lambda: raw(samples, self.kind, self.order)
        self.heights = [[height(s) for s in row] for row in samples]
        if holes:
            if hole == hole and self.format != "hgt":
                self.settings.append(f"hole={hole!r}")
            for _ in range(random.randint(1, 12)):
                x, z = random.randrange(self.columns), random.randrange(self.rows)
                samples[z][x], self.heights[z][x] = hole, None
        self.name = {"raw": random.choice(("a.raw", "a.bil", "a.bin", "a"))}.get(self.format, f"a.{self.format}")
        self.format_settings = []
        if self.format in ("raw", "hgt"):
            self.format_settings.append(f"width={self.columns}")
        if self.format == "raw":
            self.format_settings += ([f"type={self.kind}"] if self.kind != "uint16" else []) + \
                ([f"order={self.order}"] if self.order != "little" else [])

    def corners(self, x, z):
        return [self.heights[z + j][x + i] for j in (0, 1) for i in (0, 1)]

    def at(self, x, z):
        """Bilinear height at samples x, z; None in a square with a hole."""
        i, j = min(int(x), self.columns - 2), min(int(z), self.rows - 2)
        a, b, c, d = self.corners(i, j)
        if None in (a, b, c, d):
            return None
        s, t = x - i, z - j
        return (1 - t) * ((1 - s) * a + s * b) + t * ((1 - s) * c + s * d)

    def steep(self, x, z):
        """Whether the report counts the square as steep: along a side, or along a diagonal."""
        corners = self.corners(x, z)
        if None in corners:
            return False
        a, b, c, d = corners
        rises = max(abs(a - b), abs(c - d)), max(abs(a - c), abs(b - d))
        return max(rises) > 0.6 * STEEPEST * self.spacing

    def near_steep(self, x, z):
        return any(self.steep(i, j) for i in range(max(x - 5, 0), min(x + 6, self.columns - 1))
                   for j in range(max(z - 5, 0), min(z + 6, self.rows - 1)))


def check_points(cases, folder, ground, stated):
    random = cases.random
    known = [h for row in ground.heights for h in row if h is not None]
    low, high = min(known), max(known)
    margin = stated * 1.01 + 1e-5 * max(abs(low), abs(high), ground.spacing * max(ground.columns, ground.rows)) + 1e-4 * ground.spacing
    floor = FLOOR * max(ground.spacing * (max(ground.columns, ground.rows) - 1), high - low)
    points, truths = [], []
    while len(points) < POINTS:
        x, z = random.uniform(0, ground.columns - 1), random.uniform(0, ground.rows - 1)
        i, j = min(int(x), ground.columns - 2), min(int(z), ground.rows - 2)
        h = ground.at(x, z)
        if h is None:
            if min(x - i, 1 - x + i, z - j, 1 - z + j) < 0.15 or ground.near_steep(i, j):
                continue
            points.append((x * ground.spacing, random.uniform(low - 0.5 * floor, high), z * ground.spacing))
            truths.append(False)
            continue
        if ground.near_steep(i, j) or min(x, z, ground.columns - 1 - x, ground.rows - 1 - z) < 0.01:
            if random.random() < 0.02:
                points.append((x * ground.spacing, h, z * ground.spacing))
                truths.append(None)
            continue
        inside = random.random() < 0.5
        points.append((x * ground.spacing, h + (-1 if inside else 1) * random.choice((1.0, 1.5, 10.0)) * margin, z * ground.spacing))
        truths.append(inside)
        if inside and points[-1][1] < low - 0.9 * floor:
            truths[-1] = None
    rows = query(cases, folder, "a.relief", points)
    wrong = [(p, truth) for p, row, truth in zip(points, rows or [], truths) if truth is not None and (row[3] < 0) != truth]
    cases.expect(not wrong, f"{len(wrong)} of {POINTS} points are wrong, first {wrong[:1]}, reported error {stated}")


def check_other_formats(cases, folder, ground):
    """Bakes the samples as another type or with another byte order."""
    kind, order = cases.random.choice([(k, o) for k in TYPES for o in ORDERS if (k, o) != (ground.kind, ground.order)])
    settings = [f"spacing={ground.spacing!r}", f"width={ground.columns}", f"type={kind}", f"order={order}"]
    settings += ["low=0", f"high={100 * ground.spacing!r}"] if kind == "uint16" else []
    done = cases.run("relief", "bake", ground.name, "-o", "b.relief", "--heights", ",".join(settings), cwd=folder)
    named = done and any(words in done.stderr for words in ("another format", "hole=", "type and order", "give --heights", "rows of"))
    cases.expect(named, f"{ground.kind} {ground.order} is read as {kind} {order} without a warning about the format: {done and done.stderr}")


def check(cases, folder):
    ground = Ground(cases.random)
    (folder / ground.name).write_bytes(ground.data())
    settings = ",".join(ground.settings + ground.format_settings)
    if all(None in ground.corners(x, z) for x in range(ground.columns - 1) for z in range(ground.rows - 1)):
        return
    done = bake(cases, folder, ground.name, "-o", "a.relief", "--heights", settings, "--json")
    if not done:
        return
    report = json.loads(done.stdout)
    cases.expect((report["columns"], report["rows"]) == (ground.columns, ground.rows), "wrong size")
    if report["error_max"] is not None:
        check_points(cases, folder, ground, report["error_max"])
    checked = cases.run("relief", "check", "a.relief", "--mesh", ground.name, "--samples", "2000", "--json", cwd=folder)
    if cases.expect(checked and checked.returncode == 0, f"check failed: {checked and checked.stderr}"):
        wrong = json.loads(checked.stdout)["near"]["wrong_percent"]
        cases.expect(wrong < 1, f"check finds {wrong} % wrong")
    if ground.format == "raw" and not any(None in row for row in ground.heights):  # holes are spikes in another format
        check_other_formats(cases, folder, ground)


def main():
    cases = Cases("heights", 30)
    for _, folder in cases.each():
        check(cases, folder)
    cases.finish()


main()
