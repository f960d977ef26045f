#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Random vessels and pipes, of one surface or of two open surfaces with facing rims, and rods and straws as shells thinner or
thicker than the part. Compared with closed forms, for random sizes, rotations and tessellations."""

import math

from cases import Cases
from solids import Frame, bake, query, turned_axes, write_obj

POINTS = 3000
NEAR = 4e-3  # fraction of the longest side; nearer points may be on either side
MOST_WRONG = 0.01


class Profile:
    """A frustum of an n-gon along y: radius `low` at 0, `high` at `height`."""

    def __init__(self, n, low, high, height):
        self.n, self.low, self.high, self.height = n, low, high, height

    def ring(self, y, radius):
        return [(radius * math.cos(2 * math.pi * i / self.n), y, radius * math.sin(2 * math.pi * i / self.n)) for i in range(self.n)]

    def radius(self, y):
        return self.low + (self.high - self.low) * y / self.height

    def beyond(self, p):
        """Signed distance to the plane of the side that faces p, negative inside."""
        x, y, z = p
        part = 2 * math.pi / self.n
        angle = math.atan2(z, x) % part - part / 2
        slope = (self.high - self.low) * math.cos(part / 2) / self.height
        return (math.hypot(x, z) * math.cos(angle) - self.radius(y) * math.cos(part / 2)) / math.sqrt(1 + slope * slope)


class Mesh:
    def __init__(self):
        self.positions, self.faces = [], []

    def add(self, ring):
        self.positions += ring
        return list(range(len(self.positions) - len(ring), len(self.positions)))

    def band(self, low, high, inwards=False):
        for i in range(len(low)):
            k = (i + 1) % len(low)
            face = (low[i], high[i], high[k], low[k])
            self.faces.append(face[::-1] if inwards else face)

    def disc(self, ring, up):
        self.faces.append(tuple(ring[::-1] if up else ring))

    def write(self, random, path):
        """Writes the mesh with a random pose; returns its frame."""
        frame = Frame([random.uniform(-3, 3) for _ in range(3)], turned_axes(random))
        write_obj(path, [frame.to_world(p) for p in self.positions], self.faces)
        return frame


def judge(cases, folder, frame, points, truths, what):
    rows = query(cases, folder, "a.relief", [frame.to_world(p) for p in points], "--distance", "plane")
    for kind in (True, False):
        own = [(p, row[3]) for p, row, truth in zip(points, rows or [], truths) if truth is kind]
        wrong = [one for one in own if (one[1] < 0) != kind]
        cases.expect(len(wrong) <= MOST_WRONG * len(own), f"{len(wrong)} of {len(own)} points that are {'in' if kind else 'out'}side "
                     f"are not, first {wrong[:1]}: {what}")


def check_vessel(cases, folder):
    random = cases.random
    n, height = random.randint(6, 48), random.uniform(0.3, 1.5)
    low, high = random.uniform(0.15, 0.6), random.uniform(0.3, 0.6)
    wall = min(low, high) * random.uniform(0.04, 0.25)
    pipe = random.random() < 0.3
    floor = 0.0 if pipe else wall * random.uniform(0.6, 1.5)
    outer = Profile(n, low, high, height)
    inner = Profile(random.choice((n, random.randint(6, 48))), low - wall, high - wall, height)
    if inner.n != n and wall < 0.3 * low:  # the inner polygon must lie inside the outer one
        inner = Profile(n, low - wall, high - wall, height)
    joined = inner.n == n and random.random() < 0.3
    # Some inner shells end slightly above or below the outer rim.
    rise = 0.0 if joined or random.random() < 0.5 else wall * random.uniform(-0.5, 0.5)
    mesh = Mesh()
    foot, rim = mesh.add(outer.ring(0, low)), mesh.add(outer.ring(height, high))
    bottom = mesh.add(inner.ring(floor, inner.radius(floor)))
    mouth = mesh.add(inner.ring(height + rise, inner.radius(height + rise)))
    mesh.band(foot, rim)
    mesh.band(bottom, mouth, inwards=True)
    if joined:
        mesh.band(rim, mouth)
    if not pipe:
        mesh.disc(foot, up=False)
        mesh.disc(bottom, up=True)
    elif joined:
        mesh.band(bottom, foot)
    frame = mesh.write(random, folder / "a.obj")
    budget = random.choice((256, 500))
    what = f"vessel {n}/{inner.n}, radii {low}, {high}, height {height}, wall {wall}, floor {floor}, joined {joined}, rise {rise}"
    if not bake(cases, folder, "a.obj", "-o", "a.relief", "--budget", f"{budget}kB", "-q"):
        return
    near = NEAR * max(height, 2 * max(low, high))
    ends = near + abs(rise)  # the ring between the rims is within this distance of the ends
    points, truths = [], []
    while len(points) < POINTS:
        y = random.uniform(-0.1, 1.1) * height
        radius, angle = max(outer.radius(y), 0.05) * 1.15 * math.sqrt(random.random()), random.uniform(0, 2 * math.pi)
        p = (radius * math.cos(angle), y, radius * math.sin(angle))
        out, cavity = outer.beyond(p), inner.beyond(p)
        if abs(out) < near or abs(cavity) < near or min(abs(y), abs(y - floor)) < near or abs(y - height) < ends:
            continue
        points.append(p)
        truths.append(0 < y < height and out < 0 and not (cavity < 0 and y > floor))
    judge(cases, folder, frame, points, truths, what)


def check_rod(cases, folder):
    random = cases.random
    n, height = random.randint(4, 24), random.uniform(0.5, 1.5)
    low = height * 10 ** random.uniform(-2, -0.7)
    rod = Profile(n, low, low * random.choice((1.0, random.uniform(0.5, 1.5))), height)
    thickness = 2 * low * 10 ** random.uniform(-0.7, 0.7)
    thickness = min(max(thickness, 0.01 * height), 0.2 * height)
    half = 0.5 * thickness
    straw = random.random() < 0.3
    mesh = Mesh()
    foot, head = mesh.add(rod.ring(0, rod.low)), mesh.add(rod.ring(height, rod.high))
    rings = [foot, *(mesh.add(rod.ring(height * i / 5, rod.radius(height * i / 5))) for i in range(1, 5) if random.random() < 0.5), head]
    for one, other in zip(rings, rings[1:]):
        mesh.band(one, other)
    if not straw:
        mesh.disc(foot, up=False)
        mesh.disc(head, up=True)
    frame = mesh.write(random, folder / "a.obj")
    what = f"rod {n}, radii {rod.low}, {rod.high}, height {height}, thickness {thickness}, straw {straw}"
    if not bake(cases, folder, "a.obj", "-o", "a.relief", "--budget", "500kB", "--as", "shell", "--thickness", "%.6g" % thickness, "-q"):
        return
    near = NEAR * height + 0.02 * thickness
    points, truths = [], []
    while len(points) < POINTS:
        y = random.uniform(-half, height + half) * (1 if random.random() < 0.5 else 1.1)
        radius, angle = (rod.radius(y) + 1.5 * half) * math.sqrt(random.random()), random.uniform(0, 2 * math.pi)
        p = (radius * math.cos(angle), y, radius * math.sin(angle))
        planes = [rod.beyond(p)] + ([] if straw else [-y, y - height])
        if straw and not half < y < height - half:
            continue
        # Shell of a convex solid: each plane moves outward. Mitres exceed half the thickness.
        beyond = max(planes)
        distance = abs(beyond) - half
        if abs(distance) < near:
            continue
        points.append(p)
        truths.append(distance < 0)
    judge(cases, folder, frame, points, truths, what)


def main():
    cases = Cases("vessels", 20)
    for number, folder in cases.each():
        (check_vessel, check_rod)[number % 2](cases, folder)
    cases.finish()


main()
