// How far the maps are from a mesh: points of its surface, where the truth is 0, and where points near it are on the wrong
// side, as `relief check` ranks such places.
import { boundsOf, boxOf, cross, dot, length, lengthText, normalize, quantile, random, sub } from "./math.js";
import { MeshTruth } from "./mesh_truth.js";

const kPoints = 40_000;
const kNear = 20_000;
const kSigma = 0.005; // of the points near the mesh, in its longest sides
const kPlaces = 12;
const kCell = 0.03; // of a place, in longest sides
const kReach = 3; // of a place round its worst cell, in cells that hold kAsBad of what that one does
const kAsBad = 0.25;

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

/**
 * How deep in their shells sheets lie: half of their thickness, which the record has if there are any; else 0. byPart: that is
 * a default, of which small parts take less.
 */
export function sheetDepth(collider) {
    const [, byPart, thickness] = /(?:^| )--thickness (auto=)?([0-9.e+-]+)/.exec(collider.info.options) ?? [];
    return { depth: 0.5 * Number(thickness ?? 0), byPart: byPart !== undefined };
}

/** A distance on the mesh, less that depth where it is nearer to it than to 0. In kHeatFragment too. */
const offSheet = (d, depth) => (d < -0.5 * depth ? d + depth : d);

/** Points near the mesh that the maps have on the wrong side: { position, normal, map, inside (as the maps have it) }. */
function wrongPoints(collider, mesh, { depth, byPart }) {
    const { positions, normals } = samplePoints(mesh, kNear);
    const sigma = kSigma * boxOf(boundsOf(mesh.vertices)).longest;
    const next = random(11);
    const near = positions.map((x) => x + sigma * Math.sqrt(-2 * Math.log(1 - next())) * Math.cos(2 * Math.PI * next()));
    const { distance, map } = collider.query(near);
    const shells = /(?:^| )--as shell(?: |$)/.test(collider.info.options);
    const truth = new MeshTruth(mesh, { depth, byPart, shells, reach: 6 * sigma });
    const wrong = [];
    for (let i = 0; i < kNear; ++i) {
        const position = [...near.subarray(3 * i, 3 * i + 3)];
        const inside = map[i] >= 0 && distance[i] < 0;
        if (truth.inside(position) !== inside) {
            wrong.push({ position, normal: [...normals.subarray(3 * i, 3 * i + 3)], map: map[i], inside });
        }
    }
    return wrong;
}

/**
 * The places with the most points on the wrong side: each a cell, the worst first, and what is about as bad round it. As
 * bake/measure/worst_places.cpp finds them.
 */
function worstPlaces(collider, wrong, side) {
    const cells = new Map();
    const cellOf = (p) => p.map((v) => Math.floor(v / side));
    for (const one of wrong) {
        const cell = cellOf(one.position);
        const key = cell.join();
        if (!cells.has(key)) {
            cells.set(key, { cell, points: [] });
        }
        cells.get(key).points.push(one);
    }
    const places = [];
    for (const worst of [...cells.values()].sort((a, b) => b.points.length - a.points.length)) {
        if (!cells.delete(worst.cell.join())) {
            continue; // a place has it
        }
        const least = kAsBad * worst.points.length;
        const points = [...worst.points];
        const around = [worst.cell];
        for (const waiting of around) { // it grows
            for (let k = 0; k < 27; ++k) {
                const cell = waiting.map((v, i) => v + Math.floor(k / 3 ** i) % 3 - 1);
                const found = cells.get(cell.join());
                if (found && cell.every((v, i) => Math.abs(v - worst.cell[i]) <= kReach)) {
                    cells.delete(cell.join());
                    points.push(...found.points);
                    if (found.points.length >= least) {
                        around.push(cell);
                    }
                }
            }
        }
        places.push({ middle: middleOf(worst.points), points });
    }
    return places.sort((a, b) => b.points.length - a.points.length).slice(0, kPlaces).map(({ middle, points }) => {
        const { min, max } = boundsOf(points.flatMap((one) => one.position));
        const byMap = new Map();
        points.forEach((one) => byMap.set(one.map, (byMap.get(one.map) ?? 0) + 1));
        const map = [...byMap].reduce((most, one) => (one[1] > most[1] ? one : most))[0];
        const place = { position: middle.position, normal: middle.normal, size: Math.max(...sub(max, min)), points: points.length,
                        share_percent: 100 * points.length / wrong.length, map,
                        false_inside_percent: 100 * points.filter((one) => one.inside).length / points.length };
        return { ...place, why: reasonAt(collider, place) };
    });
}

/** Of points the one nearest to their mean. */
function middleOf(points) {
    const mean = [0, 1, 2].map((k) => points.reduce((sum, { position }) => sum + position[k], 0) / points.length);
    const away = ({ position }) => length(sub(position, mean));
    return points.reduce((least, one) => (away(one) < away(least) ? one : least));
}

/**
 * What the maps say at the points of a mesh, and on which side they have points near it:
 * { range, mean, median, p99, unknown, depth, wrong_percent, places }.
 */
export function measure(collider, mesh) {
    const { positions } = samplePoints(mesh);
    const sheets = sheetDepth(collider);
    const { depth } = sheets;
    const { longest } = boxOf(collider.bounds);
    const { distance: raw, map } = collider.query(positions);
    const errors = [...raw].map((d, i) => (known(d, map[i]) ? Math.abs(offSheet(d, depth)) : -1));
    const valid = errors.filter((e) => e >= 0);
    const mean = valid.reduce((sum, e) => sum + e, 0) / Math.max(valid.length, 1);
    const wrong = wrongPoints(collider, mesh, sheets);
    return { range: Math.max(quantile(valid, 0.995), 1e-6 * longest), mean, median: quantile(valid, 0.5),
             p99: quantile(valid, 0.99), depth, unknown: 1 - valid.length / errors.length,
             wrong_percent: 100 * wrong.length / kNear, places: worstPlaces(collider, wrong, kCell * longest) };
}

/** One sentence. */
function reasonAt(collider, { map, normal }) {
    if (map < 0) {
        return "No map votes here: none sees this place.";
    }
    const info = collider.info.maps[map];
    let why = `Map ${map} decides here`;
    if (info.projection !== "cube") {
        const side = Math.max(info.object_per_map[0] / info.width, info.object_per_map[1] / info.height);
        why += `, whose texels are ${lengthText(side, collider.info.unit)} wide`;
        const slope = Math.round(Math.asin(Math.min(Math.abs(dot(normalize(info.rows[2]), normal)), 1)) * 180 / Math.PI);
        why += slope < 15 ? `; its rays graze the mesh at ${slope}°, so that a texel spans much of it` : "";
    }
    return `${why}.`;
}
