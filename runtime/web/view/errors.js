// How far the maps are from a mesh, at points of its surface, where the truth is 0.
import { boxOf, cross, length, quantile, random, sub } from "./math.js";

const kPoints = 40_000;

/** Points evenly over the mesh, the same on each visit. */
export function samplePoints({ vertices, triangles }, count = kPoints) {
    const corner = (t, i) => {
        const v = 3 * triangles[3 * t + i];
        return [vertices[v], vertices[v + 1], vertices[v + 2]];
    };
    const total = triangles.length / 3;
    const sums = new Float64Array(total + 1);
    for (let t = 0; t < total; ++t) {
        const a = corner(t, 0);
        sums[t + 1] = sums[t] + length(cross(sub(corner(t, 1), a), sub(corner(t, 2), a)));
    }
    const next = random(7);
    const positions = new Float32Array(3 * count);
    for (let i = 0, t = 0; i < count; ++i) {
        const share = (i + next()) / count * sums[total];
        while (t < total - 1 && sums[t + 1] <= share) {
            ++t;
        }
        const [a, b, c] = [0, 1, 2].map((k) => corner(t, k));
        let [u, v] = [next(), next()];
        if (u + v > 1) {
            [u, v] = [1 - u, 1 - v];
        }
        const ab = sub(b, a);
        const ac = sub(c, a);
        positions.set(a.map((x, k) => x + u * ab[k] + v * ac[k]), 3 * i);
    }
    return positions;
}

const known = (distance, map) => map >= 0 && Math.abs(distance) < 1e29;

/** How deep in their shells sheets lie: half of their thickness, which the record has if there are any; else 0. */
export function sheetDepth(collider) {
    return 0.5 * Number(/(?:^| )--thickness (?:auto=)?([0-9.e+-]+)/.exec(collider.info.options)?.[1] ?? 0);
}

/** A distance on the mesh, less that depth where it is nearer to it than to 0. In kHeatFragment too. */
const offSheet = (d, depth) => (d < -0.5 * depth ? d + depth : d);

/** How far the maps are from the points of a mesh: { range, mean, median, p99, depth }. */
export function measure(collider, mesh) {
    const positions = samplePoints(mesh);
    const depth = sheetDepth(collider);
    const { longest } = boxOf(collider.bounds);
    const { distance, map } = collider.query(positions);
    const errors = [...distance].filter((d, i) => known(d, map[i])).map((d) => Math.abs(offSheet(d, depth)));
    const mean = errors.reduce((sum, e) => sum + e, 0) / Math.max(errors.length, 1);
    return { range: Math.max(quantile(errors, 0.995), 1e-6 * longest), mean, median: quantile(errors, 0.5),
             p99: quantile(errors, 0.99), depth };
}
