#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the cases of one GoogleTest program in one process, and names each failing case.

    run_program.py PROGRAM [--shard I/N] [--skip PATTERNS] [--only PATTERNS] [--timeout SECONDS]

After a crash or a timeout, the running case is reported as failed, and each remaining case runs in its own process. PATTERNS
are those of --gtest_filter, joined by ':'. Exit status: 0 if at least one case ran and all passed, else 1.
"""

import argparse
import ctypes
import os
import queue
import re
import signal
import subprocess
import sys
import threading
import time

RUN = re.compile(rb'^\[ RUN      \] (\S+)')
END = re.compile(rb'^\[ *(OK|FAILED|SKIPPED) *\] ([^\s,]+).*?(?:\((\d+) ms\))?$')


LIBC = ctypes.CDLL(None)


def end_with_parent():
    LIBC.prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


class Run:
    """One process of the program: the result of each case, and the case that was running when it ended early."""

    def __init__(self, program, filter_text, timeout, environment):
        self.results = {}  # case: (passed, milliseconds, log)
        self.unfinished = None
        self.reason = ''
        process = subprocess.Popen([program, f'--gtest_filter={filter_text}', '--gtest_color=no'], env=environment,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   preexec_fn=end_with_parent)
        lines = queue.Queue()

        def read():
            for line in process.stdout:
                lines.put(line)
            lines.put(None)

        threading.Thread(target=read, daemon=True).start()
        log = []
        deadline = time.monotonic() + timeout
        while True:
            try:
                line = lines.get(timeout=max(0.0, deadline - time.monotonic()))
            except queue.Empty:
                self.reason = f'exceeded {timeout:g} s'
                break
            if line is None:
                break
            begin = RUN.match(line)
            end = END.match(line)
            if begin:
                self.unfinished = begin[1].decode()
                log = []
                deadline = time.monotonic() + timeout
            elif end and self.unfinished == end[2].decode():
                self.results[self.unfinished] = (end[1] == b'OK', int(end[3] or 0), b''.join(log))
                self.unfinished = None
                log = []
            else:
                log.append(line)
        if self.reason:
            process.kill()
        code = process.wait()
        self.log = b''.join(log)
        if not self.reason and code not in (0, 1):
            self.reason = f'ended by signal {-code}' if code < 0 else f'exit status {code}'
        if not self.reason and code == 1 and self.unfinished:
            self.reason = 'exit status 1'
        if not self.reason and code == 1 and all(passed for passed, _, _ in self.results.values()):
            self.reason = 'exit status 1 after the last case'  # such as a leak


def list_cases(program, filter_text, environment):
    text = subprocess.run([program, '--gtest_list_tests', f'--gtest_filter={filter_text}'], env=environment,
                          check=True, capture_output=True, text=True).stdout
    cases = []
    suite = ''
    for line in text.splitlines():
        name = line.split('#')[0].rstrip()
        if not line.startswith(' '):
            suite = name
        else:
            cases.append(suite + name.strip())
    return cases


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('program')
    parser.add_argument('--shard', default='1/1')
    parser.add_argument('--skip', default='')
    parser.add_argument('--only', default='*')
    parser.add_argument('--timeout', type=float, default=300.0)
    arguments = parser.parse_args()

    environment = dict(os.environ)
    for name in [name for name in environment if name.startswith('GTEST_')]:
        del environment[name]
    begun = time.monotonic()
    filter_text = arguments.only + (f'-{arguments.skip}' if arguments.skip else '')
    index, count = (int(part) for part in arguments.shard.split('/'))
    cases = list_cases(arguments.program, filter_text, environment)[index - 1::count]
    if not cases:
        print(f'{os.path.basename(arguments.program)}: no case matches {filter_text}')
        return 1

    failures = []

    def report(case, why, log):
        failures.append(case)
        sys.stdout.buffer.write(log)
        print(f'FAILED: {case}: {why}', flush=True)

    def take(run):
        for case, (passed, _, log) in run.results.items():
            if not passed:
                report(case, 'failed', log)

    # Groups of names that fit a command line of 128 KiB.
    groups = [[]]
    for case in cases:
        if sum(len(name) + 1 for name in groups[-1]) + len(case) > 100_000:
            groups.append([])
        groups[-1].append(case)
    times = {}
    for group in groups:
        run = Run(arguments.program, ':'.join(group), arguments.timeout, environment)
        take(run)
        times.update({case: ms for case, (_, ms, _) in run.results.items()})
        if not run.reason:
            continue
        report(run.unfinished or os.path.basename(arguments.program), run.reason, run.log)
        for case in group:
            if case in run.results or case == run.unfinished:
                continue
            alone = Run(arguments.program, case, arguments.timeout, environment)
            take(alone)
            times.update({name: ms for name, (_, ms, _) in alone.results.items()})
            if alone.reason:
                report(case, alone.reason, alone.log)
        if len(run.results) + (run.unfinished is not None) == 0:
            print(f'{arguments.program}: no case started')

    missing = [case for case in cases if case not in times and case not in failures]
    for case in missing:
        report(case, 'did not run', b'')
    slowest = sorted(times.items(), key=lambda item: -item[1])[:20]
    print('slowest: ' + ', '.join(f'{case} {ms / 1000:.1f} s' for case, ms in slowest if ms >= 2000))
    print(f'{len(cases)} cases, {len(failures)} failed, {time.monotonic() - begun:.1f} s')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
