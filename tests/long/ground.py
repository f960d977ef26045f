#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Hills for scripts/nightly.sh ground. Heights are the sum of a profile over x and one over z, so any height is cheap to compute.

ground.py write OUT.r16 SIDE [--high 300]             writes 16-bit samples
ground.py points OUT.csv SIDE COUNT [--aside 256]     writes points a metre above all seams of tiles of 512, or ASIDE beside them
ground.py scene WORLD SIDE KIND POINTS COUNT [--stream MB]  prints a scene with drops or balls from these points
ground.py below DUMP.ply SIDE [--high 300]            prints counts, the maximum depth and the maximum height
ground.py kicks BEFORE.ply AFTER.ply                  prints the 99.9th percentile and the maximum of energy gains in J/kg
"""
import argparse
import array
import math
import os
import random
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../cli'))
import ply  # noqa: E402

HIGHEST = 62_000
TILE = 512
GRAVITY = 9.81


def profile(side, turn):
    """Heights in sample units, with slopes up to 0.4 at 300 m."""
    waves = [(120.0, 0.43), (47.0, 0.2), (19.0, 0.06)]
    return [HIGHEST / 4 * (1 + sum(share * math.sin(i / length + turn * (k + 1)) for k, (length, share) in enumerate(waves)))
            for i in range(side)]


def write(out, side):
    across, along = profile(side, 0.7), profile(side, 2.1)
    with open(out, 'wb') as file:
        for z in along:
            row = array.array('H', [round(x + z) for x in across])
            if sys.byteorder == 'big':
                row.byteswap()
            file.write(row.tobytes())


class Surface:
    """The bilinear surface of the written samples."""

    def __init__(self, side, high):
        self.side, self.scale = side, high / 65535
        self.across, self.along = profile(side, 0.7), profile(side, 2.1)

    def at(self, x, z):
        i, j = min(int(x), self.side - 2), min(int(z), self.side - 2)
        s, t = x - i, z - j
        corner = [round(self.across[i + a] + self.along[j + b]) for b in (0, 1) for a in (0, 1)]
        return self.scale * ((1 - t) * ((1 - s) * corner[0] + s * corner[1]) + t * ((1 - s) * corner[2] + s * corner[3]))


def particles(dump):
    for row in ply.read(dump):
        yield [row[name] for name in ('x', 'y', 'z', 'vx', 'vy', 'vz', 'id')]


def points(out, side, count, aside):
    """Points on both sides of every line, a metre above the surface."""
    chance = random.Random(7)
    surface = Surface(side, 300)
    seams = range(TILE + aside, side - 20, TILE)
    with open(out, 'w') as file:
        file.write('x,y,z\n')
        for _ in range(count):
            at = [chance.uniform(20, side - 20), chance.choice(seams) + chance.uniform(-0.05, 0.05)]
            x, z = at if chance.random() < 0.5 else reversed(at)
            file.write(f'{x:.4f},{surface.at(x, z) + 1:.4f},{z:.4f}\n')


def scene(world, side, kind, file, count, stream):
    balls = kind == 'balls'
    print(f'world = "{world}"\n[time]\nsteps = 300\ndt = 0.01\n[particles]\ncapacity = {count}\n'
          f'[forces]\ngravity = [0, {-GRAVITY}, 0]\ndrag = 0\n[ground]\nenabled = false\n'
          f'[camera]\neye = [10, 400, 10]\ntarget = [{side / 2}, 0, {side / 2}]')
    if stream:
        print(f'[stream]\nradius = 40\nmemory = {stream}')
    print('[[type]]\nname = "one"\non_collision = "bounce"\n' +
          ('restitution = 0.0\nfriction = 0.0\nradius = 0.4' if balls else 'restitution = 0.3\nfriction = 0.2'))
    print(f'[[emitter]]\ntype = "one"\npoints = "{file}"\nrate = 0\nburst = {count}\nlifetime = 1000\n'
          f'velocity = [0, {0 if balls else -15}, 0]\nvelocity_spread = [0, 0, 0]')


def below(dump, side, high):
    surface = Surface(side, high)
    count, deep, deepest, highest = 0, 0, -math.inf, -math.inf
    for x, y, z, *_ in particles(dump):
        if 0 <= x <= side - 1 and 0 <= z <= side - 1:
            depth = surface.at(x, z) - y
            count, deep = count + 1, deep + (depth > 0.05)
            deepest, highest = max(deepest, depth), max(highest, -depth)
    print(count, deep, deepest, highest)


def kicks(before, after):
    def energies(dump):
        return {one: GRAVITY * y + 0.5 * (vx * vx + vy * vy + vz * vz) for _, y, _, vx, vy, vz, one in particles(dump)}
    first, then = energies(before), energies(after)
    gained = sorted(then[one] - first[one] for one in then)
    print(len(gained), gained[len(gained) * 999 // 1000], gained[-1])


if __name__ == '__main__':
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('verb', choices=['write', 'points', 'scene', 'below', 'kicks'])
    parser.add_argument('arguments', nargs='+')
    parser.add_argument('--high', type=float, default=300)
    parser.add_argument('--stream', type=float)
    parser.add_argument('--aside', type=int, default=0)
    given = parser.parse_args()
    if given.verb == 'write':
        write(given.arguments[0], int(given.arguments[1]))
    elif given.verb == 'points':
        points(given.arguments[0], int(given.arguments[1]), int(given.arguments[2]), given.aside)
    elif given.verb == 'scene':
        world, side, kind, file, count = given.arguments
        scene(world, int(side), kind, file, int(count), given.stream)
    elif given.verb == 'below':
        below(given.arguments[0], int(given.arguments[1]), given.high)
    else:
        kicks(*given.arguments)
