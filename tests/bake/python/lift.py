# SPDX-License-Identifier: Apache-2.0
"""Writes a cube of side 2 as glTF with one clip per argument: lift.py FILE NAME=X,Y,Z…, the position after 1 s."""
import base64
import json
import pathlib
import struct
import sys


def lift(clips):
    corners = [coordinate for z in (-1, 1) for y in (-1, 1) for x in (-1, 1) for coordinate in (x, y, z)]
    faces = [0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6]
    parts = [struct.pack("<24f", *corners), struct.pack("<36H", *faces), struct.pack("<2f", 0, 1)]
    parts += [struct.pack("<6f", 0, 0, 0, *to) for to in clips.values()]
    data = b"".join(parts)
    views, begin = [], 0
    for part in parts:
        views.append({"buffer": 0, "byteOffset": begin, "byteLength": len(part)})
        begin += len(part)
    vectors = [{"bufferView": 3 + i, "componentType": 5126, "count": 2, "type": "VEC3"} for i in range(len(clips))]
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "lift", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "animations": [{"name": name, "samplers": [{"input": 2, "output": 3 + i}],
                        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}
                       for i, name in enumerate(clips)],
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
        "bufferViews": views,
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [-1] * 3, "max": [1] * 3},
                      {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"},
                      {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]}] + vectors})


if __name__ == "__main__":
    named = (word.split("=") for word in sys.argv[2:])
    pathlib.Path(sys.argv[1]).write_text(lift({name: [float(x) for x in to.split(",")] for name, to in named}))
