# SPDX-License-Identifier: Apache-2.0
"""Measures how deep particles are inside a mesh, and how many rest on it (up to 3,000):

    penetration.py MESH.obj PARTICLES.ply    prints a JSON object

Shares no code with the baker. Sides are by majority of the parities of rays along three axes, since the mesh may be open. Depths
are distances to the nearest triangle.
"""
import collections
import json
import sys

import numpy as np

import ply


def read_obj(path):
    lines = [line.split() for line in open(path)]
    vertices = np.array([line[1:4] for line in lines if line[:1] == ['v']], dtype=float)
    faces = [[int(word.split('/')[0]) - 1 for word in line[1:]] for line in lines if line[:1] == ['f']]
    return vertices[np.array([(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)])]


class Columns:
    """Triangles in the squares of a grid across an axis."""

    def __init__(self, triangles, axis):
        self.triangles, self.axis = triangles, axis
        self.sides = [(axis + 1) % 3, (axis + 2) % 3]
        seen = triangles[:, :, self.sides]
        self.low, self.step = seen.min(axis=(0, 1)), (seen.max(axis=(0, 1)) - seen.min(axis=(0, 1))) / 200
        self.squares = collections.defaultdict(list)
        first, last = (((f(axis=1) - self.low) // self.step).astype(int) for f in (seen.min, seen.max))
        for k, ((i0, j0), (i1, j1)) in enumerate(zip(first, last)):
            for i in range(i0, i1 + 1):
                for j in range(j0, j1 + 1):
                    self.squares[i, j].append(k)

    def crossings(self, p):
        """Number of crossings of the ray from p along the axis."""
        a, b, c = (self.triangles[self.squares.get(tuple(((p[self.sides] - self.low) // self.step).astype(int)), [])] - p).swapaxes(0, 1)
        u, v = self.sides
        # The areas of the three parts, projected along the axis, have equal signs if the line hits the triangle.
        areas = np.stack([q[:, u] * r[:, v] - q[:, v] * r[:, u] for q, r in ((b, c), (c, a), (a, b))])
        met = (areas > 0).all(axis=0) | (areas < 0).all(axis=0)
        heights = np.stack([q[met, self.axis] for q in (a, b, c)])
        return int(((areas[:, met] * heights).sum(axis=0) / areas[:, met].sum(axis=0) > 0).sum())


def distance(p, triangles):
    a, b, c = (triangles[:, i] for i in range(3))
    best = np.inf
    for q, r in ((a, b), (b, c), (c, a)):
        edge = r - q
        t = np.clip(((p - q) * edge).sum(axis=1) / np.maximum((edge * edge).sum(axis=1), 1e-300), 0, 1)
        best = min(best, np.linalg.norm(q + t[:, None] * edge - p, axis=1).min())
    normal = np.cross(b - a, c - a)
    within = np.ones(len(a), dtype=bool)
    for q, r in ((a, b), (b, c), (c, a)):
        within &= (np.cross(r - q, p - q) * normal).sum(axis=1) >= 0
    if within.any():
        normal = normal[within]
        best = min(best, (np.abs(((p - a[within]) * normal).sum(axis=1)) / np.linalg.norm(normal, axis=1)).min())
    return best


triangles = read_obj(sys.argv[1])
triangles = triangles[np.argsort(triangles[:, 0, 0])]
low, high = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))
side = float((high - low).max())
near = 3 * side / 510
longest = max(np.linalg.norm(triangles[:, i] - triangles[:, i - 1], axis=1).max() for i in range(3))
columns = [Columns(triangles, axis) for axis in range(3)]
deepest, resting = 0.0, 0
rows = ply.read(sys.argv[2])
for row in rows:
    p = np.array([row['x'], row['y'], row['z']], dtype=float)
    if (p < low - near).any() or (p > high + near).any():
        continue
    still = resting < 3000 and row['vx'] == row['vy'] == row['vz'] == 0
    within = sum(of.crossings(p) % 2 for of in columns) >= 2
    if within:
        deepest = max(deepest, distance(p, triangles))
    if still:
        # If a triangle is within `near`, its first corner is within `near` plus the longest edge.
        first, last = np.searchsorted(triangles[:, 0, 0], [p[0] - near - longest, p[0] + near + longest])
        close = triangles[first:last][(np.abs(triangles[first:last, 0] - p) <= near + longest).all(axis=1)]
        resting += int(len(close) > 0 and distance(p, close) <= near)
print(json.dumps({'particles': len(rows), 'deepest_share_of_longest_side': deepest / side, 'resting_on_mesh': resting}))
