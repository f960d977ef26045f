#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Rotated boxes of random sizes, including plates and rods, as solids or shells, compared with closed forms: the side of points
away from the surface, the deciding plane up to 0.45 of the thickness in solids, and normals near faces. Bakes of such flat shapes
end early for any budget."""

import json
import math
import resource

from cases import Cases
from solids import BOX_FACES, Frame, bake, box_corners, box_distance, query, turned_axes, write_obj

POINTS = 3000
NEAR = 2e-3  # fraction of the longest side; nearer points may be on either side
INSIDE_ANGLE, FACE_ANGLE = 3.0, 1.0  # degrees
AT_FACE, BESIDE_FACE = 1e-3, 5e-3  # fractions of the longest side
LARGE = 16_000_000  # a budget
LARGE_BYTES, LARGE_SECONDS = 3_500_000, 15  # maximum bytes and CPU seconds of a flat shape at that budget


class Box(Frame):
    def __init__(self, random):
        side = 10 ** random.uniform(-1, 2)
        self.half = [0.5 * side * random.choice((1.0, random.uniform(0.1, 1.0))) for _ in range(3)]
        axes = turned_axes(random)
        super().__init__([random.uniform(-1, 1) * side for _ in range(3)], axes)
        self.longest = 2 * max(self.half)

    def write(self, path):
        write_obj(path, [self.to_world(p) for p in box_corners(self.half)], BOX_FACES)

    def off_normal(self, row, axis, sign, most):
        """Whether the normal of a sample has an error above `most` degrees."""
        return sign * sum(n * a for n, a in zip(row[4:7], self.axes[axis])) < math.cos(math.radians(most))


def check_faces(cases, folder, box, what):
    """Checks normals at points near a face, away from its edges."""
    points, faces = [], []
    for _ in range(POINTS // 2):
        axis, sign = cases.random.randrange(3), cases.random.choice((-1, 1))
        local = [cases.random.uniform(-1, 1) * max(h - 0.08 * box.longest, 0) for h in box.half]
        if any(h < 0.1 * box.longest for i, h in enumerate(box.half) if i != axis):
            continue
        far = cases.random.choice((AT_FACE, BESIDE_FACE))
        local[axis] = sign * (box.half[axis] + cases.random.uniform(0 if far == BESIDE_FACE else -far, far) * box.longest)
        points.append(box.to_world(local))
        faces.append((axis, sign, far))
    rows = query(cases, folder, "a.relief", points, "--distance", "plane") if points else None
    for far in AT_FACE, BESIDE_FACE:
        own = [(row, axis, sign) for row, (axis, sign, other) in zip(rows or [], faces) if other == far]
        off = sum(box.off_normal(row, axis, sign, FACE_ANGLE) for row, axis, sign in own)
        cases.expect(off <= 0.002 * len(own), f"{off} of {len(own)} normals within {far} of faces have errors above {FACE_ANGLE} degrees: {what}")


def check_large(cases, folder):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = bake(cases, folder, "a.obj", "-o", "large.relief", "--budget", str(LARGE), "--no-check", "--json")
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
    if done:
        taken = sum(one["bytes"] for one in json.loads(done.stdout)["maps"])
        cases.expect(taken <= LARGE_BYTES and seconds <= LARGE_SECONDS, f"a box uses {taken} bytes of {LARGE} and {seconds:.1f} s")


def check(cases, folder, number):
    random = cases.random
    box = Box(random)
    box.write(folder / "a.obj")
    if number % 10 == 9:
        return check_large(cases, folder)
    thickness = box.longest * 10 ** random.uniform(-1.7, -0.7) if random.random() < 0.4 else None
    shell = ["--as", "shell", "--thickness", "%.6g" % thickness] if thickness else []
    budget = random.choice((64, 128, 256, 512))
    if not bake(cases, folder, "a.obj", "-o", "a.relief", "--budget", f"{budget}kB", *shell, "-q"):
        return None
    locals_ = [[random.uniform(-1.1, 1.1) * h for h in box.half] for _ in range(POINTS)]
    results = query(cases, folder, "a.relief", [box.to_world(p) for p in locals_], "--distance", "plane")
    if not results:
        return None
    near = NEAR * box.longest
    sides = normals = depths = judged = 0
    for local, row in zip(locals_, results):
        distance = box_distance(local, box.half)
        if thickness:
            distance = abs(distance) - 0.5 * thickness
        if abs(distance) > near:
            sides += (row[3] < 0) != (distance < 0)
        if thickness or distance > -near:
            continue
        # Away from edges, where two faces are equally near, and from the middle of the thinnest side.
        gaps = sorted((h - abs(p), axis) for axis, (p, h) in enumerate(zip(local, box.half)))
        (depth, axis), (second, _) = gaps[0], gaps[1]
        if depth > 0.9 * box.half[axis] or second < 1.2 * depth + 0.05 * box.longest:
            continue
        judged += 1
        normals += box.off_normal(row, axis, 1 if local[axis] > 0 else -1, INSIDE_ANGLE)
        depths += abs(row[3] + depth) > near + 0.1 * depth
    what = f"half {box.half}, {budget} kB, shell {thickness}"
    cases.expect(sides <= POINTS // 200, f"{sides} of {POINTS} points are wrong: {what}")
    most = judged * (3 if budget == 64 else 1) // 100
    cases.expect(normals <= most, f"{normals} of {judged} normals have errors above {INSIDE_ANGLE} degrees: {what}")
    cases.expect(depths <= most, f"{depths} of {judged} depths are wrong: {what}")
    return None if thickness else check_faces(cases, folder, box, what)


def main():
    cases = Cases("shapes", 30)
    for number, folder in cases.each():
        check(cases, folder, number)
    cases.finish()


main()
