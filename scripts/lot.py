#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Ten randomly drawn meshes, on which Relief was not tuned. scripts/accuracy.sh --lot and --draw run this.

lot.py FOLDER             unpacks the meshes of lot.txt into FOLDER, and prints their paths
lot.py FOLDER --draw BIN  draws them, and writes lot.txt; BIN contains relief-accuracy

Packages are downloaded with `apt-get download`; nothing is installed or executed.
"""
import collections
import glob
import gzip
import hashlib
import json
import os
import shutil
import subprocess
import sys
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
LIST = os.path.join(HERE, 'lot.txt')
# Debian packages with files in formats that the import reads. Relief used none of them before the draw.
PACKAGES = ('cura', 'geomview', 'libirrlicht-doc', 'libsimbody-dev', 'morse-simulator-data', 'pink-pony-data', 'prusa-slicer',
            'trigger-rally-data')
FORMATS = ('.obj', '.stl', '.ply', '.off', '.gltf', '.glb', '.fbx', '.dae', '.3ds', '.blend', '.x', '.lwo', '.b3d', '.lxo', '.ms3d',
           '.smd')
SEED = 'relief'
MESHES, PER_PACKAGE_MAX = 10, 2
TRIANGLES = range(500, 500_001)
NOTE = f"""# The meshes of scripts/accuracy.sh --lot: a package of Debian 12, and a path in it.
#
# Drawn by `scripts/accuracy.sh --draw`, before anything was measured on them. The files of {len(PACKAGES)} packages in formats that
# the import reads are sorted by the SHA-256 of "{SEED}:package:path". In this order, a file is chosen if it has
# {TRIANGLES[0]} to {TRIANGLES[-1]} triangles, no chosen file has the same name, and fewer than {PER_PACKAGE_MAX} files of its package are chosen.
"""


def unpack(packages, folder):
    """Unpacks each package into a folder of its name, with the archives and compressed files inside."""
    os.makedirs(folder, exist_ok=True)
    for package in packages:
        root = os.path.join(folder, package)
        if not os.path.isdir(root):
            subprocess.run(['apt-get', '-qq', '-o', 'APT::Sandbox::User=root', 'download', package], cwd=folder, stdout=sys.stderr, check=True)
            deb, = glob.glob(f'{folder}/{package}_*.deb')
            subprocess.run(['dpkg-deb', '-x', deb, root], check=True)
            os.remove(deb)
        for path in files_of(root):
            if path.endswith('.zip'):
                with zipfile.ZipFile(path) as archive:
                    archive.extractall(path + '.d')
        for path in files_of(root):
            if path.endswith('.gz') and is_mesh(path[:-3]):
                with gzip.open(path) as packed, open(path[:-3], 'wb') as plain:
                    shutil.copyfileobj(packed, plain)


def files_of(root):
    """Regular files only: a link could lead anywhere."""
    return [path for path in sorted(glob.glob(f'{glob.escape(root)}/**', recursive=True))
            if os.path.isfile(path) and not os.path.islink(path)]


def is_mesh(path):
    return os.path.splitext(path)[1].lower() in FORMATS


def candidates(folder):
    """Pairs of a package and a path in it, in the order of the draw."""
    found = [(package, os.path.relpath(path, f'{folder}/{package}')) for package in PACKAGES
             for path in files_of(f'{folder}/{package}') if is_mesh(path)]
    return sorted(found, key=lambda one: hashlib.sha256(':'.join([SEED, *one]).encode()).hexdigest())


def triangles_of(path, bin):
    """The triangle count that relief-accuracy reports, from a cheap run; 0 if it rejects the file."""
    done = subprocess.run([f'{bin}/relief-accuracy', path, '--budget', '0.25MB', '--methods', 'paper', '--samples', '100'],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=1800, check=False)
    if done.returncode:
        print(f'  rejected: {done.stderr.strip()}', file=sys.stderr)
        return 0
    return json.loads(done.stdout)['meshes'][0]['triangles']


def draw(folder, bin):
    unpack(PACKAGES, folder)
    taken, of_package, passed = [], collections.Counter(), collections.Counter()
    drawn = candidates(folder)
    for package, name in drawn:
        if len(taken) == MESHES:
            break
        if of_package[package] == PER_PACKAGE_MAX:
            continue
        if any(os.path.basename(name) == os.path.basename(other) for _, other, _ in taken):
            continue
        triangles = triangles_of(f'{folder}/{package}/{name}', bin)
        print(f'{package}: {name}: {triangles} triangles', file=sys.stderr)
        if triangles in TRIANGLES:
            taken.append((package, name, triangles))
            of_package[package] += 1
        else:
            passed['rejected' if triangles == 0 else 'too few or too many triangles'] += 1
    with open(LIST, 'w', encoding='utf-8') as file:
        file.write(NOTE + f'# Candidates: {len(drawn)} files. Skipped: ' +
                   (', '.join(f'{count} {why}' for why, count in sorted(passed.items())) or 'none') + '.\n')
        file.writelines(f'{package}: {name}\n' for package, name, _ in taken)


def main():
    folder = sys.argv[1]
    if sys.argv[2:3] == ['--draw']:
        draw(folder, sys.argv[3])
        return
    with open(LIST, encoding='utf-8') as file:
        listed = [line.rstrip('\n').split(': ', 1) for line in file if line[0] != '#']
    unpack(sorted({package for package, _ in listed}), folder)
    for package, name in listed:
        path = f'{folder}/{package}/{name}'
        if not os.path.isfile(path):
            sys.exit(f'accuracy.sh: {package} does not contain {name}; use Debian 12, or draw again with --draw')
        print(path)


if __name__ == '__main__':
    main()
