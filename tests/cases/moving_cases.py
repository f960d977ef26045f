#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Resting drops near a box that a clip or scene keys translate, rotate, scale or morph: a drop dies exactly if the box passes
over it."""

import json
import math
import pathlib
import sys

from cases import Cases
from solids import BOX_FACES, Gltf, bake, box_corners, box_distance

sys.path.append(str(pathlib.Path(__file__).parent.parent / "cli"))
import ply  # noqa: E402

DROPS = 1500
STEPS, DT = 60, 1 / 60
KINDS = ("keys", "shift", "turn", "scale", "morph")


def turn(axis, angle, p):
    """Right-handed rotation about a unit axis, by Rodrigues' formula."""
    c, s = math.cos(angle), math.sin(angle)
    along = sum(a * b for a, b in zip(axis, p)) * (1 - c)
    cross = [axis[i - 2] * p[i - 1] - axis[i - 1] * p[i - 2] for i in range(3)]
    return [c * x + s * y + along * a for x, y, a in zip(p, cross, axis)]


class Motion:
    """A box moved from `start` by a fraction u in 0…1 of `way`, an angle and a scale."""

    def __init__(self, random, kind):
        self.kind = kind
        self.half = [random.uniform(0.25, 1.0) for _ in range(3)]
        thin = min(self.half)
        self.start = [random.uniform(-1, 1) for _ in range(3)]
        axis = [random.gauss(0, 1) for _ in range(3)]
        norm = math.sqrt(sum(a * a for a in axis)) or 1.0
        self.axis = [a / norm for a in axis]
        # At most half of its thinnest side per step.
        most = min(5.0, 0.5 * thin * STEPS)
        self.way = [random.uniform(-1, 1) * most / 2 for _ in range(3)] if kind in ("keys", "shift", "morph") else [0, 0, 0]
        self.angle = random.uniform(0.3, 2.8) if kind in ("keys", "turn") else 0.0
        self.scale = random.choice((random.uniform(1.3, 2.5), random.uniform(0.4, 0.8))) if kind == "scale" else 1.0

    def local(self, p, u):
        p = [c - s - u * w for c, s, w in zip(p, self.start, self.way)]
        return [c / (1 + u * (self.scale - 1)) for c in turn(self.axis, -u * self.angle, p)]

    def distance(self, p, u):
        return box_distance(self.local(p, u), self.half) * (1 + u * (self.scale - 1))

    def longest(self):
        return 2 * math.sqrt(sum(h * h for h in self.half)) * max(1, self.scale)

    def write(self, path):
        gltf = Gltf()
        mesh = gltf.add_mesh(box_corners(self.half), BOX_FACES)
        times = gltf.add([(0.0,), (STEPS * DT,)], kind="SCALAR")
        if self.kind == "morph":
            target = gltf.add([self.way] * 8)
            gltf.document["meshes"][mesh]["primitives"][0]["targets"] = [{"POSITION": target}]
            gltf.document["meshes"][mesh]["weights"] = [0]
        values = {"shift": ("translation", lambda: gltf.add([self.start, [s + w for s, w in zip(self.start, self.way)]])),
                  "scale": ("scale", lambda: gltf.add([[1] * 3, [self.scale] * 3])),
                  "turn": ("rotation", lambda: gltf.add([[0, 0, 0, 1], [math.sin(self.angle / 2) * a for a in self.axis] +
                                                         [math.cos(self.angle / 2)]], kind="VEC4")),
                  "morph": ("weights", lambda: gltf.add([(0.0,), (1.0,)], kind="SCALAR"))}
        gltf.document["nodes"] = [{"mesh": mesh, "translation": self.start}]
        if self.kind in values:
            name, add = values[self.kind]
            gltf.document["animations"] = [{"name": "move", "channels": [{"sampler": 0, "target": {"node": 0, "path": name}}],
                                            "samplers": [{"input": times, "output": add(), "interpolation": "LINEAR"}]}]
        gltf.write(path, scenes=[{"nodes": [0]}])


def check(cases, folder, kind):
    random = cases.random
    motion = Motion(random, kind)
    motion.write(folder / "a.gltf")
    if kind == "keys":
        motion.start, place = [0, 0, 0], motion.start  # the baked mesh includes the position
        options = ["--budget", "256kB", "--no-check"]
    else:
        options = ["--animated"]
    if not bake(cases, folder, "a.gltf", "-o", "a.relief", "-q", *options):
        return
    resolution = random.choice((96, 128, 256))
    if kind == "keys":
        # The box rotates about the origin of the container.
        motion.local = lambda p, u: [c - s for c, s in zip(turn(motion.axis, -u * motion.angle,
                                                                [c - u * w for c, w in zip(p, motion.way)]), place)]
        collider = "".join(f"[[collider.key]]\ntime = {u * STEPS * DT}\nposition = {[u * w for w in motion.way]}\n"
                           f"axis = {motion.axis}\nangle = {math.degrees(u * motion.angle)}\n" for u in (0, 1))
        texel = motion.longest() / 60
    else:
        collider = f'play = {{ clip = "move", loop = false, resolution = {resolution} }}\n'
        texel = motion.longest() / resolution
    margin = 2.5 * texel
    reach = 3 + max(abs(c) for c in motion.way) + motion.longest()
    points = []
    while len(points) < DROPS:
        p = [c + random.uniform(-reach, reach) * 0.6 for c in motion.start]
        if motion.distance(p, 0) > margin:
            points.append(p)
    (folder / "points.csv").write_text("".join("%.9g,%.9g,%.9g\n" % tuple(p) for p in points))
    (folder / "s.toml").write_text(
        f"[time]\ndt = {DT}\nsteps = {STEPS}\n[particles]\ncapacity = {DROPS}\n[forces]\ngravity = [0, 0, 0]\ndrag = 0\n"
        f'[ground]\nenabled = false\n[[collider]]\nfile = "a.relief"\n{collider}'
        '[[type]]\non_collision = "die"\n[[emitter]]\nshape = "points"\npoints = "points.csv"\nvelocity = [0, 0, 0]\n'
        f"velocity_spread = [0, 0, 0]\nrate = 0\nburst = {DROPS}\nlifetime = [1000, 1000]\n")
    done = cases.run("relief-sim", "s.toml", "--dump", "a.ply", "--events", "a.jsonl", "-q", cwd=folder, seconds=120)
    if not cases.expect(done and done.returncode == 0, f"not simulated: {done and done.stderr}"):
        return
    what = f"{kind}: half {motion.half}, way {motion.way}, angle {motion.angle}, scale {motion.scale}"
    left = [(row["x"], row["y"], row["z"]) for row in ply.read(folder / "a.ply")]
    passed = [p for p in left if min(motion.distance(p, i / STEPS) for i in range(1, STEPS + 1)) < -margin]
    cases.expect(not passed, f"{len(passed)} of {DROPS} drops in the path of the box live, first {passed[:1]}; {what}")
    hits = [json.loads(line) for line in (folder / "a.jsonl").read_text().splitlines()]
    cases.expect(len(hits) + len(left) == DROPS, f"{len(hits)} hits and {len(left)} left of {DROPS}; {what}")
    clear = [hit for hit in hits if min(motion.distance(hit["position"], i / STEPS) for i in range(STEPS + 1)) > margin + 0.05 * texel]
    cases.expect(not clear, f"{len(clear)} drops outside the path of the box were hit, first {clear[:1]}; {what}")


def main():
    cases = Cases("moving", 15)
    for number, folder in cases.each():
        check(cases, folder, KINDS[number % len(KINDS)])
    cases.finish()


main()
