"""Boxes of random units and axes in formats that the unit tests of bake/import do not write: the collider's size in metres is
known in closed form. Decimal commas are read as points or refused, never cut off."""

import json
import struct

import cases

UNITS = {"m": 1, "cm": 0.01, "mm": 0.001, "um": 1e-6, "km": 1000, "in": 0.0254, "ft": 0.3048, "yd": 0.9144}
UP = {"+x": lambda p: (-p[1], p[0], p[2]), "-x": lambda p: (p[1], -p[0], p[2]), "+y": lambda p: p,
      "-y": lambda p: (p[0], -p[1], -p[2]), "+z": lambda p: (p[0], p[2], -p[1]), "-z": lambda p: (p[0], -p[2], p[1])}
QUADS = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
TRIANGLES = [corner for a, b, c, d in QUADS for corner in ((a, b, c), (a, c, d))]


def comma(value):
    return repr(float(value)).replace(".", ",")


def dae(points, number=repr):
    params = "".join(f'<param name="{axis}" type="float"/>' for axis in "XYZ")
    return ('<?xml version="1.0" encoding="utf-8"?>\n<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" '
            'version="1.4.1"><asset/><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="24">'
            f'{" ".join(number(v) for p in points for v in p)}</float_array>'
            f'<technique_common><accessor source="#a" count="8" stride="3">{params}</accessor></technique_common></source>'
            '<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="12"><input '
            f'semantic="VERTEX" source="#v" offset="0"/><p>{" ".join("%d %d %d" % t for t in TRIANGLES)}</p></triangles>'
            '</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">'
            '<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene '
            'url="#s"/></scene></COLLADA>\n').encode()


def smd(points, number=repr):
    triangles = "".join("mat\n" + "".join("0 %s 0 0 1 0 0\n" % " ".join(map(number, points[i])) for i in t) for t in TRIANGLES)
    return ('version 1\nnodes\n0 "root" -1\nend\nskeleton\ntime 0\n0 0 0 0 0 0 0\nend\ntriangles\n'
            f"{triangles}end\n").encode()


def ms3d(points):
    vertices = struct.pack("<H", 8) + b"".join(struct.pack("<B3fbB", 0, *p, -1, 0) for p in points)
    triangles = struct.pack("<H", 12) + b"".join(
        struct.pack("<H3H9f3f3fBB", 0, *t, *[0, 0, 1] * 3, 0, 0, 0, 0, 0, 0, 1, 0) for t in TRIANGLES)
    groups = struct.pack("<H", 1) + struct.pack("<B32sH", 0, b"g", 12) + struct.pack("<12Hb", *range(12), -1)
    return (b"MS3D000000" + struct.pack("<i", 4) + vertices + triangles + groups + struct.pack("<H", 0)
            + struct.pack("<ffI", 24, 1, 0) + struct.pack("<H", 0))


def x(points):
    return ("xof 0303txt 0032\nMesh box {\n8;\n" + ",\n".join(";".join(map(repr, p)) + ";" for p in points) + ";\n12;\n"
            + ",\n".join("3;%d,%d,%d;" % t for t in TRIANGLES) + ";\n}\n").encode()


def b3d(points):
    def chunk(name, data):
        return name + struct.pack("<I", len(data)) + data

    vertices = chunk(b"VRTS", struct.pack("<3i", 0, 0, 0) + b"".join(struct.pack("<3f", *p) for p in points))
    triangles = chunk(b"TRIS", struct.pack("<i", -1) + b"".join(struct.pack("<3i", *t) for t in TRIANGLES))
    mesh = chunk(b"MESH", struct.pack("<i", -1) + vertices + triangles)
    place = struct.pack("<10f", 0, 0, 0, 1, 1, 1, 1, 0, 0, 0)
    return chunk(b"BB3D", struct.pack("<i", 1) + chunk(b"NODE", b"b\0" + place + mesh))


def lwo(points):
    def chunk(name, data):
        return name + struct.pack(">I", len(data)) + data + b"\0" * (len(data) % 2)

    polygons = b"FACE" + b"".join(struct.pack(">4H", 3, *t) for t in TRIANGLES)
    body = b"LWO2" + chunk(b"TAGS", b"Default\0") + chunk(b"LAYR", struct.pack(">HH3f", 0, 0, 0, 0, 0) + b"\0\0")
    body += chunk(b"PNTS", b"".join(struct.pack(">3f", *p) for p in points)) + chunk(b"POLS", polygons)
    body += chunk(b"PTAG", b"SURF" + b"".join(struct.pack(">HH", i, 0) for i in range(12)))
    return b"FORM" + struct.pack(">I", len(body) + 18) + body + chunk(b"SURF", b"Default\0\0\0")


class Units(cases.Cases):
    def bake(self, path, *options):
        """Bounds and unit, or the failed process: one line with the file's name."""
        container = path.parent / "box.relief"
        done = self.run("relief", "bake", path, "-o", container, "--map", "fixed8:size=16", "-q", *options)
        if done is None or done.returncode != 0:
            self.expect(done is None or (path.name in done.stderr and done.stderr.count("\n") == 1), f"not one line: {done}")
            return done
        info = json.loads(self.run("relief", "info", container, "--json").stdout)
        return info["bounds"]["min"] + info["bounds"]["max"], info["unit"]

    def expect_box(self, baked, points, unit):
        wanted = [f(p[axis] for p in points) for f in (min, max) for axis in range(3)]
        room = 1e-5 * max(map(abs, wanted))
        self.expect(isinstance(baked, tuple) and all(abs(a - b) <= room for a, b in zip(baked[0], wanted)) and baked[1] == unit,
                    f"{baked} instead of {wanted} '{unit}'")


def main():
    run = Units("units", 70)
    kinds = [smd, ms3d, x, b3d, lwo, dae, smd]
    for number, folder in run.each():
        kind = kinds[number % len(kinds)]
        low = [run.random.uniform(-20, 20) for _ in range(3)]
        high = [v + run.random.uniform(0.5, 30) for v in low]
        points = [tuple((high if i >> axis & 1 else low)[axis] for axis in range(3)) for i in range(8)]
        path = folder / f"a.{kind.__name__}"
        if number % len(kinds) >= 5:
            path.write_bytes(kind(points, comma))
            baked = run.bake(path)
            if isinstance(baked, tuple):
                run.expect_box(baked, points, baked[1])
            else:
                run.expect(baked is not None and baked.returncode == 3 and "comma" in baked.stderr, f"no word of the comma: {baked}")
            continue
        path.write_bytes(kind(points))
        # x, b3d and lwo are left-handed: z is turned round.
        mirrored = kind in (x, b3d, lwo)
        seen = [(p[0], p[1], -p[2]) for p in points] if mirrored else points
        run.expect_box(run.bake(path), seen, "")
        unit = run.random.choice(list(UNITS))
        run.expect_box(run.bake(path, "--unit", unit), [tuple(UNITS[unit] * v for v in p) for p in seen], "m")
        axis = run.random.choice(list(UP))
        turn = UP[{"+z": "-z", "-z": "+z"}.get(axis, axis) if mirrored else axis]
        run.expect_box(run.bake(path, "--up", axis), [turn(p) for p in seen], "")
    run.finish()


if __name__ == "__main__":
    main()
