"""scripts/bench.py, on figures made up here: bench.py SOURCE_DIR"""
import json
import os
import random
import subprocess
import sys
import tempfile
import unittest

SOURCE = sys.argv.pop(1)
sys.path.insert(0, os.path.join(SOURCE, "scripts"))
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

    def test_a_tenth_slower_is_told_from_noise_of_two_percent(self):
        old = {f"f{i}": rounds(i, 2.0, 0.02) for i in range(32)}
        new = {f"f{i}": rounds(i + 50, 2.2 if i == 7 else 2.0, 0.02) for i in range(32)}
        done = self.compare(old, new)
        self.assertEqual(done.returncode, 1)
        slower = [line for line in done.stdout.splitlines() if line.endswith("  slower")]
        self.assertEqual([line.split()[0] for line in slower], ["f7"])
        self.assertIn("1 of 32 figures", done.stdout)

    def test_faster_is_no_failure(self):
        done = self.compare({"f": rounds(1, 2.0, 0.02)}, {"f": rounds(2, 1.5, 0.02)})
        self.assertEqual(done.returncode, 0)
        self.assertIn("  faster", done.stdout)

    def test_a_change_below_three_percent_is_the_same_however_sure(self):
        done = self.compare({"f": rounds(1, 2.0, 0.001)}, {"f": rounds(2, 2.04, 0.001)})
        self.assertEqual(done.returncode, 0)
        self.assertIn("  same", done.stdout)

    def test_a_change_within_the_spread_is_not_told_from_noise(self):
        done = self.compare({"f": [1.0, 2.0] * 4}, {"f": [2.0, 1.0, 2.0, 1.5] * 2})
        self.assertEqual(done.returncode, 0)
        self.assertIn("not told from noise", done.stdout)

    def test_a_figure_that_is_gone_fails(self):
        done = self.compare({"f": rounds(1, 1.0, 0.1), "g": rounds(2, 1.0, 0.1)}, {"f": rounds(1, 1.0, 0.1)})
        self.assertEqual(done.returncode, 1)
        self.assertIn("is gone", done.stdout)

    def test_what_cannot_be_compared_says_so_in_one_line(self):
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

    def test_chance_is_that_of_the_tables(self):
        # Mann and Whitney 1947: of 8 and 8 rounds U may be 13 at most for a one-sided 2.5 %, of 5 and 5 it may be 2.
        self.assertAlmostEqual(bench.chance([1, 2, 3], [4, 5, 6]), 1 / 20)
        for count, most in ((8, 13), (5, 2)):
            below = lambda u: sum(bench.ways(count, count, k) for k in range(u + 1)) / sum(
                bench.ways(count, count, k) for k in range(count * count + 1))
            self.assertLessEqual(below(most), 0.025)
            self.assertGreater(below(most + 1), 0.025)


class Growth(unittest.TestCase):
    def test_the_exponent_is_that_of_a_power(self):
        for power in (0.5, 1.0, 1.7):
            points = [(float(x), 3.0 * x ** power) for x in (10, 100, 1000, 10000)]
            self.assertAlmostEqual(bench.exponent(points), power)

    def test_the_exponent_is_of_the_upper_half(self):
        # What a start costs hides the growth of small ones.
        points = [(float(2 ** k), 5.0 + 2.0 ** k) for k in range(0, 25)]
        self.assertAlmostEqual(bench.exponent(points), 1.0, delta=0.02)

    def test_one_point_has_none(self):
        self.assertIsNone(bench.exponent([(1.0, 1.0)]))

    def test_the_terrain_has_the_triangles_asked_for(self):
        with tempfile.TemporaryDirectory() as folder:
            for wanted in (1000, 100000):
                made = bench.write_solid(os.path.join(folder, "mesh.ply"), wanted)
                self.assertAlmostEqual(made / wanted, 1.0, delta=0.05)


if __name__ == "__main__":
    unittest.main()
