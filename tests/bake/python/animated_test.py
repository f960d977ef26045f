"""Animated colliders in Python: baked with the options of the tool, played by a scene, and nothing falls into them."""
import os
import pathlib
import subprocess

import numpy as np
import pytest

import relief
from lift import lift

BIN = pathlib.Path(os.environ["RELIEF_BIN"])


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "lift.gltf").write_text(lift({"rise": (0, 1, 0)}))
    (tmp_path / "more.gltf").write_text(lift({"slide": (2, 0, 0)}))
    return tmp_path


def test_it_is_what_the_tool_bakes(folder):
    done = subprocess.run([BIN / "relief", "bake", folder / "lift.gltf", "--animated", "--clips", folder / "more.gltf", "-q",
                           "-o", folder / "tool.relief"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    baked = relief.bake(folder / "lift.gltf", animated=True, clips=str(folder / "more.gltf"))
    assert baked.to_bytes() == (folder / "tool.relief").read_bytes()


def test_what_lies_on_it_rises_with_it(folder):
    relief.bake(folder / "lift.gltf", animated=True, clips=str(folder / "more.gltf")).save(folder / "lift.relief")
    (folder / "scene.toml").write_text("""
time = { dt = 0.015625 }
particles = { capacity = 2048 }
forces = { gravity = [0, -2, 0], drag = 0 }
ground = { enabled = false }
[[collider]]
file = "lift.relief"
play = { clip = "rise", repeat = false, resolution = 128 }
[[emitter]]
box_min = [-0.8, 1.1, -0.8]
box_max = [0.8, 1.6, 0.8]
burst = 1000
rate = 0
lifetime = 50
velocity = [0, 0, 0]
velocity_spread = [0, 0, 0]
""")
    with relief.Simulation(folder / "scene.toml") as simulation:
        simulation.step(48)
        top = 1 + simulation.time
        assert simulation.alive == 1000
        assert (simulation.positions[:, 1] > top - 0.03).sum() == 1000
        assert (simulation.collisions > 0).sum() > 900
        simulation.step(64)
        assert (np.abs(simulation.positions[:, 1] - 2) < 0.6).all() and (simulation.positions[:, 1] > 1.97).all()


def test_sparks_of_its_top_rise_with_it(folder):
    baked = relief.bake(folder / "lift.gltf", animated=True)
    baked.save(folder / "lift.relief")
    (folder / "scene.toml").write_text("""
time = { dt = 0.015625 }
particles = { capacity = 5000 }
forces = { gravity = [0, 0, 0], drag = 0 }
ground = { enabled = false }
[[collider]]
file = "lift.relief"
play = { clip = "rise", start = 0.25, repeat = false, resolution = 128 }
[[emitter]]
shape = "surface"
attach = 0
group = "lift"
direction = [0, 1, 0]
speed = 0
inherit = 1
rate = 6000
lifetime = 50
""")
    with relief.Simulation(folder / "scene.toml") as simulation:
        simulation.step(32)
        # All of them rise at its speed of 1, so that they stay on the cube: a sixth on each of its faces.
        place = simulation.positions - [0, 0.25 + simulation.time, 0]
        assert len(place) == pytest.approx(3000, abs=1)
        outermost = np.abs(place).max(axis=1)
        assert np.abs(outermost - 1).max() < 0.02
        faces = np.bincount(np.abs(place).argmax(axis=1) * 2 + (np.take_along_axis(
            place, np.abs(place).argmax(axis=1)[:, None], axis=1)[:, 0] > 0), minlength=6)
        assert ((faces - 500) ** 2 / 500).sum() < 30, faces
    (folder / "wrong.toml").write_text((folder / "scene.toml").read_text().replace('"lift"', '"Head"'))
    with pytest.raises(relief.InputError, match="'Head'; it has 'lift'"):
        relief.Simulation(folder / "wrong.toml")
