# SPDX-License-Identifier: Apache-2.0
"""Writes a small level as glTF: level.py OUT.gltf|OUT.glb [KEY=VALUE…]

Nodes: a floor, and three boxes by one mesh, turned and scaled, and one that is stretched. x=3 moves the first box, high=2
makes the mesh of all boxes higher, box=0 leaves boxes out.
"""
import base64
import json
import struct
import sys

options = {'x': 0.0, 'high': 1.0, 'box': 1.0, 'floor': 20.0}
options.update((key, float(value)) for key, value in (word.split('=') for word in sys.argv[2:]))


def box(x, y, z):
    points = [(a, b, c) for a in (-x, x) for b in (0, y) for c in (-z, z)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


data, views, accessors, meshes = b'', [], [], []
for name, (points, triangles) in (('floor', box(options['floor'], 0.5, options['floor'])),
                                  ('box', box(0.5, options['high'], 0.25))):
    for part, component, kind, count, more in (
            (b''.join(struct.pack('<3f', *p) for p in points), 5126, 'VEC3', len(points),
             {'min': [min(p[i] for p in points) for i in range(3)], 'max': [max(p[i] for p in points) for i in range(3)]}),
            (b''.join(struct.pack('<3H', *t) for t in triangles), 5123, 'SCALAR', 3 * len(triangles), {})):
        views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(part)})
        accessors.append({'bufferView': len(views) - 1, 'componentType': component, 'type': kind, 'count': count, **more})
        data += part
    meshes.append({'name': name, 'primitives': [{'attributes': {'POSITION': len(views) - 2}, 'indices': len(views) - 1}]})
nodes = [{'name': 'ground', 'mesh': 0, 'translation': [0, -0.5, 0]}]
if options['box']:
    nodes += [{'name': 'first', 'mesh': 1, 'translation': [options['x'], 0, 0]},
              {'name': 'second', 'mesh': 1, 'translation': [5, 0, 5], 'rotation': [0, 0.6, 0, 0.8], 'scale': [2, 2, 2]},
              {'name': 'third', 'mesh': 1, 'translation': [-5, 0.1, 5], 'rotation': [0.6, 0, 0, 0.8]},
              {'name': 'wide', 'mesh': 1, 'translation': [-5, 0, -5], 'scale': [3, 1, 1]}]
document = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': list(range(len(nodes)))}], 'nodes': nodes,
            'meshes': meshes, 'accessors': accessors, 'bufferViews': views, 'buffers': [{'byteLength': len(data)}]}
if sys.argv[1].endswith('.glb'):
    text = json.dumps(document).encode()
    text += b' ' * (-len(text) % 4)
    data += bytes(-len(data) % 4)
    with open(sys.argv[1], 'wb') as file:
        file.write(struct.pack('<4sII', b'glTF', 2, 28 + len(text) + len(data)))
        file.write(struct.pack('<I4s', len(text), b'JSON') + text + struct.pack('<I4s', len(data), b'BIN\0') + data)
else:
    document['buffers'][0]['uri'] = 'data:application/octet-stream;base64,' + base64.b64encode(data).decode()
    json.dump(document, open(sys.argv[1], 'w'))
