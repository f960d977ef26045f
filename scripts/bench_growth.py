#!/usr/bin/env python3
"""How time grows with triangles, bytes and particles: what `scripts/bench.sh --growth DIR` runs.

Writes DIR/growth.csv and DIR/growth.png, three plots on log axes, and says the exponents: the slope of time over size,
both as logarithms, of the larger half of the sizes.

    triangles   relief bake --budget 1MB of a bumpy ball, made here, and vdb_tool's level set of it at 128 voxels
    bytes       relief bake --budget BYTES of the bunny, and vdb_tool's level set of as many bytes, 2 a voxel
    particles   a step by relief-bench-step among the bunny's planned maps of 1 MB, and a bare copy of the state

All by the clock, whole processes but for particles: the median of --repeats runs, of which the next size is taken only
where the last ended within --limit seconds.
"""
import argparse
import array
import csv
import importlib.util
import json
import math
import os
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import threading
import time
from typing import NamedTuple

BUNNY = "/usr/share/glmark2/models/bunny.obj"
HEAD = ["size", "series", "x", "seconds", "machine"]
SIZES = {"triangles": "triangles of the mesh", "bytes": "bytes of the collider", "particles": "particles"}


class Row(NamedTuple):
    size: str  # of SIZES
    series: str
    x: float
    seconds: float
    machine: str


def say(text):
    print(text, file=sys.stderr, flush=True)


def write_rows(path, rows):
    with open(path + ".part", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEAD)
        writer.writerows([row.size, row.series, f"{row.x:g}" if row.x >= 1e15 else int(row.x), repr(row.seconds),
                          row.machine] for row in rows)
    os.replace(path + ".part", path)


def read_rows(path):
    rows = []
    try:
        with open(path, encoding="utf-8", newline="") as file:
            lines = list(csv.reader(file))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        sys.exit(f"bench_growth.py: {path}: {error}; name a growth.csv")
    if not lines or lines[0] != HEAD:
        sys.exit(f"bench_growth.py: {path}: its first line is not {','.join(HEAD)}; name a growth.csv")
    for number, line in enumerate(lines[1:], 2):
        try:
            size, series, x, seconds, machine = line
            row = Row(size, series, float(x), float(seconds), machine)
            if size not in SIZES or not all(math.isfinite(v) and v > 0 for v in (row.x, row.seconds)):
                raise ValueError
        except ValueError:
            sys.exit(f"bench_growth.py: {path}: line {number} is no row of {','.join(HEAD)} with numbers above 0")
        rows.append(row)
    return rows


def exponent(points):
    """Of the larger half of the points (x, seconds), two at least; None of one point."""
    points = sorted(points)
    upper = points[len(points) // 2:] if len(points) > 3 else points
    if len(upper) < 2:
        return None
    xs = [math.log(x) for x, _ in upper]
    ys = [math.log(y) for _, y in upper]
    mean_x, mean_y = statistics.fmean(xs), statistics.fmean(ys)
    return sum((x - mean_x) * (y - mean_y) for x, y in zip(xs, ys)) / sum((x - mean_x) ** 2 for x in xs)


def write_solid(path, triangles):
    """A bumpy ball as PLY, closed; returns how many triangles it has."""
    rings = max(round(math.sqrt(triangles / 4.0)), 3)
    around = 2 * rings
    vertices = array.array("f", (0.0, 0.0, 1.0))
    for ring in range(1, rings):
        across = math.pi * ring / rings
        sine, cosine = math.sin(across), math.cos(across)
        for i in range(around):
            turn = 2.0 * math.pi * i / around
            r = 1.0 + 0.15 * math.sin(5.0 * turn) * sine ** 5 * math.cos(4.0 * across) + 0.02 * math.sin(
                40.0 * across) * sine ** 9 * math.cos(36.0 * turn)
            vertices.extend((r * sine * math.cos(turn), r * sine * math.sin(turn), r * cosine))
    last = len(vertices) // 3
    vertices.extend((0.0, 0.0, -1.0))
    count = 2 * around * (rings - 1)
    face = struct.Struct("<Biii")
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices) // 3}\nproperty float x\n"
                   f"property float y\nproperty float z\nelement face {count}\n"
                   "property list uchar int vertex_indices\nend_header\n".encode())
        file.write(vertices.tobytes())
        for i in range(around):
            j = (i + 1) % around
            file.write(face.pack(3, 0, 1 + i, 1 + j))
            below = last - around
            file.write(face.pack(3, last, below + j, below + i))
        for ring in range(rings - 2):
            row = bytearray()
            a = 1 + ring * around
            b = a + around
            for i in range(around):
                j = (i + 1) % around
                row += face.pack(3, a + i, b + i, b + j) + face.pack(3, a + i, b + j, a + j)
            file.write(row)
    return count


class Clock:
    def __init__(self, repeats, limit):
        self.repeats = repeats
        self.limit = limit

    def run(self, command):
        """(seconds, output, peak MB), or None where the command failed or ran out of time, said why."""
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            start = time.perf_counter()
            child = subprocess.Popen(command, stdout=out, stderr=err, start_new_session=True)
            stop = threading.Timer(2.0 * self.limit, lambda: os.killpg(child.pid, signal.SIGKILL))
            stop.start()
            _, status, usage = os.wait4(child.pid, 0)
            seconds = time.perf_counter() - start
            stop.cancel()
            child.returncode = os.waitstatus_to_exitcode(status)
            peak = usage.ru_maxrss / 1024.0
            if child.returncode != 0:
                err.seek(0)
                words = err.read().decode(errors="replace").strip().splitlines() or [f"exit code {child.returncode}"]
                say(f"  {command[0]} ended after {seconds:.1f} s and {peak:.0f} MB: {words[-1]}")
                return None
            out.seek(0)
            return seconds, out.read(), peak

    def series(self, size, name, machine, points):
        """points: x, and what to run or what gives it. Ends where a point fails or takes longer than the limit."""
        rows = []
        for x, command in points:
            taken = []
            for _ in range(self.repeats):
                done = self.run(command() if callable(command) else command)
                if done is None:
                    return rows
                taken.append(done)
                if done[0] > self.limit / self.repeats:
                    break
            seconds = statistics.median(one[0] for one in taken)
            rows.append(Row(size, name, float(x), seconds, machine))
            say(f"  {name}: {x} {SIZES[size]}, {seconds:.3f} s, {max(one[2] for one in taken):.0f} MB")
            if seconds > self.limit:
                say(f"  {name}: larger ones are left out, --limit is {self.limit:g} s")
                break
        return rows


def level_set(mesh, voxels, target):
    return ["vdb_tool", "-read", mesh, "-mesh2ls", f"dim={voxels}", "width=3", "-write", target]


def of_triangles(options, clock, folder, machine):
    meshes = []

    def mesh(wanted):
        path = f"{folder}/mesh{wanted}.ply"
        if not os.path.exists(path):
            for old in meshes:
                os.remove(old)
            meshes[:] = [path]
            write_solid(path, wanted)
        return path

    rows = []
    ended = set()
    for wanted in options.triangles:  # one mesh at a time: large ones fill disks
        triangles = write_solid(mesh(wanted), wanted)
        for name, command in (("relief bake, 1 MB", [f"{options.bin}/relief", "bake", mesh(wanted), "-o",
                                                     f"{folder}/out.relief", "-q", "--budget", "1MB"]),
                              ("vdb_tool mesh2ls, 128 voxels", level_set(mesh(wanted), 128, f"{folder}/out.vdb"))):
            if name in ended:
                continue
            one = clock.series("triangles", name, machine, [(triangles, command)])
            rows += one
            if not one or one[0].seconds > clock.limit:
                ended.add(name)
    return rows


def of_bytes(options, clock, folder, machine):
    bakes = [(size, [f"{options.bin}/relief", "bake", options.mesh, "-o", f"{folder}/out.relief", "-q", "--budget",
                     str(size)]) for size in options.bytes]
    volumes = [(size, level_set(options.mesh, round((size / 2.0) ** (1.0 / 3.0)), f"{folder}/out.vdb"))
               for size in options.bytes]
    return (clock.series("bytes", "relief bake", machine, bakes) +
            clock.series("bytes", "vdb_tool mesh2ls, as many bytes of 2 a voxel", machine, volumes))


def step_rows(report, machine):
    """Of one report of relief-bench-step."""
    particles = float(report["steps"]["particles"])
    path = report["path"]
    names = {"no_collider": "step without collider", "collider": "step", "radius": "step of balls"}
    rows = [Row("particles", f"bare copy, {path}", particles, report["copy"]["ms"] / 1000.0, machine)]
    for variant in report["variants"]:
        if variant["name"] in names:
            rows.append(Row("particles", f"{names[variant['name']]}, {path}", particles, variant["ms"] / 1000.0, machine))
    return rows


def of_particles(options, clock, folder, machine):
    collider = f"{folder}/planned.relief"
    if clock.run([f"{options.bin}/relief", "bake", options.mesh, "-o", collider, "-q", "--budget", "1MB"]) is None:
        sys.exit(1)
    rows = []
    for count in options.particles:
        start = time.perf_counter()
        done = clock.run([f"{options.bin}/relief-bench-step", collider, "--path", options.path, "--only", "radius",
                          "--particles", str(count)])
        if done is None:
            break
        report = json.loads(done[1])
        rows += step_rows(report, f"{machine}, {report['renderer']}")
        say(f"  {count} particles: a step {1000.0 * rows[-2].seconds:.3f} ms")
        if time.perf_counter() - start > clock.limit:
            break
    return rows


def draw(path, rows):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    sizes = [size for size in SIZES if any(row.size == size for row in rows)]
    figure, plots = pyplot.subplots(1, len(sizes), figsize=(6.5 * len(sizes), 6.0), squeeze=False)
    for plot, size in zip(plots[0], sizes):
        for name, points in curves(rows, size):
            power = exponent(points)
            label = name if power is None else f"{name}: ∝ n^{power:.2f}"
            plot.loglog([x for x, _ in points], [y for _, y in points], marker="o", markersize=4, label=label)
        plot.set_xlabel(SIZES[size])
        plot.set_ylabel("seconds a step" if size == "particles" else "seconds")
        plot.grid(True, which="major", alpha=0.3)
        plot.legend(fontsize="small")
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def curves(rows, size):
    """(name, points) in the order of the rows; the machine is named where there are several."""
    machines = {row.machine for row in rows if row.size == size}
    found = {}
    for row in rows:
        if row.size == size:
            name = row.series if len(machines) == 1 else f"{row.series}; {row.machine}"
            found.setdefault(name, []).append((row.x, row.seconds))
    return [(name, sorted(points)) for name, points in found.items()]


def numbers(text):
    values = [int(word) for word in text.split(",") if word]
    if any(value <= 0 for value in values):
        raise argparse.ArgumentTypeError("numbers above 0 are needed")
    return sorted(values)


def parse(arguments):
    parser = argparse.ArgumentParser(prog="bench_growth.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", required=True, help="folder of the executables")
    parser.add_argument("--out", required=True, help="folder for growth.csv and growth.png")
    parser.add_argument("--mesh", default=BUNNY)
    parser.add_argument("--triangles", type=numbers, metavar="N,N…", help="none: ''",
                        default=[10 ** 3, 10 ** 4, 10 ** 5, 10 ** 6, 10 ** 7])
    parser.add_argument("--bytes", type=numbers, metavar="N,N…", default=[1 << k for k in range(16, 27, 2)])
    parser.add_argument("--particles", type=numbers, metavar="N,N…, of 1024", default=[1 << k for k in range(12, 25, 2)])
    parser.add_argument("--path", choices=["fragment", "compute"], default="compute")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--limit", type=float, default=300.0, help="seconds")
    parser.add_argument("--with", dest="others", action="append", default=[], metavar="FILE.csv",
                        help="draw the rows of another machine, too; once for each file")
    parser.add_argument("--steps", action="append", default=[], metavar="MACHINE=FILE.json",
                        help="and these reports of relief-bench-step")
    options = parser.parse_args(arguments)
    if options.repeats < 1 or not options.limit > 0.0:
        parser.error("--repeats and --limit must be above 0")
    return options


def main(arguments):
    options = parse(arguments)
    if importlib.util.find_spec("matplotlib") is None:  # said before the hours that the rest may take
        sys.exit("bench_growth.py: this python3 has no matplotlib; take /usr/bin/python3 and python3-matplotlib")
    machine = f"{os.uname().machine}, {os.cpu_count()} processors"
    rows = [row for path in options.others for row in read_rows(path)]
    for word in options.steps:
        name, _, path = word.partition("=")
        try:
            with open(path, encoding="utf-8") as file:
                rows += step_rows(json.load(file), name)
        except (OSError, ValueError, KeyError, TypeError) as error:
            sys.exit(f"bench_growth.py: --steps {word}: {error!r}; name a machine and a report of relief-bench-step")
    os.makedirs(options.out, exist_ok=True)
    clock = Clock(options.repeats, options.limit)
    target = os.path.join(options.out, "growth")
    with tempfile.TemporaryDirectory() as folder:
        for wanted, measure in ((options.triangles, of_triangles), (options.bytes, of_bytes),
                                (options.particles, of_particles)):
            if wanted:
                rows += measure(options, clock, folder, machine)
                write_rows(target + ".csv", rows)  # what is there remains where a later part fails
    write_rows(target + ".csv", rows)
    for size in SIZES:
        for name, points in curves(rows, size):
            power = exponent(points)
            if power is not None:
                print(f"{size:10s} {name:60s} grows as n^{power:.2f}, {points[0][0]:g} to {points[-1][0]:g}")
    if rows:
        draw(target + ".png", rows)


if __name__ == "__main__":
    main(sys.argv[1:])
