#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the corner of a kitchen as glTF with a material for each part: kitchen.py OUT.gltf

Also writes OUT.ply with their colours, for pictures. The output is reproducible. Needs only Python.
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from gltf import Gltf  # noqa: E402
from village import Shape, ply  # noqa: E402

PLATES = [(0.66, -0.42, 0.105), (0.96, -0.42, 0.085), (0.66, -0.14, 0.085), (0.96, -0.14, 0.105)]  # x, z, radius
STOVE_TOP = 0.90
PLATE_TOP = STOVE_TOP + 0.012
TABLE_TOP = 0.74


def parts():
    """Solids by material; metres, y up."""
    table = Shape().box((-1.15, TABLE_TOP - 0.04, -0.45), (0.05, TABLE_TOP, 0.45), "wood")
    for x in (-1.10, -0.05):
        for z in (-0.40, 0.35):
            table.box((x, 0.0, z), (x + 0.05, TABLE_TOP - 0.04, z + 0.05), "wood")
    stove = Shape().box((0.50, 0.0, -0.58), (1.12, STOVE_TOP, 0.02), "enamel")
    stove.box((0.55, 0.18, 0.02), (1.07, 0.66, 0.035), "enamel")   # the door
    stove.box((0.60, 0.68, 0.035), (1.02, 0.70, 0.06), "enamel")   # its handle
    for i in range(4):
        stove.box((0.57 + 0.13 * i, 0.77, 0.02), (0.61 + 0.13 * i, 0.81, 0.045), "enamel")  # knobs
    plates = Shape()
    for x, z, r in PLATES:
        profile = [(r, STOVE_TOP - 0.002), (r, PLATE_TOP - 0.004), (r - 0.004, PLATE_TOP)]
        plates.turned(profile, 48, "hot plate", (x, 0.0, z))
    bowl = Shape().turned([(0.06, TABLE_TOP), (0.075, TABLE_TOP + 0.02), (0.135, TABLE_TOP + 0.075), (0.15, TABLE_TOP + 0.12),
                           (0.14, TABLE_TOP + 0.12), (0.125, TABLE_TOP + 0.08), (0.065, TABLE_TOP + 0.03),
                           (0.001, TABLE_TOP + 0.025)], 48, "china", (-0.55, 0.0, 0.0))
    room = Shape().box((-1.5, -0.1, -0.8), (1.5, 0.0, 1.2), "tiles").box((-1.5, 0.0, -0.8), (1.5, 1.6, -0.7), "tiles")
    room.box((1.4, 0.0, -0.7), (1.5, 1.6, 1.2), "tiles")
    return {"wood": table, "enamel": stove, "hot plate": plates, "china": bowl, "tiles": room}


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: kitchen.py OUT.gltf")
    corner, colored = Gltf(), Shape()
    for name, shape in parts().items():
        mesh = corner.mesh(shape.points, [(shape.triangles, corner.material(name))], name=name)
        corner.nodes.append({"name": name, "mesh": mesh})
        colored.add(shape.points, shape.triangles, name)
    corner.write(sys.argv[1])
    with open(os.path.splitext(sys.argv[1])[0] + ".ply", "wb") as out:
        out.write(ply(colored))


if __name__ == "__main__":
    main()
