#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the accuracy of `relief bake` on artist-made meshes. scripts/accuracy.sh --corpus runs it.

corpus.py BIN FOLDER THIRTEEN... -- [OPTION]...

BIN contains relief, relief-accuracy and relief-bench. FOLDER is for temporary files, and contains CGAL's meshes in
data/meshes. Bakes each model with `relief bake --budget 1MB`, and measures the result and distance volumes of the same
bytes, dense and sparse, against the same truth: for sheets, the same shell.
"""
import argparse
import csv
import json
import math
import os
import resource
import statistics
import subprocess
import sys
import time
import zipfile

from accuracy_table import RIVALS

HERE = os.path.dirname(os.path.abspath(__file__))
FURNITURE = '/usr/share/sweethome3d/furniture'
ASSIMP = '/usr/share/assimp/models'
LEAST = 0.01  # percent: replaces smaller fractions of wrong points in ratios
PAPER = ['--map', 'front-back:dir=-z,size=512,depth=half,decode=projected', '--map', 'cube:size=512,decode=projected']
PARTICLES, BLOCKS, REPEATS = 65536, 3, 3


def listed():
    """The names of corpus.txt."""
    with open(os.path.join(HERE, 'corpus.txt'), encoding='ascii') as file:
        lines = [line.split(': ') for line in file.read().splitlines() if line[0] != '#']
    return [os.path.join(package, name) for package, names in lines for name in names.split()]


def unpack(folder, thirteen):
    """The path of each model, by name."""
    paths = {os.path.basename(path).rsplit('.', 1)[0]: path for path in thirteen}
    paths['samples/terrain'] = f'{folder}/terrain.obj'
    subprocess.run([sys.executable, os.path.join(HERE, '../samples/meshes.py'), 'terrain', f'{folder}/terrain.obj'], check=True)
    for archive in 'KatorLegaz', 'Scopia':
        with zipfile.ZipFile(f'{FURNITURE}/{archive}.sh3f') as file:
            for entry in sorted(file.namelist()):
                if entry.endswith(('.obj', '.mtl')):
                    path = file.extract(entry, folder + '/furniture')
                    if entry.endswith('.obj'):
                        paths[os.path.dirname(entry)] = path
    for name in listed():
        package, _, rest = name.partition('/')
        if package == 'cgal':
            paths[name] = f'{folder}/data/meshes/{rest}'
        elif package == 'assimp':
            paths[name] = f'{ASSIMP}/{rest}'
    return paths


def checked(command):
    """Standard output."""
    return subprocess.run(command, stdout=subprocess.PIPE, text=True, timeout=1800, check=True).stdout


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def step_ratio(bin, folder):
    """The time of a step with patches, relative to the paper's two maps. Both are minima of several alternating runs."""
    least = {'ours': math.inf, 'paper': math.inf}
    for _ in range(REPEATS):
        for name in least:
            report = json.loads(checked([f'{bin}/relief-bench', 'step', f'{folder}/{name}.relief', '--only', 'collider',
                                         '--particles', str(PARTICLES), '--blocks', str(BLOCKS)]))
            least[name] = min(least[name], *(row['ms'] for row in report['tables'][0]['rows'] if row['name'] == 'collider'))
    return least['ours'] / least['paper']


def kind_of(shape):
    """The kind of the part that is least like a solid."""
    for kind, name in ('terrains', 'terrain'), ('sheets', 'sheets'), ('solids_with_holes', 'holes'):
        if shape[kind]:
            return name
    return 'solid'


def measure(name, path, bin, folder, options):
    """One row."""
    ours = f'{folder}/ours.relief'
    start, cpu_start = time.perf_counter(), processor_seconds()
    baked = json.loads(checked([f'{bin}/relief', 'bake', path, '-o', ours, '--budget', '1MB', '--threads', '2',
                                '--json', '-q']))
    seconds, cpu = time.perf_counter() - start, processor_seconds() - cpu_start
    start = time.perf_counter()
    report = json.loads(checked([f'{bin}/relief-accuracy', path, '--budget', '1MB', '--methods',
                                 ','.join([*options.rivals, 'ours']), '--collider', ours,
                                 '--samples', str(options.samples)]))
    mesh = report['meshes'][0]
    wrong = {entry['method']: entry['accuracy']['near']['wrong_percent'] for entry in report['results']}
    came = next(entry['accuracy'].get('as_it_came') for entry in report['results'] if entry['method'] == 'ours')
    row = {'model': name, 'triangles': mesh['triangles'], 'kind': kind_of(mesh['shape']), 'ours': f"{wrong['ours']:.4g}",
           'came': f"{came['wrong_percent']:.4g}" if came else '', 'maps': len(baked['maps']), 'bake_s': f'{seconds:.2f}', 'step': '',
           'cpu_s': f'{cpu:.2f}',
           'rivals_s': f'{time.perf_counter() - start:.1f}',
           'warned': any('wrong near the surface' in warning for warning in baked['warnings'])}
    for rival in options.rivals:
        row[rival] = f'{wrong[rival]:.4g}'
        row[f'ours/{rival}'] = f"{max(wrong['ours'], LEAST) / max(wrong[rival], LEAST):.3f}"
    if options.steps:
        checked([f'{bin}/relief', 'bake', path, '-o', f'{folder}/paper.relief', '-q', *PAPER])
        row['step'] = f"{step_ratio(bin, folder):.2f}"
    return row


def percent(part, whole):
    return f'{100 * part / whole:.0f} %'


def columns_of(rivals):
    return ['model', 'triangles', 'kind', *rivals, 'ours', 'came', *(f'ours/{rival}' for rival in rivals), 'maps', 'bake_s', 'step', 'cpu_s',
            'rivals_s']


def against(rows, rival):
    """The ratios of ours to one rival, with the targets."""
    ratios = [float(row[f'ours/{rival}']) for row in rows]
    mean, above = math.exp(statistics.fmean(map(math.log, ratios))), sum(ratio > 1 for ratio in ratios)
    aims = (' (at most 0.333)', ' (at most 5 %)') if rival == 'volume' else ('', '')
    return f'{mean:.3f} of {RIVALS[rival]}{aims[0]}, above 1 for {percent(above, len(rows))}{aims[1]}'


def summary(rows, rivals):
    """The lines that summarise all models, with the targets."""
    lines = []
    for kind in ['all', *sorted({row['kind'] for row in rows})]:
        of = [row for row in rows if kind in ('all', row['kind'])]
        bad = [row for row in of if float(row['ours']) > 10]
        silent = sum(not row['warned'] for row in bad)
        lines.append(f'{kind}, {len(of)}: wrong points of ours (geometric mean): '
                     f'{"; ".join(against(of, rival) for rival in rivals)}; '
                     f'more than 10 % wrong: {percent(len(bad), len(of))}, without a warning {percent(silent, len(of))} (none)')
    small = [row for row in rows if row['triangles'] <= 100_000]
    for column, what, of, aims in (('bake_s', 'seconds of a bake (at most 100,000 triangles)', small, (1, 3)),
                                   ('step', "step / step with the paper's maps", rows, (1.5, 3))):
        known = [row for row in of if row[column]]
        if known:
            worst = max(known, key=lambda row: float(row[column]))
            median = statistics.median(float(row[column]) for row in known)
            lines.append(f'{what}: median {median:.2f} (at most {aims[0]}), '
                         f'worst {worst[column]} (at most {aims[1]}; {worst["model"]})')
    return lines


def chosen(paths, options):
    """The names to measure."""
    if not options.only:
        return listed()
    names = []
    for wanted in options.only.split(','):
        found = [name for name in paths
                 if wanted in (name, os.path.basename(name), os.path.splitext(os.path.basename(name))[0])]
        if not found:
            sys.exit(f"accuracy.sh: unknown model '{wanted}' in --only; scripts/corpus.txt lists the models")
        names += found
    return names


def arguments(words):
    parser = argparse.ArgumentParser(prog='accuracy.sh --corpus', description='Measures the sixty models of corpus.txt at 1 MB')
    parser.add_argument('--only', metavar='A,B', help='measure only these models, by name or by the last part of their path')
    parser.add_argument('--rivals', type=lambda text: text.split(','), default=list(RIVALS), metavar='A,B',
                        help=f'distance volumes to compare with (default: {",".join(RIVALS)}); fitted bricks take most of the time')
    parser.add_argument('--samples', type=int, default=20000, metavar='N', help='points of each kind (default: 20000)')
    parser.add_argument('--steps', action='store_true', help="also time steps, relative to the paper's maps (slow)")
    options = parser.parse_args(words)
    unknown = [rival for rival in options.rivals if rival not in RIVALS]
    if unknown:
        parser.error(f"unknown rival '{unknown[0]}' in --rivals; choose from: {', '.join(RIVALS)}")
    return options


def main():
    split = sys.argv.index('--')
    bin, folder, *thirteen = sys.argv[1:split]
    words = sys.argv[split + 1:]
    options = arguments(words)
    paths = unpack(folder, thirteen)
    rows = []
    writer = csv.DictWriter(sys.stdout, columns_of(options.rivals), extrasaction='ignore')
    writer.writeheader()
    for name in chosen(paths, options):
        rows.append(measure(name, paths[name], bin, folder, options))
        writer.writerow(rows[-1])
        sys.stdout.flush()
    print(*summary(rows, options.rivals), sep='\n')


main()
