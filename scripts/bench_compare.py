#!/usr/bin/env python3
"""Tells a slower program from a noisy machine: bench_compare.py OLD.json NEW.json

Each file is what `scripts/bench.sh --save` writes: some rounds of every figure. A figure is a ratio within one round, so
that a busy machine meets both sides of it; less is better. A figure is called slower or faster where its median has
changed by at least 3 % and the rounds of the two files are too far apart for chance: the exact one-sided test of Mann and
Whitney, once in a thousand for all figures together (Bonferroni).

Exit code: 0 nothing is slower; 1 something is slower, or a figure is gone; 2 the files cannot be compared.
"""
import functools
import json
import math
import statistics
import sys

LEAST_CHANGE = 0.03
CHANCE = 0.001


class Unusable(Exception):
    pass


def load(path):
    cure = "write it with scripts/bench.sh --save"
    try:
        with open(path, encoding="utf-8") as file:
            data = json.load(file)
    except (OSError, ValueError) as error:
        raise Unusable(f"{path}: {error}; {cure}") from error
    figures = data.get("figures") if isinstance(data, dict) else None
    if not isinstance(figures, dict) or not figures or not isinstance(data.get("machine"), str):
        raise Unusable(f"{path}: not the figures of a benchmark; {cure}")
    for name, rounds in figures.items():
        if not isinstance(rounds, list) or not rounds or not all(
                type(value) in (int, float) and math.isfinite(value) and value > 0 for value in rounds):
            raise Unusable(f"{path}: figure '{name}' is no list of numbers above 0; {cure}")
    return data


@functools.lru_cache(maxsize=None)
def ways(m, n, u):
    """Orders of m and n rounds in which exactly u pairs have the one of m above."""
    if u < 0:
        return 0
    if m == 0 or n == 0:
        return int(u == 0)
    return ways(m - 1, n, u - n) + ways(m, n - 1, u)


def chance(low, high):
    """That rounds of one and the same program lie as `high` does above `low`, or more so. Equal ones count half."""
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
    return "same" if abs(change) < LEAST_CHANGE else "not told from noise"


def spread(rounds):
    return f"{statistics.median(rounds):9.3f} ({min(rounds):.3f} to {max(rounds):.3f})"


def compare(old, new, out):
    """Prints the table; returns the exit code."""
    both = [name for name in old["figures"] if name in new["figures"]]
    if not both:
        raise Unusable("the two files have no figure in common; take both with the same scripts/bench.sh")
    rounds = min(len(data["figures"][name]) for data in (old, new) for name in both)
    if 1 / math.comb(2 * rounds, rounds) > CHANCE / len(both):
        raise Unusable(f"{rounds} rounds cannot tell {len(both)} figures from noise; take more with --rounds")
    print(f"{'figure':34s} {'old, least to most':32s} {'new, least to most':32s} new/old", file=out)
    bad = 0
    for name in both:
        a, b = old["figures"][name], new["figures"][name]
        says = verdict(a, b, len(both))
        bad += says == "slower"
        ratio = statistics.median(b) / statistics.median(a)
        print(f"{name:34s} {spread(a):32s} {spread(b):32s} {ratio:7.3f}  {says}", file=out)
    for name in old["figures"]:
        if name not in new["figures"]:
            bad += 1
            print(f"{name:34s} is gone", file=out)
    for name in new["figures"]:
        if name not in old["figures"]:
            print(f"{name:34s} is new", file=out)
    print("nothing is slower" if bad == 0 else f"{bad} of {len(old['figures'])} figures are slower or gone", file=out)
    return 0 if bad == 0 else 1


def main(arguments):
    try:
        if len(arguments) != 2:
            raise Unusable("usage: bench_compare.py OLD.json NEW.json")
        old, new = (load(path) for path in arguments)
        if old["machine"] != new["machine"]:
            raise Unusable(f"{arguments[0]} is of another machine ('{old['machine']}') than {arguments[1]} "
                           f"('{new['machine']}'); take both on one")
        return compare(old, new, sys.stdout)
    except Unusable as error:
        print(f"bench_compare.py: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
