# SPDX-License-Identifier: Apache-2.0
"""Tests scripts/bench.py and scripts/accuracy_table.py on made-up figures: bench.py SOURCE_DIR"""
import json
import os
import random
import subprocess
import sys
import tempfile
import unittest

SOURCE = sys.argv.pop(1)
sys.path.insert(0, os.path.join(SOURCE, "scripts"))
import accuracy_table  # noqa: E402
import lot  # noqa: E402
import bench  # noqa: E402


def rounds(seed, median, noise, count=9):
    draw = random.Random(seed)
    return [median * (1.0 + draw.uniform(-noise, noise)) for _ in range(count)]


class Compare(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def write(self, name, figures, machine="a machine"):
        path = os.path.join(self.folder.name, name)
        with open(path, "w", encoding="utf-8") as file:
            json.dump({"machine": machine, "figures": figures}, file)
        return path

    def run_on(self, old, new):
        return subprocess.run([sys.executable, os.path.join(SOURCE, "scripts", "bench.py"), "--compare", old, new],
                              capture_output=True, text=True, check=False)

    def compare(self, old, new):
        return self.run_on(self.write("old.json", old), self.write("new.json", new))

    def test_the_same_program_on_a_noisy_machine_is_not_slower(self):
        for seed in range(12):
            old = {f"f{i}": rounds(seed * 100 + i, 2.0, 0.2) for i in range(32)}
            new = {f"f{i}": rounds(seed * 100 + i + 50, 2.0, 0.2) for i in range(32)}
            done = self.compare(old, new)
            self.assertEqual(done.returncode, 0, f"seed {seed}: {done.stdout}")

    def test_ten_percent_slower_is_distinguished_from_two_percent_noise(self):
        old = {f"f{i}": rounds(i, 2.0, 0.02) for i in range(32)}
        new = {f"f{i}": rounds(i + 50, 2.2 if i == 7 else 2.0, 0.02) for i in range(32)}
        done = self.compare(old, new)
        self.assertEqual(done.returncode, 1)
        slower = [line for line in done.stdout.splitlines() if line.endswith("  slower")]
        self.assertEqual([line.split()[0] for line in slower], ["f7"])
        self.assertIn("1 of 32 figures", done.stdout)

    def test_verdicts(self):
        figure = rounds(1, 1.0, 0.1)
        for old, new, code, words in (
                ({"f": rounds(1, 2.0, 0.02)}, {"f": rounds(2, 1.5, 0.02)}, 0, "  faster"),
                # Below three percent, even if significant.
                ({"f": rounds(1, 2.0, 0.001)}, {"f": rounds(2, 2.04, 0.001)}, 0, "  same"),
                ({"f": [1.0, 2.0] * 4}, {"f": [2.0, 1.0, 2.0, 1.5] * 2}, 0, "within noise"),
                ({"f": figure, "g": figure}, {"f": figure}, 1, "is missing")):
            done = self.compare(old, new)
            self.assertEqual(done.returncode, code, words)
            self.assertIn(words, done.stdout)

    def test_incomparable_files_fail_with_one_line(self):
        good = self.write("good.json", {"f": rounds(1, 1.0, 0.1)})
        text = os.path.join(self.folder.name, "text.json")
        with open(text, "w", encoding="utf-8") as file:
            file.write("{")
        for bad in (text, os.path.join(self.folder.name, "none.json"), self.write("empty.json", {}),
                    self.write("zero.json", {"f": [0.0] * 8}), self.write("words.json", {"f": ["1"] * 8}),
                    self.write("other.json", {"f": [1.0] * 8}, "another machine"),
                    self.write("names.json", {"g": [1.0] * 8}), self.write("few.json", {"f": [1.0] * 2})):
            done = self.run_on(good, bad)
            self.assertEqual(done.returncode, 2, bad)
            self.assertEqual(done.stdout, "", bad)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_chance_equals_the_tabulated_p_values(self):
        self.assertAlmostEqual(bench.chance([1, 2, 3], [4, 5, 6]), 1 / 20)
        self.assertAlmostEqual(bench.chance([4, 5, 6], [1, 2, 3]), 1.0)


def contest(mesh, closed, budget, ours, took=1.0):
    return {"mesh": mesh, "closed": closed, "budget": budget, "ours/volume": ours, "paper/volume": 2.0 * ours,
            "ours": {"build_seconds": took}}


class Lot(unittest.TestCase):
    def test_candidates_are_sorted_by_the_hashes_of_their_names(self):
        names = {"cura": ["a/x.stl", "a/y.OBJ", "readme.txt"], "geomview": ["a/x.stl"]}
        with tempfile.TemporaryDirectory() as folder:
            for package, files in names.items():
                os.makedirs(f"{folder}/{package}/a")
                for name in files:
                    with open(f"{folder}/{package}/{name}", "w", encoding="utf-8"):
                        pass
            os.symlink("x.stl", f"{folder}/cura/a/z.stl")
            found = lot.candidates(folder)
        # The hashes of "relief:cura:a/x.stl" and so on are from sha256sum.
        self.assertEqual(found, [("cura", "a/y.OBJ"), ("cura", "a/x.stl"), ("geomview", "a/x.stl")])


class Accuracy(unittest.TestCase):
    def test_the_mean_of_reciprocals_is_one(self):
        # The arithmetic mean would be 1.75.
        self.assertAlmostEqual(accuracy_table.geometric_mean([4.0, 0.25, 1.0]), 1.0)
        self.assertAlmostEqual(accuracy_table.geometric_mean([0.1, 0.1, 0.8]), 0.2)
        self.assertIsNone(accuracy_table.geometric_mean([]))

    def test_zero_counts_as_half_a_point(self):
        self.assertAlmostEqual(accuracy_table.wrong_ratio(0.5, 2.0, 200000), 0.25)
        # One point of 200,000 is 0.0005 %.
        self.assertAlmostEqual(accuracy_table.wrong_ratio(0.0, 0.0005, 200000), 0.5)
        self.assertAlmostEqual(accuracy_table.wrong_ratio(0.0005, 0.0, 200000), 2.0)
        self.assertAlmostEqual(accuracy_table.wrong_ratio(0.0, 0.0, 200000), 1.0)

    def test_another_method_can_replace_ours(self):
        def result(method, wrong):
            return {"mesh": "a", "budget": 1000000, "closed": True, "method": method,
                    "accuracy": {"near": {"wrong_percent": wrong}}}
        report = {"meshes": [{"samples": 1000}], "results": [result("patches", 0.5), result("bricks", 2.0)]}
        found, = accuracy_table.contests(report, "patches")
        self.assertEqual(found["ours/bricks"], 0.25)
        self.assertNotIn("ours/bricks", accuracy_table.contests(report)[0])

    def test_met_targets(self):
        found = [contest("a", True, 250000, 0.1, 9.0), contest("b", True, 250000, 0.225),
                 contest("a", True, 1000000, 0.2, 2.9), contest("b", False, 1000000, 0.05)]
        text = accuracy_table.summary_text(found)
        self.assertIn("0.25 MB, 2 meshes:\n  ours / dense 0.15 (target at most 0.2), worst b (0.225), closed meshes above 1: none", text)
        self.assertIn("  ours / fitted bricks not measured\n  paper / dense 0.3\n", text)
        self.assertIn("slowest bake a (2.90 s, target", text)
        self.assertIn("slowest bake a (9.00 s)\n", text)  # bakes are timed at 1 MB
        self.assertIn("verdict: all targets are met", text)

    def test_only_open_meshes_may_exceed_the_volume(self):
        found = [contest("good", True, 4000000, 0.01), contest("bad", False, 4000000, 1.5)]
        line, missed = accuracy_table.summary(found, 4000000)
        self.assertIn("worst bad", line)
        self.assertEqual(missed, [])
        found[1]["closed"] = True
        line, missed = accuracy_table.summary(found, 4000000)
        self.assertIn("above 1: bad (1.5)", line)
        self.assertEqual(missed, ["1 closed above dense at 4 MB"])

    def test_each_rival_has_its_targets(self):
        found = [{**contest(mesh, True, 4000000, 0.1), "ours/bricks": 0.5, "ours/fitted": fitted, "ours/unreal": 3.0}
                 for mesh, fitted in (("a", 0.4), ("b", 1.2), ("c", 0.7))]
        line, missed = accuracy_table.summary(found, 4000000)
        self.assertEqual(missed, [])  # one mesh may exceed fitted bricks; Unreal's bricks have no target
        self.assertIn("ours / exact bricks 0.5 (target at most 0.5)", line)
        self.assertIn("above 1: b (1.2)", line)
        found[2]["ours/fitted"] = 1.1
        self.assertEqual(accuracy_table.summary(found, 4000000)[1],
                         ["ours / fitted bricks 0.808 at 4 MB", "2 closed above fitted bricks at 4 MB"])
        found = [{**of, "budget": 1000000} for of in found]
        self.assertIn("ours / exact bricks 0.5 at 1 MB", accuracy_table.summary(found, 1000000)[1])

    def test_tables_contain_the_measured_methods(self):
        field = {"near": {"wrong_percent": 0.5, "false_inside_percent": 0.3, "false_outside_percent": 0.2},
                 "distance_error": {"mean_percent": 0.01, "p99_percent": 0.2}, "normal_error_degrees": {"mean": 1.5, "p99": 20.0}}
        result = {"mesh": "a", "budget": 1000000, "closed": False, "accuracy": field, "bytes": 999, "maps": 4,
                  "build_seconds": None}
        found = accuracy_table.contests({"meshes": [{"samples": 1000}],
                                         "results": [{**result, "method": method} for method in ("fitted", "ours")]})
        self.assertEqual(accuracy_table.sides(found), [["mesh", "fitted bricks %>", "ours %>", "in %>", "out %>"],
                                                       ["a (open)", "0.500", "0.500", "0.300", "0.200"]])
        self.assertEqual(accuracy_table.errors(found), [["", "fitted bricks>", "ours>"],
                                                        ["distance, % of the longest side", *["0.01, 0.2"] * 2],
                                                        ["normal", *["1.5°, 20°"] * 2]])

    def test_missed_targets_are_named(self):
        found = [contest("a", True, 250000, 0.21), contest("a", True, 1000000, 0.21, 3.1)]
        self.assertEqual(len(accuracy_table.summary(found, 250000)[1]), 1)
        self.assertEqual(len(accuracy_table.summary(found, 1000000)[1]), 2)

    def test_only_measurements_are_judged(self):
        found = contest("a", True, 1000000, 0.5)
        del found["ours/volume"]
        self.assertIn("verdict: ours was not measured", accuracy_table.summary_text([found]))


if __name__ == "__main__":
    unittest.main()
