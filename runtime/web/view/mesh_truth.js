// Which points lie inside a mesh, as `relief check` has it: closed parts are solid, open ones are sheets of a thickness, or
// without one the ground, whose inside is behind their triangles.
import { cross, dot, length, scale, sub } from "./math.js";

/** Corners that lie at one place are one; a number for each place. */
function weld(vertices) {
    const places = new Map();
    return Uint32Array.from({ length: vertices.length / 3 }, (_, i) => {
        const key = `${vertices[3 * i]} ${vertices[3 * i + 1]} ${vertices[3 * i + 2]}`;
        if (!places.has(key)) {
            places.set(key, places.size);
        }
        return places.get(key);
    });
}

/**
 * For each triangle whether its part is closed, that is whether each of the part's edges is gone along as often as back;
 * and the longest side of the part's box.
 */
function partsOf(vertices, triangles) {
    const place = weld(vertices);
    const parent = Uint32Array.from(place, (_, i) => i);
    const root = (i) => {
        while (parent[i] !== i) {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        return i;
    };
    const edges = new Map(); // from the lower place to the higher one: along less back
    for (let i = 0; i < triangles.length; ++i) {
        const from = place[triangles[i]];
        const to = place[triangles[i % 3 === 2 ? i - 2 : i + 1]];
        parent[root(from)] = root(to);
        if (from !== to) {
            const key = Math.min(from, to) * 2 ** 26 + Math.max(from, to);
            edges.set(key, (edges.get(key) ?? 0) + (from < to ? 1 : -1));
        }
    }
    const open = new Set();
    for (const [key, left] of edges) {
        if (left !== 0) {
            open.add(root(Math.floor(key / 2 ** 26)));
        }
    }
    const boxes = new Map();
    for (let i = 0; i < place.length; ++i) {
        const part = root(place[i]);
        const box = boxes.get(part) ?? { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
        for (let k = 0; k < 3; ++k) {
            box.low[k] = Math.min(box.low[k], vertices[3 * i + k]);
            box.high[k] = Math.max(box.high[k], vertices[3 * i + k]);
        }
        boxes.set(part, box);
    }
    const sizes = new Map([...boxes].map(([part, box]) => [part, Math.max(...sub(box.high, box.low))]));
    const partOf = (t) => root(place[triangles[3 * t]]);
    const count = { length: triangles.length / 3 };
    return {
        closed: Uint8Array.from(count, (_, t) => (open.has(partOf(t)) ? 0 : 1)),
        size: Float64Array.from(count, (_, t) => sizes.get(partOf(t))),
    };
}

/** Of a default thickness what a part takes, as bake/shape/thickness.h has it. */
const partThickness = (thickness, size) => Math.min(Math.max(thickness, 0.004 * size), 0.25 * size);

const kEntriesMax = 4e6; // triangles in cells: some tens of megabytes

/** Triangles by the cells of a grid that their boxes, grown by `reach`, meet. axes: those that the grid divides. */
class Bins {
    constructor(mesh, chosen, axes, count, reach) {
        const boxes = chosen.map((t) => axes.map((axis) => {
            const all = [0, 1, 2].map((k) => mesh.vertices[3 * mesh.triangles[3 * t + k] + axis]);
            return [Math.min(...all) - reach, Math.max(...all) + reach];
        }));
        this.axes = axes;
        this.low = axes.map((_, i) => boxes.reduce((least, box) => Math.min(least, box[i][0]), Infinity));
        const size = axes.map((_, i) => boxes.reduce((most, box) => Math.max(most, box[i][1]), -Infinity) - this.low[i]);
        const cells = (box, side) => box.reduce((product, [low, high]) => product * Math.ceil((high - low) / side + 1), 1);
        do {
            this.side = Math.max(...size) / count || 1;
            count = Math.ceil(count / 2);
        } while (count > 1 && boxes.reduce((sum, box) => sum + cells(box, this.side), 0) > kEntriesMax);
        this.count = size.map((one) => Math.max(Math.ceil(one / this.side), 1));
        this.cells = new Map();
        boxes.forEach((box, n) => {
            const from = box.map(([low], i) => this.#at(low, i));
            const to = box.map(([, high], i) => this.#at(high, i));
            const place = [...from];
            for (let k = 0; k < axes.length;) {
                const key = this.#key(place);
                if (!this.cells.has(key)) {
                    this.cells.set(key, []);
                }
                this.cells.get(key).push(chosen[n]);
                for (k = 0; k < axes.length && ++place[k] > to[k]; ++k) {
                    place[k] = from[k];
                }
            }
        });
    }

    #at(v, i) {
        return Math.min(Math.max(Math.floor((v - this.low[i]) / this.side), 0), this.count[i] - 1);
    }

    #key(place) {
        return place.reduce((sum, one, i) => sum * this.count[i] + one, 0);
    }

    near(p) {
        return this.cells.get(this.#key(this.axes.map((axis, i) => this.#at(p[axis], i)))) ?? [];
    }
}

/** Of a triangle the point nearest to p: Ericson, Real-Time Collision Detection (2005), 5.1.5. */
function closest(p, a, b, c) {
    const ab = sub(b, a);
    const ac = sub(c, a);
    const along = (from, way, t) => from.map((v, i) => v + t * way[i]);
    const ap = sub(p, a);
    const [d1, d2] = [dot(ab, ap), dot(ac, ap)];
    if (d1 <= 0 && d2 <= 0) {
        return a;
    }
    const bp = sub(p, b);
    const [d3, d4] = [dot(ab, bp), dot(ac, bp)];
    if (d3 >= 0 && d4 <= d3) {
        return b;
    }
    const vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        return along(a, ab, d1 / (d1 - d3));
    }
    const cp = sub(p, c);
    const [d5, d6] = [dot(ab, cp), dot(ac, cp)];
    if (d6 >= 0 && d5 <= d6) {
        return c;
    }
    const vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        return along(a, ac, d2 / (d2 - d6));
    }
    const va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) {
        return along(b, sub(c, b), (d4 - d3) / (d4 - d3 + d5 - d6));
    }
    const sum = va + vb + vc;
    return along(along(a, ab, vb / sum), ac, vc / sum);
}

export class MeshTruth {
    /**
     * @param depth   of sheets, half of their thickness; 0: open parts are ground
     * @param byPart  that depth is a default, of which each part takes its own
     * @param shells  closed parts are sheets, too
     * @param reach   how far from the surface points are asked for
     */
    constructor(mesh, { depth, byPart, shells, reach }) {
        this.mesh = mesh;
        const { closed, size } = partsOf(mesh.vertices, mesh.triangles);
        this.depths = size.map((one) => (byPart && depth > 0 ? 0.5 * partThickness(2 * depth, one) : depth));
        const all = Array.from(closed.keys());
        const solid = all.filter((t) => closed[t] && !shells);
        const open = all.filter((t) => !closed[t] || shells);
        const fine = Math.min(Math.max(Math.ceil(Math.sqrt(solid.length)), 16), 400);
        const columns = (axis) => new Bins(mesh, solid, [(axis + 1) % 3, (axis + 2) % 3], fine, 0);
        this.rays = solid.length ? [0, 1, 2].map(columns) : [];
        const reached = open.reduce((most, t) => Math.max(most, this.depths[t]), reach);
        this.open = open.length ? new Bins(mesh, open, [0, 1, 2], 64, reached) : null;
    }

    #corners(t) {
        const { vertices, triangles } = this.mesh;
        return [0, 1, 2].map((k) => {
            const v = 3 * triangles[3 * t + k];
            return [vertices[v], vertices[v + 1], vertices[v + 2]];
        });
    }

    /** Whether a ray along an axis goes out of the solids oftener than in. */
    #odd(p, axis, bins) {
        const [u, v] = bins.axes;
        let odd = false;
        for (const t of bins.near(p)) {
            const q = this.#corners(t).map((corner) => sub(corner, p));
            let weights = [0, 0, 0];
            for (let k = 0; k < 3; ++k) {
                const [a, b] = [q[(k + 1) % 3], q[(k + 2) % 3]];
                weights[k] = a[u] * b[v] - a[v] * b[u];
            }
            if (weights.every((w) => w > 0) || weights.every((w) => w < 0)) {
                const sum = weights[0] + weights[1] + weights[2];
                odd = odd !== (weights[0] * q[0][axis] + weights[1] * q[1][axis] + weights[2] * q[2][axis]) / sum > 0;
            }
        }
        return odd;
    }

    inside(p) {
        // Of three rays two are right where one meets an edge.
        if (this.rays.filter((bins, axis) => this.#odd(p, axis, bins)).length >= 2) {
            return true;
        }
        let least = Infinity;
        let behind = false;
        for (const t of this.open?.near(p) ?? []) {
            const [a, b, c] = this.#corners(t);
            const way = sub(p, closest(p, a, b, c));
            const normal = cross(sub(b, a), sub(c, a));
            const side = dot(way, scale(normal, 1 / (length(normal) || 1)));
            // Where two triangles are as near, the one that faces the point more squarely knows its side.
            const away = length(way) - 1e-3 * Math.abs(side);
            if (this.depths[t] > 0 && away < this.depths[t]) {
                return true;
            }
            if (away < least) {
                least = away;
                behind = this.depths[t] === 0 && side < 0;
            }
        }
        return behind;
    }
}
