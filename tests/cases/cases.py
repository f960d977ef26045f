# SPDX-License-Identifier: Apache-2.0
"""The framework of the random-case generators in this folder, which scripts/nightly.sh cases runs.

A generator is a program, NAME_cases.py BIN [--seed N] [--cases N]. It draws its cases only from Cases.random, so a seed
reproduces them, runs the tools in BIN, and calls fail() for each wrong result. Each case has its own seed: --only N repeats
one case and keeps its files.
"""

import argparse
import datetime
import os
import pathlib
import random
import resource
import subprocess
import sys
import tempfile

# Exit codes documented in bake/cli/README.md. Any other code or signal is a crash.
EXIT_CODES = range(0, 8)


class Cases:
    """Runs a number of cases in temporary folders and records failures."""

    def __init__(self, name, default_cases):
        parser = argparse.ArgumentParser(description=f"random cases: {name}")
        parser.add_argument("bin", type=lambda path: pathlib.Path(path).resolve(), help="folder of the executables")
        today = int(datetime.date.today().strftime("%Y%m%d"))
        parser.add_argument("--seed", type=int, default=today, help="default: the day's date")
        parser.add_argument("--cases", type=int, default=default_cases)
        parser.add_argument("--only", type=int, metavar="N", help="run case N only, and leave its files in a folder that is printed")
        options = parser.parse_args()
        self.name, self.bin, self.seed, self.count, self.only = name, options.bin, options.seed, options.cases, options.only
        self.random = None
        self.failures = {}
        self.case = 0

    def each(self):
        """Yields (number, empty folder) for each case."""
        for self.case in range(self.count) if self.only is None else [self.only]:
            self.random = random.Random(f"{self.name} {self.seed} {self.case}")
            if self.only is not None:
                self.count = 1
                folder = tempfile.mkdtemp(prefix="relief-case-")
                print(f"{self.name}: files of case {self.only}: {folder}", file=sys.stderr)
                yield self.case, pathlib.Path(folder)
                return
            with tempfile.TemporaryDirectory(prefix="relief-case-") as folder:
                yield self.case, pathlib.Path(folder)

    def run(self, *command, seconds=60, memory=4 << 30, **keywords):
        """Runs a tool of BIN, named command[0]. Fails the case on a hang, a signal, an undocumented exit code, or an error
        without a message. Limits the address space to `memory` bytes. Returns the subprocess.CompletedProcess, or None after a
        hang."""
        command = [str(self.bin / command[0]), *map(str, command[1:])]

        def limit():
            if "ASAN_OPTIONS" not in os.environ:  # its shadow memory uses terabytes of address space
                resource.setrlimit(resource.RLIMIT_AS, (memory, memory))

        try:
            done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=seconds,
                                  preexec_fn=limit, **keywords)
        except subprocess.TimeoutExpired:
            self.fail(f"took more than {seconds} s: {' '.join(command)}")
            return None
        if done.returncode not in EXIT_CODES:
            self.fail(f"exit code {done.returncode}: {' '.join(command)}: {done.stderr[-300:]}")
        elif done.returncode != 0 and not done.stderr.strip():
            self.fail(f"exit code {done.returncode} without a message: {' '.join(command)}")
        return done

    def expect(self, condition, why):
        if not condition:
            self.fail(why)
        return condition

    def fail(self, why):
        """Records that the current case failed, with its first reason."""
        if self.failures.setdefault(self.case, why) is why:
            print(f"{self.name}: {why}; repeat with: python3 {sys.argv[0]} {self.bin} --seed {self.seed} --only {self.case}",
                  file=sys.stderr)

    def finish(self):
        """Prints the counts; exits with 1 if a case failed."""
        print(f"{self.name}: {self.count - len(self.failures)} passed, {len(self.failures)} failed (seed {self.seed})")
        sys.exit(1 if self.failures else 0)
