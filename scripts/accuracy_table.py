#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Formats relief-accuracy's JSON for scripts/accuracy.sh: accuracy_table.py [METHOD] <REPORT.json

Compares METHOD (default: ours) with its rivals. Prints a row for each mesh, with the figures of all budgets in a cell. Then
prints to standard error, for each budget, geometric means of ratios over meshes, and whether the claims of
bake/measure/README.md hold.
"""
import json
import math
import statistics
import sys

# The methods that ours is compared with, at the same bytes: bake/measure/README.md.
RIVALS = {"volume": "dense", "unreal": "Unreal's", "bricks": "exact bricks", "fitted": "fitted bricks"}
METHODS = {**RIVALS, "paper": "paper", "ours": "ours"}
BUDGETS = (250_000, 1_000_000, 4_000_000)
# Target ratios of our wrong points to those of a rival, one for each budget.
AIMS = {"volume": (0.2, 0.2, 0.2), "bricks": (0.45, 0.45, 0.5), "fitted": (0.7, 0.7, 0.75)}
ABOVE_MAX = {"volume": 0, "fitted": 1}  # maximum number of closed meshes on which ours has more wrong points
TIMED_BUDGET, BAKE_SECONDS_MAX = 1_000_000, 3.0


def wrong_ratio(percent, volume_percent, samples):
    """Zero counts as half a point, so that ratios and their logarithms are finite. 0 / 0 is 1."""
    least = 50.0 / samples
    return max(percent, least) / max(volume_percent, least)


def geometric_mean(values):
    """None if there are no values."""
    return math.exp(math.fsum(map(math.log, values)) / len(values)) if values else None


def contests(report, ours="ours"):
    """For each mesh and budget, the results by method and the ratios of wrong points. `ours` is the method stored as "ours"."""
    samples = report["meshes"][0]["samples"]
    found = {}
    for result in report["results"]:
        key = (result["mesh"], result["budget"])
        found.setdefault(key, {"mesh": result["mesh"], "budget": result["budget"], "closed": result["closed"]})[
            "ours" if result["method"] == ours else result["method"]] = result
    def wrong(contest, method):
        return contest[method]["accuracy"]["near"]["wrong_percent"]

    for contest in found.values():
        for of, by in [("paper", "volume"), *(("ours", rival) for rival in RIVALS)]:
            if of in contest and by in contest:
                contest[f"{of}/{by}"] = wrong_ratio(wrong(contest, of), wrong(contest, by), samples)
    return list(found.values())


def budget_text(budget):
    return f"{budget * 1e-6:.4g} MB"


def measured_of(found):
    """The methods in any contest, in the order of METHODS."""
    return [method for method in METHODS if any(method in contest for contest in found)]


def label(contest):
    return contest["mesh"] + ("" if contest["closed"] else " (open)")


def number(contest, method, group, name, digits):
    measured = contest[method]["accuracy"].get(group) if method in contest else None
    return f"{measured[name]:.{digits}f}" if measured else "-"


def sides(found):
    """The rows of wrong points. A heading that ends with '>' is right-aligned."""
    came = any("as_it_came" in contest.get("ours", {"accuracy": {}})["accuracy"] for contest in found)
    columns = [(f"{METHODS[method]} %>", method, "near", "wrong_percent") for method in measured_of(found)]
    columns += [("in %>", "ours", "near", "false_inside_percent"), ("out %>", "ours", "near", "false_outside_percent")]
    columns += [("as it came %>", "ours", "as_it_came", "wrong_percent")] if came else []
    rows = [["mesh", *(heading for heading, *_ in columns)]]
    for mesh in dict.fromkeys(contest["mesh"] for contest in found):
        of = [contest for contest in found if contest["mesh"] == mesh]
        rows.append([label(of[0]), *(", ".join(number(contest, *column, 3) for contest in of) for _, *column in columns)])
    return rows


def errors(found):
    """The rows of distance and normal errors at the budget of TIMED_BUDGET: medians over the meshes."""
    methods = measured_of(found)
    rows = [["", *(f"{METHODS[method]}>" for method in methods)]]
    for heading, group, names, unit in (("distance, % of the longest side", "distance_error", ("mean_percent", "p99_percent"), ""),
                                        ("normal", "normal_error_degrees", ("mean", "p99"), "°")):
        of = [{method: contest[method]["accuracy"].get(group) for method in methods if method in contest}
              for contest in found if contest["budget"] == TIMED_BUDGET]
        known = {method: [one[method] for one in of if one.get(method)] for method in methods}
        rows.append([heading, *(", ".join(f"{statistics.median(one[name] for one in known[method]):.2g}{unit}" for name in names)
                                if known[method] else "-" for method in methods)])
    return rows


def against(rival, found, budget):
    """The text on one rival, and the targets that ours misses."""
    ours = {contest["mesh"]: contest[f"ours/{rival}"] for contest in found if f"ours/{rival}" in contest}
    if not ours:
        return f"ours / {RIVALS[rival]} not measured", []
    at = " at " + budget_text(budget)
    mean, worst = geometric_mean(list(ours.values())), max(ours, key=ours.get)
    aim = dict(zip(BUDGETS, AIMS.get(rival, ()))).get(budget)
    above = [contest["mesh"] for contest in found if contest["closed"] and contest.get(f"ours/{rival}", 0.0) > 1.0]
    missed = [f"ours / {RIVALS[rival]} {mean:.3g}{at}"] if aim and mean > aim else []
    if len(above) > ABOVE_MAX.get(rival, len(above)):
        missed.append(f"{len(above)} closed above {RIVALS[rival]}{at}")
    return (f"ours / {RIVALS[rival]} {mean:.3g}{f' (target at most {aim:.3g})' if aim else ''}, worst {worst} ({ours[worst]:.3g}), "
            "closed meshes above 1: " + (", ".join(f"{mesh} ({ours[mesh]:.3g})" for mesh in above) or "none")), missed


def summary(found, budget):
    """The lines of a budget, and its missed targets."""
    found = [contest for contest in found if contest["budget"] == budget]
    texts, missed = zip(*(against(rival, found, budget) for rival in RIVALS))
    missed = [target for of in missed for target in of]
    texts = list(texts)
    mean = geometric_mean([contest["paper/volume"] for contest in found if "paper/volume" in contest])
    texts += [f"paper / dense {mean:.3g}"] if mean is not None else []
    times = {contest["mesh"]: contest["ours"]["build_seconds"] for contest in found
             if contest.get("ours", {}).get("build_seconds") is not None}
    if times:
        slowest = max(times, key=times.get)
        target = f", target at most {BAKE_SECONDS_MAX:.2f} s" if budget == TIMED_BUDGET else ""
        texts.append(f"slowest bake {slowest} ({times[slowest]:.2f} s{target})")
        if target and times[slowest] > BAKE_SECONDS_MAX:
            missed.append(f"a bake of {times[slowest]:.2f} s at {budget_text(budget)}")
    meshes = len({contest["mesh"] for contest in found})
    return f"{budget_text(budget)}, {meshes} mesh{'' if meshes == 1 else 'es'}:\n  " + "\n  ".join(texts), missed


def summary_text(found):
    budgets = list(dict.fromkeys(contest["budget"] for contest in found))
    lines, missed = zip(*(summary(found, budget) for budget in budgets))
    missed = "; ".join(target for of in missed for target in of)
    judged = any(f"ours/{rival}" in contest for contest in found for rival in RIVALS)
    verdict = ("missed: " + missed if missed else "all targets are met" if judged
               else "ours was not measured against a rival")
    return "".join(line + "\n" for line in lines) + f"verdict: {verdict}\n"


def legend(meshes):
    mesh, came = meshes[0], any("as_it_came" in one for one in meshes)
    return [f"%: misclassified points near the surface; in, out: false inside and false outside of ours. "
            f"{mesh['samples']} points, seed {mesh['seed']}, at a distance of {mesh['sigma_percent']:.1f} % of the longest side "
            "(standard deviation).",
            "open: an edge has an odd number of triangles.",
            *(["as it came: ours near sheets, measured against the imported surface: points within half the thickness of it are "
               "inside. The truth of the other columns is the shells that the bake makes of sheets."] if came else []),
            f"Below, at {budget_text(TIMED_BUDGET)}: medians over the meshes of the mean and the 99th percentile of the error of the "
            "signed distance at those points, and of the angle of the normal at the surface. Bricks store distances only near the "
            "surface: larger distances count as their band."]


def markdown(rows):
    rule = ["---:" if head.endswith(">") else "---" for head in rows[0]]
    return "".join(f"| {' | '.join(cell.rstrip('>') for cell in of)} |\n" for of in (rows[0], rule, *rows[1:]))


def main():
    report = json.load(sys.stdin)
    found = contests(report, *sys.argv[1:])
    print(markdown(sides(found)), "<br>\n".join(legend(report["meshes"])) + "\n", markdown(errors(found)), sep="\n", end="")
    sys.stderr.write(summary_text(found))


if __name__ == "__main__":
    main()
