# SPDX-License-Identifier: Apache-2.0
"""blender -b --factory-startup --python-exit-code 1 -P blender_addon.py -- ADDON RELIEF RELIEF_SIM FOLDER [PICTURE.png]

Bakes, checks and plays in Blender, and compares the results with the tools and with closed forms. PYTHONPATH must contain the
package.
"""
import importlib.util
import math
import os
import pathlib
import subprocess
import sys

import bpy
import numpy as np

addon_file, tool, sim, folder, *picture = sys.argv[sys.argv.index("--") + 1:]
folder = pathlib.Path(folder)
spec = importlib.util.spec_from_file_location("relief_collider", addon_file)
addon = importlib.util.module_from_spec(spec)
sys.modules["relief_collider"] = addon
spec.loader.exec_module(addon)
addon.register()
import relief  # noqa: E402


def refused(operator, words, **arguments):
    try:
        operator(**arguments)
    except RuntimeError as error:
        assert words in str(error), f"{error} does not contain '{words}'"
    else:
        raise AssertionError(f"not rejected: {words}")


bpy.ops.wm.read_factory_settings(use_empty=True)
refused(bpy.ops.relief.bake, "nothing is selected")
light = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT"))
bpy.context.scene.collection.objects.link(light)
bpy.context.view_layer.objects.active = light
refused(bpy.ops.relief.bake, "not a mesh")

# A translated and rotated sphere with negative scale: a closed form in world space.
bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=1.0, location=(2, -1, 3), rotation=(0.3, 0.2, 0.1),
                                     scale=(-0.5, 0.5, 0.5))
ball = bpy.context.active_object
refused(bpy.ops.relief.show_errors, "bake it first")
refused(bpy.ops.relief.bake, "save the .blend")
for up in ("Z", "Y"):
    ball.relief.up = up
    path = folder / f"ball_{up}.relief"
    assert bpy.ops.relief.bake(filepath=str(path)) == {"FINISHED"}
    collider = relief.load(path)
    random = np.random.default_rng(3).uniform(-0.8, 0.8, (5000, 3))
    points = addon.to_relief(random + (2, -1, 3), up)
    distance = collider.query(points, distance="nearest").distance
    truth = np.linalg.norm(random, axis=1) - 0.5
    clear = np.abs(truth) > 0.01
    assert ((distance < 0) == (truth < 0))[clear].all(), f"{up} up: wrong sides"
    assert 0 <= ball.relief.wrong < 1, ball.relief.wrong

# The tool bakes the same maps from the same triangles.
vertices, triangles = addon.world_mesh(bpy.context, ball)
with open(folder / "ball.obj", "w") as out:
    for v in addon.to_relief(vertices, "Y"):
        out.write("v %.9g %.9g %.9g\n" % tuple(v))
    for t in triangles + 1:
        out.write("f %d %d %d\n" % tuple(t))
subprocess.run([tool, "bake", folder / "ball.obj", "-o", folder / "tool.relief", "-q", "--budget", "1MB"], check=True)
for name in ("ball_Y", "tool"):
    subprocess.run([tool, "export", folder / f"{name}.relief", "--engine", "c", folder / name, "-q"], check=True)
for ending in ("texels", "constants"):
    baked = (folder / "ball_Y" / f"ball_Y.{ending}").read_bytes()
    assert (folder / "tool" / f"tool.{ending}").read_bytes() == baked, f"the add-on bakes different {ending}"

# The overlay's colours show the collider's distance at the surface; white is 0.
bpy.ops.mesh.primitive_monkey_add(size=2)
monkey = bpy.context.active_object
monkey.modifiers.new("subsurf", "SUBSURF").levels = 2
monkey.relief.budget = 60
assert bpy.ops.relief.bake(filepath=str(folder / "monkey.relief")) == {"FINISHED"}
assert bpy.ops.relief.show_errors() == {"FINISHED"}
overlay = bpy.data.objects[addon.OVERLAY + monkey.name]
colors = np.empty(4 * len(overlay.data.vertices), dtype=np.float32)
overlay.data.color_attributes[addon.COLOR].data.foreach_get("color", colors)
colors = colors.reshape(-1, 4)
places = np.empty(3 * len(overlay.data.vertices), dtype=np.float32)
overlay.data.vertices.foreach_get("co", places)
said = relief.load(folder / "monkey.relief").query(places.reshape(-1, 3), distance="nearest").distance
depth = addon.sheet_depth(relief.load(folder / "monkey.relief"))
said = np.where(said < -0.5 * depth, said + depth, said)
far = np.abs(said) > 0.5 * overlay["relief_range"]
near = np.abs(said) < 0.002 * overlay["relief_range"]
assert far.any() and near.any()
spread = colors[:, :3].max(axis=1) - colors[:, :3].min(axis=1)
assert spread[far].min() > 0.25 and spread[near].max() < 0.1, (spread[far].min(), spread[near].max())
assert monkey.hide_get()
marks = [one for one in bpy.data.objects if one.get("relief_of") == monkey.name and one.type == "EMPTY"]
assert len(marks) == 3 and all(one["why"] for one in marks), marks

if picture:
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 64
    scene.cycles.use_denoising = False
    scene.cycles.device = "CPU"
    scene.render.resolution_x, scene.render.resolution_y = 720, 480
    scene.render.filepath = picture[0]
    scene.render.image_settings.file_format = "JPEG" if picture[0].endswith(".jpg") else "PNG"
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.55, 0.6, 0.68, 1)
    scene.world.node_tree.nodes["Background"].inputs[1].default_value = 0.45
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 1.6, (0.9, 0.3, 0.6)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler, camera.data.lens = (2.2, -5.6, 1.1), (math.radians(80), 0, math.radians(21)), 62
    for one in (sun, camera):
        scene.collection.objects.link(one)
    ball.hide_render = monkey.hide_render = True
    scene.camera = camera
    bpy.ops.render.render(write_still=True)

# Later edits are detected, and hiding the overlay restores the object.
bpy.context.view_layer.objects.active = monkey
monkey.location.x += 1
bpy.context.view_layer.update()
refused(bpy.ops.relief.show_errors, "bake it again")
assert bpy.ops.relief.hide_errors() == {"FINISHED"}
assert not monkey.hide_get() and addon.OVERLAY + monkey.name not in bpy.data.objects
assert not [one for one in bpy.data.objects if one.get("relief_of")]

# A particle cache of relief-sim, on the monkey, frame by frame.
(folder / "s.toml").write_text("""
[collider]
file = "ball_Y.relief"
[time]
steps = 30
[render]
steps_per_frame = 10
[emitter]
rate = 2000.0
""")
subprocess.run([sim, folder / "s.toml", "-q", "--dump-frames", folder / "frames"], check=True)
bpy.context.scene.frame_set(5)
assert bpy.ops.relief.load_cache(directory=str(folder / "frames"), up="Y") == {"FINISHED"}
cloud = bpy.context.active_object
for frame, file in ((5, 0), (6, 1), (7, 2), (100, 2), (1, 0)):
    bpy.context.scene.frame_set(frame)
    particles = addon.read_particles(folder / "frames" / f"particles_{file:04}.ply")
    at = np.empty(3 * len(cloud.data.vertices), dtype=np.float32)
    cloud.data.vertices.foreach_get("co", at)
    x, y, z = particles["position"].T
    assert np.array_equal(at.reshape(-1, 3), np.stack([x, -z, y], axis=1)), f"frame {frame}"
    for name in ("age", "id", "type"):
        values = np.empty(len(particles), dtype=np.float32 if name == "age" else np.int32)
        cloud.data.attributes[name].data.foreach_get("value", values)
        assert np.array_equal(values, particles[name]), name
    velocity = np.empty(3 * len(particles), dtype=np.float32)
    cloud.data.attributes["velocity"].data.foreach_get("vector", velocity)
    assert np.array_equal(velocity.reshape(-1, 3)[:, 2], particles["velocity"][:, 1])
refused(bpy.ops.relief.load_cache, "contains no particles", directory=str(folder))
cut = (folder / "frames" / "particles_0001.ply").read_bytes()
(folder / "frames" / "particles_0001.ply").write_bytes(cut[:-7])
bpy.context.scene.frame_set(6)
assert "truncated" in cloud.relief_cache.message
os.makedirs(folder / "wrong", exist_ok=True)
(folder / "wrong" / "particles_0000.ply").write_bytes(b"ply\nformat ascii 1.0\nend_header\n")
refused(bpy.ops.relief.load_cache, "is not a particle file of relief-sim", directory=str(folder / "wrong"))

addon.unregister()
print("blender: bakes match the tool, errors are shown, particles play")
