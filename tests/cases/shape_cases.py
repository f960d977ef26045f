#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Turned boxes of random sizes, plates and rods among them, alone or as shells, against their closed form: the side of each
point that is not next to the surface, and in solid ones the plane that decides up to 0.45 of the thickness."""

import math

from cases import Cases

POINTS = 3000
NEAR = 2e-3  # of the longest side: nearer points may be on either side
ANGLE = 3.0  # degrees


def axes_of(random):
    """Rows: the axes of a random turn."""
    while True:
        q = [random.gauss(0, 1) for _ in range(4)]
        norm = math.sqrt(sum(c * c for c in q))
        if norm > 0.1:
            break
    w, x, y, z = (c / norm for c in q)
    return ((1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
            (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
            (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)))


class Box:
    def __init__(self, random):
        side = 10 ** random.uniform(-1, 2)
        self.half = [0.5 * side * random.choice((1.0, random.uniform(0.1, 1.0))) for _ in range(3)]
        self.axes = axes_of(random)
        self.center = [random.uniform(-1, 1) * side for _ in range(3)]
        self.longest = 2 * max(self.half)

    def to_world(self, local):
        return [c + sum(l * axis[i] for l, axis in zip(local, self.axes)) for i, c in enumerate(self.center)]

    def distance(self, local):
        d = [abs(p) - h for p, h in zip(local, self.half)]
        return math.sqrt(sum(max(c, 0) ** 2 for c in d)) + min(max(d), 0)

    def write(self, path):
        with open(path, "w", encoding="ascii") as out:
            for k in range(8):
                out.write("v %.9g %.9g %.9g\n" % tuple(self.to_world([h if k >> i & 1 else -h for i, h in enumerate(self.half)])))
            for face in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
                out.write("f %d %d %d %d\n" % tuple(c + 1 for c in face))


def query(cases, folder, points):
    with open(folder / "in.csv", "w", encoding="ascii") as out:
        out.writelines("%.9g,%.9g,%.9g\n" % tuple(p) for p in points)
    done = cases.run("relief", "query", "a.relief", "--points", "in.csv", "-o", "-", "--distance", "plane", cwd=folder)
    return [[float(word or "nan") for word in line.split(",")] for line in done.stdout.splitlines()[1:]] if done else []


def check(cases, folder):
    random = cases.random
    box = Box(random)
    box.write(folder / "a.obj")
    thickness = box.longest * 10 ** random.uniform(-1.7, -0.7) if random.random() < 0.4 else None
    shell = ["--as", "shell", "--thickness", "%.6g" % thickness] if thickness else []
    budget = random.choice((64, 128, 256, 512))
    done = cases.run("relief", "bake", "a.obj", "-o", "a.relief", "--budget", f"{budget}kB", *shell, "-q", cwd=folder)
    if not cases.expect(done and done.returncode == 0, f"not baked: {done and done.stderr}"):
        return
    locals_ = [[random.uniform(-1.1, 1.1) * h for h in box.half] for _ in range(POINTS)]
    results = query(cases, folder, [box.to_world(p) for p in locals_])
    if not cases.expect(len(results) == POINTS, f"{len(results)} samples"):
        return
    near = NEAR * box.longest
    sides = normals = depths = judged = 0
    for local, (*_, f, nx, ny, nz, _) in zip(locals_, results):
        distance = box.distance(local)
        if thickness:
            distance = abs(distance) - 0.5 * thickness
        if abs(distance) > near:
            sides += (f < 0) != (distance < 0)
        if thickness or distance > -near:
            continue
        # Clear of edges, where two faces are as near, and of the middle of the thinnest side.
        gaps = sorted((h - abs(p), axis) for axis, (p, h) in enumerate(zip(local, box.half)))
        (depth, axis), (second, _) = gaps[0], gaps[1]
        if depth > 0.9 * box.half[axis] or second < 1.2 * depth + 0.05 * box.longest:
            continue
        judged += 1
        sign = 1 if local[axis] > 0 else -1
        cosine = sign * sum(n * a for n, a in zip((nx, ny, nz), box.axes[axis]))
        normals += cosine < math.cos(math.radians(ANGLE))
        depths += abs(f + depth) > near + 0.1 * depth
    what = f"half {box.half}, {budget} kB, shell {thickness}"
    cases.expect(sides <= POINTS // 200, f"{sides} of {POINTS} points are on the wrong side: {what}")
    cases.expect(normals <= judged // 100, f"{normals} of {judged} normals are off by more than {ANGLE} degrees: {what}")
    cases.expect(depths <= judged // 100, f"{depths} of {judged} depths are off: {what}")


def main():
    cases = Cases("shapes", 30)
    for _, folder in cases.each():
        check(cases, folder)
    cases.finish()


main()
