"""Boxes in mesh formats, with the units, axes and placements that these can state. Each function returns a file's bytes.

A box is a pair of corners, the lower one first. Numbers are written by `number`, such as comma().
"""

import struct

QUADS = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
TRIANGLES = [corner for a, b, c, d in QUADS for corner in ((a, b, c), (a, c, d))]


def corners(box):
    """Of the box, corner i with the higher x, y and z by the bits 0, 1 and 2 of i."""
    return [tuple(box[i >> axis & 1][axis] for axis in range(3)) for i in range(8)]


def comma(value):
    return repr(float(value)).replace(".", ",")


def lines(points, number):
    return "".join(" ".join(map(number, point)) + "\n" for point in points)


def dae(box, asset="", number=repr):
    positions = " ".join(number(v) for p in corners(box) for v in p)
    params = "".join(f'<param name="{axis}" type="float"/>' for axis in "XYZ")
    return ('<?xml version="1.0" encoding="utf-8"?>\n<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" '
            f'version="1.4.1">{asset if asset.startswith("<asset") else f"<asset>{asset}</asset>"}<library_geometries>'
            f'<geometry id="g"><mesh><source id="p"><float_array id="a" count="24">{positions}</float_array>'
            f'<technique_common><accessor source="#a" count="8" stride="3">{params}</accessor></technique_common></source>'
            '<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="12"><input '
            f'semantic="VERTEX" source="#v" offset="0"/><p>{" ".join("%d %d %d" % t for t in TRIANGLES)}</p></triangles>'
            '</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">'
            '<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene '
            'url="#s"/></scene></COLLADA>\n').encode()


def fbx(box, unit="1", up="1", sign="1", number=repr):
    """In text. `unit`: what stands as UnitScaleFactor; None: nothing does."""
    whole = '"int", "Integer"'
    settings = f'P: "UpAxis", {whole}, "",{up}\nP: "UpAxisSign", {whole}, "",{sign}\n'
    settings += "" if unit is None else f'P: "UnitScaleFactor", "double", "Number", "",{unit}\n'
    polygons = ",".join("%d,%d,%d" % (a, b, -c - 1) for a, b, c in TRIANGLES)
    return ("; FBX 7.3.0 project file\nFBXHeaderExtension:  {\nFBXHeaderVersion: 1003\nFBXVersion: 7300\n}\n"
            f"GlobalSettings:  {{\nVersion: 1000\nProperties70:  {{\n{settings}}}\n}}\nObjects:  {{\n"
            'Geometry: 1000, "Geometry::t", "Mesh" {\nVertices: *24 {\na: '
            f'{",".join(number(v) for p in corners(box) for v in p)}\n}}\nPolygonVertexIndex: *36 {{\na: {polygons}\n}}\n'
            'GeometryVersion: 124\n}\nModel: 2000, "Model::t", "Mesh" {\nVersion: 232\nProperties70:  {\n}\n}\n}\n'
            'Connections:  {\nC: "OO",2000,0\nC: "OO",1000,2000\n}\n').encode()


def three_ds(box, master_scale=None):
    def chunk(name, data):
        return struct.pack("<HI", name, len(data) + 6) + data

    mesh = chunk(0x4110, struct.pack("<H", 8) + b"".join(struct.pack("<3f", *p) for p in corners(box)))
    mesh += chunk(0x4120, struct.pack("<H", 12) + b"".join(struct.pack("<4H", *t, 0) for t in TRIANGLES))
    scale = b"" if master_scale is None else chunk(0x0100, struct.pack("<f", master_scale))
    return chunk(0x4D4D, chunk(0x3D3D, scale + chunk(0x4000, b"t\0" + chunk(0x4100, mesh))))


def x(box):
    points = ",\n".join(";".join(map(repr, p)) + ";" for p in corners(box))
    return (f"xof 0303txt 0032\nMesh box {{\n8;\n{points};\n12;\n" + ",\n".join("3;%d,%d,%d;" % t for t in TRIANGLES)
            + ";\n}\n").encode()


def b3d(box):
    def chunk(name, data):
        return name + struct.pack("<I", len(data)) + data

    vertices = chunk(b"VRTS", struct.pack("<3i", 0, 0, 0) + b"".join(struct.pack("<3f", *p) for p in corners(box)))
    triangles = chunk(b"TRIS", struct.pack("<i", -1) + b"".join(struct.pack("<3i", *t) for t in TRIANGLES))
    mesh = chunk(b"MESH", struct.pack("<i", -1) + vertices + triangles)
    place = struct.pack("<10f", 0, 0, 0, 1, 1, 1, 1, 0, 0, 0)
    return chunk(b"BB3D", struct.pack("<i", 1) + chunk(b"NODE", b"b\0" + place + mesh))


def lwo(box):
    def chunk(name, data):
        return name + struct.pack(">I", len(data)) + data + b"\0" * (len(data) % 2)

    polygons = b"FACE" + b"".join(struct.pack(">4H", 3, *t) for t in TRIANGLES)
    body = b"LWO2" + chunk(b"TAGS", b"Default\0") + chunk(b"LAYR", struct.pack(">HH3f", 0, 0, 0, 0, 0) + b"\0\0")
    body += chunk(b"PNTS", b"".join(struct.pack(">3f", *p) for p in corners(box))) + chunk(b"POLS", polygons)
    body += chunk(b"PTAG", b"SURF" + b"".join(struct.pack(">HH", i, 0) for i in range(12)))
    return b"FORM" + struct.pack(">I", len(body) + 18) + body + chunk(b"SURF", b"Default\0\0\0")


def ms3d(box):
    vertices = struct.pack("<H", 8) + b"".join(struct.pack("<B3fbB", 0, *p, -1, 0) for p in corners(box))
    triangles = struct.pack("<H", 12) + b"".join(
        struct.pack("<H3H9f3f3fBB", 0, *t, *[0, 0, 1] * 3, 0, 0, 0, 0, 0, 0, 1, 0) for t in TRIANGLES)
    groups = struct.pack("<H", 1) + struct.pack("<B32sH", 0, b"g", 12) + struct.pack("<12Hb", *range(12), -1)
    return (b"MS3D000000" + struct.pack("<i", 4) + vertices + triangles + groups + struct.pack("<H", 0)
            + struct.pack("<ffI", 24, 1, 0) + struct.pack("<H", 0))


def smd(box, number=repr):
    points = corners(box)
    triangles = "".join("mat\n" + "".join("0 %s 0 0 1 0 0\n" % " ".join(map(number, points[i])) for i in t)
                        for t in TRIANGLES)
    return ('version 1\nnodes\n0 "root" -1\nend\nskeleton\ntime 0\n0 0 0 0 0 0 0\nend\ntriangles\n'
            f"{triangles}end\n").encode()


def obj(box):
    points = "".join("v " + line + "\n" for line in lines(corners(box), repr).splitlines())
    return (points + "".join("f %d %d %d\n" % (a + 1, b + 1, c + 1) for a, b, c in TRIANGLES)).encode()


# What each format states of its axes: where the source's point (x, y, z) lies after the import.
AS_IS = lambda p: p
Z_UP = lambda p: (p[0], p[2], -p[1])
Z_MIRRORED = lambda p: (p[0], p[1], -p[2])
