# SPDX-License-Identifier: Apache-2.0
"""A glTF writer for the scripts in this folder: meshes, nodes, materials and clips. Its output is reproducible."""
import base64
import json
import struct


class Gltf:
    """The arrays of a document. Nodes and animations are appended as glTF objects."""

    def __init__(self):
        self.nodes, self.meshes, self.materials, self.animations = [], [], [], []
        self.accessors, self.views, self.data = [], [], bytearray()

    def accessor(self, kind, letter, numbers, **bounds):
        """kind: glTF's accessor type; letter: f or I, as in struct."""
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": 4 * len(numbers)})
        self.data += struct.pack(f"<{len(numbers)}{letter}", *numbers)
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[kind]
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": {"f": 5126, "I": 5125}[letter],
                               "count": len(numbers) // width, "type": kind, **bounds})
        return len(self.accessors) - 1

    def material(self, name, color=None):
        """color: sRGB, 0 to 1."""
        shade = {"pbrMetallicRoughness": {"baseColorFactor": [round(c ** 2.2, 4) for c in color] + [1.0]}} if color else {}
        self.materials.append({"name": name, **shade})
        return len(self.materials) - 1

    def mesh(self, points, parts, **name):
        """parts: pairs of triangles and the index of their material, or None."""
        bounds = {end: [least(p[k] for p in points) for k in range(3)] for end, least in (("min", min), ("max", max))}
        at = self.accessor("VEC3", "f", [x for p in points for x in p], **bounds)
        primitives = []
        for triangles, material in parts:
            corners = self.accessor("SCALAR", "I", [i for t in triangles for i in t])
            primitives.append({"attributes": {"POSITION": at}, "indices": corners,
                               **({} if material is None else {"material": material})})
        self.meshes.append({**name, "primitives": primitives})
        return len(self.meshes) - 1

    def document(self, uri):
        below = {child for node in self.nodes for child in node.get("children", [])}
        more = {key: rows for key, rows in (("materials", self.materials), ("animations", self.animations)) if rows}
        return json.dumps({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [i for i in range(len(self.nodes)) if i not in below]}],
            "nodes": self.nodes, "meshes": self.meshes, **more, "buffers": [{"byteLength": len(self.data), **uri}],
            "bufferViews": self.views, "accessors": self.accessors}).encode()

    def write(self, path):
        """Writes one file: binary if its name ends in .glb, else JSON with an embedded buffer."""
        if path.endswith(".glb"):
            text = self.document({})
            text += b" " * (-len(text) % 4)
            out = (struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(self.data), len(text), b"JSON") + text +
                   struct.pack("<I4s", len(self.data), b"BIN\0") + self.data)
        else:
            out = self.document({"uri": "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()})
        with open(path, "wb") as file:
            file.write(out)
