# SPDX-License-Identifier: Apache-2.0
"""Shared by shape generators: meshes as lists of positions and faces, closed-form boxes, OBJ and glTF files, and queries."""

import base64
import json
import math
import struct

BOX_FACES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def turned_axes(random):
    """The axes of a random rotation, as rows."""
    while True:
        q = [random.gauss(0, 1) for _ in range(4)]
        norm = math.sqrt(sum(c * c for c in q))
        if norm > 0.1:
            break
    w, x, y, z = (c / norm for c in q)
    return ((1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
            (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
            (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)))


class Frame:
    """A rotated frame."""

    def __init__(self, center, axes):
        self.center, self.axes = center, axes

    def to_world(self, local):
        return [c + sum(l * axis[i] for l, axis in zip(local, self.axes)) for i, c in enumerate(self.center)]


def box_corners(half):
    return [[h if k >> i & 1 else -h for i, h in enumerate(half)] for k in range(8)]


def box_distance(local, half):
    """Signed distance, negative inside."""
    d = [abs(p) - h for p, h in zip(local, half)]
    return math.sqrt(sum(max(c, 0) ** 2 for c in d)) + min(max(d), 0)


def write_obj(path, positions, faces):
    with open(path, "w", encoding="ascii") as out:
        out.writelines("v %.9g %.9g %.9g\n" % tuple(p) for p in positions)
        out.writelines("f " + " ".join(str(c + 1) for c in face) + "\n" for face in faces)


class Gltf:
    """A glTF document with embedded data."""

    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []
        self.document = {"asset": {"version": "2.0"}, "scene": 0, "meshes": [], "nodes": []}

    def add(self, rows, component=5126, kind="VEC3"):
        """Adds numbers as an accessor; returns its index."""
        letter = {5126: "f", 5125: "I"}[component]
        part = b"".join(struct.pack(f"<{len(row)}{letter}", *row) for row in rows)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(part)})
        self.data += part
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component, "type": kind, "count": len(rows),
                               "min": [min(c) for c in zip(*rows)], "max": [max(c) for c in zip(*rows)]})
        return len(self.accessors) - 1

    def add_mesh(self, positions, faces, **more):
        """Adds a mesh with `more` members in its primitive; returns its index."""
        corners = [(c,) for f in faces for i in range(1, len(f) - 1) for c in (f[0], f[i], f[i + 1])]
        primitive = {"attributes": {"POSITION": self.add(positions)}, "indices": self.add(corners, 5125, "SCALAR"), **more}
        self.document["meshes"].append({"primitives": [primitive]})
        return len(self.document["meshes"]) - 1

    def write(self, path, **more):
        buffer = {"byteLength": len(self.data), "uri": "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()}
        document = {**self.document, "accessors": self.accessors, "bufferViews": self.views, "buffers": [buffer], **more}
        path.write_text(json.dumps(document), encoding="utf-8")


def query(cases, folder, file, points, *options):
    """Query results, one row per point; None after a failure."""
    with open(folder / "points.csv", "w", encoding="ascii") as out:
        out.writelines("%.9g,%.9g,%.9g\n" % tuple(p) for p in points)
    done = cases.run("relief", "query", file, "--points", "points.csv", "-o", "-", *options, cwd=folder)
    rows = [[float(word or "nan") for word in line.split(",")] for line in done.stdout.splitlines()[1:]] if done else []
    ok = cases.expect(done and done.returncode == 0 and len(rows) == len(points), f"{len(rows)} samples: {done and done.stderr}")
    return rows if ok else None


def bake(cases, folder, mesh, *options, seconds=60):
    """The finished process, or None after a failure."""
    done = cases.run("relief", "bake", mesh, *options, cwd=folder, seconds=seconds)
    return done if cases.expect(done and done.returncode == 0, f"bake failed: {done and done.stderr}") else None
