# SPDX-License-Identifier: Apache-2.0
"""Wrong, unusual and hostile arguments: never a silent result, never an internal error of the binding."""
import copy
import gc
import inspect
import multiprocessing
import pickle
import threading

import numpy as np
import pytest

import relief

VERTICES = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
TRIANGLES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
SCENE = '[collider]\nfile = "c.relief"\n[particles]\ncapacity = 500\n'


@pytest.fixture(scope="module")
def collider():
    return relief.bake(VERTICES, TRIANGLES, budget="20kB", no_check=True)


@pytest.fixture
def scene(tmp_path, collider):
    collider.save(tmp_path / "c.relief")
    (tmp_path / "s.toml").write_text(SCENE)
    return tmp_path / "s.toml"


def test_unknown_arguments_suggest_the_nearest_one(collider, scene):
    calls = [
        (lambda: relief.bake(VERTICES, TRIANGLES, budgte="20kB"), r"bake\(\) has no argument 'budgte'; did you mean 'budget'\?"),
        (lambda: relief.bake(VERTICES, TRIANGLES, map="cube"), "'map'; did you mean 'maps'"),
        (lambda: relief.bake(VERTICES, TRIANGLES, zzz=1), r"bake\(\) has no argument 'zzz'; see help\(relief.bake\)"),
        (lambda: relief.check(collider, VERTICES, TRIANGLES, sample=5), r"check\(\) .*'sample'; did you mean 'samples'"),
        (lambda: collider.query(VERTICES, distances="plane"), r"query\(\) .*did you mean 'distance'"),
        (lambda: collider.save("x.relief", compression=3), r"save\(\) .*did you mean 'compress'"),
        (lambda: collider.to_bytes(compression=3), r"to_bytes\(\) .*did you mean 'compress'"),
        (lambda: relief.Simulation(scene, sed=1), r"Simulation\(\) .*did you mean 'seed'"),
        (lambda: relief.World(paht="w"), r"World\(\) .*did you mean 'path'"),
        (lambda: relief.load(sauce="x"), r"load\(\) .*did you mean 'source'"),
    ]
    for call, words in calls:
        with pytest.raises(TypeError, match=words):
            call()


def test_dir_lists_only_the_api(collider):
    assert set(dir(relief)) == {*relief.__all__, "__version__", "__doc__", "__name__", "__file__"}
    assert all(hasattr(relief, name) for name in dir(relief))
    assert {"format", "width", "height", "texels"} <= set(dir(collider.maps[0]))
    assert list(inspect.signature(relief.bake).parameters)[:4] == ["mesh", "triangles", "name", "maps"]


@pytest.mark.parametrize("number", [2**32 + 1, 2**64 - 1])
def test_indices_do_not_wrap_around(number, collider):
    triangles = TRIANGLES.astype(np.uint64)
    triangles[2, 1] = number
    for use in (relief.bake, lambda *mesh: relief.check(collider, *mesh)):
        with pytest.raises(relief.InputError, match=f"uses vertex {number} but there are 4"):
            use(VERTICES, triangles)


@pytest.mark.parametrize("vertices,triangles,error,words", [
    (VERTICES, TRIANGLES - 1, ValueError, "of at least 0"),
    (VERTICES, TRIANGLES.astype(float), TypeError, "triangles must be an array of indices, .* not of float64"),
    (VERTICES, TRIANGLES.astype(bool), TypeError, "not of bool"),
    (VERTICES, [[0, 1, 2**70]], TypeError, "not of object"),
    (VERTICES, TRIANGLES.ravel(), ValueError, "triangles must be an array of shape"),
    (VERTICES, [[0, 1, 2], [0, 1]], ValueError, "rows of different lengths"),
    (VERTICES, np.zeros((0, 3), int), relief.InputError, "no triangle has an area"),
    (VERTICES, None, ValueError, "triangles are missing"),
    (VERTICES, "abc", ValueError, "shape"),
    (VERTICES * 1j, TRIANGLES, TypeError, "vertices must be an array of numbers, not of complex128"),
    (VERTICES.astype(str), TRIANGLES, TypeError, "vertices must be an array of numbers"),
    (VERTICES[:, :2], TRIANGLES, ValueError, r"vertices must be an array of shape \(n, 3\), not \(4, 2\)"),
    (VERTICES * 1e300, TRIANGLES, relief.InputError, "not a number or beyond 1e15"),
    (VERTICES * np.nan, TRIANGLES, relief.InputError, "not a number"),
    (np.ma.masked_less(VERTICES, 0.5), TRIANGLES, ValueError, "masked"),
    (None, TRIANGLES, ValueError, "shape"),
    (np.zeros((0, 3)), TRIANGLES, relief.InputError, "there are 0"),
    ("mesh.obj", TRIANGLES, ValueError, "triangles cannot be given for a mesh file"),
    ("mesh\0.obj", None, ValueError, "null character"),
    (b"mesh.obj", TRIANGLES, ValueError, "shape"),
], ids=range(20))
def test_invalid_meshes(vertices, triangles, error, words, collider):
    for use in (relief.bake, lambda *mesh: relief.check(collider, *mesh)):
        with pytest.raises(error, match=words):
            use(vertices, triangles)


def test_names_must_be_text(collider):
    with pytest.raises(ValueError, match="^name has 256 bytes; at most 255 are allowed"):
        relief.bake(VERTICES, TRIANGLES, name="ä" * 128)
    for name in ("", "a\nb\x1b[2J", "\udcff", "ä" * 127):
        made = relief.bake(VERTICES, TRIANGLES, name=name, budget="20kB", no_check=True)
        assert "\n" not in repr(made) and "\x1b" not in repr(made)
        assert relief.load(made.to_bytes()).to_bytes() == made.to_bytes()


def test_non_finite_points_give_nan(collider):
    points = np.array([[0.1, 0.1, 0.1], [np.nan, 0, 0], [0, np.inf, 0], [0, 0, -np.inf], [1e300, 0, 0], [9, 9, 9]])
    for distance in ("plane", "nearest"):
        said = collider.query(points, distance)
        assert np.isnan(said.distance).tolist() == [False, True, True, True, True, False]
        assert np.isnan(said.normal).all(axis=1).tolist() == np.isnan(said.normal).any(axis=1).tolist() == [
            False, True, True, True, True, False]
        assert said.map[1:5].tolist() == [-1] * 4 and said.distance[0] < 0 < said.distance[5]
        alone = collider.query(points[:1], distance)
        assert all(np.array_equal(a, b[:1]) for a, b in zip(alone, said))


@pytest.mark.parametrize("points,error", [
    (np.zeros((3, 2)), ValueError), (np.zeros(3), ValueError), ([], ValueError), (None, ValueError), ("points", ValueError),
    ([[1, 2], [3]], ValueError), ([[1j, 0, 0]], TypeError), ([["a", "b", "c"]], TypeError), ([[None, 1, 2]], TypeError),
    (np.zeros((2, 3), bool), TypeError), (np.zeros((2, 3), "datetime64[s]"), TypeError), (np.zeros((1, 2, 3)), ValueError),
], ids=range(12))
def test_invalid_points(points, error, collider):
    with pytest.raises(error, match="^points must be an array of"):
        collider.query(points)


def test_points_in_every_layout(collider):
    points = np.random.default_rng(1).uniform(-1, 2, (100_000, 3)).astype(np.float32)
    expected = collider.query(points)
    assert len(collider.query(np.zeros((0, 3))).distance) == 0
    wide = np.zeros((200_000, 6), dtype=np.float32)
    wide[::2, ::2] = points
    for other in (points.astype(">f4"), points.astype(np.float64), np.asfortranarray(points), wide[::2, ::2],
                  points[::-1].copy()[::-1], points.tolist()):
        assert all(np.array_equal(a, b) for a, b in zip(expected, collider.query(other)))
    with pytest.raises(relief.UsageError, match="^distance is 3 but must be 'plane' or 'nearest'"):
        collider.query(points, 3)


def ask(collider):
    return collider.query(np.array([[0.1, 0.1, 0.1]])).distance.tolist()


def test_colliders_can_be_pickled_and_copied(collider):
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
        again = pickle.loads(pickle.dumps(collider, protocol))
        assert again.to_bytes() == collider.to_bytes() and repr(again) == repr(collider)
    assert copy.copy(collider) is collider and copy.deepcopy([collider])[0] is collider
    one = pickle.loads(pickle.dumps(collider.maps[0]))
    assert np.array_equal(one.texels, collider.maps[0].texels) and copy.copy(one).format == one.format
    assert relief.load(bytearray(collider.to_bytes(19))).to_bytes() == collider.to_bytes()
    for method in ("fork", "spawn"):  # a pool that is forked after this process has started threads
        with multiprocessing.get_context(method).Pool(2) as pool:
            assert pool.map_async(ask, [collider] * 4).get(timeout=60) == [ask(collider)] * 4
    with pytest.raises(TypeError, match="relief.bake"):
        relief.Collider("b.relief")


@pytest.mark.parametrize("compression", [-1, 20, 1.5, float("nan"), 2**70])
def test_invalid_compression_levels(compression, collider, tmp_path):
    for write in (lambda: collider.save(tmp_path / "x.relief", compression), lambda: collider.to_bytes(compression)):
        with pytest.raises(ValueError, match="^compress is .* but must be a whole number from 0 to 19$"):
            write()
    assert not (tmp_path / "x.relief").exists()


def test_dash_is_a_file_name(collider, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(relief.FileError):
        relief.load("-")
    collider.save("-")
    assert relief.load("-").to_bytes() == (tmp_path / "-").read_bytes() == collider.to_bytes()
    with pytest.raises(relief.Error, match="'./-'"):
        relief.bake("-")


def test_non_utf8_names(collider, tmp_path):
    name = "\udcff\udcfe"
    with pytest.raises(relief.FileError, match=r"\\xff\\xfe"):
        relief.load(tmp_path / name)
    collider.save(tmp_path / name)
    assert relief.load(tmp_path / name).to_bytes() == collider.to_bytes()
    (tmp_path / f"{name}.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n")
    with pytest.warns(relief.ReliefWarning):
        made = relief.bake(tmp_path / f"{name}.obj", budget="20kB")
    assert relief.check(made, tmp_path / f"{name}.obj", samples=100).wrong_percent < 100


def test_invalid_paths(collider, tmp_path):
    for call in (collider.save, relief.load, relief.Simulation):
        for wrong in (None, 3, ["a"]):
            with pytest.raises(TypeError, match="is of type .* but must be a path"):
                call(wrong)
        with pytest.raises(ValueError, match="null character"):
            call(str(tmp_path / "a\0b"))
        with pytest.raises(relief.Error):
            call("")
    with pytest.raises(TypeError, match="collider is of type bytes but must be a relief.Collider"):
        relief.check(collider.to_bytes(), VERTICES, TRIANGLES)
    for samples in (0, -1, 1.5, 10**12):
        with pytest.raises(relief.Error, match="^samples is"):
            relief.check(collider, VERTICES, TRIANGLES, samples=samples)
    with pytest.raises(ValueError, match="^seed is"):
        relief.check(collider, VERTICES, TRIANGLES, seed=-1)


@pytest.mark.parametrize("count,error", [(-1, ValueError), (2**32, ValueError), (0.5, ValueError), (float("inf"), ValueError),
                                         ("3", TypeError), (None, TypeError), (True, TypeError), ([1], TypeError)])
def test_invalid_step_counts(count, error, scene):
    with relief.Simulation(scene) as simulation:
        with pytest.raises(error, match="^count is"):
            simulation.step(count)
        assert simulation.time == 0
        simulation.step(2.0)
        simulation.step(np.uint8(1))
        simulation.step(0)
        assert simulation.time == pytest.approx(3 / 60, rel=1e-3)


def test_simulations_close_and_alternate(scene):
    with pytest.raises(ValueError, match="^seed is -1"):
        relief.Simulation(scene, seed=-1)
    alone = relief.Simulation(scene, seed=5)
    alone.step(40)
    expected = alone.positions
    one, two = relief.Simulation(scene, seed=5.0), relief.Simulation(scene, seed=6, hits=True)
    for _ in range(20):
        one.step(2)
        two.step(1)
    two.take_hits()
    assert np.array_equal(one.positions, expected) and len(expected) > 10
    two.close()
    two.close()
    for use in (two.step, two.take_hits, lambda: two.positions, lambda: two.time, lambda: two.alive):
        with pytest.raises(ValueError, match="^the simulation is closed$"):
            use()
    one.step(1)
    with pytest.raises(TypeError):
        pickle.dumps(one)


def test_other_threads_are_rejected(scene):
    simulation = relief.Simulation(scene)
    simulation.step(10)
    failed = []

    def use():
        try:
            simulation.step(1)
        except relief.UsageError as error:
            failed.append(str(error))

    thread = threading.Thread(target=use)
    thread.start()
    thread.join()
    assert len(failed) == 1 and "thread that created it" in failed[0]
    simulation.step(1)
    assert simulation.time == pytest.approx(11 / 60, rel=1e-3)
    holder = [simulation]
    del simulation
    thread = threading.Thread(target=lambda: (holder.clear(), gc.collect()))  # drops the last reference
    thread.start()
    thread.join()
    relief.Simulation(scene).step(1)
