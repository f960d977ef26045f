// Meshes as OBJ and PLY, for a look at them: { vertices: Float32Array, triangles: Uint32Array }.

export class MeshFailure extends Error {}

function checked(name, vertices, triangles) {
    if (triangles.length === 0) {
        throw new MeshFailure(`${name} holds no triangles`);
    }
    const count = vertices.length / 3;
    if (triangles.some((i) => !(i >= 0 && i < count))) {
        throw new MeshFailure(`${name} is damaged: a face names a vertex that is not there`);
    }
    if (!vertices.every(Number.isFinite)) {
        throw new MeshFailure(`${name} is damaged: a vertex is not a number`);
    }
    return { vertices: Float32Array.from(vertices), triangles: Uint32Array.from(triangles) };
}

function fan(corners, triangles) {
    for (let i = 2; i < corners.length; ++i) {
        triangles.push(corners[0], corners[i - 1], corners[i]);
    }
}

export function readObj(name, bytes) {
    const vertices = [];
    const triangles = [];
    for (const line of new TextDecoder().decode(bytes).split("\n")) {
        if (line.startsWith("v ")) {
            const [, x, y, z] = line.trim().split(/\s+/);
            vertices.push(Number(x), Number(y), Number(z));
        } else if (line.startsWith("f ")) {
            const count = vertices.length / 3;
            fan(line.trim().split(/\s+/).slice(1).map((corner) => {
                const i = parseInt(corner, 10);
                return i < 0 ? count + i : i - 1;
            }), triangles);
        }
    }
    return checked(name, vertices, triangles);
}

const kNumbers = {
    char: "Int8", int8: "Int8", uchar: "Uint8", uint8: "Uint8", short: "Int16", int16: "Int16", ushort: "Uint16",
    uint16: "Uint16", int: "Int32", int32: "Int32", uint: "Uint32", uint32: "Uint32", float: "Float32",
    float32: "Float32", double: "Float64", float64: "Float64",
};

function plyHeader(name, bytes) {
    const text = new TextDecoder("latin1").decode(bytes.subarray(0, 65536));
    const end = /end_header\r?\n/.exec(text);
    if (!text.startsWith("ply") || !end) {
        throw new MeshFailure(`${name} is no PLY file`);
    }
    const elements = [];
    let format = "ascii";
    for (const line of text.slice(0, end.index).split(/\r?\n/)) {
        const words = line.trim().split(/\s+/);
        if (words[0] === "format") {
            format = words[1];
        } else if (words[0] === "element") {
            elements.push({ name: words[1], count: Number(words[2]), properties: [] });
        } else if (words[0] === "property") {
            const list = words[1] === "list";
            const types = (list ? words.slice(2, 4) : [words[1]]).map((type) => kNumbers[type]);
            if (types.includes(undefined) || elements.length === 0) {
                throw new MeshFailure(`${name} has a PLY header that this page does not understand: '${line.trim()}'`);
            }
            elements.at(-1).properties.push({ name: words.at(-1), list, types });
        }
    }
    return { format, elements, start: end.index + end[0].length };
}

/** Numbers one after the other, whatever they are written as. */
function plyNumbers(format, bytes, start) {
    if (format === "ascii") {
        const words = new TextDecoder().decode(bytes.subarray(start)).split(/\s+/).filter(Boolean);
        let at = 0;
        return () => (at < words.length ? Number(words[at++]) : NaN);
    }
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const little = format === "binary_little_endian";
    let at = start;
    return (type) => {
        const size = Number(/\d+/.exec(type)[0]) / 8;
        const value = at + size <= view.byteLength ? view[`get${type}`](at, little) : NaN;
        at += size;
        return value;
    };
}

export function readPly(name, bytes) {
    const { format, elements, start } = plyHeader(name, bytes);
    const next = plyNumbers(format, bytes, start);
    const vertices = [];
    const triangles = [];
    for (const element of elements) {
        if (!(element.count <= bytes.length)) {
            throw new MeshFailure(`${name} is cut off: it has fewer elements than its header says`);
        }
        for (let i = 0; i < element.count; ++i) {
            const row = {};
            for (const { name: property, list, types } of element.properties) {
                const count = list ? next(types[0]) : 1;
                if (!(count >= 0 && count <= bytes.length)) {
                    throw new MeshFailure(`${name} is cut off or damaged in its list of ${element.name}`);
                }
                row[property] = list ? Array.from({ length: count }, () => next(types[1])) : next(types[0]);
            }
            if (element.name === "vertex") {
                vertices.push(row.x, row.y, row.z);
            } else if (element.name === "face") {
                fan(row.vertex_indices ?? row.vertex_index ?? [], triangles);
            }
        }
    }
    return checked(name, vertices, triangles);
}

export function readMesh(name, bytes) {
    return /\.ply$/i.test(name) ? readPly(name, bytes) : readObj(name, bytes);
}

export function meshBounds(vertices) {
    const min = [Infinity, Infinity, Infinity];
    const max = [-Infinity, -Infinity, -Infinity];
    vertices.forEach((v, i) => {
        min[i % 3] = Math.min(min[i % 3], v);
        max[i % 3] = Math.max(max[i % 3], v);
    });
    return { min, max };
}
