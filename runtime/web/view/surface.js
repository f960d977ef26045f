// The surface as the maps see it, as triangles: a vertex in each cell of a grid whose corners differ in inside and
// outside, where the surface cuts the cell's edges. A shader then asks the maps again at each pixel.
import { clamp } from "./math.js";

const kBatch = 60_000; // points asked at a time: some milliseconds
const kBisections = 6;

const pause = () => new Promise((done) => setTimeout(done));

class Grid {
    constructor(box, cells) {
        this.spacing = box.longest / cells;
        this.n = box.size.map((side) => Math.max(Math.ceil(side / this.spacing - 1e-6), 1) + 4);
        this.from = box.center.map((c, i) => c - 0.5 * this.spacing * (this.n[i] - 1));
        this.count = this.n[0] * this.n[1] * this.n[2];
        this.stride = [1, this.n[0], this.n[0] * this.n[1]];
        // What a map says beyond the body is not the body: a height field is solid far below.
        const slack = 0.5 * this.spacing;
        this.low = box.min.map((v) => v - slack);
        this.high = box.max.map((v) => v + slack);
    }

    place(index, out, at) {
        const [nx, ny] = this.n;
        out[at] = this.from[0] + this.spacing * (index % nx);
        out[at + 1] = this.from[1] + this.spacing * (Math.floor(index / nx) % ny);
        out[at + 2] = this.from[2] + this.spacing * Math.floor(index / (nx * ny));
    }
}

/** inside[i] of points; asked in batches with pauses between, so that the page stays alive. */
async function askInside(collider, grid, points, alive) {
    const count = points.length / 3;
    const inside = new Uint8Array(count);
    for (let from = 0; from < count; from += kBatch) {
        const to = Math.min(from + kBatch, count);
        const { distance, map } = collider.query(points.subarray(3 * from, 3 * to));
        for (let i = from; i < to; ++i) {
            const within = points[3 * i] > grid.low[0] && points[3 * i] < grid.high[0] &&
                points[3 * i + 1] > grid.low[1] && points[3 * i + 1] < grid.high[1] &&
                points[3 * i + 2] > grid.low[2] && points[3 * i + 2] < grid.high[2];
            inside[i] = within && map[i - from] >= 0 && distance[i - from] < 0 ? 1 : 0;
        }
        await pause();
        if (!alive()) {
            return null;
        }
    }
    return inside;
}

async function gridInside(collider, grid, alive) {
    const inside = new Uint8Array(grid.count);
    const part = new Float32Array(3 * Math.min(4 * kBatch, grid.count));
    for (let from = 0; from < grid.count; from += part.length / 3) {
        const n = Math.min(part.length / 3, grid.count - from);
        for (let i = 0; i < n; ++i) {
            grid.place(from + i, part, 3 * i);
        }
        const answers = await askInside(collider, grid, part.subarray(0, 3 * n), alive);
        if (!answers) {
            return null;
        }
        inside.set(answers, from);
    }
    return inside;
}

/** Edges along which inside changes: [corner, axis] pairs, and where on them it does. */
async function crossings(collider, grid, inside, alive) {
    const edges = [];
    for (let axis = 0; axis < 3; ++axis) {
        const step = grid.stride[axis];
        for (let i = 0; i + step < grid.count; ++i) {
            if (inside[i] !== inside[i + step] && Math.floor(i / step) % grid.n[axis] < grid.n[axis] - 1) {
                edges.push(i, axis);
            }
        }
    }
    const count = edges.length / 2;
    const ends = [new Float32Array(3 * count), new Float32Array(3 * count)]; // outside, inside
    for (let e = 0; e < count; ++e) {
        const corner = edges[2 * e];
        const other = corner + grid.stride[edges[2 * e + 1]];
        grid.place(inside[corner] ? other : corner, ends[0], 3 * e);
        grid.place(inside[corner] ? corner : other, ends[1], 3 * e);
    }
    const middle = new Float32Array(3 * count);
    for (let k = 0; k < kBisections; ++k) {
        for (let i = 0; i < middle.length; ++i) {
            middle[i] = 0.5 * (ends[0][i] + ends[1][i]);
        }
        const answers = await askInside(collider, grid, middle, alive);
        if (!answers) {
            return null;
        }
        for (let e = 0; e < count; ++e) {
            ends[answers[e]].set(middle.subarray(3 * e, 3 * e + 3), 3 * e);
        }
    }
    return { edges, points: ends[1] };
}

/** The four cells round an edge, in turn about its axis. */
function cellsRound(grid, corner, axis) {
    const u = grid.stride[(axis + 1) % 3];
    const v = grid.stride[(axis + 2) % 3];
    return [corner - u - v, corner - v, corner, corner - u];
}

function triangles(grid, inside, { edges, points }) {
    const vertexOf = new Int32Array(grid.count).fill(-1);
    const sums = [];
    const shares = [];
    const indices = [];
    for (let e = 0; e < edges.length / 2; ++e) {
        const corner = edges[2 * e];
        const quad = cellsRound(grid, corner, edges[2 * e + 1]).map((cell) => {
            if (vertexOf[cell] < 0) {
                vertexOf[cell] = shares.length;
                shares.push(0);
                sums.push(0, 0, 0);
            }
            const vertex = vertexOf[cell];
            shares[vertex] += 1;
            for (let i = 0; i < 3; ++i) {
                sums[3 * vertex + i] += points[3 * e + i];
            }
            return vertex;
        });
        const [a, b, c, d] = inside[corner] ? quad : quad.reverse();
        indices.push(a, b, c, a, c, d);
    }
    const vertices = new Float32Array(sums.length);
    for (let i = 0; i < vertices.length; ++i) {
        vertices[i] = sums[i] / shares[Math.floor(i / 3)];
    }
    return { vertices, indices: Uint32Array.from(indices) };
}

/**
 * @param collider  of relief.js
 * @param box       of math.js's boxOf()
 * @param cells     along its longest side
 * @param alive     says whether the answer is still wanted
 * @returns { vertices, indices, spacing }, or null once it is not
 */
export async function surfaceOf(collider, box, cells, alive = () => true) {
    const grid = new Grid(box, clamp(cells, 4, 512));
    const inside = await gridInside(collider, grid, alive);
    const found = inside && await crossings(collider, grid, inside, alive);
    return found && { ...triangles(grid, inside, found), spacing: grid.spacing };
}
