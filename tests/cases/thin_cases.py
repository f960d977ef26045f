#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Levels of large bodies with thin posts, as worlds and as one collider: `check` names exactly the meshes with lost posts, as
determined by points in each post."""

import json

from cases import Cases
from solids import BOX_FACES, bake, box_corners, query

INSIDE = 40  # points in each post
LOST, HELD = 0.7, 0.03  # fractions of them classified as outside


def add_box(mesh, center, half):
    positions, faces = mesh
    first = len(positions)
    positions += [tuple(c + d for c, d in zip(center, corner)) for corner in box_corners(half)]
    faces += [tuple(first + c for c in face) for face in BOX_FACES]


class House:
    """A slab with posts that start inside it."""

    def __init__(self, random, name, x):
        self.name = name
        side = 10 ** random.uniform(0.5, 1.5)
        self.slab = ((x, 0, 0), (side, 0.02 * side, side))
        thin = side * 10 ** random.uniform(-4, -1.7)
        height = random.uniform(0.02, 0.1) * side
        self.posts = []
        for _ in range(random.randint(1, 12)):
            place = (x + random.uniform(-0.9, 0.9) * side, 0.01 * side + height, random.uniform(-0.9, 0.9) * side)
            self.posts.append((place, (thin, height, thin)))

    def mesh(self):
        mesh = [], []
        add_box(mesh, *self.slab)
        for post in self.posts:
            add_box(mesh, *post)
        return mesh


def write_level(path, houses):
    with open(path, "w", encoding="ascii") as out:
        first = 1
        for house in houses:
            positions, faces = house.mesh()
            out.write(f"o {house.name}\n")
            out.writelines("v %.9g %.9g %.9g\n" % p for p in positions)
            out.writelines("f " + " ".join(str(c + first) for c in face) + "\n" for face in faces)
            first += len(positions)


def lost_shares(cases, folder, file, house):
    """For each post the fraction of its points above the slab that are classified as outside; None after a failure."""
    points = []
    top = house.slab[1][1]
    for center, half in house.posts:
        for _ in range(INSIDE):
            p = [c + cases.random.uniform(-0.9, 0.9) * h for c, h in zip(center, half)]
            p[1] = cases.random.uniform(top + 0.1 * half[1], center[1] + 0.9 * half[1])
            points.append(p)
    rows = query(cases, folder, file, points, *(["--distance", "plane"] if file.endswith(".relief") else []))
    return rows and [sum(not row[3] < 0 for row in rows[i:i + INSIDE]) / INSIDE for i in range(0, len(rows), INSIDE)]


def check(cases, folder, as_world):
    random = cases.random
    houses, x = [], 0.0
    for i in range(random.randint(1, 3) if as_world else 1):
        houses.append(House(random, f"house{i}", x))
        x += 150  # slabs are up to 63 wide
    write_level(folder / "a.obj", houses)
    budget = int(10 ** random.uniform(4.5, 6) * len(houses))
    where = ["--world", "w"] if as_world else ["-o", "a.relief"]
    file = "w/world.json" if as_world else "a.relief"
    if not bake(cases, folder, "a.obj", *where, "--budget", str(budget), "-q"):
        return
    done = cases.run("relief", "check", file, "--mesh", "a.obj", "--samples", "20000", "--json", cwd=folder)
    text = cases.run("relief", "check", file, "--mesh", "a.obj", "--samples", "20000", cwd=folder)
    if not cases.expect(done and text and done.returncode == text.returncode == 0, f"check failed: {done and done.stderr}"):
        return
    report = json.loads(done.stdout)
    for house in houses:
        shares = lost_shares(cases, folder, file, house)
        if shares is None:
            return
        count = sum(share > LOST for share in shares)
        half = house.posts[0][1]
        what = f"{house.name}: posts of {half} on {house.slab[1][0]}, {budget} bytes: lost {[round(s, 2) for s in shares]}"
        if as_world:
            named = [one for one in report["accuracy"]["lost_parts"] if one["mesh"] == house.name]
            lost = named[0]["lost"] if named else 0
            cases.expect(not lost or house.name in text.stdout + text.stderr, f"the text does not name {house.name}")
        else:
            lost = report["parts"]["lost"]
        cases.expect(lost >= count, f"check names {lost} lost parts; {what}")
        if all(share < HELD for share in shares):
            cases.expect(not lost, f"check names {lost} lost parts that exist; {what}")


def main():
    cases = Cases("thin", 20)
    for number, folder in cases.each():
        check(cases, folder, number % 3 != 2)
    cases.finish()


main()
