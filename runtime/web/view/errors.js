// How far the maps are from a mesh: points of its surface, where the truth is 0, and the worst of them.
import { boxOf, cross, dot, length, normalize, quantile, random, shortNumber, sub } from "./math.js";

const kPoints = 40_000;
const kPlaces = 12;

/** Points evenly over the mesh, the same on each visit; { positions, normals }. */
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
    const normals = new Float32Array(3 * count);
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
        normals.set(normalize(cross(ab, ac)), 3 * i);
    }
    return { positions, normals };
}

const known = (distance, map) => map >= 0 && Math.abs(distance) < 1e29;

/** How deep in their shells sheets lie: half of their thickness, which the record has if there are any; else 0. */
export function sheetDepth(collider) {
    return 0.5 * Number(/(?:^| )--thickness ([0-9.e+-]+)/.exec(collider.info.options)?.[1] ?? 0);
}

/** A distance on the mesh, less that depth where it is nearer to it than to 0. In kHeatFragment too. */
const offSheet = (d, depth) => (d < -0.5 * depth ? d + depth : d);

/** What the maps say at the points of a mesh: { range, mean, median, p99, unknown, depth, places }. */
export function measure(collider, mesh) {
    const { positions, normals } = samplePoints(mesh);
    const depth = sheetDepth(collider);
    const { distance: raw, map } = collider.query(positions);
    const distance = raw.map((d) => offSheet(d, depth));
    const errors = [...distance].map((d, i) => (known(d, map[i]) ? Math.abs(d) : -1));
    const valid = errors.filter((e) => e >= 0);
    const order = errors.map((e, i) => i).filter((i) => errors[i] >= 0).sort((a, b) => errors[b] - errors[a]);
    const apart = 0.08 * boxOf(collider.bounds).longest;
    const places = [];
    for (const i of order) {
        const position = [...positions.subarray(3 * i, 3 * i + 3)];
        if (places.every((one) => length(sub(one.position, position)) > apart)) {
            const normal = [...normals.subarray(3 * i, 3 * i + 3)];
            places.push({ position, normal, error: distance[i], map: map[i], ...reasonAt(collider, normal, distance[i], map[i]) });
        }
        if (places.length === kPlaces) {
            break;
        }
    }
    const mean = valid.reduce((sum, e) => sum + e, 0) / Math.max(valid.length, 1);
    return { range: Math.max(quantile(valid, 0.995), 1e-6 * boxOf(collider.bounds).longest), mean,
             median: quantile(valid, 0.5), p99: quantile(valid, 0.99), depth, unknown: 1 - valid.length / errors.length, places };
}

/** Kind of error and one sentence. */
function reasonAt(collider, normal, error, map) {
    const info = collider.info.maps[map];
    const far = Math.abs(error);
    const kind = error < 0 ? "surface too far out" : "surface too far in";
    const texel = collider.info.finest_texel;
    let why = `Map ${map} decides here, and its surface lies ${shortNumber(far)} ${error < 0 ? "outside" : "inside"} the mesh`;
    if (info.projection !== "cube") {
        const slope = Math.round(Math.asin(Math.min(Math.abs(dot(normalize(info.rows[2]), normal)), 1)) * 180 / Math.PI);
        if (slope < 15) {
            why += `: its rays graze the mesh at ${slope}°, so that a texel spans much of it`;
        } else if (far > 4 * texel) {
            why += ": something nearer hides this place from it, and no map that sees it says otherwise";
        }
    } else if (far > 4 * texel) {
        why += ": something between it and this place hides it";
    }
    return { kind, why: `${why}.` };
}
