#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Random hierarchies of boxes as glTF, FBX, COLLADA and AC3D, with hidden nodes, levels of detail, instances, and instances of
missing objects. The collider matches a separate traversal, warnings count skipped objects, and `--hidden keep` bakes all objects.
As levels they have a body for each box, for any node names."""

import json
import re
from xml.sax.saxutils import quoteattr

from cases import Cases
from solids import BOX_FACES, Gltf, bake, box_corners, query

FORMATS = ("gltf", "fbx", "dae", "ac")
HALF = 0.5
FAR = 2.5  # distance between box centres
NAMES = ("props/chair", "../../up", "a\u202eb", "x" * 300, "", "same", "same", "two words", "quote\"", "tab\there", "<b>&amp;",
         "CON", "ünï", "line\nbreak", "~root", "$(id)", "-o", ".", "..", "\u2028", "%s%n", "\x1b[31m")
UNSAFE = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")


class Node:
    """place: relative to the parent, with a rotation of 0 or 90 degrees about y and a scale."""

    def __init__(self, random, parent):
        self.parent, self.children = parent, []
        self.turned = random.random() < 0.3
        self.scale = random.choice((1.0, 1.0, 1.0, 0.5, 2.0))
        self.at = [random.randint(-9, 9) for _ in range(3)]
        self.box = False
        self.hidden = False  # hides the node and its descendants
        self.unshown = False  # hides only the node
        self.levels = False  # children are levels of detail, the finest first
        self.loose = False  # does not inherit visibility
        self.copy_of = None
        self.name = ""

    def to_parent(self, p):
        x, y, z = (self.scale * c for c in p)
        return [c + d for c, d in zip(self.at, (z, y, -x) if self.turned else (x, y, z))]

    def place(self, p=(0, 0, 0)):
        p = self.to_parent(p)
        return self.parent.place(p) if self.parent else p


class Tree:
    def __init__(self, random, kind):
        self.random, self.kind = random, kind
        self.roots, self.all = [], []
        boxes = random.randint(3, 12)
        while boxes:
            parent = random.choice(self.all) if self.all and random.random() < 0.7 else None
            if parent and (parent.levels or self.depth(parent) > 4):
                continue
            node = Node(random, parent)
            if kind == "ac":
                node.scale = 1.0
            node.box = random.random() < 0.75
            if node.box and not self.is_free(node):
                continue
            self.add(node)
            boxes -= node.box
            if node.box:
                node.hidden = random.random() < 0.15
            else:
                node.hidden = random.random() < 0.3
            node.unshown = kind == "fbx" and random.random() < 0.15
            node.loose = kind == "fbx" and random.random() < 0.1
        if random.random() < 0.5 and kind in ("gltf", "fbx"):
            self.add_levels()
        self.copies = [self.copied() for _ in range(random.randint(0, 2))] if kind == "dae" else []
        for i, node in enumerate(self.all):
            node.name = f"n{i}"
        self.missing = random.randint(1, 3) if kind == "dae" and random.random() < 0.4 else 0

    @staticmethod
    def depth(node):
        return 1 + Tree.depth(node.parent) if node.parent else 0

    def centers(self):
        return [node.place() for node in self.all if node.box]

    def is_free(self, node):
        at = node.place()
        scale, up = 1.0, node
        while up:
            scale, up = scale * up.scale, up.parent
        return 0.4 < scale < 2.1 and all(max(abs(a - b) for a, b in zip(at, other)) > FAR for other in self.centers())

    def add(self, node):
        (node.parent.children if node.parent else self.roots).append(node)
        self.all.append(node)

    def add_levels(self):
        group = Node(self.random, None)
        group.scale, group.levels = 1.0, True
        count = self.random.randint(2, 3)
        for _ in range(200):
            levels = [Node(self.random, group) for _ in range(count)]
            for level in levels:
                level.box, level.scale = True, 1.0
            apart = all(max(abs(a - b) for a, b in zip(p.place(), q.place())) > FAR for p in levels for q in levels if p is not q)
            if apart and all(self.is_free(level) for level in levels):
                self.add(group)
                for level in levels:
                    self.add(level)
                return

    def copied(self):
        """A library node with a box, instanced once or twice."""
        node = Node(self.random, None)
        node.scale, node.box = 1.0, True
        return node

    def shown(self, node, keep):
        """Why a node's box is skipped: 'hidden', 'level' or None."""
        if keep:
            return None
        if node.unshown:
            return "hidden"
        while node:
            if node.hidden:
                return "hidden"
            if node.parent and node.parent.levels and node is not node.parent.children[0]:
                return "level"
            if node.loose:
                return None
            node = node.parent
        return None


# --- writers ---


def write_gltf(tree, path):
    gltf = Gltf()
    mesh = gltf.add_mesh(box_corners([HALF] * 3), BOX_FACES)
    index = {id(node): i for i, node in enumerate(tree.all)}
    for node in tree.all:
        entry = {"name": node.name, "translation": node.at, "scale": [node.scale] * 3}
        if node.turned:
            entry["rotation"] = [0, 0.5 ** 0.5, 0, 0.5 ** 0.5]
        if node.box:
            entry["mesh"] = mesh
        if node.hidden:
            entry["extensions"] = {"KHR_node_visibility": {"visible": False}}
        if node.children:
            entry["children"] = [index[id(child)] for child in node.children]
        gltf.document["nodes"].append(entry)
    for node in tree.all:
        if node.levels:  # MSFT_lod belongs to the finest level
            first, *rest = (index[id(child)] for child in node.children)
            gltf.document["nodes"][first].setdefault("extensions", {})["MSFT_lod"] = {"ids": rest}
    required = {"extensionsRequired": ["KHR_node_visibility"]} if tree.random.random() < 0.3 else {}
    gltf.write(path, scenes=[{"nodes": [index[id(node)] for node in tree.roots]}], **required)


def write_fbx(tree, path):
    out = ["; FBX 7.3.0 project file", "FBXHeaderExtension:  {", "FBXHeaderVersion: 1003", "FBXVersion: 7300", "}",
           "GlobalSettings:  {", "Version: 1000", "Properties70:  {", 'P: "UpAxis", "int", "Integer", "",1',
           'P: "UpAxisSign", "int", "Integer", "",1', 'P: "UnitScaleFactor", "double", "Number", "",100', "}", "}", "Objects:  {",
           'Geometry: 1000, "Geometry::b", "Mesh" {', "Vertices: *24 {",
           "a: " + ",".join(str(c) for p in box_corners([HALF] * 3) for c in p), "}", "PolygonVertexIndex: *24 {",
           "a: " + ",".join(str(c if i < 3 else -c - 1) for face in BOX_FACES for i, c in enumerate(face)), "}",
           "GeometryVersion: 124", "}"]
    links = []
    for i, node in enumerate(tree.all):
        number = 2000 + i
        kind = "Mesh" if node.box else "LodGroup" if node.levels else "Null"
        out += [f'Model: {number}, "Model::{node.name}", "{kind}" {{', "Version: 232", "Properties70:  {",
                'P: "Lcl Translation", "Lcl Translation", "", "A",%d,%d,%d' % tuple(node.at),
                'P: "Lcl Scaling", "Lcl Scaling", "", "A",%g,%g,%g' % ((node.scale,) * 3)]
        out += ['P: "Lcl Rotation", "Lcl Rotation", "", "A",0,90,0'] if node.turned else []
        out += ['P: "Visibility", "Visibility", "", "A",0'] if node.hidden else []
        out += ['P: "Show", "bool", "", "",0'] if node.unshown else []
        out += ['P: "Visibility Inheritance", "Visibility Inheritance", "", "",0'] if node.loose else []
        out += ["}", "}"]
        parent = 2000 + tree.all.index(node.parent) if node.parent else 0
        links += [f'C: "OO",{number},{parent}'] + ([f'C: "OO",1000,{number}'] if node.box else [])
    path.write_text("\n".join(out + ["}", "Connections:  {"] + links + ["}", ""]), encoding="utf-8")


def dae_node(tree, node, url='<instance_geometry url="#g"/>'):
    random = tree.random
    ids = random.choice(('id="{0}" name="{0}"', 'id="{0}"', 'sid="{0}"', 'name="{0}"', 'id="{0}" name="same"')).format(node.name)
    unseen = '<technique profile="FCOLLADA"><visibility>0.000000</visibility></technique>'
    other = '<technique profile="OTHER"><kind>1</kind></technique>'
    hidden = random.choice((f"<extra>{unseen}</extra>", f"<extra>{other}{unseen}</extra>",
                            f"<extra>{other}</extra><extra>{unseen}</extra>")) if node.hidden else ""
    return (f"<node {ids}><translate>{' '.join(map(str, node.at))}</translate>"
            + ("<rotate>0 1 0 90</rotate>" if node.turned else "") + f"<scale>{' '.join([str(node.scale)] * 3)}</scale>"
            + (url if node.box else "") + "".join(dae_node(tree, child) for child in node.children) + hidden + "</node>")


def write_dae(tree, path):
    corners = " ".join(str(c) for p in box_corners([HALF] * 3) for c in p)
    triangles = " ".join(str(c) for a, b, c, d in BOX_FACES for c in (a, b, c, a, c, d))
    library = '<node id="copy"><instance_geometry url="#g"/></node>' if tree.copies else ""
    scene = "".join(dae_node(tree, copy, '<instance_node url="#copy"/>') for copy in tree.copies)
    lost = [f'<node name="lost{i}"><instance_geometry url="#nothing{i}"/></node>' for i in range(tree.missing)]
    path.write_text(
        '<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>'
        '<unit meter="1"/><up_axis>Y_UP</up_axis></asset><library_geometries><geometry id="g"><mesh><source id="p">'
        f'<float_array id="a" count="24">{corners}</float_array><technique_common><accessor source="#a" count="8" stride="3">'
        '<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>'
        '</source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="12">'
        f'<input semantic="VERTEX" source="#v" offset="0"/><p>{triangles}</p></triangles></mesh></geometry></library_geometries>'
        f'<library_nodes>{library}</library_nodes><library_visual_scenes><visual_scene id="s">'
        + "".join(dae_node(tree, node) for node in tree.roots) + scene + "".join(lost) +
        '</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>', encoding="utf-8")


def write_ac(tree, path):
    out = ["AC3Db", 'MATERIAL "" rgb 1 1 1 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0', "OBJECT world",
           f"kids {len(tree.roots)}"]

    def put(node):
        out.extend(["OBJECT " + ("poly" if node.box else "group"), f'name "{node.name}"', "loc %d %d %d" % tuple(node.at)])
        if node.turned:  # the images of the axes
            out.append("rot 0 0 -1 0 1 0 1 0 0")
        if node.hidden:
            out.append("hidden")
        if node.box:
            out.append("numvert 8")
            out.extend("%g %g %g" % tuple(p) for p in box_corners([HALF] * 3))
            out.append(f"numsurf {len(BOX_FACES)}")
            for face in BOX_FACES:
                out.extend(["SURF 0x0", "refs 4"] + [f"{c} 0 0" for c in face])
        out.append(f"kids {len(node.children)}")
        for child in node.children:
            put(child)

    for root in tree.roots:
        put(root)
    path.write_text("\n".join(out) + "\n", encoding="utf-8")


WRITERS = {"gltf": write_gltf, "fbx": write_fbx, "dae": write_dae, "ac": write_ac}


# --- the comparison ---


def check_warnings(cases, tree, stderr, left_out):
    for reason, words in (("hidden", r"left out (\d+) hidden object"), ("level", r"left out (\d+) lower level")):
        said = re.search(words, stderr)
        count = left_out.count(reason)
        cases.expect((int(said[1]) if said else 0) == count, f"{count} boxes are skipped ({reason}), but the output is: {stderr}")
    if tree.missing:
        said = re.search(r"'#nothing\d'.*?(?:and (\d+) more)?$", stderr, re.MULTILINE | re.DOTALL)
        more = re.search(r"and (\d+) more like it", stderr)
        cases.expect(said and 1 + int(more[1] if more else 0) == tree.missing, f"{tree.missing} instances are missing: {stderr}")


def check_tree(cases, folder, kind):
    random = cases.random
    tree = Tree(random, kind)
    tree.copies = [node for node in tree.copies if tree.is_free(node) and (tree.all.append(node) or True)]
    for i, node in enumerate(tree.copies):
        node.name = f"c{i}"
    file = f"a.{kind}"
    WRITERS[kind](tree, folder / file)
    boxes = [node for node in tree.all if node.box]
    for keep in (False, True):
        reasons = [tree.shown(node, keep) for node in boxes]
        if None not in reasons:
            done = cases.run("relief", "bake", file, "-o", "a.relief", "-q", cwd=folder)
            cases.expect(done and done.returncode == 3 and "--hidden keep" in done.stderr, f"everything is hidden: {done}")
            continue
        options = ["--hidden", "keep"] if keep else []
        done = bake(cases, folder, file, "-o", "a.relief", "--budget", "256kB", "--no-check", "--warnings-only", *options)
        rows = done and query(cases, folder, "a.relief", [node.place() for node in boxes], "--distance", "plane")
        if not rows:
            return
        for node, row, reason in zip(boxes, rows, reasons):
            cases.expect((row[3] < 0) == (reason is None), f"{kind}, keep {keep}: the box at {node.place()} ({node.name}) is "
                         f"{'baked' if row[3] < 0 else 'not baked'}; it is {reason or 'shown'}")
        check_warnings(cases, tree, done.stderr, reasons)
        done = None if keep else bake(cases, folder, file, "--world", "w", "--budget", "256kB", "-q")
        if done:
            bodies = json.loads((folder / "w/world.json").read_text())["bodies"]
            cases.expect(len(bodies) == reasons.count(None), f"{kind}: {len(bodies)} bodies of {reasons.count(None)}")


def check_names(cases, folder):
    """A level of boxes in a row, whose nodes and meshes have unusual names."""
    random = cases.random
    names = [random.choice(NAMES) + random.choice(("", "", ".001")) for _ in range(random.randint(2, 8))]
    gltf = Gltf()
    for i, name in enumerate(names):
        mesh = gltf.add_mesh(box_corners([HALF + 0.01 * i, HALF, HALF]), BOX_FACES)
        gltf.document["meshes"][mesh]["name"] = random.choice((name, random.choice(NAMES)))
        gltf.document["nodes"].append({"name": name, "mesh": mesh, "translation": [3 * i, 0, 0]})
    gltf.write(folder / "a.gltf", scenes=[{"nodes": list(range(len(names)))}])
    done = bake(cases, folder, "a.gltf", "--world", "w", "--budget", "256kB", "--no-check")
    if not done:
        return
    world = json.loads((folder / "w/world.json").read_text(encoding="utf-8"))
    texts = [done.stdout, done.stderr]
    cases.expect(len(world["bodies"]) == len(names), f"{len(world['bodies'])} bodies of {names}")
    for file in sorted(path.name for path in (folder / "w").rglob("*")):
        cases.expect(re.fullmatch(r"[^/\x00-\x1f\u202a-\u202e\u2066-\u2069]{1,255}", file), f"file {file!r}")
    cases.expect(sorted(path.name for path in folder.iterdir()) == ["a.gltf", "w"], f"unexpected files: {names}")
    for command in (["check"], ["info"], ["check", "--mesh", "a.gltf"]):
        checked = cases.run("relief", command[0], "w/world.json", *command[1:], cwd=folder)
        cases.expect(checked and checked.returncode == 0, f"{command} of {names}: {checked and checked.stderr}")
        texts += [checked.stdout, checked.stderr] if checked else []
    cases.expect(not any(UNSAFE.search(text) for text in texts), f"control characters in the output: {names}")
    rows = query(cases, folder, "w/world.json", [(3 * i, 0, 0) for i in range(len(names))])
    cases.expect(rows and all(row[3] < 0 for row in rows), f"a body is missing: {names}")


def main():
    cases = Cases("trees", 20)
    for number, folder in cases.each():
        kind = (*FORMATS, "names")[number % 5]
        check_names(cases, folder) if kind == "names" else check_tree(cases, folder, kind)
    cases.finish()


main()
