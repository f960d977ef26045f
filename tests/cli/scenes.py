#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plays scenes at random within the ranges that runtime/scene/README.md gives, ends included.

    scenes.py RELIEF_SIM COLLIDER COUNT

Each ends with particles whose numbers are all finite and whose energy is one; or with one line that names the scene and
a place in it, or the type of particle that was lost. RELIEF_TEST_SEED makes others.
"""
import math
import os
import random
import subprocess
import sys

import ply

# Key, least, most: a number, or with * a vector of three. A least of 0+ is above 0.
TABLES = {
    'forces': [('*gravity', -1e6, 1e6), ('*wind', -1e6, 1e6), ('drag', 0, 1e6)],
    'attractor': [('*position!', -1e9, 1e9), ('strength!', -1e6, 1e6), ('radius!', '0+', 1e9), ('reach', '0+', 1e9),
                  ('falloff', 'of', [0, 1, 2])],
    'vortex': [('*center!', -1e9, 1e9), ('*axis', -1e9, 1e9), ('strength!', -1e6, 1e6), ('radius!', '0+', 1e9),
               ('falloff', 'of', [0, 1, 2])],
    'curl_noise': [('amplitude!', '0+', 1e6), ('scale!', '0+', 1e9), ('octaves', 'of', [1, 2, 3, 4])],
    'collision': [('restitution', 0, 1), ('friction', 0, 1), ('friction_threshold', 0, 1e6), ('sweep', 0, 1e9)],
    'ground': [('height', -1e9, 1e9)],
    'type': [('mass', 1e-15, 1e9), ('radius', 0, 1e9), ('restitution', 0, 1), ('friction', 0, 1),
             ('lifetime_loss', 0, 1e6), ('on_collision', 'of', ['"bounce"', '"stop"', '"slide"', '"die"'])],
}
EMITTER = [('*velocity', -1e6, 1e6), ('*velocity_spread', 0, 1e6), ('lifetime', '0+', 1e6), ('rate', 0, 1e9)]


def number(r, least, most):
    """Everyday, of any size, or an end."""
    if least == 'of':
        return r.choice(most)
    low = 0.0 if least == '0+' else least
    kind = r.randrange(10)
    if kind == 0:
        return most
    if kind == 1:
        return 1e-30 if least == '0+' else low
    if kind == 2 and low <= 0 < most and least != '0+':
        return 0.0
    smallest = math.log10(max(low, min(most, 1.0) * (1e-12 if kind < 6 else 1e-3)))
    largest = math.log10(most if kind < 6 else min(most, 30.0))
    value = min(max(10 ** r.uniform(min(smallest, largest), largest), low), most)
    return -value if low < 0 and r.randrange(2) else value


def text(value):
    return value if isinstance(value, str) else repr(value)


def lines(r, keys, share):
    result = []
    for key, least, most in keys:
        must = key.endswith('!')
        vector = key.startswith('*')
        if must or r.random() < share:
            value = [number(r, least, most) for _ in range(3)] if vector else number(r, least, most)
            value = '[%s]' % ', '.join(map(text, value)) if vector else text(value)
            result.append('%s = %s' % (key.strip('*!'), value))
    return result


def scene(r, collider):
    dt = r.choice([1e-6, 1e-3, 1 / 60, 1 / 60, 0.1, 1.0])
    result = ['[collider]', 'file = "%s"' % collider]
    if r.randrange(3) == 0:
        result += lines(r, [('*position', -1e9, 1e9), ('scale', 1e-6, 1e6), ('restitution', 0, 1), ('friction', 0, 1)], 0.5)
    result += ['[time]', 'dt = %r' % dt, 'steps = %d' % r.randrange(1, 25),
               'integrator = %s' % r.choice(['"euler"', '"verlet"']), '[particles]', 'capacity = 400']
    result += ['[emitter]', 'burst = 200'] + lines(r, EMITTER, 0.5)
    result += r.choice([[], ['point = [%s]' % ', '.join(text(number(r, -1e9, 1e9)) for _ in range(3))],
                        ['box_min = [-1.0, -1.0, -1.0]', 'box_max = [1.0, 1.0, 1.0]']])
    for table, keys in TABLES.items():
        if r.randrange(2):
            result.append('[[%s]]' % table if table in ('attractor', 'vortex', 'type') else '[%s]' % table)
            result += lines(r, keys, 0.6)
    return '\n'.join(result) + '\n'


def fault(sim, name, dump):
    """What is wrong with its end, or '', and how it ended."""
    run = subprocess.run([sim, name, '--dump', dump, '-q'], capture_output=True, text=True, timeout=300)
    errors = run.stderr.splitlines()
    if run.returncode == 0:
        rows = ply.read(dump)
        os.remove(dump)
        wrong = sum(not all(map(math.isfinite, row.values())) for row in rows)
        return '%d of %d particles are no numbers' % (wrong, len(rows)) if wrong else '', 'played'
    if os.path.exists(dump):
        return 'exit code %d and a dump' % run.returncode, ''
    named = name + ':' in run.stderr and (run.returncode == 3 or 'type' in run.stderr)
    if run.returncode not in (3, 4) or len(errors) != 1 or not named:
        return 'exit code %d: %s' % (run.returncode, run.stderr), ''
    return '', 'refused' if run.returncode == 3 else 'lost'


def main():
    sim, collider, count = sys.argv[1], sys.argv[2], int(sys.argv[3])
    first = 1000000 * int(os.environ.get('RELIEF_TEST_SEED', '0'))
    ends = {'played': 0, 'refused': 0, 'lost': 0, '': 0}
    failed = 0
    for seed in range(first, first + count):
        with open('scene.toml', 'w') as file:
            file.write(scene(random.Random(seed), collider))
        wrong, end = fault(sim, 'scene.toml', 'out.ply')
        ends[end] += 1
        if wrong:
            failed += 1
            print('FAILED: scene %d: %s\n%s' % (seed, wrong, open('scene.toml').read()), file=sys.stderr)
    print('%d scenes: %d played, %d refused, %d ended with a particle that was lost' %
          (count, ends['played'], ends['refused'], ends['lost']))
    if 2 * ends['played'] < count:
        print('FAILED: most are not played', file=sys.stderr)
        failed += 1
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
