# SPDX-License-Identifier: Apache-2.0
"""The Python package compared with the tools."""
import json
import os
import pathlib
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import relief

BIN = pathlib.Path(os.environ["RELIEF_BIN"])
BUNNY = "/usr/share/glmark2/models/bunny.obj"


@pytest.fixture(scope="module")
def bunny(tmp_path_factory):
    path = tmp_path_factory.mktemp("bunny") / "bunny.relief"
    subprocess.run([BIN / "relief", "bake", BUNNY, "-q", "-o", path, "--budget", "200kB"], check=True)
    return path


def bunny_arrays():
    """Vertices and triangles of the bunny."""
    with open(BUNNY) as file:
        rows = [line.split() for line in file]
    return (np.array([row[1:4] for row in rows if row[:1] == ["v"]], dtype=np.float32),
            np.array([row[1:4] for row in rows if row[:1] == ["f"]], dtype=int) - 1)


def random_points(count, seed=1):
    return np.random.default_rng(seed).uniform(-1.1, 1.1, (count, 3)).astype(np.float32)


@pytest.mark.parametrize("distance", ["plane", "nearest"])
def test_queries_match_relief_query(distance, bunny, tmp_path):
    points = random_points(10_000)
    np.savetxt(tmp_path / "points.csv", points, delimiter=",", fmt="%.9g")
    text = subprocess.run([BIN / "relief", "query", bunny, "--points", tmp_path / "points.csv", "-o", "-",
                           "--distance", distance], check=True, capture_output=True, text=True).stdout
    rows = [line.split(",") for line in text.splitlines()[1:]]
    distance, normal, which = relief.load(bunny).query(points, *([] if distance == "plane" else [distance]))
    assert len(rows) == 10_000 and distance.shape == (10_000,) and normal.shape == (10_000, 3) and which.dtype == np.int32
    for i, row in enumerate(rows):
        assert which[i] == (-1 if row[7] == "" else int(row[7]))
        if row[3] not in ("", "inf"):
            assert distance[i] == np.float32(row[3])
            assert list(normal[i]) == [np.float32(value) for value in row[4:7]]


def test_arrays_match_their_file(bunny):
    vertices, triangles = bunny_arrays()
    points = random_points(10_000)
    collider = relief.bake(vertices, triangles, budget=200_000)
    for ours, of_file in zip(collider.query(points), relief.load(bunny).query(points)):
        assert np.array_equal(ours, of_file)
    assert relief.check(collider, vertices, triangles, samples=2000).wrong_percent < 5


def test_files_equal_bytes(bunny, tmp_path):
    collider = relief.load(bunny)
    collider.save(tmp_path / "plain.relief")
    collider.save(tmp_path / "packed.relief", compress=19)
    assert (tmp_path / "plain.relief").read_bytes() == bunny.read_bytes()
    assert (tmp_path / "packed.relief").stat().st_size < bunny.stat().st_size
    points = random_points(1000)
    for other in (relief.load(bunny.read_bytes()), relief.load(tmp_path / "packed.relief")):
        assert all(np.array_equal(a, b) for a, b in zip(collider.query(points), other.query(points)))


def test_maps_are_arrays():
    collider = relief.bake(BUNNY, maps=["front-back:dir=-x", "cube", "float:dir=-y"], resolution=96)
    assert len(collider.maps) == 3
    vertices, _ = bunny_arrays()
    assert np.allclose(collider.bounds, [np.min(vertices, 0), np.max(vertices, 0)], atol=1e-6)
    for one in collider.maps:
        texels = one.texels
        assert texels.shape == (one.faces, one.height, one.width, 4) and not texels.flags.owndata
        assert not texels.flags.writeable
        assert np.shares_memory(texels, one.texels)
        depth = one.depth[np.isfinite(one.depth)]
        assert depth.size > 0.05 * one.width * one.height and depth.min() >= 0
        assert depth.max() <= (1 if one.faces == 1 else 1.7321)
    texels = collider.maps[0].texels
    before = texels.copy()
    del collider, one
    assert np.array_equal(texels, before)  # the array keeps the collider alive


def test_patches_have_a_tree_but_no_depths():
    one = relief.bake(BUNNY, maps="patches:budget=8kB").maps[0]
    assert one.format == "patches" and one.texels.dtype == np.uint16 and one.texels.shape == (1, one.height, one.width, 4)
    roots = one.texels[0, 0, 0, :3].astype(int)
    # The first texels are the header and the root records. At least one root must contain a part of the surface.
    kinds = one.texels[0].reshape(-1, 4)[1:1 + roots.prod(), 0] & 3
    assert roots.min() >= 1 and (kinds >= 2).any()
    for name in ("depth", "back_depth"):
        with pytest.raises(relief.UsageError, match="map 0 has patches"):
            getattr(one, name)


def test_invalid_files(tmp_path):
    with pytest.raises(relief.FileError, match="missing.relief"):
        relief.load(tmp_path / "missing.relief")
    with pytest.raises(relief.Error):
        relief.bake(tmp_path / "missing.obj")
    with pytest.raises(relief.InputError):
        relief.load(b"nonsense")


def test_queries_release_the_interpreter_lock(bunny):
    collider, points, ticks, done = relief.load(bunny), random_points(2_000_000), [], threading.Event()

    def tick():
        while not done.wait(0.001):
            ticks.append(1)

    thread = threading.Thread(target=tick)
    thread.start()
    begun = time.perf_counter()
    collider.query(points)
    took = time.perf_counter() - begun
    done.set()
    thread.join()
    assert len(ticks) > 5 or took < 0.05


def test_sample_creates_three_plots(tmp_path):
    sample = pathlib.Path(os.environ["RELIEF_SOURCE"]) / "samples/python/plots.py"
    subprocess.run([sys.executable, sample, BUNNY], cwd=tmp_path, check=True)
    for name in ("slice.png", "maps.png", "budgets.png"):
        assert (tmp_path / name).read_bytes().startswith(b"\x89PNG") and (tmp_path / name).stat().st_size > 10_000


def test_simulation_matches_relief_sim(bunny, tmp_path):
    (tmp_path / "scenes").mkdir()
    scene = tmp_path / "scenes" / "scene.toml"
    scene.write_text('[time]\nsteps = 90\nprewarm = 0.2\n[collider]\nfile = "../bunny.relief"\n'
                     '[particles]\ncapacity = 3000\n[[type]]\n[[type]]\n[[emitter]]\ntype = 0\n[[emitter]]\ntype = 1\n')
    (tmp_path / "bunny.relief").write_bytes(bunny.read_bytes())
    with pytest.raises(relief.Error, match="scene.toml:5"):
        relief.Simulation(scene)
    with pytest.raises(relief.UsageError, match="hits=True"):
        relief.Simulation(scene, root=tmp_path).take_hits()
    subprocess.run([BIN / "relief-sim", scene, "-q", "--root", tmp_path, "--dump", tmp_path / "final.ply",
                    "--events", tmp_path / "hits.jsonl"], check=True)
    simulation = relief.Simulation(scene, root=tmp_path, hits=True)
    simulation.step(50)
    parts = [simulation.take_hits()]
    simulation.step(40)
    parts.append(simulation.take_hits())
    assert len(simulation.take_hits().step) == 0 and len(parts[0].step) > 0 and parts[0].step.max() <= 50

    raw = (tmp_path / "final.ply").read_bytes()
    body = raw[raw.index(b"end_header\n") + 11:]
    dump = np.frombuffer(body, dtype=np.dtype([("position", "<f4", 3), ("velocity", "<f4", 3), ("age", "<f4"),
                                               ("lifetime", "<f4"), ("id", "<u4"), ("type", "<u4")]))
    order = np.argsort(simulation.ids)
    assert simulation.alive == len(dump) > 1000 and abs(simulation.time - 1.5) < 1e-3
    for ours, theirs in (("ids", "id"), ("positions", "position"), ("velocities", "velocity"), ("types", "type"),
                         ("lifetimes", "lifetime")):
        assert np.array_equal(getattr(simulation, ours)[order], dump[theirs]), ours
    assert simulation.collisions.sum() > 0 and set(simulation.types) == {0, 1}

    said = [json.loads(line) for line in open(tmp_path / "hits.jsonl")]
    hits = relief.Hits(*(np.concatenate(both) for both in zip(*parts)))
    assert len(said) == len(hits.step) > 500
    for key in ("step", "id", "type", "time", "position", "normal", "velocity", "speed"):
        assert np.allclose([hit[key] for hit in said], getattr(hits, key), rtol=1e-5, atol=1e-6), key
    assert [-1 if hit["body"] is None else hit["body"] for hit in said] == hits.body.tolist()


def test_stub_matches_the_module():
    """_relief.pyi lists exactly the classes, functions and members of the compiled module."""
    import ast
    import inspect

    from relief import _relief

    def public(thing):
        return {name for name in vars(thing) if not name.startswith("_")}

    stub = ast.parse(pathlib.Path(relief.__file__).with_name("_relief.pyi").read_text())
    functions = {f.name: f for f in stub.body if isinstance(f, ast.FunctionDef)}
    classes = {c.name: c for c in stub.body if isinstance(c, ast.ClassDef)}
    values = {v.target.id for v in stub.body if isinstance(v, ast.AnnAssign)}
    assert public(_relief) == functions.keys() | classes.keys() | values
    for name, declared in classes.items():
        made = getattr(_relief, name)
        assert inspect.isclass(made)
        members = {f.name: f for f in declared.body if isinstance(f, ast.FunctionDef)}
        assert public(made) == {member for member in members if not member.startswith("__")}
        assert made.__mro__[1].__name__ in ([base.id for base in declared.bases] or ["pybind11_object"])
    for name, declared in functions.items():
        # pybind11 writes the signature into the docstring.
        assert getattr(_relief, name).__doc__.count("arg") == len(declared.args.posonlyargs), name
