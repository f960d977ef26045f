# SPDX-License-Identifier: Apache-2.0
"""Writes a small level as glTF: level.py OUT.gltf|OUT.glb [KEY=VALUE…]

Nodes: a floor, three boxes with one mesh, rotated and scaled, and a stretched box. x=3 moves the first box, high=2 raises the mesh
of all boxes, box=0 omits the boxes.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'samples'))
from gltf import Gltf  # noqa: E402

options = {'x': 0.0, 'high': 1.0, 'box': 1.0, 'floor': 20.0}
options.update((key, float(value)) for key, value in (word.split('=') for word in sys.argv[2:]))


def box(x, y, z):
    points = [(a, b, c) for a in (-x, x) for b in (0, y) for c in (-z, z)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


level = Gltf()
for name, (points, triangles) in (('floor', box(options['floor'], 0.5, options['floor'])),
                                  ('box', box(0.5, options['high'], 0.25))):
    level.mesh(points, [(triangles, None)], name=name)
level.nodes = [{'name': 'ground', 'mesh': 0, 'translation': [0, -0.5, 0]}]
if options['box']:
    level.nodes += [{'name': 'first', 'mesh': 1, 'translation': [options['x'], 0, 0]},
                    {'name': 'second', 'mesh': 1, 'translation': [5, 0, 5], 'rotation': [0, 0.6, 0, 0.8], 'scale': [2, 2, 2]},
                    {'name': 'third', 'mesh': 1, 'translation': [-5, 0.1, 5], 'rotation': [0.6, 0, 0, 0.8]},
                    {'name': 'wide', 'mesh': 1, 'translation': [-5, 0, -5], 'scale': [3, 1, 1]}]
level.write(sys.argv[1])
