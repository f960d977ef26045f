# SPDX-License-Identifier: Apache-2.0
"""relief.bake() and relief.check() have the options, bytes and verdicts of `relief bake` and `relief check`."""
import inspect
import json
import os
import pathlib
import re
import subprocess
import warnings

import numpy as np
import pytest

import relief
from lift import lift

BIN = pathlib.Path(os.environ["RELIEF_BIN"])

# Two parts: a closed box, and an open sheet above it.
SCENE = """o box
{}
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8
o sheet
{}
f 9 10 11 12
""".format(*("\n".join(f"v {x} {y} {z}" for x, y, z in corners) for corners in (
    [(x, y, z) for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))], [(-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1)])))


@pytest.fixture(scope="module")
def mesh(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "scene.obj"
    path.write_text(SCENE)
    return path


# Arguments with the equivalent command line. They cover every option. A bake of 60 kB is small and fast.
PATCHES = {"budget": "60kB", "no_check": True}
WAYS = [
    (dict(budget=np.int64(60_000), quality="fast", threads=1), ["--budget", "60kB", "--quality", "fast", "--threads", "1"]),
    (dict(budget=6e4, texel=0.001), ["--budget", "60kB", "--texel", "0.001"]),
    (dict(PATCHES, prefer="inside", as_="shell", thickness=0.1),
     ["--budget", "60kB", "--prefer", "inside", "--as", "shell", "--thickness", "0.1"]),
    (dict(PATCHES, as_=["sheet=terrain", "box=solid"]), ["--budget", "60kB", "--as", "sheet=terrain", "--as", "box=solid"]),
    (dict(holes="keep", resolution=32), ["--holes", "keep", "--resolution", "32"]),
    (dict(PATCHES, repair="wrap=0.1", strict=True), ["--budget", "60kB", "--repair", "wrap=0.1", "--strict"]),
    (dict(PATCHES, unit="mm", up="+z", max_import_memory="1GB", import_timeout=9, max_triangles=100, timeout=500),
     ["--budget", "60kB", "--unit", "mm", "--up", "+z", "--max-import-memory", "1GB", "--import-timeout", "9", "--max-triangles", "100",
      "--timeout", "500"]),
    (dict(max_error="20%", budget="1MB"), ["--max-error", "20", "--budget", "1MB"]),
    (dict(paper=True, resolution=32), ["--paper", "--resolution", "32"]),
    (dict(maps="cube:size=32"), ["--map", "cube:size=32"]),
    (dict(maps=["front-back:dir=-x", "fixed8:dir=+y,size=16x8"], resolution=24, decode="projected", depth="half"),
     ["--map", "front-back:dir=-x", "--map", "fixed8:dir=+y,size=16x8", "--resolution", "24", "--decode", "projected",
      "--depth", "half"]),
]


def by_themselves():
    """A way for each remaining field that is a flag or whose values the tool's help lists."""
    tried = set().union(*(arguments for arguments, _ in WAYS))
    said = tool("bake", "--help").stdout
    for name, kind, *_ in relief._relief.bake_fields():
        option = "--" + name.replace("_", "-")
        values = re.search(rf"{option} ([^ \[]+\|[^ \[]+)", said)
        if name not in (*tried, "animated") and kind == "flag":
            yield {**PATCHES, name: True}, ["--budget", "60kB", option]
        elif name not in tried and values:
            last = values[1].split("|")[-1]
            yield {**PATCHES, name: last}, ["--budget", "60kB", option, last]


def tool(*words):
    return subprocess.run([BIN / "relief", *words], capture_output=True, text=True)


WAYS += by_themselves()


@pytest.mark.parametrize("arguments,words", WAYS, ids=[" ".join(words) for _, words in WAYS])
def test_every_option_matches_the_tool(arguments, words, mesh, tmp_path):
    done = tool("bake", mesh, "--warnings-only", "-o", tmp_path / "tool.relief", *words,
                *(["--no-check"] if arguments.get("no_check") else []))
    assert done.returncode == 0, done.stderr
    with warnings.catch_warnings(record=True, action="always") as caught:
        collider = relief.bake(mesh, **arguments)
    assert collider.to_bytes() == (tmp_path / "tool.relief").read_bytes()
    assert [issubclass(one.category, relief.ReliefWarning) for one in caught] == [True] * done.stderr.count("warning: ")


def test_no_option_of_the_tool_is_missing():
    """Only options of the command's output, recipes and levels are left out; compress belongs to save()."""
    said = set(re.findall(r"(?:^ +| -.,)--([a-z][a-z-]*)", tool("bake", "--help").stdout, re.MULTILINE))
    others = {"help", "manual", "quiet", "verbose", "warnings-only", "output", "json", "depfile", "compress", "recipe",
              "events", "shard", "stamp", "dry-run", "world"}
    has = {name for name in inspect.signature(relief.bake).parameters if name not in ("mesh", "triangles", "name")}
    assert others < said
    assert {"map" if name == "maps" else name.rstrip("_").replace("_", "-") for name in has} == said - others
    used = set().union(*(arguments for arguments, _ in WAYS))
    assert has - used == {"heights", "animated", "clips"}  # covered by the next tests


def test_height_maps_match_the_tool(mesh, tmp_path):
    path = tmp_path / "hills.raw"
    path.write_bytes(np.arange(40 * 40, dtype="<u2").tobytes())
    words = "spacing=0.5,low=-1,high=300,hole=77"
    assert tool("bake", path, "-q", "-o", tmp_path / "a.relief", "--heights", words).returncode == 0
    ground = relief.bake(path, heights=words, threads=1)
    assert ground.to_bytes() == (tmp_path / "a.relief").read_bytes()
    with pytest.raises(relief.UsageError, match="^budget has no effect with heights"):
        relief.bake(path, heights=words, budget="1MB")
    with pytest.raises(relief.InputError, match="scene.obj.*do not form rows of 7 samples"):
        relief.bake(mesh, heights=words + ",width=7")
    with pytest.raises(relief.UsageError, match="read from a file"):
        relief.bake(np.eye(3), np.array([[0, 1, 2]]), heights=words)


def test_animated_bake_matches_the_tool_and_plays(tmp_path):
    (tmp_path / "lift.gltf").write_text(lift({"rise": (0, 1, 0)}))
    (tmp_path / "more.gltf").write_text(lift({"slide": (2, 0, 0)}))
    done = tool("bake", tmp_path / "lift.gltf", "--animated", "--clips", tmp_path / "more.gltf", "-q", "-o", tmp_path / "tool.relief")
    assert done.returncode == 0, done.stderr
    baked = relief.bake(tmp_path / "lift.gltf", animated=True, clips=str(tmp_path / "more.gltf"))
    assert baked.to_bytes() == (tmp_path / "tool.relief").read_bytes()
    # A particle that falls onto the lift rises with it.
    (tmp_path / "scene.toml").write_text("""
time = { dt = 0.015625 }
particles = { capacity = 2048 }
forces = { gravity = [0, -2, 0], drag = 0 }
ground = { enabled = false }
collider = { file = "tool.relief", play = { clip = "rise", loop = false, resolution = 128 } }
emitter = { box_min = [-0.8, 1.1, -0.8], box_max = [0.8, 1.6, 0.8], burst = 1000, rate = 0, lifetime = 50, velocity = [0, 0, 0], velocity_spread = [0, 0, 0] }
""")
    with relief.Simulation(tmp_path / "scene.toml") as simulation:
        simulation.step(48)
        assert (simulation.positions[:, 1] > 1 + simulation.time - 0.03).sum() == simulation.alive == 1000
        assert (simulation.collisions > 0).sum() > 900


def test_arrays_match_their_file(mesh):
    rows = [line.split() for line in SCENE.splitlines()]
    vertices = np.array([row[1:] for row in rows if row[0] == "v"], dtype=float)
    quads = np.array([row[1:] for row in rows if row[0] == "f"], dtype=int) - 1
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.uint64)
    collider = relief.bake(vertices, triangles, name="own", budget=60_000, as_="shell")
    # Strides, byte orders and types do not matter.
    odd = np.asfortranarray(vertices.astype(">f8"))[::1]
    other = relief.bake(odd, np.repeat(triangles.astype(np.int16), 2, axis=0)[::2], name="own", budget=60_000, as_="shell")
    assert other.to_bytes() == collider.to_bytes() and "own" in repr(collider)
    assert relief.check(collider, vertices, triangles, samples=2000).wrong_percent < 5


CHECKS = [dict(samples=3000), dict(samples=3000, min_part=0.5),
          dict(samples=3000, unit="mm", up="+z", max_import_memory="1GB", import_timeout=9, max_triangles=100, hidden="keep")]


@pytest.mark.parametrize("bake,arguments", [({}, arguments) for arguments in CHECKS] + [
    (bake, dict(samples=4e3, seed=7)) for bake in (dict(holes="keep", resolution=64), dict(repair="wrap=0.05"),
                                                   dict(as_="shell"), dict(as_="sheet=terrain"), dict(thickness=0.3))], ids=str)
def test_checks_match_the_tool(bake, arguments, mesh, tmp_path):
    """Every option of a check, and the solid of every way to bake."""
    assert set().union(*CHECKS) | {"seed"} == set(inspect.signature(relief.check).parameters) - {"collider", "mesh", "triangles"}
    frame = {name: arguments[name] for name in ("unit", "up") if name in arguments}
    words = [f"--{name.replace('_', '-')}={value if isinstance(value, str) else format(value, 'g')}"
             for name, value in arguments.items()]
    size = {} if "resolution" in bake else {"budget": "60kB"}
    with warnings.catch_warnings(action="ignore"):
        relief.bake(mesh, no_check=True, **size, **bake, **frame).save(tmp_path / "a.relief")
    said = json.loads(tool("check", tmp_path / "a.relief", "--mesh", mesh, "--json", *words).stdout)
    with warnings.catch_warnings(record=True, action="always") as caught:
        accuracy = relief.check(relief.load(tmp_path / "a.relief"), mesh, **arguments)
    assert accuracy.wrong_percent == pytest.approx(said["verdict"]["wrong_percent"], abs=1e-12)
    assert (accuracy.grade, accuracy.lost_parts) == (said["verdict"]["grade"], said["verdict"]["lost_parts"])
    measured = (said["repaired"] or said)["accuracy"]
    assert accuracy.distance_error_mean == pytest.approx(measured["distance_error"]["mean"])
    assert accuracy.normal_error_mean == pytest.approx(measured["normal_error_degrees"]["mean"])
    ignored = said["verdict"]["ignored_parts"]
    assert accuracy.ignored_parts == ignored["lost"] + ignored["thickened"]
    assert (accuracy.proven_depth or 0) == pytest.approx(said["depth_proof"]["depth"] or 0, rel=1e-6)
    assert len(accuracy.worst_places) == len(said["worst_places"])
    for place, other in zip(accuracy.worst_places, said["worst_places"]):
        assert place.position == pytest.approx(other["position"], abs=1e-6)
        assert (place.cause, place.map) == (other["cause"], other["map"])
        assert place.contribution_percent == pytest.approx(other["contribution_percent"])
    assert [str(one.message) for one in caught] == said["warnings"]


def test_checks_reject_other_meshes(mesh, tmp_path):
    collider = relief.bake(mesh, budget="60kB", as_="sheet=terrain")
    (tmp_path / "other.obj").write_text(SCENE.replace("v 1 2 1", "v 1 2 9"))
    with pytest.raises(relief.InputError, match="the mesh that it was baked from"):
        relief.check(collider, tmp_path / "other.obj")
    with pytest.raises(relief.UsageError, match="baked with names"):
        relief.check(collider, np.eye(3), [[0, 1, 2]])


WRONG = [dict(budget="much"), dict(budget=-1), dict(budget=0.5), dict(budget=float("nan")), dict(budget=10**40), dict(budget=1e300),
         dict(budget="--paper"), dict(quality="worst"), dict(prefer=""), dict(repair=""),
         dict(maps="cube", paper=True), dict(thickness=float("inf")), dict(max_error=-1), dict(unit="ell")]


@pytest.mark.parametrize("arguments,words", [(one, "^" + next(iter(one))) for one in WRONG] + [
    (dict(maps=["cube:size=0"]), "size"), (dict(as_="sheets"), "sheets"), (dict(as_="nothing=shell"), "nothing"),
    (dict(repair="all"), "all")], ids=str)
def test_value_errors_name_the_argument(arguments, words, mesh):
    with pytest.raises(ValueError, match=words) as error:
        relief.bake(mesh, **arguments)
    assert isinstance(error.value, relief.UsageError) and "\n" not in str(error.value)


@pytest.mark.parametrize("arguments", [dict(budget=[]), dict(budget=True), dict(paper=1), dict(maps=[1]), dict(as_={"a": 1}),
                                       dict(quality=b"fast"), dict(budget=1j), dict(name=3), dict(budget=np.ones(2))])
def test_type_errors_name_the_argument(arguments):
    with pytest.raises(TypeError, match=f"^{next(iter(arguments))} is of type .* but must be"):
        relief.bake(np.eye(3), [[0, 1, 2]], **arguments)


def test_timeout(mesh):
    with pytest.raises(relief.LimitError, match="timeout"):
        relief.bake(mesh, budget="64MB", quality="best", timeout=0.05)
    with pytest.raises(relief.UsageError, match="^unit applies only to a mesh read from a file"):
        relief.bake(np.eye(3), [[0, 1, 2]], unit="mm")
    with pytest.raises(relief.UsageError, match="NAME=KIND applies only to a mesh read from a file"):
        relief.bake(np.eye(3), [[0, 1, 2]], as_="a=shell")
