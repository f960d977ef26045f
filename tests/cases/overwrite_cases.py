"""Random outputs of both tools onto their inputs, through links, and onto each other: no input may change, no output
may be lost to another, and a refusal names what it refuses."""

import hashlib
import os
import pathlib
import re
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
every = 1
"""
DRAWN = """[collider]
file = "box.relief"
[render]
mesh = "box.obj"
"""
RECIPE = """version = 1
[[asset]]
mesh = "box.obj"
output = "baked/{stem}.relief"
plan = "plan.toml"
"""
# Commands that must be refused, whichever of these their output lands on: {.png} is a name with this ending that leads to it,
# {map.exr} a folder in which this file does.
MESH, PLANNED, MADE = "box.obj box.mtl", "box.obj plan.toml box.mtl", "recipe.toml box.obj plan.toml box.mtl .relief-cache.json baked/box.relief"
BAKE, MANY = "relief bake box.obj -q", "relief bake --recipe recipe.toml -q"
SCENE_FILES = "scene.toml box.relief live.obj points.csv flow.raw atlas.png"
SIMULATIONS = (("scene.toml", SCENE_FILES), ("drawn.toml", "drawn.toml box.relief box.obj"), ("box.relief", "box.relief"))
OUTPUTS = ("--dump {.ply}", "--events {.jsonl}", "--frames {frame_0000.png}", "--frames {frame_0002.png}",
           "--dump-frames {particles_0001.ply}")
REFUSED = [(f"relief-sim {scene} {output}", files) for scene, files in SIMULATIONS for output in OUTPUTS] + [
    (f"relief-sim {scene} {first} {second}", target) for scene, _ in SIMULATIONS for first, second, target in (
        ("--dump new", "--events {}", "new"), ("--events new", "--dump {}", "new"), ("--dump -", "--events /dev/fd/1", ""),
        ("--frames frames", "--dump ./frames", ""), ("--frames frames", "--events sub/../frames", ""))] + [
    (f"{BAKE} --map cube:size=8 -o {{}}", MESH), (f"{BAKE} --plan plan.toml -o {{}}", PLANNED),
    (f"{BAKE} --budget 9kB -o new --plan-out {{}}", MESH), (f"{BAKE} --plan plan.toml -o new --depfile {{}}", PLANNED),
    (f"{BAKE} --map cube:size=8 @args -o {{}}", "args"), (f"{BAKE} --map cube:size=8 -o new --depfile {{}}", "new"),
    (f"{BAKE} --map cube:size=8 -o - --json", ""),
    ("relief view box.relief --mesh box.obj -o {}", "box.relief " + MESH),
    ("relief export box.relief -o {map0_patches.exr}", "box.relief"),
    ("relief slice box.relief -o {.png}", "box.relief"),
    ("relief query box.relief --points points.csv -o {}", "box.relief points.csv"),
    ("relief check box.relief --mesh box.obj --samples 50 --html {}", "box.relief " + MESH),
    ("relief export box.relief --voxels 16 --mesh {}", "box.relief"),
    *((f"relief export box.relief --gpu {{{file}}}", "box.relief") for file in ("gpu.json", "block.bin", "collider.glsl")),
    *((f"{MANY} {option} {{}}", MADE) for option in ("--stamp", "--depfile", "--events"))]
ALLOWED = "relief-sim scene.toml --dump new --events other --dump-frames sub --steps 2"


def make_inputs(cases, folder):
    (folder / "box.obj").write_text(BOX)
    (folder / "live.obj").write_text(BOX)
    (folder / "box.mtl").write_text("newmtl a\nKd 1 0 0\n")
    (folder / "points.csv").write_text("0,2,0\n")
    (folder / "flow.raw").write_bytes(struct.pack("<24f", *range(24)))
    subprocess.run(["convert", "-size", "4x4", "xc:red", folder / "atlas.png"], check=True)
    (folder / "scene.toml").write_text(SCENE)
    (folder / "drawn.toml").write_text(DRAWN)
    (folder / "recipe.toml").write_text(RECIPE)
    (folder / "args").write_text("--json\n")
    made = cases.run("relief", "bake", "box.obj", "-o", "box.relief", "--budget", "20kB", "--no-check", "--plan-out",
                     "plan.toml", "-q", cwd=folder)
    assert made.returncode == 0, made.stderr


def lead(random, folder, target, name):
    """A name by which an output lands on `target`, which may be missing."""
    if name.startswith(".") or not name:
        how = random.choice(["same", "symbolic", "hard"])
        if how == "same" and target.endswith(name):
            return target
        path, back = folder / f"leads{name}", target
    else:
        how = random.choice(["symbolic", "hard"])
        (folder / "leads").mkdir()
        path, back = folder / "leads" / name, f"../{target}"
    if how == "hard" and (folder / target).is_file():
        os.link(folder / target, path)
    else:
        path.symlink_to(back)
    return path.relative_to(folder).parts[0]


def main():
    cases = Cases("overwrite", 120)
    with tempfile.TemporaryDirectory(prefix="relief-pristine-") as name:
        pristine = pathlib.Path(name)
        make_inputs(cases, pristine)
        for number, folder in cases.each():
            shutil.copytree(pristine, folder, dirs_exist_ok=True)
            before = {path: hashlib.sha256(path.read_bytes()).digest() for path in folder.iterdir()}
            (folder / "sub").mkdir()
            (folder / "baked").mkdir()
            command, targets = cases.random.choice(REFUSED) if number % 10 else (ALLOWED, "")
            target = cases.random.choice(targets.split() or [""])
            text = re.sub(r"\{(.*?)\}", lambda m: lead(cases.random, folder, target, m[1]), command)
            done = cases.run(*text.split(), cwd=folder)
            if done is None:
                continue
            for path, digest in before.items():
                kept = path.is_file() and hashlib.sha256(path.read_bytes()).digest() == digest
                cases.expect(kept, f"{path.name} is lost: {text}")
            wanted = 0 if command == ALLOWED else 1
            cases.expect(done.returncode == wanted, f"exit code {done.returncode}, not {wanted}: {text}, {target}: {done.stderr}")
            left = [path.name for path in folder.rglob(".relief-*") if path.name != ".relief-cache.json"]
            cases.expect(not left, f"left behind: {left}: {text}")
    cases.finish()


main()
