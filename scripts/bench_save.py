#!/usr/bin/env python3
"""What `scripts/bench.sh --save FILE` runs: bench_save.py BIN MESH ROUNDS FILE

Takes some rounds of every figure for bench_compare.py. A round runs each program once; every figure is a ratio of two
times of the same round, and less is better.
"""
import json
import os
import platform
import subprocess
import sys
import tempfile
import time

SIX_MAPS = [word for way in ("-x", "-y", "-z")
            for word in ("--map", f"front-back:dir={way},depth=half,decode=projected")]


# Few, where processors do the GPU's work.
PARTICLES = "1048576" if os.environ.get("RELIEF_BENCH_LARGE") == "1" else "16384"


def printed(command):
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


def seconds(command):
    start = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - start


def one_round(binaries, mesh, folder):
    figures = {}
    relief = f"{binaries}/relief"
    planned = f"{folder}/planned.relief"
    # The least that a bake can be: import, tree, bare rays and writing, in a process of its own.
    floor = printed([f"{binaries}/relief-bench-raycast", mesh, f"{folder}/floor.relief"])["sum"] / 1000.0
    figures["bake of six maps / floor"] = seconds([relief, "bake", mesh, "-o", f"{folder}/six.relief", "-q", *SIX_MAPS]) / floor
    figures["planned bake of 1 MB / floor"] = seconds([relief, "bake", mesh, "-o", planned, "-q", "--budget", "1MB"]) / floor
    for path in ("fragment", "compute"):
        # A few blocks, for rounds are many.
        step = printed([f"{binaries}/relief-bench-step", planned, "--path", path, "--particles", PARTICLES,
                        "--blocks", "3"])
        figures[f"{path}: no collider / copy"] = step["copy"]["step_over_copy"]["median"]
        for variant in step["variants"]:
            ratio = variant["over_collider"]["median"]
            if variant["name"] == "no_collider":
                figures[f"{path}: collider / no collider"] = 1.0 / ratio
            elif variant["name"] != "collider":
                figures[f"{path}: {variant['name']} / collider"] = ratio
    return step["renderer"], figures


def main(arguments):
    binaries, mesh, rounds, target = arguments
    taken = {}
    with tempfile.TemporaryDirectory() as folder:
        for done in range(int(rounds)):
            renderer, figures = one_round(binaries, mesh, folder)
            for name, value in figures.items():
                taken.setdefault(name, []).append(value)
            data = {"machine": f"{platform.machine()}, {os.cpu_count()} processors, {renderer}", "figures": taken}
            with open(target + ".part", "w", encoding="utf-8") as file:
                json.dump(data, file, indent=1)
                file.write("\n")
            os.replace(target + ".part", target)  # what was taken remains where a later round is cut off
            print(f"round {done + 1} of {rounds}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
