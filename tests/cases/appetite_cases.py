#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Expensive meshes: slivers, layered walls, and parts far apart. Each bake must end within tight limits of memory and time, with
a result or a one-line error, which names the file and only options that were given. For containers, see tests/cli/appetite.sh."""

import math

from cases import Cases

SECONDS = 60  # generous, for a shared machine
MEMORY = 1500 << 20
BOX_FACES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


# Meshes are (positions, faces).
def box(mesh, at, half):
    positions, faces = mesh
    first = len(positions)
    positions += [tuple(c + (half if k >> i & 1 else -half) for i, c in enumerate(at)) for k in range(8)]
    faces += [tuple(first + c for c in face) for face in BOX_FACES]


def boxes_far_apart(cases):
    mesh = [], []
    spread = 10 ** cases.random.uniform(2, 9)
    half = spread * 10 ** cases.random.uniform(-6, -1)
    for _ in range(cases.random.randint(2, 6)):
        box(mesh, [cases.random.uniform(-spread, spread) for _ in range(3)], half)
    return mesh


def scattered_triangles(cases):
    positions, faces = [], []
    spread = 10 ** cases.random.uniform(0, 9)
    size = spread * 10 ** cases.random.uniform(-5, -1)
    for _ in range(12):
        at = [cases.random.uniform(-spread, spread) for _ in range(3)]
        faces.append(tuple(range(len(positions), len(positions) + 3)))
        positions += [tuple(c + cases.random.uniform(-size, size) for c in at) for _ in range(3)]
    return positions, faces


def fan(cases):
    """Slivers around a point: an umbrella, whole or in separate blades, or the pages of a book."""
    count = cases.random.randint(300, 1500)
    kind = cases.random.choice(("umbrella", "blades", "book"))
    width = 0.6 if kind == "blades" else 1.0
    positions, faces = [(0, 1, 0), (0, 0, 0)], []
    for i in range(count):
        a, b = (2 * math.pi * (i + s) / count for s in (0, width))
        positions += [(math.cos(a), 0.1 * math.sin(5 * a), math.sin(a)), (math.cos(b), 0.1 * math.sin(5 * b), math.sin(b))]
        faces.append((0, 1, 2 * i + 2) if kind == "book" else (0, 2 * i + 2, 2 * i + 3))
    return positions, faces


def cells(cases):
    """Walls of a block of cells. Inner walls are single, or double as between adjacent boxes."""
    n = [cases.random.randint(2, 10) for _ in range(3)]
    if cases.random.random() < 0.5:
        mesh = [], []
        for i in range(n[0]):
            for j in range(n[1]):
                for k in range(n[2]):
                    box(mesh, (i, j, k), 0.5)
        return mesh
    positions = [(i, j, k) for i in range(n[0] + 1) for j in range(n[1] + 1) for k in range(n[2] + 1)]
    index = {p: i for i, p in enumerate(positions)}
    faces = []
    for p in positions:
        for axis in range(3):
            corners = [tuple(p[i] + (step[0] if i == (axis + 1) % 3 else step[1] if i == (axis + 2) % 3 else 0)
                             for i in range(3)) for step in ((0, 0), (1, 0), (1, 1), (0, 1))]
            if all(c in index for c in corners):
                faces.append(tuple(index[c] for c in corners))
    return positions, faces


def bake(cases, folder):
    make = cases.random.choice((boxes_far_apart, boxes_far_apart, scattered_triangles, scattered_triangles, fan, cells))
    positions, faces = make(cases)
    with open(folder / "a.obj", "w", encoding="ascii") as out:
        out.writelines("v %.9g %.9g %.9g\n" % tuple(p) for p in positions)
        out.writelines("f " + " ".join(str(c + 1) for c in face) + "\n" for face in faces)
    done = cases.run("relief", "bake", "a.obj", "-o", "a.relief", "--no-check", "-q", cwd=folder, seconds=SECONDS,
                     memory=MEMORY + (4 << 30))  # the address space includes the importer's own limit
    if done is None:
        return
    if done.returncode == 0:
        cases.expect((folder / "a.relief").exists(), "exit code 0, but no file")
        return
    cases.expect(not (folder / "a.relief").exists(), "an error, but a file exists")
    cases.expect(done.returncode in (3, 4, 6) and "a.obj" in done.stderr,
                 f"{make.__name__}: exit code {done.returncode}: {done.stderr}")
    for option in ("--map", "dir or box", "--resolution"):
        cases.expect(option not in done.stderr, f"names an option that was not given: {done.stderr}")


def main():
    cases = Cases("appetite", 30)
    for _, folder in cases.each():
        bake(cases, folder)
    cases.finish()


main()
