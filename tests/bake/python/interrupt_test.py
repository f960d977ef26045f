# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C, a real SIGINT to a separate program, stops any work of the package within about a second."""
import os
import pathlib
import signal
import subprocess
import sys
import time

import pytest

BIN = pathlib.Path(os.environ["RELIEF_BIN"])
BUNNY = "/usr/share/glmark2/models/bunny.obj"
# Prints "begun", works for much more than a second, and prints what stopped it.
PROGRAM = """
import sys, time
import numpy as np
import relief
{before}
print("begun", flush=True)
try:
    {work}
except KeyboardInterrupt:
    print("interrupted", flush=True)
    {after}
    print("goes on", flush=True)
"""
LIMIT = 4.0  # seconds; an idle machine needs far less, and the work takes at least ten times as long
BAKE = 'relief.bake("%s", budget="64MB", quality="best")' % BUNNY
WORK = {
    "planned": (BAKE, "", 0.3),
    "baked": (BAKE, "", 2.5),
    "maps": ('relief.bake("%s", maps=["front-back:dir=-x,size=4096", "cube:size=2048"], quality="best")' % BUNNY, "", 1.0),
    "searched": ('relief.bake("%s", max_error=0.0001)' % BUNNY, "", 1.0),
    "wrapped": ('relief.bake("%s", repair="wrap=0.001")' % BUNNY, "", 1.0),
    "checked": ('relief.check(c, "%s", samples=30_000_000)' % BUNNY, 'c = relief.bake("%s", budget="50kB")' % BUNNY, 0.5),
    "queried": ("c.query(points, 'nearest')", 'points = np.zeros((40_000_000, 3), np.float32); c = relief.bake("%s", budget="50kB")' % BUNNY,
                0.5),
}


def interrupt(program, wait):
    """Runs the program and sends SIGINT `wait` seconds after it prints "begun". It must react in time. Returns the rest of its
    output, its errors and its exit status."""
    process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == "begun\n", process.stderr.read()
        time.sleep(wait)
        begun = time.perf_counter()
        process.send_signal(signal.SIGINT)
        first = process.stdout.readline()
        assert time.perf_counter() - begun < LIMIT
        return first + process.stdout.read(), process.stderr.read(), process.wait(60)
    finally:
        process.kill()


@pytest.mark.parametrize("name", WORK)
def test_interrupted_work_raises_and_the_program_continues(name):
    work, before, wait = WORK[name]
    after = 'assert relief.bake("%s", budget="20kB", no_check=True).maps' % BUNNY if name == "baked" else "pass"
    said, errors, status = interrupt(PROGRAM.format(before=before, work=work, after=after), wait)
    assert (said, status) == ("interrupted\ngoes on\n", 0), errors


def test_interrupt_stops_between_steps(tmp_path):
    subprocess.run([BIN / "relief", "bake", BUNNY, "-q", "-o", tmp_path / "b.relief", "--budget", "50kB"], check=True)
    scene = '[collider]\nfile = "b.relief"\n[particles]\ncapacity = 1000\n'
    (tmp_path / "s.toml").write_text(scene)
    (tmp_path / "w.toml").write_text(scene + "[time]\nprewarm = 600\n")
    begin = f"relief.Simulation({str(tmp_path / 's.toml')!r})"
    after = "assert 0 < s.time < 1e6 and len(s.ids) == s.alive; s.step(2)"
    for before, work, after in ((f"s = {begin}", "s.step(2**32 - 1)", after),
                                ("", begin.replace("s.toml", "w.toml"), f"{begin}.step(2)")):
        said, errors, status = interrupt(PROGRAM.format(before=before, work=work, after=after), 0.5)
        assert (said, status) == ("interrupted\ngoes on\n", 0), errors


def test_uncaught_interrupt_ends_the_program_by_the_signal():
    program = f"import relief\nprint('begun', flush=True)\n{BAKE}"
    said, errors, status = interrupt(program, 2)
    assert status == -signal.SIGINT and errors.rstrip().endswith("KeyboardInterrupt") and said == ""


def test_custom_handler_is_called():
    program = ("import relief, signal\nsignal.signal(signal.SIGINT, lambda *_: print('mine', flush=True))\n"
               "c = []\nprint('begun', flush=True)\n"
               f'c.append(relief.bake("{BUNNY}", budget="2MB")); print(c[0].gpu_bytes > 1e6)')
    said, errors, status = interrupt(program, 0.5)
    assert (said, status) == ("mine\nTrue\n", 0), errors
