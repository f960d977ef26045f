#!/usr/bin/env python3
"""Makes the corner of a kitchen, as glTF whose parts have materials: kitchen.py OUT.gltf

Beside it OUT.ply has their colours, for pictures.

The same argument gives the same bytes. Needs nothing but Python itself.
"""
import base64
import json
import math
import os
import struct
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from village import Shape, ply  # noqa: E402

PLATES = [(0.66, -0.42, 0.105), (0.96, -0.42, 0.085), (0.66, -0.14, 0.085), (0.96, -0.14, 0.105)]  # x, z, radius
STOVE_TOP = 0.90
PLATE_TOP = STOVE_TOP + 0.012
TABLE_TOP = 0.74


def box(low, high):
    """Corners and triangles of a box, wound outwards."""
    corners = [tuple((high if i >> k & 1 else low)[k] for k in range(3)) for i in range(8)]
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    return corners, [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]


def lathe(x, z, rings, around=48):
    """A solid of revolution about an upright axis, closed at both ends: rings are (radius, y), from below."""
    corners = [(x + r * math.cos(2 * math.pi * i / around), y, z + r * math.sin(2 * math.pi * i / around))
               for r, y in rings for i in range(around)]
    triangles = []
    for ring in range(len(rings) - 1):
        for i in range(around):
            a, b = ring * around + i, ring * around + (i + 1) % around
            triangles += [(a, a + around, b), (b, a + around, b + around)]
    for y, first, flip in ((rings[0][1], 0, False), (rings[-1][1], (len(rings) - 1) * around, True)):
        middle = len(corners)
        corners.append((x, y, z))
        for i in range(around):
            a, b = first + i, first + (i + 1) % around
            triangles.append((middle, b, a) if flip else (middle, a, b))
    return corners, triangles


def parts():
    """Solids by material, in metres, y up."""
    table = [box((-1.15, TABLE_TOP - 0.04, -0.45), (0.05, TABLE_TOP, 0.45))]
    for x in (-1.10, -0.05):
        for z in (-0.40, 0.35):
            table.append(box((x, 0.0, z), (x + 0.05, TABLE_TOP - 0.04, z + 0.05)))
    stove = [box((0.50, 0.0, -0.58), (1.12, STOVE_TOP, 0.02)),
             box((0.55, 0.18, 0.02), (1.07, 0.66, 0.035)),   # the door
             box((0.60, 0.68, 0.035), (1.02, 0.70, 0.06))]   # its handle
    stove += [box((0.57 + 0.13 * i, 0.77, 0.02), (0.61 + 0.13 * i, 0.81, 0.045)) for i in range(4)]  # knobs
    plates = [lathe(x, z, [(r, STOVE_TOP - 0.002), (r, PLATE_TOP - 0.004), (r - 0.004, PLATE_TOP)]) for x, z, r in PLATES]
    bowl = lathe(-0.55, 0.0, [(0.06, TABLE_TOP), (0.075, TABLE_TOP + 0.02), (0.135, TABLE_TOP + 0.075),
                              (0.15, TABLE_TOP + 0.12), (0.14, TABLE_TOP + 0.12), (0.125, TABLE_TOP + 0.08),
                              (0.065, TABLE_TOP + 0.03), (0.001, TABLE_TOP + 0.025)])
    room = [box((-1.5, -0.1, -0.8), (1.5, 0.0, 1.2)), box((-1.5, 0.0, -0.8), (1.5, 1.6, -0.7)),
            box((1.4, 0.0, -0.7), (1.5, 1.6, 1.2))]
    return {"wood": table, "enamel": stove, "hot plate": plates, "china": [bowl], "tiles": room}


def gltf():
    """The document, with its buffer inside."""
    data, views, accessors, meshes, nodes, materials = b"", [], [], [], [], []
    for name, solids in parts().items():
        corners, triangles = [], []
        for own, faces in solids:
            triangles += [tuple(i + len(corners) for i in t) for t in faces]
            corners += own
        corners = [struct.unpack("<3f", struct.pack("<3f", *c)) for c in corners]
        low = [min(c[k] for c in corners) for k in range(3)]
        high = [max(c[k] for c in corners) for k in range(3)]
        for values, extra in ((b"".join(struct.pack("<3f", *c) for c in corners),
                               {"componentType": 5126, "type": "VEC3", "count": len(corners), "min": low, "max": high}),
                              (b"".join(struct.pack("<3I", *t) for t in triangles),
                               {"componentType": 5125, "type": "SCALAR", "count": 3 * len(triangles)})):
            accessors.append({"bufferView": len(views), **extra})
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(values)})
            data += values
        materials.append({"name": name})
        meshes.append({"name": name, "primitives": [{"attributes": {"POSITION": len(accessors) - 2},
                                                     "indices": len(accessors) - 1, "material": len(meshes)}]})
        nodes.append({"name": name, "mesh": len(nodes)})
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
            "meshes": meshes, "materials": materials, "accessors": accessors, "bufferViews": views,
            "buffers": [{"byteLength": len(data), "uri": uri}]}


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: kitchen.py OUT.gltf")
    with open(sys.argv[1], "w", encoding="utf-8") as out:
        json.dump(gltf(), out)
    colored = Shape()
    for name, solids in parts().items():
        for corners, triangles in solids:
            colored.add(corners, triangles, name)
    with open(os.path.splitext(sys.argv[1])[0] + ".ply", "wb") as out:
        out.write(ply(colored))
