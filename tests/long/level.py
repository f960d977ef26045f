#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a level for accuracy tests: level.py OUT.glb [--props 200] [--size 1000] [--cells 500] [--seed 1]

A node with hilly terrain, and `props` nodes with furniture of Debian's sweethome3d-furniture, 1.6 m long: fifty models in turn.
Equal arguments give equal bytes.
"""
import argparse
import math
import os
import random
import sys
import zipfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../samples'))
from gltf import Gltf  # noqa: E402
from meshes import smooth_noise  # noqa: E402

FURNITURE = '/usr/share/sweethome3d/furniture'
MODELS = 50
LONG = 1.6


def read_obj(text):
    """Positions and triangles; polygons become fans."""
    points, triangles = [], []
    for line in text.splitlines():
        words = line.split()
        if words[:1] == ['v']:
            points.append(tuple(map(float, words[1:4])))
        elif words[:1] == ['f']:
            corners = [int(word.split('/')[0]) for word in words[1:]]
            corners = [i - 1 if i > 0 else len(points) + i for i in corners]
            triangles += [(corners[0], corners[k], corners[k + 1]) for k in range(1, len(corners) - 1)]
    return points, triangles


def furniture():
    """Fifty models, selected evenly by name from those with 200 to 20,000 triangles."""
    found = []
    for archive in 'KatorLegaz', 'Scopia':
        with zipfile.ZipFile(f'{FURNITURE}/{archive}.sh3f') as file:
            for entry in sorted(file.namelist()):
                if entry.endswith('.obj'):
                    points, triangles = read_obj(file.read(entry).decode('utf-8', 'replace'))
                    if 200 <= len(triangles) <= 20000:
                        found.append((os.path.basename(entry)[:-4], points, triangles))
    return [found[i * len(found) // MODELS] for i in range(MODELS)]


def height(x, z):
    return 20 * smooth_noise(x / 120, z / 120) + 4 * smooth_noise(x / 30 + 7, z / 30)


def terrain(size, cells):
    step = size / cells
    points = [((i - cells / 2) * step, height((i - cells / 2) * step, (k - cells / 2) * step), (k - cells / 2) * step)
              for k in range(cells + 1) for i in range(cells + 1)]
    triangles = []
    for k in range(cells):
        for i in range(cells):
            a = k * (cells + 1) + i
            triangles += [(a, a + cells + 1, a + 1), (a + 1, a + cells + 1, a + cells + 2)]
    return points, triangles


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('out')
    parser.add_argument('--props', type=int, default=200)
    parser.add_argument('--size', type=float, default=1000.0)
    parser.add_argument('--cells', type=int, default=500)
    parser.add_argument('--seed', type=int, default=1)
    options = parser.parse_args()
    draw = random.Random(options.seed)
    glb = Gltf()
    points, triangles = terrain(options.size, options.cells)
    glb.nodes.append({'name': 'terrain', 'mesh': glb.mesh(points, [(triangles, None)], name='terrain')})
    models = []
    for name, points, triangles in furniture():
        low = [min(p[i] for p in points) for i in range(3)]
        high = [max(p[i] for p in points) for i in range(3)]
        scale = LONG / max(b - a for a, b in zip(low, high))
        middle = [(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2]
        placed = [tuple((c - m) * scale for c, m in zip(p, middle)) for p in points]
        models.append((name, glb.mesh(placed, [(triangles, None)], name=name)))
    reach = 0.45 * options.size
    for i in range(options.props):
        name, mesh = models[i % len(models)]
        x, z, angle = draw.uniform(-reach, reach), draw.uniform(-reach, reach), draw.uniform(0, 2 * math.pi)
        glb.nodes.append({'name': f'{name}_{i + 1}', 'mesh': mesh, 'translation': [x, height(x, z), z],
                          'rotation': [0, math.sin(angle / 2), 0, math.cos(angle / 2)]})
    glb.write(options.out)


if __name__ == '__main__':
    main()
