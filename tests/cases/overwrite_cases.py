# SPDX-License-Identifier: Apache-2.0
"""Random outputs of both tools that collide with inputs, also through links, or with each other: no input may change, no output
may overwrite another, and errors name the conflict."""

import hashlib
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile

from cases import Cases

BOX = """mtllib box.mtl
v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1
usemtl a
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4
"""
SCENE = """[time]
steps = 3
[[collider]]
file = "box.relief"
[[collider]]
mesh = "live.obj"
deform = { amplitude = 0.1, frequency = 2 }
resolution = 16
[particles]
capacity = 50
[emitter]
shape = "points"
points = "points.csv"
rate = 10
[flow]
raw = "flow.raw"
size = [2, 2, 2]
components = 3
box_min = [-1, -1, -1]
box_max = [1, 1, 1]
[[type]]
cell = 0
[render]
atlas = "atlas.png"
size = [16, 16]
steps_per_frame = 1
"""
DRAWN = """[collider]
file = "box.relief"
[render]
mesh = "box.obj"
"""
PICTURED = """[collider]
file = "box.relief"
[render]
meshes = "."
"""
RECIPE = """version = 1
[[asset]]
mesh = "box.obj"
output = "baked/{stem}.relief"
budget = "20kB"
"""
SCENES = {
    "scene.toml": ["scene.toml", "box.relief", "live.obj", "points.csv", "flow.raw", "atlas.png"],
    "drawn.toml": ["drawn.toml", "box.relief", "box.obj"],
    "pictured.toml": ["pictured.toml", "box.relief", "box.obj"],
    "box.relief": ["box.relief"],
}


def make_inputs(cases, folder):
    (folder / "box.obj").write_text(BOX)
    (folder / "live.obj").write_text(BOX)
    (folder / "box.mtl").write_text("newmtl a\nKd 1 0 0\n")
    (folder / "points.csv").write_text("0,2,0\n")
    (folder / "flow.raw").write_bytes(struct.pack("<24f", *range(24)))
    subprocess.run(["convert", "-size", "4x4", "xc:red", folder / "atlas.png"], check=True)
    (folder / "scene.toml").write_text(SCENE)
    (folder / "drawn.toml").write_text(DRAWN)
    (folder / "pictured.toml").write_text(PICTURED)
    (folder / "recipe.toml").write_text(RECIPE)
    made = cases.run("relief", "bake", "box.obj", "-o", "box.relief", "--budget", "20kB", "--no-check", "-q", cwd=folder)
    assert made.returncode == 0, made.stderr


class Arena:
    """A folder with every input, and names that resolve to them."""

    def __init__(self, cases, folder, pristine):
        self.random, self.folder = cases.random, folder
        shutil.copytree(pristine, folder, dirs_exist_ok=True)
        self.names = {path.name: hashlib.sha256(path.read_bytes()).digest() for path in folder.iterdir()}
        (folder / "sub").mkdir()
        self.count = 0

    def unchanged(self):
        """The name of a changed input, or None."""
        for name, digest in self.names.items():
            path = self.folder / name
            if not path.is_file() or hashlib.sha256(path.read_bytes()).digest() != digest:
                return name
        return None

    def fresh(self, ending):
        self.count += 1
        return f"new{self.count}{ending}"

    def lead(self, target, ending):
        """A name that resolves to `target`, which may not exist."""
        name = self.fresh(ending)
        how = self.random.choice(["same", "symbolic", "hard"])
        path = self.folder / target
        if how == "same" and target.endswith(ending):
            return target
        if how == "hard" and path.is_file():
            os.link(path, self.folder / name)
            return name
        (self.folder / name).symlink_to(target)
        return name

    def lead_frame(self, target, head, ending):
        """A folder whose numbered file resolves to `target`."""
        frames = self.folder / self.fresh("")
        frames.mkdir()
        frame = frames / f"{head}{self.random.randrange(3):04}{ending}"
        if self.random.random() < 0.5:
            frame.symlink_to(f"../{target}")
        else:
            os.link(self.folder / target, frame)
        return frames.name


def sim_case(arena, random):
    """Returns a command, and whether it must be rejected."""
    scene = random.choice(sorted(SCENES))
    target = random.choice(SCENES[scene])
    options = {"--dump": ".ply", "--events": ".jsonl"}
    kind = random.choice(["input", "input", "frames", "dumps", "two", "out", "fine", "folder"])
    command = ["relief-sim", scene]
    if kind == "input":
        option = random.choice(sorted(options))
        return command + [option, arena.lead(target, options[option])], True
    if kind == "frames":
        return command + ["--frames", arena.lead_frame(target, "frame_", ".png")], True
    if kind == "dumps":
        return command + ["--dump-frames", arena.lead_frame(target, "particles_", ".ply")], True
    if kind == "folder":
        option = random.choice(["--dump", "--events"])
        return command + ["--frames", "frames", option, random.choice(["frames", "./frames", "sub/../frames"])], True
    first, second = random.sample(["--dump", "--events"], 2)
    if kind == "out":
        standard = ["-", "/dev/stdout", "/dev/fd/1"]
        return command + [first, random.choice(standard), second, random.choice(standard)], True
    if kind == "two":
        name = arena.fresh("")
        return command + [first, name, second, arena.lead(name, "")], True
    return command + [first, arena.fresh(""), second, arena.fresh(""), "--dump-frames", "sub", "--steps", "2"], False


def relief_case(arena, random):
    def lead(*targets, ending=""):
        return arena.lead(random.choice(targets), ending)
    fresh = arena.fresh
    bake = ["relief", "bake", "box.obj", "-q"]
    refused = [
        lambda: bake + ["-o", lead("box.obj", "box.mtl"), "--map", "cube:size=8"],
        lambda: bake + ["-o", fresh(".relief"), "--depfile", lead("box.obj", "box.mtl"), "--budget", "9kB"],
        lambda: (lambda one: bake + ["-o", one, "--depfile", lead(one), "--map", "cube:size=8"])(fresh("")),
        lambda: ["relief", "view", "box.relief", "--mesh", "box.obj", "-o", lead("box.relief", "box.obj", "box.mtl")],
        lambda: bake + ["-o", "-", "--json", "--map", "cube:size=8"],
        lambda: ["relief", "export", "box.relief", "-o", maps_folder()],
        lambda: ["relief", "slice", "box.relief", "-o", lead("box.relief", ending=".png")],
        lambda: ["relief", "query", "box.relief", "--points", "points.csv", "-o", lead("box.relief", "points.csv")],
        lambda: ["relief", "check", "box.relief", "--mesh", "box.obj", "--samples", "50", "--page",
                 lead("box.relief", "box.obj", "box.mtl")],
        lambda: ["relief", "export", "box.relief", "--mesh", lead("box.relief"), "--voxels", "16"],
        lambda: ["relief", "export", "box.relief", "--engine", "c", engine_folder()],
        lambda: recipe() + [random.choice(["--stamp", "--depfile"]),
                            lead("recipe.toml", "box.obj", "box.mtl", ".relief-cache.json",
                                 "baked/box.relief")],
        lambda: recipe() + ["--events", lead("recipe.toml", "box.obj", "box.mtl", ".relief-cache.json",
                                             "baked/box.relief")],
    ]

    def folder_with(file):
        name = fresh("")
        (arena.folder / name).mkdir()
        (arena.folder / name / file).symlink_to("../box.relief")
        return name

    def engine_folder():
        return folder_with(random.choice(["box.relief", "box.texels", "relief.glsl", "RELIEF.md"]))

    def maps_folder():
        return folder_with(random.choice(["view_+x.exr", "view_-z.exr"]))

    def recipe():
        (arena.folder / "baked").mkdir()
        return ["relief", "bake", "--recipe", "recipe.toml", "-q"]

    return random.choice(refused)(), True


def main():
    cases = Cases("overwrite", 120)
    with tempfile.TemporaryDirectory(prefix="relief-pristine-") as name:
        pristine = pathlib.Path(name)
        make_inputs(cases, pristine)
        for number, folder in cases.each():
            arena = Arena(cases, folder, pristine)
            make = sim_case if cases.random.random() < 0.6 else relief_case
            command, refused = make(arena, cases.random)
            done = cases.run(*command, cwd=folder)
            if done is None:
                continue
            text = " ".join(command)
            lost = arena.unchanged()
            cases.expect(lost is None, f"{lost} was overwritten: {text}")
            cases.expect(not refused or done.returncode == 1, f"exit code {done.returncode}, not 1: {text}: {done.stderr}")
            cases.expect(refused or done.returncode == 0, f"rejected: {text}: {done.stderr}")
            left = [path.name for path in folder.rglob(".relief-*") if path.name != ".relief-cache.json"]
            cases.expect(not left, f"left behind: {left}: {text}")
    cases.finish()


main()
