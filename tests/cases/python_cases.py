#!/usr/bin/python3
"""Random calls of the package relief of Python: python_cases.py BIN [--seed N] [--cases N]

Half of the cases bake a random mesh with random options, right and wrong, through relief.bake() and through `relief bake`: both
give the same bytes, or both fail alike. The others hand random values and arrays to random functions: the answer is right,
or an error of one line that is no binding's.
"""
import os
import pathlib
import sys
import warnings

if not sys.executable.startswith("/usr/bin/python3"):
    os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])  # Debian's, which the module is built for

import numpy as np  # noqa: E402

from cases import Cases  # noqa: E402

cases = Cases("python", 120)
sys.path.insert(0, str(cases.bin.parent / "python"))
import relief  # noqa: E402

random = cases.random
EXIT_CODES = {relief.UsageError: 1, relief.FileError: 2, relief.InputError: 3, relief.UnsupportedError: 5, relief.LimitError: 6}
# Of each option some values that are right, some that are nearly so, and nonsense; as text, for both ways to give them.
VALUES = {
    "budget": ["20kB", "30000", "0.02MB", "24 KiB", "0", "-1", "1e4", "kB", "9" * 30, ""],
    "max_error": ["60", "55%", "101", "-3", "nan", "%"],
    "max_maps": ["1", "3", "64", "65", "0", "+2"],
    "quality": ["fast", "normal", "best", "Fast", ""],
    "prefer": ["inside", "outside", "neither", "none"],
    "holes": ["close", "keep", "fill"],
    "repair": ["orient", "holes", "wrap=0.1", "wrap=2", "wrap=", "mend"],
    "as_": ["auto", "solid", "shell", "terrain", "one=solid", "two=shell", "three=shell", "=solid", "solids"],
    "thickness": ["0.1", "0.02", "1e-9", "1e9", "0", "inf", "-0.1"],
    "unit": ["mm", "m", "inch", "ell"],
    "up": ["+z", "-x", "z", "+w"],
    "threads": ["1", "2", "0", "9999"],
    "max_triangles": ["5", "1000", "0"],
    "maps": ["cube:size=8", "front-back:dir=-x,size=16", "fixed8:dir=+y,size=8x12", "float:dir=1/2/3,size=8", "cube:size=0", "ball"],
    "resolution": ["16", "3", "99999999"],
    "decode": ["plane", "projected", "flat"],
    "depth": ["half", "unorm16", "byte"],
    "time_limit": ["100", "0", "x"],
}
FLAGS = ["paper", "strict", "no_check"]


def mesh_file(folder):
    """Two boxes, each perhaps without a side, or inside out, or with an index that does not exist."""
    lines, count = [], 0
    for name in ("one", "two"):
        lines.append(f"o {name}")
        low = [random.uniform(-2, 2) for _ in range(3)]
        size = [random.choice([random.uniform(0.2, 2), 0.01]) for _ in range(3)]
        lines += ["v " + " ".join(f"{low[axis] + (corner >> axis & 1) * size[axis]:.6g}" for axis in range(3))
                  for corner in range(8)]
        sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        if random.random() < 0.4:
            sides.pop(random.randrange(6))
        turned = random.random() < 0.2
        for side in sides:
            lines.append("f " + " ".join(str(count + corner + 1) for corner in (side[::-1] if turned else side)))
        count += 8
    if random.random() < 0.05:
        lines.append(f"f 1 2 {count + random.choice([1, 2**32, 2**31])}")
    (folder / "mesh.obj").write_text("\n".join(lines) + "\n")
    return folder / "mesh.obj"


def option_of(name):
    return "--" + {"maps": "map"}.get(name, name.rstrip("_").replace("_", "-"))


def a_bake(folder):
    mesh = mesh_file(folder)
    chosen = {}
    for name in random.sample(sorted(VALUES), random.randrange(4)):
        # Mostly the first, which are right.
        values = VALUES[name]
        chosen[name] = values[min(int(random.expovariate(0.5)), len(values) - 1)]
    if not chosen.keys() & {"maps", "max_error"} or random.random() < 0.1:
        chosen.setdefault("budget", "20kB")
    arguments = dict(chosen)
    words = [f"{option_of(name)}={value}" for name, value in chosen.items() if value]
    words += [word for name, value in chosen.items() if not value for word in (option_of(name), value)]
    for name in random.sample(FLAGS, random.randrange(2)):
        arguments[name] = True
        words.append(option_of(name))
    for name in ("budget", "max_maps", "thickness", "threads", "resolution", "max_error"):
        # A number where the text is one.
        if random.random() < 0.5:
            try:
                arguments[name] = float(arguments[name])
            except (KeyError, ValueError):
                pass
    if isinstance(arguments.get("budget"), float) and "e" in chosen["budget"]:
        arguments["budget"] = chosen["budget"]  # the tool reads no 1e4, numbers of Python may be written so
    if chosen.get("max_maps") == "+2":
        arguments["max_maps"] = "+2"
    done = cases.run("relief", "bake", mesh, "-q", "-o", folder / "tool.relief", *words)
    if done is None:
        return
    try:
        made, code = relief.bake(mesh, **arguments).to_bytes(), 0
    except relief.Error as error:
        made, code = None, EXIT_CODES.get(type(error), 7 if "not reached" in str(error) else 4)
        cases.expect("\n" not in str(error) and str(error), f"a message of several lines: {error}")
    what = f"{arguments} against {words}"
    if cases.expect(code == done.returncode, f"{code} for {done.returncode}: {what}: {done.stderr}") and code == 0:
        cases.expect(made == (folder / "tool.relief").read_bytes(), f"other bytes: {what}")


def a_value():
    return random.choice([None, True, False, 0, -1, 1, 2**31, 2**32, 2**64, -2**70, 0.5, 2.0, -0.0, 1e300, float("nan"), float("inf"), "",
                          "1", "\0", "-", "mesh.obj", b"", b"RELIEF", [], [1], {}, object(), 1j, np.float32(2), np.uint8(3), np.int64(-4),
                          np.zeros(0), np.ones((2, 2)), np.datetime64("2026-01-01"), "\udcff", pathlib.Path("x"), range(3), np.nan])


def an_array(rows):
    dtype = random.choice([float, "f4", "f2", ">f8", int, "u1", "u8", ">i2", bool, complex, object, str])
    numbers = [random.choice([0, 1, 2, 3, random.randrange(9)]) for _ in range(3 * rows)]
    array = np.array(numbers, dtype=int).reshape(rows, 3).astype(dtype)
    if array.dtype.kind == "f" and random.random() < 0.3 and rows:
        array[random.randrange(rows), random.randrange(3)] = random.choice([np.nan, np.inf, -np.inf, 1e5])
    if array.dtype.kind in "iu" and random.random() < 0.3 and rows:
        array[random.randrange(rows), random.randrange(3)] = np.iinfo(array.dtype).max
    return random.choice([array, np.asfortranarray(array), array[::-1], array[:, ::-1], array.tolist(), array[:, :2], array.T,
                          array.ravel(), np.repeat(array, 2, axis=0)[::2], np.ma.array(array, mask=array == array.T[0, 0] if rows else False)])


def a_call(folder):
    os.chdir(folder)  # for what writes "x.relief"
    collider = COLLIDER
    points = an_array(random.randrange(6))
    calls = {
        "query": lambda: collider.query(points, random.choice(["plane", "nearest", a_value()])),
        "bake": lambda: relief.bake(an_array(5), an_array(4), budget=random.choice(["20kB", a_value()]), name=random.choice(["m", a_value()])),
        "option": lambda: relief.bake(VERTICES, TRIANGLES, **{random.choice(sorted(VALUES) + FLAGS): a_value(), "budget": "20kB"}),
        "check": lambda: relief.check(random.choice([collider, a_value()]), VERTICES, random.choice([TRIANGLES, an_array(4)]),
                                      samples=random.choice([100, a_value()]), seed=random.choice([1, a_value()])),
        "load": lambda: relief.load(random.choice([a_value(), collider.to_bytes()[:random.randrange(400)]])),
        "save": lambda: collider.save(random.choice(["x.relief", a_value()]), a_value()),
        "simulation": lambda: relief.Simulation(a_value(), seed=a_value(), root=a_value()),
    }
    name = random.choice(sorted(calls))
    try:
        said = calls[name]()
        if name == "query":
            known = np.isfinite(np.asarray(points, dtype=np.float32)).all(axis=1)
            cases.expect(np.isnan(said.distance).tolist() == (~known).tolist(), f"NaN is not NaN: {points!r}")
            fresh = collider.query(np.array(points, dtype=np.float32)[known]) if known.any() else None
            if fresh is not None:
                cases.expect(np.array_equal(np.sign(fresh.distance), np.sign(said.distance[known])), f"another layout, other sides: {points!r}")
    except (relief.Error, TypeError, ValueError) as error:
        text = str(error)
        cases.expect(text and "\n" not in text and "incompatible" not in text and "_relief" not in text, f"{name}: {text}")


VERTICES = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
TRIANGLES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
warnings.simplefilter("ignore")
COLLIDER = relief.bake(VERTICES, TRIANGLES, budget="20kB")
for number, folder in cases.each():
    try:
        (a_bake if number % 2 == 0 else a_call)(folder)
    except Exception as error:  # of the case too: it is seen, and named
        cases.fail(f"{type(error).__name__}: {error}")
    os.chdir("/")
cases.finish()
