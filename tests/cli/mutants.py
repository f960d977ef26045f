#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Gives `relief bake` broken meshes (mutate.py), and says what came of them.

    mutants.py RELIEF COUNT [--jobs N] [--hang SECONDS] [--models FOLDER] [--page FILE]

Allowed are a collider that `relief check` calls sound, or one line that names the mesh, its exit code, and nothing left
behind: no output, no temporary file, no process. Everything else is a failure, told with the mutant's number.
--models: every file of a folder too. --page: the counts as Markdown.
"""
import argparse
import collections
import ctypes
import multiprocessing
import os
import signal
import subprocess
import sys
import tempfile

import mutate

OPTIONS = ['--map', 'fixed8:size=16', '-q', '--import-time', '10', '--import-memory', '1GB']
REFUSALS = {3: 'invalid', 5: 'unsupported', 6: 'limit'}
# A flat mesh that the one map looks along: told by exit code 4, and no fault.
UNSEEN = 'no map sees a surface'
PR_SET_CHILD_SUBREAPER = 36

relief = None
hang = None  # seconds


def begin(program, seconds):
    """In each process of the pool: orphans of its bakes become its children."""
    global relief, hang
    relief, hang = program, seconds
    if ctypes.CDLL(None, use_errno=True).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0) != 0:
        sys.exit('mutants.py: prctl: ' + os.strerror(ctypes.get_errno()))


def orphans():
    """What lives on after a bake; is ended here."""
    me = os.getpid()
    with open('/proc/%d/task/%d/children' % (me, me)) as file:
        children = [int(pid) for pid in file.read().split()]
    for pid in children:
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)
    return children


def run(arguments, folder):
    """Exit code (None: it hung), standard error."""
    environment = dict(os.environ, TMPDIR=os.path.join(folder, 'tmp'))
    with tempfile.TemporaryFile() as errors:  # no pipe, which an orphan would hold open
        process = subprocess.Popen([relief, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=errors, start_new_session=True, env=environment)
        try:
            process.wait(hang)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return None, ''
        errors.seek(0)
        return process.returncode, errors.read().decode('utf-8', 'replace')


def bake(mesh, name, folder, given):
    """What came of it: a word, whether the worker crashed, and what is wrong ('' if nothing is)."""
    out = os.path.join(folder, 'out.relief')
    code, errors = run(['bake', mesh, '-o', out, *OPTIONS], folder)
    left = orphans()
    lines = errors.splitlines()
    wrong = []
    word = REFUSALS.get(code, 'baked' if code == 0 else 'unseen' if code == 4 and UNSEEN in errors else 'failed')
    if code is None:
        word, wrong = 'hung', ['no end within %g s' % hang]
    elif word == 'failed':
        wrong.append('exit code %d: %s' % (code, errors))
    elif code != 0 and not (len(lines) == 1 and lines[0].startswith('relief: error: ') and name in lines[0]):
        wrong.append('not one line that names the mesh: %r' % errors)
    files = sorted(set(os.listdir(folder)) - set(given) - {'tmp'}) + os.listdir(os.path.join(folder, 'tmp'))
    if code == 0 and files == ['out.relief']:
        checked, complaint = run(['check', out], folder)
        if checked != 0:
            word, wrong = 'torn', ['relief check: exit code %s: %s' % (checked, complaint)]
    elif files or code == 0:
        word, wrong = 'torn', wrong + ['files: %s' % files]
    if left:
        word, wrong = word if word == 'hung' else 'orphan', wrong + ['processes left: %s' % left]
    return word, 'crashed' in errors and code == 3, '; '.join(wrong)


def try_mutant(number):
    meshes = mutate.seeds()
    # The seeds themselves, below zero, show that a mesh would be baked.
    name, kind, data, beside = meshes[-number - 1] if number < 0 else mutate.mutant(number, meshes)
    with tempfile.TemporaryDirectory() as folder:
        os.mkdir(os.path.join(folder, 'tmp'))
        mutate.write(folder, name, data, beside)
        result = bake(os.path.join(folder, name), name, folder, [name, *beside])
    return number, kind, *result


def try_model(path):
    with tempfile.TemporaryDirectory() as folder:
        os.mkdir(os.path.join(folder, 'tmp'))
        return path, 'files', *bake(path, os.path.basename(path), folder, [])


COLUMNS = ['baked', 'invalid', 'unsupported', 'limit', 'unseen']


def row(kind, results):
    words = collections.Counter(result[2] for result in results)
    counts = [len(results), *(words[column] for column in COLUMNS), sum(result[3] for result in results)]
    return '| %s | %s |' % (kind, ' | '.join(str(count) for count in counts))


def page(mutants, models):
    lines = ['| | bakes | baked, and sound | invalid (3) | unsupported (5) | limit (6) | nothing to see (4) | '
             'of the invalid: the worker crashed |', '| --- |' + ' ---: |' * 7]
    for kind in sorted({result[1] for result in mutants}):
        lines.append(row(kind, [result for result in mutants if result[1] == kind]))
    lines.append(row('all mutants', mutants))
    if models:
        lines.append(row('files of assimp-testmodels', models))
    words = collections.Counter(result[2] for result in mutants + models)
    lines += ['', 'Hung: %d. Torn or temporary files: %d. Processes left: %d. Other ends or messages: %d.' % (
        words['hung'], words['torn'], words['orphan'],
        sum(bool(result[4]) and result[2] not in ('hung', 'torn', 'orphan') for result in mutants + models))]
    return '\n'.join(lines) + '\n'


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('relief')
    parser.add_argument('count', type=int)
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--hang', type=float, default=15)
    parser.add_argument('--models')
    parser.add_argument('--page')
    call = parser.parse_args()
    files = []
    for folder, _, names in os.walk(call.models or os.devnull):
        files += [os.path.join(folder, name) for name in names]
    seeds = len(mutate.seeds())
    with multiprocessing.Pool(call.jobs, begin, [os.path.abspath(call.relief), call.hang]) as pool:
        whole = pool.map(try_mutant, range(-seeds, 0), 1)
        first = 1000000 * int(os.environ.get('RELIEF_TEST_SEED', '0'))
        mutants = pool.map(try_mutant, range(first, first + call.count), 4)
        models = pool.map(try_model, sorted(files), 4)
    failures = ['mutant %s: %s' % (r[0], r[4]) for r in mutants if r[4]]
    failures += ['%s: %s' % (r[0], r[4]) for r in models if r[4]]
    failures += ['seed mesh %d is not baked: %s' % (r[0], r[4] or r[2]) for r in whole if r[2] != 'baked']
    text = page(mutants, models)
    print(text, end='')
    if call.page:
        with open(call.page, 'w') as out:
            out.write(text)
    for failure in failures:
        print('FAILED: ' + failure, file=sys.stderr)
    words = {result[2] for result in mutants}
    if not {'baked', 'invalid'} <= words:
        failures.append('')
        print('FAILED: the mutants try nothing: all are %s' % ', '.join(sorted(words)), file=sys.stderr)
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
