#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Finds running processes. Zombies do not count as running: not every container's first process reaps orphans.

    processes.py PID    waits up to 5 s until the process and its group have ended; exit code 1 if one still runs
"""
import os
import sys
import time


def runs(number):
    """Whether a process with this ID or in this group runs."""
    for name in os.listdir('/proc'):
        if name.isdigit():
            try:
                with open('/proc/%s/stat' % name) as file:
                    state, _, group = file.read().rpartition(')')[2].split()[:3]
            except OSError:
                continue
            if number in (int(name), int(group)) and state not in 'ZX':
                return True
    return False


def gone(number, seconds):
    """Waits, because the kernel may end the importer of a dead parent with a delay."""
    end = time.monotonic() + seconds
    while runs(number):
        if time.monotonic() > end:
            return False
        time.sleep(0.01)
    return True


if __name__ == '__main__':
    sys.exit(0 if gone(int(sys.argv[1]), 5.0) else 1)
