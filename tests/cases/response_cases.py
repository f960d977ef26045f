#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Contact responses: glTF physics materials with the defaults of their extension, and manual edits of world.json, which stay with
their bodies if nodes are reordered, removed, renamed, moved or added."""

import json
import re

from cases import Cases
from solids import BOX_FACES, Gltf, bake, box_corners

# Defaults of KHR_physics_rigid_bodies, schema material.physics.
DEFAULTS = {"restitution": 0.0, "dynamicFriction": 0.6}
PHYSICS = "KHR_physics_rigid_bodies"
NEAR = 2e-6


def check_physics(cases, folder):
    random = cases.random
    gltf = Gltf()
    mesh = gltf.add_mesh(box_corners([0.5] * 3), BOX_FACES)
    materials = []
    for i in range(random.randint(2, 5)):
        material = {"name": f"m{i}"}
        for key in ("restitution", "dynamicFriction", "staticFriction"):
            if random.random() < 0.5:
                material[key] = round(random.choice((0, 1, random.uniform(0, 1), random.uniform(0, 2))), 3)
        materials.append(material)
    used = random.sample(range(len(materials)), random.randint(2, len(materials)))
    for place, number in enumerate(used):
        gltf.document["nodes"].append({"mesh": mesh, "name": f"n{place}", "translation": [3 * place, 0, 0],
                                       "extensions": {PHYSICS: {"collider": {"geometry": {"node": place}, "physicsMaterial": number}}}})
    gltf.write(folder / "a.gltf", scenes=[{"nodes": list(range(len(used)))}], extensionsUsed=[PHYSICS],
               extensions={PHYSICS: {"physicsMaterials": materials}})
    if not bake(cases, folder, "a.gltf", "-o", "a.relief", "-q"):
        return
    done = cases.run("relief", "info", "a.relief", "--json", cwd=folder)
    found = {one["name"]: one for one in json.loads(done.stdout)["materials"]} if done else {}
    for number in used:
        stated = {**DEFAULTS, **materials[number]}
        got = found.get(stated["name"])
        if cases.expect(got, f"{stated} is missing: {found}"):
            cases.expect(abs(got["restitution"] - min(stated["restitution"], 1)) < NEAR
                         and abs(got["friction"] - min(stated["dynamicFriction"], 1)) < NEAR, f"{materials[number]} became {got}")


class Thing:
    """A node. No two nodes have both the same size and position."""

    def __init__(self, name, size, x):
        self.name, self.size, self.x = name, size, x
        self.friction = 0.0


def write_level(path, things):
    gltf = Gltf()
    meshes = {}
    for thing in things:
        if thing.size not in meshes:
            meshes[thing.size] = gltf.add_mesh(box_corners([0.1 * (1 + thing.size)] * 3), BOX_FACES)
        gltf.document["nodes"].append({"name": thing.name, "mesh": meshes[thing.size], "translation": [3 * thing.x, 0, 0]})
    gltf.write(path, scenes=[{"nodes": list(range(len(things)))}])


def body_of(world, thing):
    """The body at the position of the node."""
    return next(body for body in world["bodies"] if abs(body["position"][0] - 3 * thing.x) < 1e-3)


def check_by_hand(cases, folder):
    random = cases.random
    # Names and sizes can be shared, but not positions.
    things = [Thing(random.choice(("gate", "gate", "door", f"n{i}")), random.randrange(4), i) for i in range(random.randint(3, 9))]
    write_level(folder / "a.gltf", things)
    if not bake(cases, folder, "a.gltf", "--world", "w", "--budget", "64kB", "-q"):
        return
    file = folder / "w/world.json"
    world = json.loads(file.read_text())
    for i, thing in enumerate(things):
        if random.random() < 0.7:
            thing.friction = round((i + 1) / 16, 4)
            body_of(world, thing)["friction"] = thing.friction
    file.write_text(json.dumps(world))
    removed, renamed, moved = [], [], []
    for thing in list(things):
        alone = sum(other.name == thing.name for other in things) == 1
        edit = random.random()
        if edit < 0.15 and len(things) > 2:
            things.remove(thing)
            removed.append(thing)
        elif edit < 0.3:
            thing.name = "renamed %d" % thing.x
            renamed.append(thing)
        elif edit < 0.4 and alone and not removed:
            thing.x += 40
            moved.append(thing)
    added = [Thing(f"new {i}", 5, 20 + i) for i in range(random.randint(0, 2))]
    things += added
    random.shuffle(things)
    write_level(folder / "a.gltf", things)
    done = bake(cases, folder, "a.gltf", "--world", "w", "--budget", "64kB", "--warnings-only")
    if not done:
        return
    world = json.loads(file.read_text())
    for thing in things:
        friction = body_of(world, thing)["friction"]
        kind = "added" if thing in added else "renamed" if thing in renamed else "moved" if thing in moved else "kept"
        cases.expect(friction == thing.friction, f"{kind} '{thing.name}' at {thing.x} has {friction}, not {thing.friction}")
    for thing in removed:
        cases.expect(not thing.friction or re.search(f"'{thing.name}'", done.stderr), f"'{thing.name}' is not reported: {done.stderr}")


def main():
    cases = Cases("responses", 30)
    for number, folder in cases.each():
        (check_physics, check_by_hand)[number % 2](cases, folder)
    cases.finish()


main()
