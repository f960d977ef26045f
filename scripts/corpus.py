#!/usr/bin/env python3
"""How wrong `relief bake` is on meshes as artists make them: what scripts/accuracy.sh --corpus runs.

corpus.py BIN FOLDER THIRTEEN... -- [OPTION]...

BIN has relief, relief-accuracy and relief-sim; FOLDER is for temporary files, and has CGAL's meshes in data/meshes.
One model after another is baked as `relief bake --budget 1MB` bakes it, and what was written is measured against a
distance volume of as many bytes, with the same truth.
"""
import argparse
import csv
import json
import math
import os
import statistics
import subprocess
import sys
import time
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
FURNITURE = '/usr/share/sweethome3d/furniture'
ASSIMP = '/usr/share/assimp/models'
COLUMNS = ['model', 'triangles', 'kind', 'volume', 'ours', 'ratio', 'maps', 'bake_s', 'step']
LEAST = 0.01  # percent: what a share of no wrong points counts as in a ratio
PAPER = ['--map', 'front-back:dir=-z,size=512,depth=half,decode=projected', '--map', 'cube:size=512,decode=projected']
PARTICLES, STEPS, REPEATS = 65536, 12, 3


def listed():
    """The names of corpus.txt by section."""
    sections = {}
    for line in open(os.path.join(HERE, 'corpus.txt'), encoding='ascii'):
        line = line.split('#')[0].strip()
        if line.startswith('['):
            names = sections[line.strip('[]')] = []
        elif line:
            names.append(line)
    return sections


def unpack(folder, thirteen):
    """All models: a path for each name."""
    paths = {os.path.basename(path).rsplit('.', 1)[0]: path for path in thirteen}
    sources = os.path.join(HERE, '..', 'samples', 'meshes.py')
    for name in 'torus', 'basin', 'terrain':
        paths['samples/' + name] = f'{folder}/{name}.obj'
        subprocess.run([sys.executable, sources, name, f'{folder}/{name}.obj'], check=True)
    for archive in 'KatorLegaz', 'Scopia':
        with zipfile.ZipFile(f'{FURNITURE}/{archive}.sh3f') as file:
            for entry in sorted(file.namelist()):
                if entry.endswith(('.obj', '.mtl')):
                    path = file.extract(entry, folder + '/furniture')
                    if entry.endswith('.obj'):
                        paths[os.path.dirname(entry)] = path
    for names in listed().values():
        for name in names:
            maker, _, rest = name.partition('/')
            if maker == 'cgal':
                paths[name] = f'{folder}/data/meshes/{rest}'
            elif maker == 'assimp':
                paths[name] = f'{ASSIMP}/{rest}'
    return paths


def run(command):
    return subprocess.run(command, capture_output=True, text=True, errors='replace', timeout=1800)


def last_line(result):
    lines = result.stderr.strip().splitlines()
    return lines[-1] if lines else f'exit code {result.returncode}'


class Refused(Exception):
    """What a program said instead of measuring."""


def checked(command):
    result = run(command)
    if result.returncode != 0:
        raise Refused(last_line(result))
    return result.stdout


def step_ratio(bin, folder, bounds):
    """A step against planned maps over one against the paper's two: the least of some runs each, in turns."""
    low, high = bounds['min'], bounds['max']
    side = max(h - l for l, h in zip(low, high))
    for name in 'ours', 'paper':
        with open(f'{folder}/{name}.toml', 'w', encoding='ascii') as scene:
            scene.write(f'[collider]\nfile = "{name}.relief"\n[particles]\ncapacity = {PARTICLES}\n[emitter]\n'
                        f'burst = {PARTICLES}\nrate = 0.0\nbox_min = {low}\nbox_max = {high}\n[forces]\ndrag = 2.5\n'
                        f'wind = [{0.125 * side}, 0.0, {0.05 * side}]\n')
    least = {'ours': math.inf, 'paper': math.inf}
    for _ in range(REPEATS):
        for name in least:
            text = checked([f'{bin}/relief-sim', f'{folder}/{name}.toml', '--steps', str(STEPS), '--json', '-q'])
            least[name] = min(least[name], json.loads(text)['ms_per_step_median'])
    return least['ours'] / least['paper']


def measure(name, path, bin, folder, options):
    """One row."""
    ours = f'{folder}/ours.relief'
    start = time.perf_counter()
    baked = json.loads(checked([f'{bin}/relief', 'bake', path, '-o', ours, '--budget', '1MB', '--threads', '2',
                                '--json', '-q']))
    seconds = time.perf_counter() - start
    command = [f'{bin}/relief-accuracy', path, '--budget', '1MB', '--methods', 'volume,ours', '--collider', ours,
               '--samples', str(options.samples), '--json']
    if options.cache:
        command += ['--cache', options.cache]
    report = json.loads(checked(command))
    mesh = report['meshes'][0]
    wrong = {entry['method']: entry['accuracy']['near']['wrong_percent'] for entry in report['results']}
    row = {'model': name, 'triangles': mesh['triangles'], 'kind': 'closed' if mesh['watertight'] else 'open',
           'volume': f"{wrong['volume']:.4g}", 'ours': f"{wrong['ours']:.4g}",
           'ratio': f"{max(wrong['ours'], LEAST) / max(wrong['volume'], LEAST):.3f}",
           'maps': len(baked['maps']), 'bake_s': f'{seconds:.2f}', 'step': ''}
    if options.steps:
        checked([f'{bin}/relief', 'bake', path, '-o', f'{folder}/paper.relief', '-q', *PAPER])
        row['step'] = f"{step_ratio(bin, folder, baked['bounds']):.2f}"
    return row


def summary(rows, refused):
    """What the models come to, line by line."""
    lines = []
    for kind in ['all', *sorted({row['kind'] for row in rows})]:
        of = [row for row in rows if kind in ('all', row['kind'])]
        ratios = [float(row['ratio']) for row in of]
        share = lambda test: 100 * sum(map(test, of)) / len(of)
        lines.append(f"{kind}: {len(of)} models; ours/volume {math.exp(statistics.fmean(map(math.log, ratios))):.3f} "
                     f"(geometric mean; less than {LEAST} % counts as {LEAST} %), "
                     f"worse than the volume on {share(lambda row: float(row['ratio']) > 1):.0f} %, "
                     f"above 10 % wrong on {share(lambda row: float(row['ours']) > 10):.0f} %")
    for column, what, unit in ('bake_s', 'bake', ' s'), ('step', 'step, of the paper\'s two maps', ''):
        known = [row for row in rows if row[column]]
        if known:
            worst = max(known, key=lambda row: float(row[column]))
            lines.append(f"{what}: median {statistics.median(float(row[column]) for row in known):.2f}{unit}, "
                         f"worst {worst[column]}{unit} ({worst['model']})")
    lines += [f'not measured: {name}: {why}' for name, why in refused]
    return lines


def main():
    split = sys.argv.index('--')
    bin, folder, *thirteen = sys.argv[1:split]
    parser = argparse.ArgumentParser(prog='accuracy.sh --corpus')
    parser.add_argument('--all', action='store_true', help='every model, not sixty: hours')
    parser.add_argument('--only', metavar='A,B', help='these models, by their names or what follows the slash')
    parser.add_argument('--samples', type=int, default=20000, metavar='N', help='points near each surface')
    parser.add_argument('--steps', action='store_true', help='also time steps of relief-sim: slow')
    parser.add_argument('--csv', metavar='FILE', help='write the rows as they come')
    parser.add_argument('--cache', metavar='FILE', help="keep the volume's figures here between runs")
    parser.add_argument('--markdown', action='store_true', help='write bake/measure/accuracy_corpus.md')
    options = parser.parse_args(sys.argv[split + 1:])

    paths = unpack(folder, thirteen)
    names = list(paths) if options.all or options.only else listed()['sixty']
    if options.only:
        wanted = options.only.split(',')
        names = [name for name in names if name in wanted or name.split('/')[-1].split('.')[0] in wanted]
    rows, refused = [], []
    table = open(options.csv, 'w', encoding='utf-8', newline='') if options.csv else None
    writers = [csv.DictWriter(file, COLUMNS) for file in (sys.stdout, table) if file]
    for writer in writers:
        writer.writeheader()
    for name in names:
        try:
            rows.append(measure(name, paths[name], bin, folder, options))
        except (Refused, subprocess.TimeoutExpired) as error:
            refused.append((name, str(error)))
            continue
        for writer in writers:
            writer.writerow(rows[-1])
        for file in filter(None, (sys.stdout, table)):
            file.flush()
    lines = summary(rows, refused) if rows else []
    print('\n'.join(lines))


main()
