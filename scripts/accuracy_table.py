#!/usr/bin/env python3
"""What scripts/accuracy.sh prints of relief-accuracy's JSON: accuracy_table.py <REPORT.json

A row for each mesh and budget; then, for each budget, ratios, geometric means over meshes, and the verdict on the claims of
bake/measure/README.md.
"""
import json
import math
import sys

RATIO_MAX = 0.2  # the wrong points that we allow ourselves for those of a volume of as many bytes
TIMED_BUDGET, BAKE_SECONDS_MAX = 1_000_000, 3.0
HEAD = ["mesh", "budget>", "volume %>", "paper %>", "ours %>", "ours/volume>", "in %>", "out %>", "mean: volume>", "paper>",
        "ours>", "p99: volume>", "paper>", "ours>", "no distance %>", "bytes>", "maps>", "ms>"]  # '>': to the right


def wrong_ratio(percent, volume_percent, samples):
    """Half a point stands for none, so that ratios and their logarithms exist; nothing over nothing is 1."""
    least = 50.0 / samples
    return max(percent, least) / max(volume_percent, least)


def geometric_mean(values):
    """None without values."""
    return math.exp(math.fsum(map(math.log, values)) / len(values)) if values else None


def contests(report):
    """For each mesh and budget the results by method, with the ratios over the volume."""
    samples = report["meshes"][0]["samples"]
    found = {}
    for result in report["results"]:
        key = (result["mesh"], result["budget"])
        found.setdefault(key, {"mesh": result["mesh"], "budget": result["budget"], "closed": result["closed"]})[
            result["method"]] = result
    for contest in found.values():
        for method in ("paper", "ours"):
            if method in contest and "volume" in contest:
                contest[method + "/volume"] = wrong_ratio(
                    *(contest[of]["accuracy"]["near"]["wrong_percent"] for of in (method, "volume")), samples)
    return list(found.values())


def budget_text(budget):
    return f"{budget * 1e-6:.4g} MB"


def row(contest):
    def number(method, group, name, digits):
        return f"{contest[method]['accuracy'][group][name]:.{digits}f}" if method in contest else "-"

    ours = contest.get("ours")
    methods = ("volume", "paper", "ours")
    ratio = contest.get("ours/volume")
    return [contest["mesh"] + ("" if contest["closed"] else " (open)"), budget_text(contest["budget"]),
            *(number(method, "near", "wrong_percent", 3) for method in methods),
            f"{ratio:.3f}" if ratio is not None else "-",
            number("ours", "near", "false_inside_percent", 3), number("ours", "near", "false_outside_percent", 3),
            *(number(method, "distance_error", "mean_percent", 4) for method in methods),
            *(number(method, "distance_error", "p99_percent", 3) for method in methods),
            f"{ours['accuracy']['far_percent'] + ours['accuracy']['unknown_percent']:.2f}" if ours else "-",
            str(ours["bytes"]) if ours else "-", str(ours["maps"]) if ours else "-",
            f"{1000.0 * ours['build_seconds']:.0f}" if ours and ours["build_seconds"] is not None else "-"]


def summary(found, budget):
    """The line of a budget, and the targets that it misses."""
    found = [contest for contest in found if contest["budget"] == budget]
    at = " at " + budget_text(budget)
    missed = []
    ours = {contest["mesh"]: contest["ours/volume"] for contest in found if "ours/volume" in contest}
    means = [geometric_mean([contest[key] for contest in found if key in contest]) for key in ("ours/volume", "paper/volume")]
    texts = ["not measured" if mean is None else f"{mean:.3g}" for mean in means]
    line = (f"{budget_text(budget)}, {len(ours)} mesh{'' if len(ours) == 1 else 'es'}: ours/volume {texts[0]} "
            f"(target at most {RATIO_MAX:.3g}), paper/volume {texts[1]}")
    if ours:
        worst = max(ours, key=ours.get)
        above = [contest["mesh"] for contest in found if contest["closed"] and contest.get("ours/volume", 0.0) > 1.0]
        line += (f"; worst {worst} ({ours[worst]:.3g}); closed with ours above the volume: "
                 + (", ".join(f"{mesh} ({ours[mesh]:.3g})" for mesh in above) or "none"))
        if means[0] > RATIO_MAX:
            missed.append(f"ours/volume {texts[0]}{at}")
        if above:
            missed.append(f"{len(above)} closed above the volume{at}")
    times = {contest["mesh"]: contest["ours"]["build_seconds"] for contest in found
             if contest.get("ours", {}).get("build_seconds") is not None}
    if times:
        slowest = max(times, key=times.get)
        target = f", target at most {BAKE_SECONDS_MAX:.2f} s" if budget == TIMED_BUDGET else ""
        line += f"; slowest bake {slowest} ({times[slowest]:.2f} s{target})"
        if target and times[slowest] > BAKE_SECONDS_MAX:
            missed.append(f"a bake of {times[slowest]:.2f} s{at}")
    return line, missed


def summary_text(found):
    budgets = list(dict.fromkeys(contest["budget"] for contest in found))
    lines, missed = zip(*(summary(found, budget) for budget in budgets))
    missed = "; ".join(target for of in missed for target in of)
    judged = any("ours/volume" in contest for contest in found)
    verdict = ("missed: " + missed if missed else "every target is met" if judged
               else "ours was not measured against the volume")
    return "".join(line + "\n" for line in lines) + f"verdict: {verdict}\n"


def legend(mesh):
    return [f"%: points near the surface on the wrong side of it; in, out: ours, false inside and false outside. "
            f"{mesh['samples']} points, seed {mesh['seed']}, {mesh['sigma_percent']:.1f} % of the longest side off the "
            "surface (standard deviation).",
            "mean, p99: error of the signed distance at those points, in % of the longest side. Where maps say outside and "
            "no more (infinitely far, or no vote) they have no distance and no error: no distance is the share of such "
            "points in ours.",
            "ms: one bake of ours with acceleration structure, plan, rays and fit. open: computed, some edge has an odd "
            "number of triangles."]


def markdown(rows):
    rule = ["---:" if head.endswith(">") else "---" for head in HEAD]
    return "".join(f"| {' | '.join(cell.rstrip('>') for cell in of)} |\n" for of in (rows[0], rule, *rows[1:]))


def main():
    report = json.load(sys.stdin)
    found = contests(report)
    print(markdown([HEAD, *map(row, found)]) + "\n" + "<br>\n".join(legend(report["meshes"][0])) + "\n\n```text\n" +
          summary_text(found) + "```")


if __name__ == "__main__":
    main()
