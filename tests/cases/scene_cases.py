#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Random scenes within the ranges of runtime/scene/README.md, including the ends. After each run, all values of all particles are
finite, or a one-line error names a place in the scene or the type of a lost particle."""

import collections
import math
import pathlib
import sys

from cases import Cases

sys.path.append(str(pathlib.Path(__file__).parents[1] / 'cli'))
import ply  # noqa: E402

BUNNY = '/usr/share/glmark2/models/bunny.obj'

# Key, minimum, maximum. * marks a vector of three numbers, ! a required key. A minimum of 0+ excludes 0; 'of' precedes a list
# of choices.
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
    """Returns a typical value, a value of any magnitude, or an end of the range."""
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


def lines(r, keys, probability):
    """Returns lines for the required keys, and for each other key with this probability."""
    result = []
    for key, least, most in keys:
        required = key.endswith('!')
        vector = key.startswith('*')
        if required or r.random() < probability:
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


def check(cases, folder, collider):
    """Returns the outcome."""
    (folder / 'scene.toml').write_text(scene(cases.random, collider))
    done = cases.run('relief-sim', 'scene.toml', '--dump', 'out.ply', '-q', seconds=300, cwd=folder)
    if not done:
        return 'hung'
    cases.expect((done.returncode == 0) == (folder / 'out.ply').exists(), f'exit code and dump do not match: {done.returncode}')
    if done.returncode == 0:
        rows = ply.read(folder / 'out.ply')
        wrong = sum(not all(map(math.isfinite, row.values())) for row in rows)
        cases.expect(wrong == 0, f'{wrong} of {len(rows)} particles have values that are not finite')
        return 'played'
    named = 'scene.toml:' in done.stderr and (done.returncode == 3 or 'type' in done.stderr)
    cases.expect(done.returncode in (3, 4) and len(done.stderr.splitlines()) == 1 and named, f'exit code {done.returncode}: {done.stderr}')
    return 'refused' if done.returncode == 3 else 'lost'


def main():
    cases = Cases('scenes', 40)
    ends = collections.Counter()
    collider = None
    for _, folder in cases.each():
        if collider is None:
            cases.run('relief', 'bake', BUNNY, '-o', 'bunny.relief', '--budget', '100kB', '-q', cwd=folder)
            collider = (folder / 'bunny.relief').read_bytes()
        (folder / 'bunny.relief').write_bytes(collider)
        ends[check(cases, folder, 'bunny.relief')] += 1
    print('scenes: ' + ', '.join(f'{count} {end}' for end, count in sorted(ends.items())))
    cases.expect(cases.only is not None or 2 * ends['played'] >= cases.count, f'most scenes were rejected: {ends}')
    cases.finish()


main()
