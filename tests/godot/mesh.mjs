// SPDX-License-Identifier: Apache-2.0
// A point-in-mesh test that shares no code with Relief: counts the triangles of a closed mesh above a point.
import { readFile } from "node:fs/promises";

/** Reads the vertices and triangles of an OBJ file. */
export async function readObj(file) {
    const vertices = [];
    const triangles = [];
    for (const line of (await readFile(file, "utf8")).split("\n")) {
        const [kind, ...words] = line.trim().split(/\s+/);
        if (kind === "v") {
            vertices.push(words.slice(0, 3).map(Number));
        } else if (kind === "f") {
            const corners = words.map((word) => parseInt(word) + (parseInt(word) < 0 ? vertices.length : -1));
            for (let i = 2; i < corners.length; ++i) {
                triangles.push([corners[0], corners[i - 1], corners[i]]);
            }
        }
    }
    return { vertices, triangles };
}

/** Returns a function that tells whether a point is inside a closed mesh. */
export function insideTest({ vertices, triangles }) {
    const kBins = 256;
    const low = [0, 1].map((axis) => vertices.reduce((least, v) => Math.min(least, v[axis]), Infinity));
    const high = [0, 1].map((axis) => vertices.reduce((most, v) => Math.max(most, v[axis]), -Infinity));
    const bin = (value, axis) => Math.floor(((value - low[axis]) / (high[axis] - low[axis])) * (kBins - 1e-6));
    const bins = Array.from({ length: kBins * kBins }, () => []);
    for (const corners of triangles) {
        const [a, b, c] = corners.map((i) => vertices[i]);
        const range = [0, 1].map((axis) => [Math.min(a[axis], b[axis], c[axis]), Math.max(a[axis], b[axis], c[axis])]);
        for (let y = bin(range[1][0], 1); y <= bin(range[1][1], 1); ++y) {
            for (let x = bin(range[0][0], 0); x <= bin(range[0][1], 0); ++x) {
                bins[y * kBins + x].push([a, b, c]);
            }
        }
    }
    const side = (p, a, b) => (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    return (point) => {
        const p = [point[0] + 1.234567e-9, point[1] + 2.345678e-9, point[2]]; // off the edges of the mesh
        if (![0, 1].every((axis) => p[axis] > low[axis] && p[axis] < high[axis])) {
            return false;
        }
        let above = 0;
        for (const [a, b, c] of bins[bin(p[1], 1) * kBins + bin(p[0], 0)]) {
            const [u, v, w] = [side(p, b, c), side(p, c, a), side(p, a, b)];
            if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0)) {
                above += (u * a[2] + v * b[2] + w * c[2]) / (u + v + w) > p[2] ? 1 : 0;
            }
        }
        return above % 2 === 1;
    };
}
