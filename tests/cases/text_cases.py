# SPDX-License-Identifier: Apache-2.0
"""Random valid files of the text formats, in the styles found in practice: relief-import must read the polygons that were written.
Every fourth case is a file with one damaged word, which must be rejected with its line.

    text_cases.py BIN [--seed N] [--cases N]      by default 200 files of each format
"""

import fcntl
import os
import re
import struct
import subprocess

import cases

FORMATS = ["obj", "off", "stl"]


# --- the tool ---


def answer_of(data):
    """The result of relief-import (bake/import/import_protocol.h): triangles as three positions each, or an error message."""
    at = 4

    def take(size):
        nonlocal at
        at += size
        return data[at - size : at]

    def length():
        return struct.unpack("<Q", take(8))[0]

    def text():
        return take(length()).decode()

    def threes(kind):
        return list(struct.iter_unpack(kind, take(12 * length())))

    if any(data[:4]):
        return text()
    text()  # the unit
    length()  # unused vertices
    for _ in range(3):  # warnings, files, their hashes
        for _ in range(length()):
            text()
    for _ in range(length()):  # surface names, with restitution and friction
        take(4)
        text()
        text()
        take(8)
    positions = threes("<3f")
    return [[positions[k] for k in t] for t in threes("<3I")]


def imported(run, path):
    """Runs relief-import like importMeshInWorker() (bake/import/import_protocol.h)."""
    mesh = os.memfd_create("mesh")
    os.write(mesh, path.read_bytes())
    result = os.memfd_create("result", os.MFD_ALLOW_SEALING)
    os.ftruncate(result, 1 << 26)
    folder = os.open(path.parent, os.O_PATH)
    alive, alive_end = os.pipe()
    files = [fcntl.fcntl(file, fcntl.F_DUPFD, 30) for file in (mesh, folder, result, alive_end)]

    def place():
        for number, file in enumerate(files, 3):
            os.dup2(file, number)

    command = [run.bin / "relief-import", path, str(1 << 30), "20", "1000000", "mesh", "names"]
    done = subprocess.run(command, preexec_fn=place, pass_fds=(3, 4, 5, 6), timeout=60)
    answer = None
    if run.expect(done.returncode == 0, f"relief-import ended with {done.returncode}"):
        answer = answer_of(os.pread(result, os.fstat(result).st_size, 0))
    for file in (mesh, result, folder, alive, alive_end, *files):
        os.close(file)
    return answer


# --- random files ---


class Writer:
    def __init__(self, random):
        self.random = random
        self.end = random.choice(["\n", "\r\n", "\r", None])  # None: mixed
        self.words = []  # positions of the numbers in the text, to damage one of them
        self.text = ""

    def blank(self, least=1):
        return "".join(self.random.choice(" \t") for _ in range(self.random.choice([least] * 5 + [2, 4])))

    def put(self, text):
        self.text += text

    def newline(self, comment=None):
        if comment and self.random.random() < 0.2:
            self.put(self.blank(0) + comment + self.random.choice(["", " a note", " 1 2 3"]))
        self.put(self.blank(0) if self.random.random() < 0.2 else "")
        self.put(self.end or self.random.choice(["\n", "\r\n", "\r"]))

    def indent(self):
        self.put(self.blank() if self.random.random() < 0.2 else "")

    def number(self, value):
        """A decimal number in a random notation."""
        text = self.random.choice(["%.6f", "%.3f", "%g", "%.9g", "%e", "%.2E"]) % value
        mantissa, exponent = re.match(r"([-+.\d]+)(.*)", text).groups()
        if self.random.random() < 0.3 and "." in mantissa:
            mantissa = mantissa.rstrip("0")
        if self.random.random() < 0.3:
            mantissa = re.sub(r"^(-?)0\.(?=\d)", r"\1.", mantissa)
        if self.random.random() < 0.2 and "." not in mantissa:
            mantissa += "."
        plus = "+" if value >= 0 and not mantissa.startswith("-") and self.random.random() < 0.1 else ""
        return plus + mantissa + exponent

    def word(self, word):
        self.words.append((len(self.text), len(word)))
        self.put(word)

    def numbers(self, values, between=None):
        """Returns the values after rounding."""
        written = [self.number(value) for value in values]
        for i, word in enumerate(written):
            if i:
                self.put((between or self.blank)())
            self.word(word)
        return [float(word) for word in written]


def polygons_of(random, most):
    """Vertices, and flat convex polygons as lists of indices; some far from the origin. The writers below return the expected
    polygons as lists of positions."""
    vertices, polygons = [], []
    far = random.choice([0, 0, 10, 1.4e5])
    for _ in range(random.randint(1, 12)):
        count = random.randint(3, most)
        centre = [random.uniform(-1, 1) * (far or 1) for _ in range(3)]
        size = max(1.0, far / 100) * random.uniform(0.5, 2)
        axes = random.sample(range(3), 2)
        begin = len(vertices)
        for i in range(count):
            # On a parabola, which is convex without trigonometry.
            at = list(centre)
            at[axes[0]] += size * i
            at[axes[1]] += size * i * i
            vertices.append(at)
        polygons.append(list(range(begin, begin + count)))
    return vertices, polygons


def write_obj(w, vertices, polygons):
    def gap():
        return w.random.choice([w.blank()] * 9 + [" \\" + (w.end or "\n") + w.blank(0)])

    written = []
    w.put(w.random.choice(["", "\ufeff", "# by hand" + (w.end or "\n")]))
    for polygon in polygons:
        while len(written) <= max(polygon):
            w.indent()
            w.put("v" + w.blank())
            row = w.numbers(vertices[len(written)] + w.random.choice([[], [], [1.0], [0.5], [0.5, 0.25, 1.0]]), gap)
            written.append([x / row[3] for x in row[:3]] if len(row) == 4 else row[:3])
            w.newline("#")
        if w.random.random() < 0.3:
            w.put(w.random.choice(["g a b # c", "o thing", "usemtl red", "s off", "vt .5 .5", "vn 0 0 1", ""]))
            w.newline()
        w.indent()
        w.put("f")
        back = w.random.random() < 0.4
        for corner in polygon:
            w.put(gap())
            w.word(str(corner - len(written) if back else corner + 1))
            w.put(w.random.choice(["", "", "/1", "//1", "/1/1"]))
        w.newline("#")
    return [[written[corner] for corner in polygon] for polygon in polygons]


def write_off(w, vertices, polygons):
    name = w.random.choice(["OFF", "off", "COFF", "NOFF", "CNOFF", "STOFF", "STCNOFF"])
    w.put(name)
    w.newline("#") if w.random.random() < 0.7 else w.put(w.blank())
    w.put(f"{len(vertices)}{w.blank()}{len(polygons)}{w.blank()}0")
    w.newline("#")
    more = 3 * ("N" in name) + 4 * ("C" in name) + 2 * ("ST" in name)
    written = []
    for vertex in vertices:
        w.indent()
        written.append(w.numbers(vertex + [0.5] * more)[:3])
        w.newline("#")
    for polygon in polygons:
        w.indent()
        w.put(str(len(polygon)))
        for corner in polygon:
            w.newline("#") if w.random.random() < 0.05 else w.put(w.blank())
            w.word(str(corner))
        w.put(w.random.choice(["", "", " 255 0 0", " .5 .5 .5 1"]))
        w.newline("#")
    return [[written[corner] for corner in polygon] for polygon in polygons]


def write_stl(w, vertices, polygons):
    case = w.random.choice([str, str, str.upper, str.capitalize])
    loose = w.random.random() < 0.3

    def gap():
        return w.random.choice([" ", "\n", "\t\r\n"]) if loose else w.blank()

    def line():
        w.put(gap()) if loose else w.newline()

    def word(name, after=line):
        w.put(w.blank(0) + case(name))
        after()

    written = []
    w.put(case("solid") + w.random.choice(["", " thing", " vertex of facets", " a b c"]))
    w.newline()
    for polygon in polygons:
        if w.random.random() < 0.1:
            w.put(case("endsolid"))
            w.newline()
            w.put(case("solid") + " vertex 1 2 3")
            w.newline()
        word("facet", lambda: w.put(gap() + case("normal") + gap()))
        w.put(w.random.choice(["0 0 1", "nan nan nan", "-nan(ind) 1.#QNAN 0", "1e-3 .5 -.5"]))
        line()
        word("outer", lambda: w.put(gap() + case("loop")))
        line()
        written.append([])
        for corner in polygon:
            word("vertex", lambda: w.put(gap()))
            written[-1].append(w.numbers(vertices[corner], gap))
            line()
        word("endloop")
        word("endfacet")
    w.newline()
    w.put(case("endsolid") + w.random.choice(["", " thing"]))
    w.newline()
    return written


WRITERS = {"obj": write_obj, "off": write_off, "stl": write_stl}


# --- the comparison ---


def near(a, b):
    """Whether the values are equal within float rounding."""
    return all(abs(x - y) <= 2e-7 * abs(y) + 1e-44 for x, y in zip(a, b))


def area(corners):
    """Twice the area vector of a polygon."""
    total = [0.0, 0.0, 0.0]
    for one, other in zip(corners[1:], corners[2:]):
        u = [x - y for x, y in zip(one, corners[0])]
        v = [x - y for x, y in zip(other, corners[0])]
        for k in range(3):
            total[k] += u[k - 2] * v[k - 1] - u[k - 1] * v[k - 2]
    return total


def difference(triangles, polygons):
    """The difference, or None. A polygon with n corners must be n - 2 triangles of these corners with its area."""
    if len(triangles) != sum(len(polygon) - 2 for polygon in polygons):
        return f"{len(triangles)} triangles of {len(polygons)} polygons"
    at = 0
    for number, polygon in enumerate(polygons):
        parts = triangles[at : at + len(polygon) - 2]
        at += len(parts)
        if any(not any(near(corner, other) for other in polygon) for part in parts for corner in part):
            return f"corners of polygon {number}"
        whole = area(polygon)
        sums = [sum(area(part)[k] for part in parts) for k in range(3)]
        reach = max(abs(x) for corner in polygon for x in corner)
        size = max(abs(x - y) for corner in polygon for x, y in zip(corner, polygon[0]))
        if max(abs(x - y) for x, y in zip(whole, sums)) > 1e-6 * size * (size + reach):
            return f"area of polygon {number}"
    return None


def line_of(text, at):
    return len(re.findall(r"\r\n?|\n", text[:at])) + 1


def main():
    run = cases.Cases("text", 200 * len(FORMATS))
    for number, folder in run.each():
        kind = FORMATS[number % len(FORMATS)]
        writer = Writer(run.random)
        vertices, polygons = polygons_of(run.random, 3 if kind == "stl" else 8)
        truth = WRITERS[kind](writer, vertices, polygons)
        text = writer.text
        spoilt = number // len(FORMATS) % 4 == 3
        if spoilt:
            at, length = run.random.choice(writer.words)
            text = text[:at] + run.random.choice(["x", "1,5", "0x10", "--2", "1.2.3"]) + text[at + length :]
        path = folder / f"m.{kind}"
        path.write_bytes(text.encode())
        mesh = imported(run, path)
        if mesh is None:
            continue
        read = not isinstance(mesh, str)
        if spoilt:
            said = None if read else re.search(r"line (\d+): ", mesh)
            run.expect(said and int(said[1]) == line_of(text, at) and ";" in mesh and "\n" not in mesh,
                       f"{kind}: line {line_of(text, at)} is spoilt: {'read' if read else mesh}")
        elif run.expect(read, f"{kind}: {mesh}"):
            different = difference(mesh, truth)
            run.expect(different is None, f"{kind}: {different}: {text[:300]!r}")
    run.finish()


main()
