# SPDX-License-Identifier: Apache-2.0
"""Worlds in Python, compared with a union of the placed colliders by numpy."""
import json
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import relief

BIN = pathlib.Path(os.environ["RELIEF_BIN"])
SOURCE = pathlib.Path(os.environ["RELIEF_SOURCE"])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    work = tmp_path_factory.mktemp("world")
    subprocess.run([sys.executable, SOURCE / "tests/cli/level.py", work / "level.gltf"], check=True)
    subprocess.run([BIN / "relief", "bake", work / "level.gltf", "--world", work / "w", "--budget", "200kB", "-q"], check=True)
    return work / "w"


@pytest.fixture(scope="module")
def world(folder):
    return relief.World(folder / "world.json")


def matrix(x, y, z, w):
    """The rotation matrix of a quaternion, in doubles."""
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def test_members_match_the_file(folder, world):
    file = json.loads((folder / "world.json").read_text())
    assert len(world) == 5 and repr(world) == "<World: 5 bodies of 3 colliders>" and world.unit == "m"
    assert world.nodes == [body["node"] for body in file["bodies"]]
    assert world.find("third") == [3]
    (folder / "tiles.json").write_text(json.dumps({**file, "bodies": file["bodies"] + file["bodies"][3:4]}))
    assert relief.World(folder / "tiles.json").find("third") == [3, 5]
    assert np.array_equal(world.positions, np.float32([body["position"] for body in file["bodies"]]))
    assert np.allclose(world.rotations, [body["rotation"] for body in file["bodies"]], atol=1e-7)
    assert np.array_equal(world.scales, np.float32([body["scale"] for body in file["bodies"]]))
    assert world.collider_of.tolist() == [body["collider"] for body in file["bodies"]]
    assert [collider.to_bytes() for collider in world.colliders] == [
        relief.load(folder / collider["file"]).to_bytes() for collider in file["colliders"]]
    low, high = world.bounds
    assert np.allclose(low, [-20, -0.5, -20], atol=0.1) and high[1] == pytest.approx(2, abs=0.1)


def test_field_is_the_union_of_the_bodies(world):
    points = np.random.default_rng(3).uniform([-8, -1, -8], [8, 3, 8], (20_000, 3)).astype(np.float32)
    distances, normals = [], []
    for body in range(len(world)):
        turn, scale = matrix(*world.rotations[body].astype(float)), float(world.scales[body])
        local = (points - world.positions[body].astype(float)) @ turn / scale
        samples = world.colliders[world.collider_of[body]].query(local)
        distances.append(np.where((samples.map >= 0) & (samples.distance < 1e29), samples.distance * scale, 1e30))
        normals.append(samples.normal @ turn.T)
    distance, normal, body = world.query(points)
    assert distance.dtype == normal.dtype == np.float32 and body.dtype == np.int32
    nearest = np.argmin(distances, axis=0)
    best = np.min(distances, axis=0)
    clear = np.sort(distances, axis=0)[1] - best > 1e-3
    off = np.abs(distance - best) > 1e-3
    assert np.mean(off) < 1e-3, "except at edges, where rounding selects another map"
    assert np.mean((distance < 0) != (best < 0)) < 1e-3
    known = clear & ~off & (best < 1e29)
    assert known.sum() > 5000 and np.mean(body[known] != nearest[known]) < 1e-3
    of_best = np.take_along_axis(np.array(normals), nearest[None, :, None], axis=0)[0]
    assert np.mean(np.linalg.norm(normal - of_best, axis=1)[known] > 0.01) < 1e-3
    assert {0, 1, 2, 3, 4} == set(body[distance < 0].tolist()), "every body contains points"


def test_non_finite_points_give_nan(world):
    distance, normal, body = world.query([[np.nan, 0, 0], [0, 0.5, 0]])
    assert np.isnan(distance[0]) and np.isnan(normal[0]).all() and body[0] == -1
    assert distance[1] < 0 and body[1] == 1


def test_simulation_plays_the_world(folder):
    with relief.Simulation(folder / "world.json", hits=True) as simulation:
        simulation.step(120)
        assert len(simulation.positions) > 0


def test_errors_are_exceptions(folder, world, tmp_path):
    with pytest.raises(relief.FileError, match="none.json"):
        relief.World(tmp_path / "none.json")
    with pytest.raises(relief.InputError, match="is not a world"):
        (tmp_path / "world.json").write_text("{}")
        relief.World(tmp_path / "world.json")
    with pytest.raises(relief.FileError, match="colliders"):
        (tmp_path / "world.json").write_text((folder / "world.json").read_text())
        relief.World(tmp_path / "world.json")
    with pytest.raises(TypeError, match="path is of type int"):
        relief.World(3)
    with pytest.raises(relief.UsageError, match="'window'"):
        world.find("window")
    with pytest.raises(TypeError, match="node is of type int"):
        world.find(3)
    with pytest.raises(relief.UsageError, match="shape"):
        world.query([1, 2, 3])
