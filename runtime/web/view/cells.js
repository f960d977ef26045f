// SPDX-License-Identifier: Apache-2.0
// Empty-space skipping for rays: a grid of cells, 255 if a map sees the whole cell outside, otherwise 0.
import { add, dot, scale } from "./math.js";
import { treeOf, visitLeaves } from "./patches.js";

const kCells = 24; // along the longest side
const kSteep = 0.03; // cosine between normal and ray below which a plane gives no bound; such planes are not stored
const kMargin = 0.01; // texels
const kHalf = 0.505; // half a cell plus a margin: rounding in the shader may select the next cell

/** Returns the depth range in which a texel may be inside. axes: x and y axes of the texel and its ray. */
function depthsInside(texel, { compare, decode, empty_is_outside: empty }, [x, y, ray]) {
    let [low, high] = empty ? [2, -1] : [-Infinity, Infinity];
    [0, 4].filter((at) => !Number.isNaN(texel[at])).forEach((at, i) => {
        [low, high] = i === 0 ? [0, 1] : [low, high];
        let [faces, slope] = [at === 0 && compare !== "greater" ? -1 : 1, 0];
        if (decode === "plane") {
            const normal = texel.subarray(at + 1, at + 4);
            faces = dot(normal, ray);
            slope = 0.5 * (Math.abs(dot(normal, x)) + Math.abs(dot(normal, y))) / Math.abs(faces);
            if (Math.abs(faces) < kSteep * Math.hypot(...ray)) {
                return;
            }
        }
        [low, high] = faces < 0 ? [Math.max(low, texel[at] - slope), high] : [low, Math.min(high, texel[at] + slope)];
    });
    return [low, high];
}

/** Returns the same range for each block of block × block texels: { columns, low, high }. */
function blocksInside(collider, index, block) {
    const map = collider.info.maps[index];
    const { width, height, object_to_map: rows, object_per_map: per } = map;
    const texels = collider.texels(index);
    const axes = [0, 1, 2].map((k) => scale(rows[k].slice(0, 3), per[k] * per[k] / [width, height, 1][k]));
    const [columns, lines] = [Math.ceil(width / block), Math.ceil(height / block)];
    const low = new Float32Array(columns * lines).fill(2);
    const high = new Float32Array(columns * lines).fill(-1);
    for (let i = 0; i < width * height; ++i) {
        const [from, to] = depthsInside(texels.subarray(8 * i, 8 * i + 8), map, axes);
        const at = Math.floor(Math.floor(i / width) / block) * columns + Math.floor(i % width / block);
        low[at] = Math.min(low[at], from);
        high[at] = Math.max(high[at], to);
    }
    return { columns, low, high };
}

/** Marks the cells that a map sees completely outside. */
function mark(cells, { from, side, n }, collider, index) {
    const { width, height, object_to_map: rows, empty_is_outside: empty } = collider.info.maps[index];
    const size = [width, height, 1];
    const reach = rows.map((row, k) => kHalf * side * size[k] * (Math.abs(row[0]) + Math.abs(row[1]) + Math.abs(row[2])) +
                           (k < 2 ? kMargin : 1e-4));
    const block = Math.max(Math.ceil(0.5 * Math.max(reach[0], reach[1])), 1); // so that few blocks cover a cell
    const { columns, low, high } = blocksInside(collider, index, block);
    for (let cell = 0; cell < cells.length; ++cell) {
        const p = [cell % n[0], Math.floor(cell / n[0]) % n[1], Math.floor(cell / n[0] / n[1])].map((c, k) => from[k] + side * (c + 0.5));
        const [u, v, depth] = rows.map((row, k) => size[k] * (dot(row, p) + row[3]));
        let outside = true;
        if (!(empty && (depth + reach[2] < 0 || depth - reach[2] > 1))) {
            const [u0, u1] = [Math.max(Math.floor(u - reach[0]), 1), Math.min(Math.floor(u + reach[0]), width - 2)];
            const [v0, v1] = [Math.max(Math.floor(v - reach[1]), 1), Math.min(Math.floor(v + reach[1]), height - 2)];
            for (let b = Math.floor(v0 / block); v0 <= v1 && b <= v1 / block && outside; ++b) {
                for (let a = Math.floor(u0 / block); u0 <= u1 && a <= u1 / block && outside; ++a) {
                    const i = b * columns + a;
                    outside = depth + reach[2] < low[i] || depth - reach[2] > high[i];
                }
            }
        }
        cells[cell] = outside ? 255 : cells[cell];
    }
}

/** Like mark(), for a patch map: marks cells that no patch and no inside leaf overlaps. */
function markPatches(cells, { from, side, n }, collider, index) {
    const { object_to_map: rows, object_per_map: [size] } = collider.info.maps[index];
    const axes = rows.map((row) => scale(row.slice(0, 3), size * size)); // axes of map space in object space
    const reached = new Uint8Array(cells.length);
    visitLeaves(treeOf(collider, index), (kind, corner, leaf) => {
        if (kind === "outside") {
            return;
        }
        const middle = axes.map((axis, k) => scale(axis, corner[k] + leaf / 2 - rows[k][3])).reduce(add);
        const [low, high] = [-1, 1].map((way) => middle.map((v, k) => {
            const half = leaf / 2 * axes.reduce((sum, axis) => sum + Math.abs(axis[k]), 0) + (kHalf - 0.5) * side;
            return Math.min(Math.max(Math.floor((v + way * half - from[k]) / side), way < 0 ? 0 : -1), way < 0 ? n[k] : n[k] - 1);
        }));
        for (let z = low[2]; z <= high[2]; ++z) {
            for (let y = low[1]; y <= high[1]; ++y) {
                const row = (z * n[1] + y) * n[0];
                reached.fill(1, row + low[0], Math.max(row + high[0] + 1, row + low[0]));
            }
        }
    });
    reached.forEach((one, i) => (cells[i] = one ? cells[i] : 255));
}

/**
 * @param bounds  the drawn box
 * @returns { n, from, side, clear }: number of cells along each axis, corner of the first cell, side length, and the
 *          cells with x fastest
 */
export function cellsOf(collider, { min, max }) {
    const size = max.map((v, k) => v - min[k]);
    const side = Math.max(...size) / kCells || 1;
    const grid = { from: min, side, n: size.map((one) => Math.max(Math.ceil(one / side - 1e-6), 1)) };
    const clear = new Uint8Array(grid.n[0] * grid.n[1] * grid.n[2]);
    collider.info.maps.forEach((map, i) => {
        if (map.projection === "local" && map.encloses) {
            markPatches(clear, grid, collider, i);
        } else if (map.projection === "orthographic" && map.encloses) {
            mark(clear, grid, collider, i);
        }
    });
    return { ...grid, clear };
}
