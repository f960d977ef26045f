#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the meshes of the samples from formulas: meshes.py torus|basin|terrain OUT.obj

The output is reproducible. Needs only Python.
"""
import math
import sys


def revolve(profile, sides):
    """A closed solid of revolution about y. profile: (radius, height), counterclockwise with y up."""
    vertices, faces = [], []
    for radius, height in profile:
        for side in range(sides):
            angle = 2 * math.pi * side / sides
            vertices.append((radius * math.cos(angle), height, -radius * math.sin(angle)))
    count = len(profile)
    for i in range(count):
        for side in range(sides):
            a = i * sides + side
            b = i * sides + (side + 1) % sides
            c = (i + 1) % count * sides + (side + 1) % sides
            d = (i + 1) % count * sides + side
            faces += [(a, b, c), (a, c, d)]
    return vertices, faces


def torus(ring=1.0, tube=0.26, sides=96, cuts=48):
    """A torus about the y axis."""
    angles = [2 * math.pi * i / cuts for i in range(cuts)]
    return revolve([(ring + tube * math.cos(a), tube * math.sin(a)) for a in angles], sides)


def basin(sides=96):
    """The round wall of a fountain's basin: 1.44 to 1.72 from the centre at its top, its base at y = 0. It has no
    overhangs, so that one map from above represents it."""
    return revolve([(1.90, 0.0), (1.88, 0.05), (1.80, 0.07), (1.74, 0.26), (1.72, 0.30), (1.68, 0.32), (1.48, 0.32),
                    (1.44, 0.30), (1.42, 0.26), (1.36, 0.0)], sides)


def lattice(x, z):
    """A hash of the lattice point (x, z), from -1 to 1."""
    h = (x * 374761393 + z * 668265263) & 0xFFFFFFFF
    h = (h ^ (h >> 13)) * 1274126177 & 0xFFFFFFFF
    return ((h ^ (h >> 16)) & 0xFFFF) / 32767.5 - 1.0


def smooth_noise(x, z):
    """Value noise: lattice values with quintic interpolation."""
    i, k = math.floor(x), math.floor(z)
    u, v = x - i, z - k
    u = u * u * u * (u * (6 * u - 15) + 10)
    v = v * v * v * (v * (6 * v - 15) + 10)
    near = lattice(i, k) * (1 - u) + lattice(i + 1, k) * u
    far = lattice(i, k + 1) * (1 - u) + lattice(i + 1, k + 1) * u
    return near * (1 - v) + far * v


def height(x, z):
    """Ridged noise: octaves of 1 - |noise|, each weighted by the previous one: rough peaks and smooth valleys."""
    total, weight, size = 0.0, 1.0, 0.55
    for octave in range(6):
        ridge = 1.0 - abs(smooth_noise(size * x + 17.3 * octave + 3.1, size * z - 9.7 * octave + 5.2))
        total += weight * ridge * ridge * 0.5 ** octave
        weight = min(1.0, weight * ridge * 1.3)
        size *= 2.0
    # High behind the centre, low at the border.
    massif = math.exp(-((x + 0.3) ** 2 + (z + 0.9) ** 2) / 5.0)
    return 0.2 * total + 0.8 * (total - 0.55) * massif


def terrain(half=4.0, cells=256):
    """A height field over [-half, half]², open below: green meadows, and grey rock on steep or high ground."""
    vertices, faces = [], []
    for k in range(cells + 1):
        for i in range(cells + 1):
            x, z = (2.0 * i / cells - 1.0) * half, (2.0 * k / cells - 1.0) * half
            y, step = height(x, z), half / cells
            steep = math.hypot(height(x + step, z) - y, height(x, z + step) - y) / step
            bare = min(1.0, max(0.0, 0.9 * steep + 0.5 * y - 0.45 + 0.25 * smooth_noise(6.0 * x, 6.0 * z)))
            meadow = 0.5 + 0.5 * smooth_noise(2.0 * x + 9.0, 2.0 * z)
            green = [a + meadow * (b - a) for a, b in zip((0.23, 0.34, 0.14), (0.44, 0.46, 0.22))]
            vertices.append((x, y, z) + tuple(a + bare * (b - a) for a, b in zip(green, (0.50, 0.47, 0.43))))
    for k in range(cells):
        for i in range(cells):
            a = k * (cells + 1) + i
            b, c, d = a + 1, a + cells + 1, a + cells + 2
            faces += [(a, c, b), (b, c, d)]
    return vertices, faces


def main():
    shapes = {"torus": torus, "basin": basin, "terrain": terrain}
    if len(sys.argv) != 3 or sys.argv[1] not in shapes:
        sys.exit("usage: meshes.py torus|basin|terrain OUT.obj")
    vertices, faces = shapes[sys.argv[1]]()
    with open(sys.argv[2], "w", encoding="ascii") as out:
        for vertex in vertices:
            out.write("v" + "".join(" %.6f" % x for x in vertex[:3]) + "".join(" %.3f" % x for x in vertex[3:]) + "\n")
        for face in faces:
            out.write("f %d %d %d\n" % tuple(i + 1 for i in face))


if __name__ == "__main__":
    main()
