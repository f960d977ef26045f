// How far the maps are from a mesh, at points of its surface, where the truth is 0.
import { boxOf, cross, length, quantile, sub } from "./math.js";

const kPoints = 40_000;

/** Points evenly over the mesh. */
function samplePoints({ vertices, triangles }) {
    const total = triangles.length / 3;
    const corners = (t) => [0, 1, 2].map((i) => vertices.subarray(3 * triangles[3 * t + i], 3 * triangles[3 * t + i] + 3));
    const sums = new Float64Array(total + 1);
    for (let t = 0; t < total; ++t) {
        const [a, b, c] = corners(t);
        sums[t + 1] = sums[t] + length(cross(sub(b, a), sub(c, a)));
    }
    const positions = new Float32Array(3 * kPoints);
    for (let i = 0, t = 0; i < kPoints; ++i) {
        while (t < total - 1 && sums[t + 1] <= (i + 0.5) / kPoints * sums[total]) {
            ++t;
        }
        const [a, b, c] = corners(t);
        // A sequence that fills the square evenly (Roberts 2018, R2); what lies beyond its diagonal is folded back.
        let [u, v] = [(0.7548776662466927 * i) % 1, (0.5698402909980532 * i) % 1];
        if (u + v > 1) {
            [u, v] = [1 - u, 1 - v];
        }
        positions.set([0, 1, 2].map((k) => a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k])), 3 * i);
    }
    return positions;
}

/** How deep in their shells sheets lie: half of their thickness, which the record has if there are any; else 0. */
const sheetDepth = (collider) => 0.5 * Number(/(?:^| )--thickness (?:auto=)?([0-9.e+-]+)/.exec(collider.info.options)?.[1] ?? 0);

/** A distance on the mesh, less that depth where it is nearer to it than to 0. In kHeatFragment too. */
const offSheet = (d, depth) => (d < -0.5 * depth ? d + depth : d);

/** How far the maps are from the points of a mesh: { range, mean, median, p99, depth }. */
export function measure(collider, mesh) {
    const depth = sheetDepth(collider);
    const { distance, map } = collider.query(samplePoints(mesh));
    const errors = [...distance].filter((d, i) => map[i] >= 0 && Math.abs(d) < 1e29).map((d) => Math.abs(offSheet(d, depth)));
    const mean = errors.reduce((sum, e) => sum + e, 0) / Math.max(errors.length, 1);
    return { range: Math.max(quantile(errors, 0.995), 1e-6 * boxOf(collider.bounds).longest), mean, median: quantile(errors, 0.5),
             p99: quantile(errors, 0.99), depth };
}
