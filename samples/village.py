#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes a village from formulas: village.py OUT

Writes OUT/village.glb, about five hundred objects on a terrain, with a material for each part, and OUT/meshes, one
coloured PLY per shape for pictures. The output is reproducible. Needs only Python.
"""
import math
import os
import random
import struct
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from gltf import Gltf  # noqa: E402
from meshes import smooth_noise  # noqa: E402

HALF = 64.0  # metres from the centre to the border
CELLS = 240

MATERIALS = {  # sRGB
    "grass": (0.36, 0.43, 0.20), "path": (0.50, 0.42, 0.32), "plaster": (0.86, 0.80, 0.68), "ochre": (0.80, 0.62, 0.38),
    "rose": (0.76, 0.53, 0.45), "timber": (0.30, 0.20, 0.13), "roof": (0.60, 0.27, 0.17), "slate": (0.30, 0.33, 0.38),
    "thatch": (0.60, 0.50, 0.30), "stone": (0.55, 0.53, 0.49), "door": (0.20, 0.33, 0.30), "glass": (0.16, 0.20, 0.25),
    "wood": (0.47, 0.34, 0.21), "iron": (0.17, 0.17, 0.19), "canvas": (0.84, 0.80, 0.70), "straw": (0.76, 0.62, 0.30),
    "leaves": (0.25, 0.36, 0.14), "autumn": (0.66, 0.38, 0.12), "needles": (0.14, 0.25, 0.17), "bark": (0.27, 0.21, 0.16),
    "water": (0.20, 0.30, 0.34), "embers": (0.95, 0.36, 0.08),
    # for kitchen.py
    "enamel": (0.86, 0.87, 0.84), "hot plate": (0.20, 0.12, 0.11), "china": (0.33, 0.47, 0.62), "tiles": (0.52, 0.60, 0.60),
}
WARM = ("water", "embers")  # melt snow


class Shape:
    """Triangles, each with a material."""

    def __init__(self):
        self.points, self.triangles, self.materials = [], [], []
        self.colors = None  # colours of the points in pictures; None: colours of the materials

    def add(self, points, faces, material):
        """faces: triangles, or convex polygons, which become fans."""
        first = len(self.points)
        fans = [tuple(first + i for i in (f[0], f[k], f[k + 1])) for f in faces for k in range(1, len(f) - 1)]
        self.points += points
        self.triangles += fans
        self.materials += [material] * len(fans)
        return self

    def bar(self, corners, material):
        """A hexahedron: four corners of one end, then those of the other."""
        sides = [(i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i) for i in range(4)]
        return self.add(corners, [(0, 3, 2, 1), (4, 5, 6, 7)] + sides, material)

    def box(self, low, high, material, turn=0.0, about=(0.0, 0.0)):
        """turn: radians about the vertical axis through `about`, (x, z)."""
        corners = []
        for i in range(8):
            x, y, z = (high[k] if i >> k & 1 else low[k] for k in range(3))
            c, s = math.cos(turn), math.sin(turn)
            dx, dz = x - about[0], z - about[1]
            corners.append((about[0] + c * dx + s * dz, y, about[1] - s * dx + c * dz))
        return self.add(corners, [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)], material)

    def beam(self, a, b, thick, material):
        """A square bar from a to b."""
        along = [q - p for p, q in zip(a, b)]
        length = math.sqrt(sum(x * x for x in along))
        w = [x / length for x in along]
        side = (0.0, 1.0, 0.0) if abs(w[1]) < 0.9 else (1.0, 0.0, 0.0)
        u = cross(side, w)
        size = math.sqrt(sum(x * x for x in u))
        u = [0.5 * thick * x / size for x in u]
        v = cross(w, u)
        return self.bar([tuple(p[k] + i * u[k] + j * v[k] for k in range(3))
                         for p in (a, b) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))], material)

    def turned(self, profile, sides, material, at=(0.0, 0.0, 0.0)):
        """A solid of revolution about the vertical axis through `at`. profile: (radius, height) upwards."""
        points = [(at[0] + r * math.cos(2 * math.pi * k / sides), at[1] + h, at[2] - r * math.sin(2 * math.pi * k / sides))
                  for r, h in profile for k in range(sides)]
        faces, last, count = strips(len(profile), sides), len(points) - sides, len(points)
        for k in range(sides):
            faces += [(count, (k + 1) % sides, k), (count + 1, last + k, last + (k + 1) % sides)]
        return self.add(points + [(at[0], at[1] + profile[i][1], at[2]) for i in (0, -1)], faces, material)

    def blob(self, at, radius, rough, seed, material, flat=1.0, steps=2):
        """A ball with bumps."""
        points, triangles = sphere(steps)
        moved = []
        for x, y, z in points:
            bump = 1.0 + rough * (smooth_noise(2.3 * x + 31.7 * seed, 2.3 * y + 5.1 * z + 3.7 * seed) +
                                  0.5 * smooth_noise(5.1 * z + 9.1 * seed, 4.7 * x - 3.9 * y))
            bump += 0.35 * rough * smooth_noise(11.0 * x + 7.0 * seed, 11.0 * y + 13.0 * z)
            moved.append((at[0] + radius * bump * x, at[1] + flat * radius * bump * y, at[2] + radius * bump * z))
        return self.add(moved, triangles, material)

    def roof(self, x, z, eaves, ridge, over, thick, material):
        """A gable roof over [-x, x] × [-z, z] with its ridge along x."""
        slope = (ridge - eaves) / z
        low = eaves - over * slope
        profile = [(-(z + over), low), (0.0, ridge), (z + over, low), (z + over, low + thick), (0.0, ridge + thick), (-(z + over), low + thick)]
        return self.prism(profile, -x - over, x + over, material)

    def prism(self, profile, x0, x1, material):
        """A prism along x. profile: six corners (z, y), three on the lower side from -z to z, three on the upper side back."""
        points = [(x, y, w) for x in (x0, x1) for w, y in profile]
        n = len(profile)
        faces = []
        for k in range(n):
            a, b = k, (k + 1) % n
            faces += [(a, n + b, b), (a, n + a, n + b)]
        for quad in ((0, 1, 4, 5), (1, 2, 3, 4)):
            faces += [quad, (n + quad[0], n + quad[2], n + quad[1]), (n + quad[0], n + quad[3], n + quad[2])]
        return self.add(points, faces, material)

    def gable(self, x, z, base, eaves, ridge, material):
        """Gable walls over [-x, x] × [-z, z] up to a ridge along x."""
        points = [(sx * x, y, w) for sx in (-1, 1) for w, y in ((-z, base), (z, base), (z, eaves), (0.0, ridge), (-z, eaves))]
        triangles = [(0, 1, 2), (0, 2, 4), (2, 3, 4), (5, 7, 6), (5, 9, 7), (7, 9, 8)]
        for a, b in ((0, 1), (1, 2), (2, 3), (3, 4), (4, 0)):
            triangles += [(a, 5 + a, 5 + b), (a, 5 + b, b)]
        return self.add(points, [(a, c, b) for a, b, c in triangles] if signed(points, triangles) < 0 else triangles, material)


def strips(rings, sides):
    """Quads between consecutive rings of points."""
    return [(i * sides + k, i * sides + (k + 1) % sides, (i + 1) * sides + (k + 1) % sides, (i + 1) * sides + k)
            for i in range(rings - 1) for k in range(sides)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def signed(points, triangles):
    """Six times the signed volume."""
    return sum(sum(p * q for p, q in zip(points[a], cross(points[b], points[c]))) for a, b, c in triangles)


SPHERES = {}


def sphere(steps):
    """A unit sphere: an octahedron whose triangles are split into four, `steps` times."""
    if steps not in SPHERES:
        points = [(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)]
        triangles = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
        for _ in range(steps):
            middles, finer = {}, []

            def middle(a, b):
                key = (min(a, b), max(a, b))
                if key not in middles:
                    p = [points[a][k] + points[b][k] for k in range(3)]
                    size = math.sqrt(sum(x * x for x in p))
                    middles[key] = len(points)
                    points.append(tuple(x / size for x in p))
                return middles[key]

            for a, b, c in triangles:
                ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
                finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
            triangles = finer
        SPHERES[steps] = points, triangles
    return SPHERES[steps]


def house(x, z, eaves, ridge, wall, roof, chimney, upper):
    """x, z: half extents; upper: height of an overhanging upper floor, or 0."""
    s = Shape()
    s.box((-x - 0.06, -1.0, -z - 0.06), (x + 0.06, 0.45, z + 0.06), "stone")
    s.gable(x, z, 0.4, eaves, ridge, wall)
    out = 0.05
    if upper:
        s.box((-x - 0.22, upper, -z - 0.22), (x + 0.22, eaves - 0.02, z + 0.22), wall)
        out = 0.27
    s.roof(x + (0.2 if upper else 0.0), z + (0.2 if upper else 0.0), eaves, ridge, 0.55, 0.16, roof)
    # Posts, rails and braces protrude from the walls.
    for side in (-1, 1):
        for k in range(5):
            at = -x + 2 * x * k / 4
            s.beam((at, upper or 0.45, side * (z + out - 0.04)), (at, eaves, side * (z + out - 0.04)), 0.16, "timber")
        for k in range(4):
            at = side * (x + out - 0.04)
            w = -z + 2 * z * k / 3
            top = eaves + (ridge - eaves) * (1.0 - abs(w) / z) - 0.1
            s.beam((at, upper or 0.45, w), (at, top, w), 0.16, "timber")
        for y in ((upper or 0.5) + 0.08, eaves - 0.12):
            s.beam((-x - out, y, side * (z + out - 0.04)), (x + out, y, side * (z + out - 0.04)), 0.16, "timber")
            s.beam((side * (x + out - 0.04), y, -z - out), (side * (x + out - 0.04), y, z + out), 0.16, "timber")
        for k in (0, 3):
            a, b = -x + 2 * x * k / 4, -x + 2 * x * (k + 1) / 4
            s.beam((a, upper or 0.5, side * (z + out - 0.05)), (b, eaves - 0.1, side * (z + out - 0.05)), 0.13, "timber")
    s.box((-0.55, 0.4, z - 0.05), (0.55, 2.35, z + 0.09), "door")
    s.box((-0.7, 0.4, z - 0.05), (-0.55, 2.5, z + 0.13), "timber").box((0.55, 0.4, z - 0.05), (0.7, 2.5, z + 0.13), "timber")
    s.box((-0.7, 2.35, z - 0.05), (0.7, 2.5, z + 0.13), "timber").box((-0.8, -0.6, z), (0.8, 0.4, z + 0.8), "stone")
    y = (upper + 0.55) if upper else 1.2
    for w in (-0.62 * x, 0.62 * x):
        for side in (-1, 1):
            low, high = side * (z + out - 0.1), side * (z + out + 0.03)
            s.box((w - 0.42, y, min(low, high)), (w + 0.42, y + 0.95, max(low, high)), "glass")
            for a, b, c, d in ((-0.5, 0.5, -0.08, 0.0), (-0.5, 0.5, 0.95, 1.05), (-0.5, -0.42, -0.08, 1.05), (0.42, 0.5, -0.08, 1.05), (-0.03, 0.03, 0.0, 0.95)):
                edge = side * (z + out + 0.07)
                s.box((w + a, y + c, min(low, edge)), (w + b, y + d, max(low, edge)), "timber")
    if chimney:
        at = 0.55 * x
        s.box((at - 0.38, eaves - 0.5, -0.38 - 0.3 * z), (at + 0.38, ridge + 0.9, 0.38 - 0.3 * z), "stone")
        s.box((at - 0.46, ridge + 0.9, -0.46 - 0.3 * z), (at + 0.46, ridge + 1.05, 0.46 - 0.3 * z), "stone")
    return s


def church():
    s = house(7.0, 4.0, 5.2, 9.4, "plaster", "slate", False, 0)
    s.box((-11.0, -1.0, -2.2), (-6.6, 13.0, 2.2), "stone")
    s.box((-11.2, 12.8, -2.4), (-6.4, 13.2, 2.4), "stone")
    s.turned([(3.3, 13.2), (1.6, 16.0), (0.06, 22.5)], 4, "slate", (-8.8, 0.0, 0.0))
    s.beam((-8.8, 22.3, 0.0), (-8.8, 24.0, 0.0), 0.12, "iron").beam((-9.3, 23.4, 0.0), (-8.3, 23.4, 0.0), 0.12, "iron")
    for z in (-2.25, 2.25):
        s.box((-9.4, 9.6, z - 0.08), (-8.2, 11.6, z + 0.08), "timber")
    return s


def mill():
    s = Shape()
    s.turned([(3.4, -1.0), (3.1, 0.6), (2.9, 0.7), (2.1, 8.2)], 24, "plaster")
    s.turned([(2.45, 8.1), (2.45, 8.35), (1.9, 9.5), (0.9, 10.4), (0.05, 10.7)], 24, "roof")
    s.beam((0.0, 8.9, 1.2), (0.0, 9.05, 3.3), 0.4, "timber")
    s.box((-0.6, 0.0, 2.7), (0.6, 2.2, 3.15), "door")
    for y, w in ((3.6, 2.55), (6.0, 2.25)):
        s.box((-0.35, y, w - 0.2), (0.35, y + 0.9, w + 0.12), "glass")
    return s


def sails():
    """The sails about their axle, the z axis."""
    s = Shape()
    s.beam((0.0, 0.0, -0.4), (0.0, 0.0, 0.5), 0.55, "timber")
    for k in range(4):
        a = math.pi / 2 * k
        c, w = math.cos(a), math.sin(a)

        def at(r, q, z=0.0):
            return (c * r - w * q, w * r + c * q, z)

        s.beam(at(0.2, 0.0), at(6.3, 0.0), 0.18, "timber")
        s.beam(at(1.4, 1.25), at(6.2, 1.25), 0.07, "wood")
        for i in range(9):
            r = 1.4 + 0.6 * i
            s.beam(at(r, -0.1), at(r, 1.3), 0.07, "wood")
        corners = [at(1.5, 0.1), at(6.1, 0.1), at(6.1, 1.2), at(1.5, 1.2)]
        s.bar([(x, y, z) for z in (-0.05, 0.02) for x, y, _ in corners], "canvas")
    return s


def tree(seed, leaves):
    rng = random.Random(seed)
    s = Shape()
    tall = rng.uniform(2.4, 3.2)
    s.turned([(0.34, -0.6), (0.24, 0.4), (0.18, tall), (0.08, tall + 1.6)], 10, "bark")
    for k in range(3):
        a = 2.1 * k + rng.uniform(0, 1)
        s.beam((0.0, tall - 0.3, 0.0), (1.1 * math.cos(a), tall + 1.1, 1.1 * math.sin(a)), 0.12, "bark")
        s.blob((1.15 * math.cos(a), tall + 1.2 + 0.3 * k, 1.15 * math.sin(a)), rng.uniform(1.1, 1.5), 0.3, seed + k, leaves, 0.85, 3)
    s.blob((0.0, tall + 2.3, 0.0), 1.6, 0.3, seed + 7, leaves, 1.0, 3)
    return s


def spruce(seed):
    rng = random.Random(seed)
    s = Shape()
    s.turned([(0.22, -0.6), (0.2, 0.8)], 8, "bark")
    tall, layers = rng.uniform(6.0, 8.0), 6
    for k in range(layers):
        y = 0.7 + (tall - 0.7) * k / layers
        wide = 1.9 * (1.0 - k / (layers + 0.6)) + 0.15
        s.turned([(0.25 * wide, y + 0.25), (wide, y), (0.62 * wide, y + 0.5), (0.06, y + 2.0 * (tall - 0.7) / layers)], 11, "needles")
    return s


def rock(seed):
    return Shape().blob((0.0, 0.1, 0.0), 0.55, 0.3, seed, "stone", 0.7, 2)


def bush(seed):
    s = Shape()
    for k in range(3):
        s.blob((0.35 * math.cos(2.1 * k), 0.35 + 0.1 * k, 0.35 * math.sin(2.1 * k)), 0.5, 0.25, seed + k, "leaves", 0.8)
    return s


def barrel():
    s = Shape().turned([(0.29, 0.0), (0.36, 0.25), (0.38, 0.45), (0.36, 0.65), (0.29, 0.9)], 16, "wood")
    for y in (0.16, 0.68):
        s.turned([(0.355, y), (0.365, y + 0.07)], 16, "iron")
    return s


def crate():
    s = Shape().box((-0.4, 0.0, -0.4), (0.4, 0.8, 0.4), "wood")
    for x in (-0.4, 0.4):
        for z in (-0.4, 0.4):
            s.box((x - 0.05, -0.01, z - 0.05), (x + 0.05, 0.82, z + 0.05), "timber")
    for y in (0.0, 0.74):
        s.box((-0.44, y, -0.44), (0.44, y + 0.08, 0.44), "timber")
    return s


def fence():
    """A fence section, two metres along x."""
    s = Shape()
    for x in (-1.0, 0.0):
        s.box((x - 0.06, -0.4, -0.06), (x + 0.06, 1.15, 0.06), "wood")
    for y in (0.4, 0.85):
        s.box((-1.02, y, -0.035), (1.0, y + 0.12, 0.035), "wood")
    return s


def bench():
    s = Shape().box((-0.9, 0.42, -0.22), (0.9, 0.5, 0.22), "wood").box((-0.9, 0.62, -0.3), (0.9, 0.95, -0.24), "wood")
    for x in (-0.7, 0.7):
        s.box((x - 0.06, -0.1, -0.2), (x + 0.06, 0.43, 0.2), "iron").box((x - 0.04, 0.4, -0.28), (x + 0.04, 0.93, -0.22), "iron")
    return s


def table():
    s = Shape().box((-1.0, 0.7, -0.45), (1.0, 0.78, 0.45), "wood")
    for x in (-0.85, 0.85):
        for z in (-0.33, 0.33):
            s.box((x - 0.06, -0.1, z - 0.06), (x + 0.06, 0.72, z + 0.06), "wood")
    return s


def well():
    s = Shape()
    # The wall around the water.
    ring = [(1.1, -0.6), (1.1, 0.85), (0.8, 0.85), (0.8, 0.5)]
    sides = 20
    points = [(r * math.cos(2 * math.pi * k / sides), y, -r * math.sin(2 * math.pi * k / sides)) for r, y in ring for k in range(sides)]
    bottom = [(len(points), (k + 1) % sides, k) for k in range(sides)]
    s.add(points + [(0.0, -0.6, 0.0)], strips(len(ring), sides) + bottom, "stone")
    disc = [points[3 * sides + k] for k in range(sides)] + [(0.0, 0.5, 0.0)]
    s.add(disc, [(sides, k, (k + 1) % sides) for k in range(sides)], "water")
    for x in (-0.95, 0.95):
        s.box((x - 0.08, 0.6, -0.08), (x + 0.08, 2.4, 0.08), "timber")
    s.beam((-1.0, 1.7, 0.0), (1.0, 1.7, 0.0), 0.14, "wood")
    return s.roof(1.1, 0.75, 2.35, 3.0, 0.2, 0.1, "roof")


def lantern():
    s = Shape().turned([(0.14, -0.3), (0.1, 0.3), (0.05, 0.4), (0.05, 2.6)], 10, "iron")
    s.box((-0.14, 2.6, -0.14), (0.14, 3.0, 0.14), "canvas")
    return s.turned([(0.26, 3.0), (0.03, 3.28)], 8, "iron")


def hay():
    return Shape().turned([(1.0, -0.3), (1.15, 0.5), (0.9, 1.3), (0.35, 1.9), (0.06, 2.1)], 14, "straw")


def cart():
    s = Shape().box((-1.2, 0.6, -0.6), (1.2, 0.7, 0.6), "wood")
    for z in (-0.6, 0.54):
        s.box((-1.2, 0.68, z), (1.2, 1.1, z + 0.06), "wood")
    for z in (-0.76, 0.68):
        for k in range(16):
            a, b = math.pi * k / 8, math.pi * (k + 1) / 8
            s.beam((0.55 * math.cos(a), 0.5 + 0.55 * math.sin(a), z + 0.04), (0.55 * math.cos(b), 0.5 + 0.55 * math.sin(b), z + 0.04), 0.09, "timber")
        for k in range(4):
            a = math.pi * k / 4
            s.beam((-0.52 * math.cos(a), 0.5 - 0.52 * math.sin(a), z + 0.04), (0.52 * math.cos(a), 0.5 + 0.52 * math.sin(a), z + 0.04), 0.05, "wood")
    for z in (-0.35, 0.35):
        s.beam((1.1, 0.65, z), (2.7, 0.35, z), 0.08, "wood")
    return s.blob((-0.2, 0.85, 0.0), 0.62, 0.12, 5, "straw", 0.7)


def brazier():
    """A bowl of embers on three legs."""
    s = Shape()
    for k in range(3):
        a = 2.1 * k
        s.beam((0.3 * math.cos(a), -0.05, 0.3 * math.sin(a)), (0.2 * math.cos(a), 0.62, 0.2 * math.sin(a)), 0.06, "iron")
    s.turned([(0.12, 0.55), (0.42, 0.72), (0.48, 0.92)], 16, "iron")
    return s.blob((0.0, 0.9, 0.0), 0.36, 0.15, 3, "embers", 0.45)


def woodpile():
    s = Shape()
    for row in range(4):
        for k in range(7 - row % 2):
            x, y = -0.78 + 0.24 * k + 0.12 * (row % 2), 0.12 + 0.21 * row
            sides = 8
            ends = [(x + 0.115 * math.cos(2 * math.pi * i / sides), y + 0.115 * math.sin(2 * math.pi * i / sides)) for i in range(sides)]
            points = [(u, w, z) for z in (-0.5, 0.5) for u, w in ends] + [(x, y, -0.5), (x, y, 0.5)]
            triangles = []
            for i in range(sides):
                j = (i + 1) % sides
                triangles += [(i, j, sides + j), (i, sides + j, sides + i), (2 * sides, j, i), (2 * sides + 1, sides + i, sides + j)]
            s.add(points, triangles if signed(points, triangles) > 0 else [(a, c, b) for a, b, c in triangles], "bark" if row % 2 else "wood")
    return s


def path_distance(x, z):
    """The distance to the centre line of the nearest path: one winds along z, one branches off to the mill."""
    street = abs(x - 3.0 * math.sin(z / 15.0)) * 0.95
    branch = abs(z + 14.0 - 0.10 * (x - 3.0) - 3.0 * math.sin(x / 9.0)) if x > 0 else 1e9
    square = max(0.0, math.hypot(x - 1.0, z - 4.0) - 6.0)
    return min(street, branch, square)


def ground(x, z):
    """The height of the ground in metres: hills around a valley, with the hill of the mill in the north-east."""
    away = max(0.0, math.hypot(x * 0.85, z * 0.8) - 26.0)
    hills = 0.0062 * away * away * (0.7 + 0.5 * smooth_noise(x / 22.0 + 3.0, z / 22.0))
    mound = 5.0 * math.exp(-((x - 29.0) ** 2 + (z + 21.0) ** 2) / 190.0)
    bumps = 0.5 * smooth_noise(x / 13.0, z / 13.0 + 4.0) + 0.12 * smooth_noise(x / 3.1 + 9.0, z / 3.1)
    pond = 1.6 * math.exp(-((x + 17.0) ** 2 + (z - 15.0) ** 2) / 34.0)
    return hills + mound + bumps * min(1.0, max(0.0, path_distance(x, z) - 1.0) / 6.0) - pond


def terrain():
    s = Shape()
    step = 2 * HALF / CELLS
    s.points = [(-HALF + i * step, ground(-HALF + i * step, -HALF + k * step), -HALF + k * step) for k in range(CELLS + 1) for i in range(CELLS + 1)]
    for k in range(CELLS):
        for i in range(CELLS):
            a = k * (CELLS + 1) + i
            b, c, d = a + 1, a + CELLS + 1, a + CELLS + 2
            for t in ((a, c, b), (b, c, d)):
                x = sum(s.points[j][0] for j in t) / 3
                z = sum(s.points[j][2] for j in t) / 3
                rag = 0.5 * smooth_noise(1.3 * x, 1.3 * z)
                s.triangles.append(t)
                s.materials.append("path" if path_distance(x, z) + rag < 1.5 else "grass")
    s.colors = [ground_color(x, z) for x, _, z in s.points]
    return s


def ground_color(x, z):
    path = min(1.0, max(0.0, (2.0 - path_distance(x, z) - 0.6 * smooth_noise(1.3 * x, 1.3 * z)) / 1.0))
    dry = 0.5 + 0.5 * smooth_noise(x / 7.0, z / 7.0)
    tuft = 0.04 * smooth_noise(3.0 * x, 3.0 * z)
    meadow = [a + dry * (b - a) + tuft for a, b in zip((0.27, 0.38, 0.15), (0.47, 0.48, 0.24))]
    return tuple(a + path * (b - a) for a, b in zip(meadow, MATERIALS["path"]))


def pond():
    ring = [(5.2 * math.cos(2 * math.pi * k / 40), 0.0, -5.2 * math.sin(2 * math.pi * k / 40)) for k in range(40)]
    low = [(x, -0.6, z) for x, _, z in ring]
    faces = [(80, k, (k + 1) % 40) for k in range(40)] + [(81, 40 + (k + 1) % 40, 40 + k) for k in range(40)]
    faces += [(40 + k, 40 + (k + 1) % 40, (k + 1) % 40, k) for k in range(40)]
    return Shape().add(ring + low + [(0.0, 0.0, 0.0), (0.0, -0.6, 0.0)], faces, "water")


def shapes():
    made = {
        "terrain": terrain(), "pond": pond(), "church": church(), "mill": mill(), "sails": sails(), "well": well(),
        "house-ochre": house(3.6, 2.7, 2.9, 5.6, "ochre", "thatch", True, 0),
        "house-plaster": house(4.3, 3.0, 4.9, 8.0, "plaster", "roof", True, 2.7),
        "house-rose": house(3.4, 2.8, 4.7, 7.6, "rose", "slate", True, 2.6),
        "barn": house(5.2, 3.4, 3.6, 7.2, "wood", "thatch", False, 0),
        "barrel": barrel(), "crate": crate(), "fence": fence(), "bench": bench(), "table": table(), "lantern": lantern(),
        "hay": hay(), "cart": cart(), "brazier": brazier(), "woodpile": woodpile(),
    }
    for k in range(3):
        made[f"tree-{k}"] = tree(11 + k, "autumn" if k == 2 else "leaves")
        made[f"spruce-{k}"] = spruce(21 + k)
        made[f"rock-{k}"] = rock(31 + k)
        made[f"bush-{k}"] = bush(41 + k)
    return made


def places():
    """Tuples (shape, node, x, y, z, rotation about y in degrees, scale)."""
    rng = random.Random(7)
    out, taken = [], []

    def put(shape, x, z, turn=0.0, scale=1.0, y=None, clear=0.0):
        node = f"{shape}.{sum(1 for p in out if p[0] == shape):03d}"
        out.append((shape, node, x, ground(x, z) if y is None else y, z, turn, scale))
        if clear:
            taken.append((x, z, clear))

    def free(x, z, clear):
        return all(math.hypot(x - u, z - w) > clear + r for u, w, r in taken)

    out.append(("terrain", "terrain", 0.0, 0.0, 0.0, 0.0, 1.0))
    put("pond", -17.0, 15.0, y=ground(-17.0, 15.0) + 0.75, clear=6.0)
    put("church", -11.0, -17.0, 60.0, clear=13.0)
    put("mill", 29.0, -21.0, clear=6.0)
    put("sails", 29.0, -17.55, y=ground(29.0, -21.0) + 9.1)
    put("well", 3.6, 4.6, 20.0, clear=2.0)
    row = [("house-plaster", -6.6, 9.2, 95.0), ("house-ochre", -7.4, -2.4, 88.0), ("house-rose", 9.6, 9.8, 262.0),
           ("house-plaster", 11.4, -3.6, 250.0), ("house-ochre", 7.4, 19.2, 240.0), ("house-rose", -4.0, 21.0, 100.0),
           ("barn", 15.5, 17.5, 200.0), ("house-rose", 5.4, -21.5, 300.0), ("house-ochre", -16.0, 1.5, 70.0),
           ("house-plaster", -14.5, 27.0, 120.0), ("house-rose", 18.0, 4.5, 230.0), ("house-ochre", 3.2, 30.5, 200.0),
           ("barn", -23.0, -5.0, 60.0), ("house-plaster", -6.5, -32.0, 80.0), ("house-ochre", 9.5, -33.0, 280.0)]
    for shape, x, z, turn in row:
        put(shape, x, z, turn, clear=5.6)
        a = math.radians(turn)
        # In front of the door, in the direction (x, z) = (sin, cos) of the rotation.
        for k in range(rng.randint(2, 4)):
            side, out_by = rng.choice((-1, 1)) * rng.uniform(1.6, 3.2), rng.uniform(3.6, 4.4)
            put(rng.choice(("barrel", "barrel", "crate", "woodpile")), x + out_by * math.sin(a) + side * math.cos(a),
                z + out_by * math.cos(a) - side * math.sin(a), rng.uniform(0, 360))
    for shape, x, z, turn in (("bench", 0.2, 8.9, 160.0), ("bench", 6.9, 3.0, 250.0), ("table", -1.9, 6.6, 20.0), ("cart", 4.4, 12.6, 70.0),
                              ("brazier", -1.0, 1.6, 0.0), ("bench", -3.0, 1.2, 70.0), ("cart", 13.0, 13.2, 20.0)):
        put(shape, x, z, turn, clear=1.3)
    for z in range(-36, 37, 9):
        for side in (-1, 1):
            x = 3.0 * math.sin(z / 15.0) + 2.6 * side
            if free(x, z, 0.4):
                put("lantern", x, z, clear=0.4)
    for shape, x, z in (("hay", 19.5, 21.5), ("hay", 22.0, 19.0), ("hay", -26.5, -1.0), ("hay", 20.0, 24.5)):
        put(shape, x, z, scale=rng.uniform(0.9, 1.2), clear=1.4)
    # Fences around the gardens.
    for u, w, half_x, half_z in ((-12.5, 20.5, 4, 3), (17.0, 10.8, 3, 2), (-17.0, -8.5, 4, 3), (13.5, -14.5, 4, 3)):
        for k in range(-half_x, half_x):
            put("fence", u + 2 * k + 1.0, w - 2 * half_z), put("fence", u + 2 * k + 1.0, w + 2 * half_z)
        for k in range(-half_z, half_z):
            put("fence", u - 2 * half_x, w + 2 * k + 1.0, 90.0), put("fence", u + 2 * half_x, w + 2 * k + 1.0, 90.0)
    for kind, count, clear, least in (("tree", 90, 2.2, 12.0), ("spruce", 120, 2.0, 26.0), ("bush", 70, 0.9, 6.0), ("rock", 60, 0.7, 6.0)):
        made = 0
        while made < count:
            x, z = rng.uniform(-HALF + 3, HALF - 3), rng.uniform(-HALF + 3, HALF - 3)
            wild = math.hypot(x, z)
            if wild < least or path_distance(x, z) < clear + 1.4 or not free(x, z, clear):
                continue
            put(f"{kind}-{rng.randrange(3)}", x, z, rng.uniform(0, 360), rng.uniform(0.75, 1.3), clear=clear)
            made += 1
    return out


def ply(shape):
    """A PLY with vertex colours; vertices between materials are duplicated."""
    order, points, faces = {}, [], []
    for t, material in zip(shape.triangles, shape.materials):
        corners = []
        for i in t:
            key = (i, None if shape.colors else material)
            if key not in order:
                order[key] = len(points)
                color = shape.colors[i] if shape.colors else MATERIALS[material]
                points.append(struct.pack("<3f4B", *shape.points[i], *(round(255 * c) for c in color), 0 if material in WARM else 255))
            corners.append(order[key])
        faces.append(struct.pack("<B3I", 3, *corners))
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n" +
            "".join(f"property float {a}\n" for a in "xyz") + "".join(f"property uchar {c}\n" for c in ("red", "green", "blue", "alpha")) +
            f"element face {len(faces)}\nproperty list uchar uint vertex_indices\nend_header\n")
    return head.encode() + b"".join(points) + b"".join(faces)


def glb(made, placed):
    level, order = Gltf(), list(made)
    names = [m for m in MATERIALS if any(m in shape.materials for shape in made.values())]
    for name in names:
        level.material(name, MATERIALS[name])
    for name, shape in made.items():
        parts = [([t for t, m in zip(shape.triangles, shape.materials) if m == material], names.index(material))
                 for material in sorted(set(shape.materials), key=names.index)]
        level.mesh(shape.points, parts, name=name)
    for shape, node, x, y, z, turn, scale in placed:
        half = math.radians(turn) / 2
        level.nodes.append({"name": node, "mesh": order.index(shape), "translation": [x, y, z],
                            "rotation": [0.0, math.sin(half), 0.0, math.cos(half)], "scale": [scale] * 3})
    return level


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: village.py OUT")
    folder = sys.argv[1]
    os.makedirs(os.path.join(folder, "meshes"), exist_ok=True)
    made, placed = shapes(), places()
    for name, shape in made.items():
        with open(os.path.join(folder, "meshes", name + ".ply"), "wb") as out:
            out.write(ply(shape))
    glb(made, placed).write(os.path.join(folder, "village.glb"))
    print(f"{len(placed)} objects of {len(made)} shapes, {sum(len(s.triangles) for s in made.values())} triangles")


if __name__ == "__main__":
    main()
