#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes a figure of capsules that walks on the spot, as glTF with materials and one clip: walker.py OUT.gltf

The output is reproducible. Needs only Python.
"""
import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from gltf import Gltf  # noqa: E402

SECONDS = 0.95  # duration of two steps
KEYS = 57
STRIDE = 1.1227  # distance in that time, metres
STANCE = 0.56  # fraction of a cycle that a foot is on the ground

# Name, parent, position in the parent, other end of the capsule, radius; metres, y up, facing +z.
PARTS = [
    ("hips", None, (0.0, 0.93, 0.0), (0.0, 0.12, 0.0), 0.125),
    ("chest", "hips", (0.0, 0.20, 0.0), (0.0, 0.24, 0.0), 0.15),
    ("neck", "chest", (0.0, 0.36, 0.0), (0.0, 0.12, 0.01), 0.055),
    ("head", "neck", (0.0, 0.16, 0.02), (0.0, 0.09, 0.015), 0.1),
    ("hair", "head", (0.0, 0.075, -0.012), (0.0, 0.035, -0.012), 0.1),
    ("left arm", "chest", (0.205, 0.27, 0.0), (0.05, -0.27, 0.0), 0.052),
    ("left forearm", "left arm", (0.05, -0.28, 0.0), (0.0, -0.27, 0.0), 0.043),
    ("right arm", "chest", (-0.205, 0.27, 0.0), (-0.05, -0.27, 0.0), 0.052),
    ("right forearm", "right arm", (-0.05, -0.28, 0.0), (0.0, -0.27, 0.0), 0.043),
    ("left thigh", "hips", (0.095, 0.0, 0.0), (0.0, -0.41, 0.0), 0.082),
    ("left shin", "left thigh", (0.0, -0.43, 0.0), (0.0, -0.38, 0.0), 0.06),
    ("left foot", "left shin", (0.0, -0.41, 0.0), (0.0, -0.01, 0.15), 0.052),
    ("right thigh", "hips", (-0.095, 0.0, 0.0), (0.0, -0.41, 0.0), 0.082),
    ("right shin", "right thigh", (0.0, -0.43, 0.0), (0.0, -0.38, 0.0), 0.06),
    ("right foot", "right shin", (0.0, -0.41, 0.0), (0.0, -0.01, 0.15), 0.052),
]

MATERIALS = {  # sRGB
    "skin": (0.80, 0.60, 0.48), "shirt": (0.24, 0.42, 0.58), "trousers": (0.25, 0.26, 0.31), "shoes": (0.20, 0.13, 0.10),
    "hair": (0.22, 0.15, 0.10),
}
WEARS = {"hips": "trousers", "thigh": "trousers", "shin": "trousers", "foot": "shoes", "chest": "shirt", "arm": "shirt",
         "hair": "hair"}


def ease(x):
    """Smoothstep."""
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


def part(name):
    return next(p for p in PARTS if p[0] == name)


def hips(phase):
    """The height of the hips: highest when one leg passes the other."""
    return 0.859 - 0.029 * math.cos(4 * math.pi * (phase - 0.01))


def foot(phase):
    """The left ankle: height, z, and pitch of the foot (positive: toes down). Heel strike, flat, then toe-off."""
    _, _, _, (_, toe_y, toe_z), radius = part("left foot")
    swing = max(0.0, (phase - STANCE) / (1.0 - STANCE))
    turn = -0.3 * (1.0 - ease(phase / 0.12)) + 0.75 * ease((phase - 0.3) / (STANCE - 0.3))
    if swing > 0.0:
        turn = 0.75 - 1.05 * ease(swing / 0.8)
    reach = 0.5 * STANCE * STRIDE
    # A cubic whose speed at both ends is that of the ground.
    back = STRIDE * (1.0 - STANCE)
    z = reach - STRIDE * phase if swing == 0.0 else -reach - back * swing + (2.0 * reach + back) * ease(swing)
    c, s = math.cos(turn), math.sin(turn)
    toes = c * toe_y - s * toe_z
    if turn > 0.0:  # pivots about the toes
        z += toe_z - (s * toe_y + c * toe_z)
    return radius + max(0.0, -toes) + 0.05 * math.sin(math.pi * swing) ** 2, z, turn


def leg(phase):
    """The joint angles of the left thigh, shin and foot that reach the position of foot()."""
    thigh, shin = (math.hypot(*part(name)[2]) for name in ("left shin", "left foot"))
    y, z, turn = foot(phase)
    down = hips(phase) - y
    far = min(math.hypot(down, z), 0.9995 * (thigh + shin))
    along = math.atan2(-z, down)
    upper = along - math.acos((thigh * thigh + far * far - shin * shin) / (2 * thigh * far))
    knee = math.pi - math.acos((thigh * thigh + shin * shin - far * far) / (2 * thigh * shin))
    return {"thigh": upper, "shin": knee, "foot": turn - upper - knee}


def bend(name, phase):
    """The angle of a joint about x: radians, negative forwards. phase: 0 to 1 over two steps, from left heel strike."""
    phase = (phase + (0.5 if name.startswith("right") else 0.0)) % 1.0
    swing = math.cos(2 * math.pi * phase)
    return {
        "arm": 0.08 + 0.5 * swing, "forearm": -0.42 + 0.2 * swing, "chest": 0.05, "neck": 0.08, "head": -0.1, "hair": 0.0,
        "hips": 0.0, **leg(phase),
    }[name.split()[-1]]


def capsules(phase):
    """The capsules of the figure at a phase: (one end, other end, radius)."""
    frames, solids = {}, []
    for name, parent, place, end, radius in PARTS:
        x, y, z = place
        angle = bend(name, phase)
        if parent is None:
            y = hips(phase)
        else:
            (px, py, pz), turn = frames[parent]
            c, s = math.cos(turn), math.sin(turn)
            x, y, z = px + x, py + c * y - s * z, pz + s * y + c * z
            angle += turn
        frames[name] = (x, y, z), angle
        c, s = math.cos(angle), math.sin(angle)
        solids.append(((x, y, z), (x + end[0], y + c * end[1] - s * end[2], z + s * end[1] + c * end[2]), radius))
    return solids


def capsule(end, radius, sides=24, rings=8):
    """Positions and triangles of a capsule from the origin to `end`."""
    length = math.sqrt(sum(x * x for x in end))
    up = [x / length for x in end]
    side = (1.0, 0.0, 0.0) if abs(up[0]) < 0.9 else (0.0, 1.0, 0.0)
    u = [side[1] * up[2] - side[2] * up[1], side[2] * up[0] - side[0] * up[2], side[0] * up[1] - side[1] * up[0]]
    size = math.sqrt(sum(x * x for x in u))
    u = [x / size for x in u]
    v = [up[1] * u[2] - up[2] * u[1], up[2] * u[0] - up[0] * u[2], up[0] * u[1] - up[1] * u[0]]
    profile = [(radius * math.sin(a), -radius * math.cos(a)) for a in (math.pi / 2 * i / rings for i in range(rings + 1))]
    profile += [(r, length - h) for r, h in reversed(profile)]
    positions, triangles = [], []
    for r, h in profile:
        for k in range(sides):
            a = 2 * math.pi * k / sides
            positions.append([r * (math.cos(a) * u[i] + math.sin(a) * v[i]) + h * up[i] for i in range(3)])
    for ring in range(len(profile) - 1):
        for k in range(sides):
            a, b = ring * sides + k, ring * sides + (k + 1) % sides
            # The ends are points: one of the two triangles there has no area.
            triangles += [(a, b, b + sides)] if ring > 0 else []
            triangles += [(a, b + sides, a + sides)] if ring + 2 < len(profile) else []
    return positions, triangles


def figure():
    walker, channels, samplers = Gltf(), [], []
    phases = [key / KEYS for key in range(KEYS + 1)]
    times = walker.accessor("SCALAR", "f", [SECONDS * phase for phase in phases], min=[0.0], max=[SECONDS])

    def channel(node, path, kind, numbers):
        samplers.append({"input": times, "output": walker.accessor(kind, "f", numbers)})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})

    names, materials = [part[0] for part in PARTS], list(MATERIALS)
    for material, color in MATERIALS.items():
        walker.material(material, color)
    for i, (name, _, place, end, radius) in enumerate(PARTS):
        positions, triangles = capsule(end, radius)
        mesh = walker.mesh(positions, [(triangles, materials.index(WEARS.get(name.split()[-1], "skin")))])
        walker.nodes.append({"name": name, "mesh": mesh, "translation": place})
        children = [names.index(part[0]) for part in PARTS if part[1] == name]
        if children:
            walker.nodes[-1]["children"] = children
        turns = [0.5 * bend(name, phase) for phase in phases]
        channel(i, "rotation", "VEC4", [x for t in turns for x in (math.sin(t), 0.0, 0.0, math.cos(t))])
        if i == 0:
            channel(i, "translation", "VEC3", [x for phase in phases for x in (place[0], hips(phase), place[2])])
    walker.animations.append({"name": "walk", "channels": channels, "samplers": samplers})
    return walker


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: walker.py OUT.gltf")
    figure().write(sys.argv[1])
