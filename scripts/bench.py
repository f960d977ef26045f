#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the benchmarks and prints the ratios that Relief promises, measured on this machine.

  scripts/bench.py [MESH]                    prints all ratios; run it twice before you trust a change
  scripts/bench.py --save OLD.json           saves nine rounds of the bake and step ratios
  scripts/bench.py --against OLD.json        measures this build and compares it with OLD.json; --save also saves it
  scripts/bench.py --compare OLD.json NEW.json   compares two files

These are not tests, because machines are shared and noisy. RELIEF_BENCH_LARGE=1 uses GPU sizes (a million particles and
more) on any machine.

Each figure is a ratio within one round, so that load on the machine affects both of its sides; smaller is better. A figure is
slower or faster if its median changed by at least 3 % and the change is significant: exact one-sided Mann-Whitney test,
p <= 0.001 for all figures together (Bonferroni). Exit code: 0 nothing is slower; 1 a figure is slower or missing; 2 the files
are not comparable.
"""
import argparse
import functools
import json
import math
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
BUNNY = "/usr/share/glmark2/models/bunny.obj"
LARGE = os.environ.get("RELIEF_BENCH_LARGE") == "1"
LEAST_CHANGE = 0.03
CHANCE = 0.001
# Three front-back maps: six surfaces, with one ray per texel and surface.
SIX_MAPS = [word for way in ("-x", "-y", "-z")
            for word in ("--map", f"front-back:dir={way},depth=half,decode=projected")]
LEAST_MAP = ["--map", "front-back:dir=-x,size=8,decode=projected"]
PAPER_MAPS = ["--map", "front-back:dir=-z,size=512,depth=half,decode=projected", "--map", "cube:size=512,decode=projected"]
PATCHES = ["--budget", "1MB"]
PROMISES = {("picture", "all"): "at most 1.2 on a GPU"}


class Unusable(Exception):
    pass


def printed(command):
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


def seconds(command):
    start = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - start


class Tools:
    """The programs of one build, a mesh, and a folder for outputs."""

    def __init__(self, binaries, mesh, folder):
        self.binaries, self.mesh, self.folder = binaries, mesh, folder

    def bake(self, name, options):
        return [f"{self.binaries}/relief", "bake", self.mesh, "-o", f"{self.folder}/{name}.relief", "-q", *options]

    def bench(self, case, *options):
        return printed([f"{self.binaries}/relief-bench", case, *options, *(["--large"] if LARGE else [])])

    def step(self, collider, *options):
        """The report of a step, and the rows of its only table by name."""
        report = self.bench("step", f"{self.folder}/{collider}.relief", *options)
        return report, {row["name"]: row for row in report["tables"][0]["rows"]}

    def least(self):
        """Seconds of the smallest bake: import, tree, almost no rays, writing."""
        return seconds(self.bake("least", LEAST_MAP))


# Rounds of figures, and their comparison.

def one_round(tools):
    least = tools.least()
    figures = {"bake of six maps / least bake": seconds(tools.bake("six", SIX_MAPS)) / least,
               "bake of patches / least bake": seconds(tools.bake("patches", PATCHES)) / least}
    for path in ("fragment", "compute"):
        # Few blocks, because there are many rounds, and few particles for software renderers.
        report, rows = tools.step("patches", "--shaders", path, "--particles", "1048576" if LARGE else "16384", "--blocks", "3")
        for name, row in rows.items():
            if "over" in row:
                figures[f"{path}: {name} / {row['over']['of']}".replace("no_collider", "no collider")] = row["over"]["median"]
    return report["renderer"], figures


def save_rounds(tools, rounds, target):
    taken = {}
    for done in range(rounds):
        renderer, figures = one_round(tools)
        for name, value in figures.items():
            taken.setdefault(name, []).append(value)
        with open(target, "w", encoding="utf-8") as file:  # keeps finished rounds if the run is interrupted
            json.dump({"machine": f"{platform.machine()}, {os.cpu_count()} processors, {renderer}", "figures": taken}, file,
                      indent=1)
        print(f"round {done + 1} of {rounds}", file=sys.stderr, flush=True)


def load(path):
    try:
        with open(path, encoding="utf-8") as file:
            data = json.load(file)
        if not data["machine"] or not all(rounds and min(rounds) > 0 for rounds in data["figures"].values()):
            raise ValueError("its figures are not positive numbers")
    except (OSError, ValueError, TypeError, KeyError, AttributeError) as error:
        raise Unusable(f"{path}: no benchmark figures ({error}); write it with scripts/bench.py --save") from error
    return data


@functools.lru_cache(maxsize=None)
def ways(m, n, u):
    """The number of orders of m and n rounds in which the round of m is larger in exactly u pairs."""
    if u < 0:
        return 0
    if m == 0 or n == 0:
        return int(u == 0)
    return ways(m - 1, n, u - n) + ways(m, n - 1, u)


def chance(low, high):
    """The p-value of the test that `high` exceeds `low`. Ties count half."""
    m, n = len(high), len(low)
    u = sum(1.0 if h > l else 0.5 if h == l else 0.0 for h in high for l in low)
    return sum(ways(m, n, k) for k in range(math.floor(u), m * n + 1)) / math.comb(m + n, m)


def verdict(old, new, figures):
    change = statistics.median(new) / statistics.median(old) - 1.0
    enough = CHANCE / figures
    if change >= LEAST_CHANGE and chance(old, new) <= enough:
        return "slower"
    if change <= -LEAST_CHANGE and chance(new, old) <= enough:
        return "faster"
    return "same" if abs(change) < LEAST_CHANGE else "within noise"


def compare(old_path, new_path):
    """Prints the table; returns the exit code."""
    old, new = load(old_path), load(new_path)
    if old["machine"] != new["machine"]:
        raise Unusable(f"{old_path} ('{old['machine']}') and {new_path} ('{new['machine']}') are from different machines; "
                       "measure both on one machine")
    old, new = old["figures"], new["figures"]
    both = [name for name in old if name in new]
    if not both:
        raise Unusable("the two files have no figure in common; measure both with the same scripts/bench.py")
    rounds = min(len(figures[name]) for figures in (old, new) for name in both)
    if 1 / math.comb(2 * rounds, rounds) > CHANCE / len(both):
        raise Unusable(f"{rounds} rounds cannot distinguish {len(both)} figures from noise; use more with --rounds")

    def spread(taken):
        return f"{statistics.median(taken):9.3f} ({min(taken):.3f} to {max(taken):.3f})"

    print(f"{'figure':34s} {'old, min to max':32s} {'new, min to max':32s} new/old")
    bad = 0
    for name in both:
        found = verdict(old[name], new[name], len(both))
        bad += found == "slower"
        ratio = statistics.median(new[name]) / statistics.median(old[name])
        print(f"{name:34s} {spread(old[name]):32s} {spread(new[name]):32s} {ratio:7.3f}  {found}")
    for name in (name for name in old if name not in new):
        bad += 1
        print(f"{name:34s} is missing")
    for name in (name for name in new if name not in old):
        print(f"{name:34s} is new")
    print("nothing is slower" if bad == 0 else f"{bad} of {len(old)} figures are slower or missing")
    return 0 if bad == 0 else 1


# The report.

def print_tables(report):
    """A report of relief-bench."""
    for table in report["tables"]:
        rivals = table.pop("rivals", {})
        of = ", ".join(f"{name} {'x'.join(map(str, value)) if isinstance(value, list) else value}"
                       for name, value in table.items() if name != "rows")
        print(f"\n{report['case']}{', ' if of else ''}{of}; ms per call, on {report['renderer']}")
        for row in table["rows"]:
            gpu = f" ({row['gpu_ms']:.3f} on the GPU)" if row["gpu_ms"] is not None else ""
            line = f"  {row['name']:22s} {row['ms']:9.3f}{gpu}"
            if "over" in row:
                over = row["over"]
                line += f"  {over['median']:6.2f} of {over['of']} ({over['least']:.2f} to {over['most']:.2f})"
            for name, value in rivals.get(row["name"], {}).items():
                line += f", {name} {value:.0f}" if name != "build_ms" else f", built in {value:.0f} ms"
            note = PROMISES.get((report["case"], row["name"]))
            print(line + (f": {note}" if note else ""))


def print_report(tools):
    least, bake = (statistics.median(taken) for taken in
                   zip(*[(tools.least(), seconds(tools.bake("six", SIX_MAPS))) for _ in range(15)]))
    print(f"bake of six maps / of 8 x 8 texels                 {bake / least:.2f}   ({1000 * bake:.1f} / {1000 * least:.1f} ms)")

    # The particle step with patches and with the paper's collider: one front-back map and one cube.
    runs = {"patches": [], "paper": []}
    for name, maps in (("patches", PATCHES), ("paper", PAPER_MAPS)):
        seconds(tools.bake(name, maps))
    for _ in range(5):  # alternating, so that load on the machine affects both
        for name, taken in runs.items():
            taken.append(tools.step(name, "--only", "collider")[1]["collider"]["ms"])
    paper = statistics.median(runs["paper"])
    taken = statistics.median(runs["patches"])
    print(f"step with patches / with the paper's maps          {taken / paper:.2f}   ({taken:.2f} / {paper:.2f} ms)")

    collider = f"{tools.folder}/patches.relief"
    plain = tools.mesh.endswith((".obj", ".ply"))  # formats that relief-bench reads
    print_tables(tools.bench("step", collider, *(["--exact", tools.mesh] if plain else [])))
    print_tables(tools.bench("picture", collider))
    if plain:
        print_tables(tools.bench("mesh", tools.mesh))


def parse(arguments):
    parser = argparse.ArgumentParser(prog="bench.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", nargs="?", default=BUNNY)
    parser.add_argument("--save", metavar="FILE")
    parser.add_argument("--against", metavar="FILE")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--compare", nargs=2, metavar="FILE")
    return parser.parse_args(arguments)


def built(script, *arguments):
    """The last line of output of one of our scripts."""
    return subprocess.run([f"{ROOT}/scripts/{script}", *arguments], check=True, stdout=subprocess.PIPE,
                          text=True).stdout.strip().rsplit("\n", 1)[-1]


def main(arguments):
    options = parse(arguments)
    try:
        if options.compare:
            return compare(*options.compare)
        if options.against:
            load(options.against)  # fails before the measurement, which may take hours
        built("setup.sh")
        binaries = built("build.sh", "release", "relief", "relief-bench")
        with tempfile.TemporaryDirectory() as folder:
            tools = Tools(binaries, options.mesh, folder)
            if not options.save and not options.against:
                print_report(tools)
                return 0
            saved = options.save or f"{folder}/new.json"
            save_rounds(tools, options.rounds, saved)
            return compare(options.against, saved) if options.against else 0
    except Unusable as error:
        print(f"bench.py: {error}", file=sys.stderr)
        return 2
    except subprocess.CalledProcessError as error:
        print(f"bench.py: {error}\n{(error.stderr or b'').decode(errors='replace') if error.stderr else ''}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
