# SPDX-License-Identifier: Apache-2.0
"""Animated colliders in Python: baked with the tool's options and played by a scene."""
import os
import pathlib
import subprocess

import relief
from lift import lift

BIN = pathlib.Path(os.environ["RELIEF_BIN"])


def test_bake_and_playback_match_the_tool(tmp_path):
    (tmp_path / "lift.gltf").write_text(lift({"rise": (0, 1, 0)}))
    (tmp_path / "more.gltf").write_text(lift({"slide": (2, 0, 0)}))
    done = subprocess.run([BIN / "relief", "bake", tmp_path / "lift.gltf", "--animated", "--clips", tmp_path / "more.gltf", "-q",
                           "-o", tmp_path / "tool.relief"], capture_output=True, text=True)
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
