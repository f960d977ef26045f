#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the figures of ../METHOD.md into this folder: figures.py"""
import math
import pathlib

FRONT, BACK, PATCH, INK, GREY = '#d55e00', '#0072b2', '#009e73', '#222', '#999'
SOLID, INSIDE = '#e9e4d8', '#f6d9a8'


class Figure:
    def __init__(self, width, height):
        self.size = width, height
        self.lines = []

    def add(self, tag, text=None, **attributes):
        words = ''.join(f' {name.rstrip("_").replace("_", "-")}="{value:.1f}"' if isinstance(value, float) else
                        f' {name.rstrip("_").replace("_", "-")}="{value}"' for name, value in attributes.items())
        self.lines.append(f'<{tag}{words}/>' if text is None else f'<{tag}{words}>{text}</{tag}>')

    def line(self, a, b, color=INK, width=1.2, dash=None):
        style = {'stroke_dasharray': dash} if dash else {}
        self.add('line', x1=float(a[0]), y1=float(a[1]), x2=float(b[0]), y2=float(b[1]), stroke=color, stroke_width=width,
                 **style)

    def arrow(self, a, b, color=INK, width=1.6, dash=None):
        length = math.dist(a, b)
        x, y = (b[0] - a[0]) / length, (b[1] - a[1]) / length
        neck = b[0] - 7 * x, b[1] - 7 * y
        self.line(a, neck, color, width, dash)
        self.polygon([b, (b[0] - 9 * x - 4 * y, b[1] - 9 * y + 4 * x), (b[0] - 9 * x + 4 * y, b[1] - 9 * y - 4 * x)], color, 'none')

    def polygon(self, points, fill='none', stroke=INK, width=1.4, tag='polygon'):
        self.add(tag, points=' '.join(f'{x:.1f},{y:.1f}' for x, y in points), fill=fill, stroke=stroke, stroke_width=width)

    def rect(self, x, y, width, height, fill='none', stroke='none', dash=None):
        style = {'stroke_dasharray': dash} if dash else {}
        self.add('rect', x=float(x), y=float(y), width=float(width), height=float(height), fill=fill, stroke=stroke, **style)

    def dot(self, p, color=INK, radius=3.5):
        self.add('circle', cx=float(p[0]), cy=float(p[1]), r=radius, fill=color)

    def text(self, x, y, words, color=INK, anchor='start', size=14):
        self.add('text', words, x=float(x), y=float(y), fill=color, text_anchor=anchor, font_size=size)

    def write(self, name):
        width, height = self.size
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}"'
                ' font-family="DejaVu Sans, Arial, sans-serif">')
        background = f'<rect width="{width}" height="{height}" fill="white"/>'
        (pathlib.Path(__file__).parent / name).write_text('\n'.join([head, background, *self.lines, '</svg>', '']))


def blob(center, scale, dents):
    """A closed curve, clockwise on the page, with dents: angle, depth and width of each, in radians and parts of the radius."""
    points = []
    for i in range(240):
        angle = math.tau * i / 240
        radius = scale * (1.0 + 0.06 * math.cos(2.0 * angle))
        for at, depth, width in dents:
            radius -= scale * depth * math.exp(-(math.remainder(angle - at, math.tau) / width) ** 2)
        points.append((center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle)))
    return points


def crossings(curve, axis, at):
    """Intersects a curve with the line where coordinate `axis` is `at`: points and outward normals, in order along the line."""
    found = []
    for a, b in zip(curve, curve[1:] + curve[:1]):
        if (a[axis] <= at) != (b[axis] <= at):
            t = (at - a[axis]) / (b[axis] - a[axis])
            length = math.dist(a, b)
            normal = (b[1] - a[1]) / length, (a[0] - b[0]) / length
            found.append(((a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])), normal))
    return sorted(found, key=lambda hit: hit[0][1 - axis])


def within(curve, p):
    return sum(hit[0][1] < p[1] for hit in crossings(curve, 0, p[0])) % 2 == 1


def depth_map():
    figure = Figure(760, 300)
    curve = blob((212.0, 150.0), 94.0, [(5.5, 0.40, 0.38)])
    left, right, top, texel = 80.0, 345.0, 30.0, 24.0
    figure.rect(left, top, right - left, 10 * texel, '#fafafa', GREY)
    for row in (0, 9):
        figure.rect(left, top + row * texel, right - left, texel, '#eee')
    figure.polygon(curve, SOLID)
    for row in range(10):
        y = top + (row + 0.5) * texel
        hits = crossings(curve, 1, y)
        figure.line((56, y), (hits[0][0][0] if hits else right, y), GREY, 0.8, '3 3')
        for (point, normal), color in zip((hits[0], hits[-1]) if hits else (), (FRONT, BACK)):
            # The tangent through the point, across the texel's rows.
            reach = min(texel / 2 / max(abs(normal[0]), 0.5), 16.0)
            away = -normal[1] * reach, normal[0] * reach
            figure.line((point[0] - away[0], point[1] - away[1]), (point[0] + away[0], point[1] + away[1]), color, 2.6)
            figure.dot(point, color, 3)
    figure.arrow((16, 150), (52, 150), INK, 2.0)
    figure.text(16, 140, 'view')
    figure.text(left, 22, "z' = 0", anchor='middle')
    figure.text(right, 22, "z' = 1", anchor='middle')
    figure.text(140, 292, 'front', FRONT, 'middle')
    figure.text(260, 292, 'back', BACK, 'middle')
    figure.text(352, 46, 'border', GREY, size=12)
    figure.text(352, 262, 'border', GREY, size=12)

    # One texel: both distances of a point.
    x0, x1, y0, y1 = 450.0, 730.0, 60.0, 220.0
    figure.rect(x0, y0, x1 - x0, y1 - y0, '#fafafa', GREY)
    surface, point, angle = (630.0, 140.0), (500.0, 92.0), math.radians(28)
    normal = -math.cos(angle), -math.sin(angle)
    slant = 80 * math.tan(angle)
    ends = (surface[0] - slant, y1), (surface[0] + slant, y0)
    figure.polygon([*ends, (x1, y0), (x1, y1)], SOLID, 'none')
    figure.line(*ends, FRONT, 2.6)
    figure.line((x0, surface[1]), surface, GREY, 0.8, '3 3')
    figure.line((surface[0], y0), (surface[0], y1), GREY, 0.8, '3 3')
    distance = (point[0] - surface[0]) * normal[0] + (point[1] - surface[1]) * normal[1]
    figure.line(point, (surface[0], point[1]), BACK, 2.0, '6 3')
    figure.line(point, (point[0] - normal[0] * distance, point[1] - normal[1] * distance), PATCH, 2.4)
    figure.arrow(surface, (surface[0] + 44 * normal[0], surface[1] + 44 * normal[1]), FRONT)
    figure.dot(surface, FRONT)
    figure.dot(point)
    figure.text(492, 88, 'P', anchor='end')
    figure.text(638, 156, 'S')
    figure.text(584, 110, 'n', FRONT, 'end')
    figure.text(x0, 244, "projected: f = z_scale · (dist − z')", BACK, size=13)
    figure.text(x0, 266, 'plane: f = n · (P − S)', PATCH, size=13)
    figure.text(x0, 50, 'one texel')
    figure.write('depth_map.svg')


def votes():
    figure = Figure(760, 268)
    texel, count = 12.0, 19
    for panel, title in enumerate(('map along x', 'map along y', 'both maps')):
        left, top = 16.0 + 250 * panel, 34.0
        curve = blob((left + 114, top + 114), 98.0, [(4.71, 0.62, 0.26), (3.14, 0.55, 0.24)])
        starts = left, top
        spans = []
        for axis in (1, 0):
            hits = [crossings(curve, axis, starts[axis] + (i + 0.5) * texel) for i in range(count)]
            spans.append([(h[0][0][1 - axis], h[-1][0][1 - axis]) if h else (0.0, 0.0) for h in hits])
        figure.rect(left, top, texel * count, texel * count, '#fafafa', GREY)
        # Runs of cells of two texels, cut by the maps of this panel.
        for i in range(count):
            run = []
            for j in range(count):
                box = [left + j * texel, top + i * texel, left + (j + 1) * texel, top + (i + 1) * texel]
                if panel != 1:
                    box[0], box[2] = max(box[0], spans[0][i][0]), min(box[2], spans[0][i][1])
                if panel != 0:
                    box[1], box[3] = max(box[1], spans[1][j][0]), min(box[3], spans[1][j][1])
                if box[0] < box[2] and box[1] < box[3]:
                    if run and run[-1][2] == box[0] and run[-1][1::2] == box[1::2]:
                        run[-1][2] = box[2]
                    else:
                        run.append(box)
            for x0, y0, x1, y1 in run:
                figure.rect(x0, y0, x1 - x0, y1 - y0, INSIDE, INSIDE)
        figure.polygon(curve, width=1.8)
        for name, p in (('A', (left + 114, top + 42)), ('B', (left + 44, top + 114)), ('C', (left + 140, top + 140))):
            figure.dot(p)
            figure.text(p[0] + (-16 if name == 'B' else 6), p[1] + (5 if name == 'B' else -5), name)
        figure.text(left + texel * count / 2, 24, title, anchor='middle')
    figure.write('votes.svg')


def patches():
    figure = Figure(760, 330)
    side, left, top = 280.0, 20.0, 25.0
    curve = blob((left + 138, top + 142), 108.0, [(5.5, 0.40, 0.38)])

    def directions(x, y, size):
        """Directions of the outward normals in a cell, relative to the first one; and the first one."""
        angles = [math.atan2(a[0] - b[0], b[1] - a[1]) for a, b in zip(curve, curve[1:] + curve[:1])
                  if x <= a[0] < x + size and y <= a[1] < y + size]
        return [math.remainder(angle - angles[0], math.tau) for angle in angles], angles[0] if angles else 0.0

    def cell(x, y, size, level):
        turns, first = directions(x, y, size)
        if not turns:
            figure.rect(x, y, size, size, INSIDE if within(curve, (x + size / 2, y + size / 2)) else '#fafafa', GREY)
        elif level < 2 or (level < 4 and max(turns) - min(turns) > 0.75):
            for i in range(4):
                cell(x + size / 2 * (i % 2), y + size / 2 * (i // 2), size / 2, level + 1)
        else:
            figure.rect(x, y, size, size, 'white', PATCH)
            if size > 30:  # the axis: one of eight here, of 26 in space
                way = round((first + sum(turns) / len(turns)) / (math.tau / 8)) * math.tau / 8
                reach = 0.3 * size * math.cos(way), 0.3 * size * math.sin(way)
                middle = x + size / 2, y + size / 2
                figure.arrow((middle[0] - reach[0], middle[1] - reach[1]), (middle[0] + reach[0], middle[1] + reach[1]), PATCH, 1.2)

    cell(left, top, side, 0)
    figure.polygon(curve, width=1.8)
    figure.text(left + side / 2, 322, 'octree (here: quadtree)', anchor='middle')

    # Keys.
    for i, (fill, stroke, words) in enumerate((('#fafafa', GREY, 'outside: a plane'), (INSIDE, GREY, 'inside: a plane'),
                                               ('white', PATCH, 'patch, and its axis'))):
        figure.rect(326, 40 + 28 * i, 16, 16, fill, stroke)
        figure.text(350, 53 + 28 * i, words, size=13)

    # One leaf: heights over an axis.
    x, y, size = 500.0, 45.0, 220.0
    figure.rect(x, y, size, size, 'white', PATCH)
    heights = [0.62, 0.50, 0.43, 0.42, 0.47]
    tops = [(x + size * i / 4, y + size * (1 - h)) for i, h in enumerate(heights)]
    figure.polygon([(x, y + size), *tops, (x + size, y + size)], INSIDE, 'none')
    for p in tops:
        figure.line((p[0], y + size), p, GREY, 0.8, '3 3')
    figure.polygon(tops, stroke=PATCH, width=2.6, tag='polyline')
    for p in tops:
        figure.dot(p, PATCH)
    figure.arrow((x - 14, y + size), (x - 14, y), INK)
    figure.text(x - 22, y + 12, 'w', anchor='end')
    figure.arrow((x, y + size + 14), (x + size, y + size + 14), INK)
    figure.text(x + size, y + size + 32, 'u', anchor='end')
    figure.text(x + size / 2, 322, 'one patch: 5 heights', anchor='middle')
    point = x + 0.66 * size, y + 0.22 * size
    height = heights[2] + (0.66 * 4 - 2) * (heights[3] - heights[2])
    figure.line(point, (point[0], y + size * (1 - height)), BACK, 1.6, '6 3')
    figure.dot(point)
    figure.text(point[0] - 8, point[1] - 6, 'q', anchor='end')
    figure.text(point[0] + 8, point[1] + 42, 'w − H(u)', BACK, size=13)
    figure.write('patches.svg')


def reaction():
    figure = Figure(760, 270)
    for left, title in ((20.0, 'about to collide'), (395.0, 'caught')):
        figure.rect(left, 140, 345, 100, SOLID)
        figure.line((left, 140), (left + 345, 140), INK, 1.8)
        figure.text(left + 172, 24, title, anchor='middle')
        figure.text(left + 4, 134, 'outside', GREY, size=12)
        figure.text(left + 4, 234, 'inside', GREY, size=12)
        figure.arrow((left + 330, 140), (left + 330, 92), GREY)
        figure.text(left + 326, 88, 'n', GREY, 'end')

    before, after = (110.0, 78.0), (190.0, 188.0)
    figure.arrow(before, after, INK)
    figure.dot(before)
    figure.dot(after)
    figure.text(100, 74, 'P', anchor='end')
    figure.text(200, 200, 'P*')
    figure.text(158, 122, 'dt v*')
    way = after[0] - before[0], after[1] - before[1]
    figure.line((before[0], after[1]), after, GREY, 0.9, '3 3')
    figure.line(before, (before[0], after[1]), GREY, 0.9, '3 3')
    figure.text(150, 206, 'v∥', GREY, 'middle', 12)
    figure.text(102, 118, 'v⊥', GREY, 'end', 12)
    bounce = before[0] + 0.8 * way[0], before[1] - 0.3 * way[1]
    figure.arrow(before, bounce, FRONT, 2.2)
    figure.text(bounce[0] + 8, bounce[1] + 8, '(1 − ν) v∥ + ε a n', FRONT, size=13)

    for x, inwards in ((450.0, True), (590.0, False)):
        start = x, 186.0
        wanted = (x + 50, 216.0) if inwards else (x + 50, 164.0)
        taken = x + 50, 156.0
        figure.dot(start)
        figure.text(x - 8, 191, 'P', anchor='end')
        if inwards:
            figure.arrow(start, wanted, INK)
            figure.text(wanted[0] + 6, wanted[1] + 4, 'dt v*')
            figure.arrow(start, taken, FRONT, 2.2)
            figure.text(taken[0] + 6, taken[1] + 2, 'v∥ − v⊥', FRONT, size=13)
        else:
            figure.arrow(start, wanted, FRONT, 2.2)
            figure.text(wanted[0] + 6, wanted[1] + 12, 'v* is kept', FRONT, size=13)
    figure.text(475, 262, 'v*·n &lt; 0: mirrored', anchor='middle', size=13)
    figure.text(625, 262, 'v*·n ≥ 0', anchor='middle', size=13)
    figure.text(192, 262, 'f(P) ≥ 0, f(P*) &lt; 0', anchor='middle', size=13)
    figure.write('reaction.svg')


depth_map()
votes()
patches()
reaction()
