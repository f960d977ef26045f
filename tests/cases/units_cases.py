"""Boxes of random units, axes and placements in every format that states any: the collider's size in metres is known in
closed form. Files that state what cannot be are refused with the option that helps, and read with it."""

import json
import math

import cases
import unit_files as files

UNITS = {"m": 1, "cm": 0.01, "mm": 0.001, "um": 1e-6, "km": 1000, "in": 0.0254, "ft": 0.3048, "yd": 0.9144}
UP = {"+x": lambda p: (-p[1], p[0], p[2]), "-x": lambda p: (p[1], -p[0], p[2]), "+y": files.AS_IS,
      "-y": lambda p: (p[0], -p[1], -p[2]), "+z": files.Z_UP, "-z": lambda p: (p[0], -p[2], p[1])}


def bounds(points):
    return [f(p[axis] for p in points) for f in (min, max) for axis in range(3)]


class Units(cases.Cases):
    def box(self):
        low = [self.random.uniform(-20, 20) for _ in range(3)]
        return (tuple(low), tuple(v + self.random.uniform(0.5, 30) for v in low))

    def bake(self, path, *options):
        """Its bounds and its unit, or None for an error, which has been checked to be one line with the file's name."""
        container = path.parent / "box.relief"
        done = self.run("relief", "bake", path, "-o", container, "--map", "fixed8:size=128", "-q", *options)
        if done is None:
            return None
        if done.returncode != 0:
            self.expect(path.name in done.stderr and done.stderr.count("\n") == 1, f"not one line: {done.stderr}")
            return done
        info = json.loads(self.run("relief", "info", container, "--json").stdout)
        return info["bounds"]["min"] + info["bounds"]["max"], info["unit"]

    def expect_box(self, path, points, unit, *options):
        """`points`: where the corners are to lie, in metres if the unit is "m"."""
        baked = self.bake(path, *options)
        if not self.expect(isinstance(baked, tuple), f"{path.name} {options} is refused: {baked}"):
            return
        wanted = bounds(points)
        room = 1e-5 * max(map(abs, wanted))
        self.expect(all(abs(a - b) <= room for a, b in zip(baked[0], wanted)) and baked[1] == unit,
                    f"{path.name} {options}: {baked} instead of {wanted} '{unit}'")

    def expect_refused(self, path, cure):
        done = self.bake(path)
        self.expect(done is not None and not isinstance(done, tuple) and done.returncode == 3 and cure in done.stderr,
                    f"{path.name} is not refused with '{cure}': {getattr(done, 'stderr', done)}")

    def told(self, path, points, metres, axes=files.AS_IS, up="+y"):
        """With and without --unit and --up. `metres`: what the file says, or None. `axes`: where the file's (x, y, z) lies
        if it is read as it is; `up`: which axis of the file that brings up, or None where --up is taken on top."""
        def placed(turn, scale):
            return [tuple(scale * v for v in turn(p)) for p in points]

        self.expect_box(path, placed(axes, metres or 1), "m" if metres else "")
        unit = self.random.choice(list(UNITS))
        self.expect_box(path, placed(axes, UNITS[unit]), "m", "--unit", unit)
        axis = self.random.choice(list(UP))
        turn = UP[axis]
        if axes is files.Z_MIRRORED:
            # The file's axis, in a right-handed frame.
            seen = {"+z": "-z", "-z": "+z"}.get(axis, axis)
            turn = lambda p: UP[seen](files.Z_MIRRORED(p))
        self.expect_box(path, placed(turn, metres or 1), "m" if metres else "", "--up", axis)


def main():
    run = Units("units", 100)
    kinds = [dae, fbx, three_ds, left_handed, nothing, wrong, commas]
    for number, folder in run.each():
        kinds[number % len(kinds)](run, folder)
    run.finish()


def write(folder, name, data):
    path = folder / name
    path.write_bytes(data)
    return path


def dae(run, folder):
    box = run.box()
    metres = run.random.choice((None, 1, 0.01, 0.0254, 1000, run.random.uniform(0.001, 3)))
    axis, turn = run.random.choice([(None, files.AS_IS), ("Y_UP", files.AS_IS), ("Z_UP", files.Z_UP), ("X_UP", UP["+x"])])
    number = run.random.choice((repr, files.comma))
    asset = "" if metres is None else f'<unit name="u" meter="{number(metres)}"/>'
    asset += "" if axis is None else f"<up_axis>{axis}</up_axis>"
    if run.random.random() < 0.5:
        asset = f"<asset xmlns='u'><!-- <unit meter='7'/> --><created/>{asset}</asset>"
    run.told(write(folder, "a.dae", files.dae(box, asset)), files.corners(box), metres or 1, turn)


def fbx(run, folder):
    box = run.box()
    factor = run.random.choice((None, 1, 2.54, 100, 100000, run.random.uniform(0.1, 300)))
    axis = run.random.randrange(3)
    sign = run.random.choice((1, -1))
    data = files.fbx(box, None if factor is None else repr(factor), axis, sign)
    run.told(write(folder, "a.fbx", data), files.corners(box), 0.01 * (factor or 1),
             UP[("+" if sign > 0 else "-") + "xyz"[axis]])


def three_ds(run, folder):
    box = run.box()
    scale = run.random.choice((None, 1, 0.5, 2, run.random.uniform(0.1, 10)))
    points = [tuple(v / (scale or 1) for v in p) for p in files.corners(box)]
    run.told(write(folder, "a.3ds", files.three_ds(box, scale)), points, None, files.Z_UP)


def left_handed(run, folder):
    name = run.random.choice(("x", "b3d", "lwo"))
    box = run.box()
    run.told(write(folder, "a." + name, getattr(files, name)(box)), files.corners(box), None, files.Z_MIRRORED)


def nothing(run, folder):
    name = run.random.choice(("obj", "smd", "ms3d"))
    box = run.box()
    run.told(write(folder, "a." + name, getattr(files, name)(box)), files.corners(box), None)


def wrong(run, folder):
    """Units that cannot be meant: refused, and read with --unit."""
    box = run.box()
    number = run.random.choice(("-1", "0", "nan", "inf", "0,0,1", "-100", "1e999"))
    name, data = run.random.choice([
        ("a.dae", files.dae(box, f'<unit meter="{number}"/>')),
        ("a.fbx", files.fbx(box, run.random.choice(("-100", "nan", "-1e-9")))),
        ("a.3ds", files.three_ds(box, run.random.choice((-1.0, float("nan"), float("inf"), -0.5))))])
    path = write(folder, name, data)
    run.expect_refused(path, "--unit")
    unit = run.random.choice(list(UNITS))
    turn = files.Z_UP if name == "a.3ds" else files.AS_IS
    run.expect_box(path, [tuple(UNITS[unit] * v for v in turn(p)) for p in files.corners(box)], "m", "--unit", unit)


def commas(run, folder):
    """Decimal commas: read as points, or refused; never cut off."""
    box = run.box()
    name = run.random.choice(("dae", "smd"))
    path = write(folder, "a." + name, getattr(files, name)(box, number=files.comma))
    baked = run.bake(path)
    if isinstance(baked, tuple):
        wanted = bounds(files.corners(box))
        room = 1e-5 * max(map(abs, wanted))
        run.expect(all(abs(a - b) <= room for a, b in zip(baked[0], wanted)), f"{path.name}: {baked} instead of {wanted}")
    else:
        run.expect(baked is not None and baked.returncode == 3 and "comma" in baked.stderr,
                   f"{path.name}: no word of the comma: {getattr(baked, 'stderr', baked)}")


if __name__ == "__main__":
    main()
