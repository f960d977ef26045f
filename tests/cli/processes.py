#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which processes run. One that has ended does not, though nobody has waited for it: not every container's first process
waits for orphans.

    processes.py PID    waits up to 5 s until neither the process nor one of its group runs; exit code 1: one does
"""
import os
import sys
import time


def runs(number):
    """Whether a process of this number, or of this group, does."""
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
    """Waits: the kernel takes its time to end the importer of a parent that is gone."""
    end = time.monotonic() + seconds
    while runs(number):
        if time.monotonic() > end:
            return False
        time.sleep(0.01)
    return True


if __name__ == '__main__':
    sys.exit(0 if gone(int(sys.argv[1]), 5.0) else 1)
