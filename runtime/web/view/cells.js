// Where a ray through a collider may be in a hurry: a grid of cells of which a map sees all outside. The number of a cell is
// how many cells away the next one lies of which none does; 0: it is one.
import { dot, scale } from "./math.js";

const kCells = 64; // along the longest side
const kStanding = 0.033; // cosine with a map's rays below which a plane bounds nothing along them
const kMargin = 0.01; // texels
const kSide = 4; // of the blocks that a cell is compared with

/** Of each texel of a map from which depth to which it may be inside, { width, height, low, high }. */
function depthsInside(collider, index) {
    const { width, height, rows, object_per_map: per, compare, decode, empty_is_outside: empty } = collider.info.maps[index];
    const texels = collider.texels(index);
    const [x, y, ray] = [0, 1, 2].map((k) => scale(rows[k].slice(0, 3), per[k] * per[k] / [width, height, 1][k]));
    const least = kStanding * Math.hypot(...ray);
    const low = new Float32Array(width * height).fill(2);
    const high = new Float32Array(width * height).fill(-1);
    for (let i = 0; i < width * height; ++i) {
        const found = [8 * i, 8 * i + 4].filter((at) => !Number.isNaN(texels[at]));
        if (found.length === 0 && empty) {
            continue;
        }
        [low[i], high[i]] = found.length ? [0, 1] : [-Infinity, Infinity];
        for (const at of found) {
            const depth = texels[at];
            let [faces, slope] = [at === 8 * i && compare !== "greater" ? -1 : 1, 0];
            if (decode === "plane") {
                const normal = [texels[at + 1], texels[at + 2], texels[at + 3]];
                faces = dot(normal, ray);
                slope = 0.5 * (Math.abs(dot(normal, x)) + Math.abs(dot(normal, y))) / Math.abs(faces);
                if (Math.abs(faces) < least) {
                    continue;
                }
            }
            if (faces < 0) {
                low[i] = Math.max(low[i], depth - slope);
            } else {
                high[i] = Math.min(high[i], depth + slope);
            }
        }
    }
    return { width, height, low, high };
}

/** The same of blocks of texels, each level half as fine as the one before. */
function pyramid(level) {
    const levels = [level];
    while (level.width > 1 || level.height > 1) {
        const [width, height] = [Math.ceil(level.width / 2), Math.ceil(level.height / 2)];
        const low = new Float32Array(width * height).fill(2);
        const high = new Float32Array(width * height).fill(-1);
        for (let y = 0; y < level.height; ++y) {
            for (let x = 0; x < level.width; ++x) {
                const to = (y >> 1) * width + (x >> 1);
                const from = y * level.width + x;
                low[to] = Math.min(low[to], level.low[from]);
                high[to] = Math.max(high[to], level.high[from]);
            }
        }
        level = { width, height, low, high };
        levels.push(level);
    }
    return levels;
}

/** Marks the cells that a map does not see outside wholly. */
function clear(cells, { from, side, n }, collider, index) {
    const { width, height, rows, empty_is_outside: empty } = collider.info.maps[index];
    const levels = pyramid(depthsInside(collider, index));
    const size = [width, height, 1];
    const reach = rows.map((row, k) => 0.5 * side * size[k] * (Math.abs(row[0]) + Math.abs(row[1]) + Math.abs(row[2])) +
                           (k < 2 ? kMargin : 1e-4));
    // Blocks so large that few of them cover a cell.
    const chosen = Math.min(Math.max(Math.ceil(Math.log2(2 * Math.max(reach[0], reach[1]) / kSide)), 0), levels.length - 1);
    const level = levels[chosen];
    let cell = 0;
    for (let z = 0; z < n[2]; ++z) {
        for (let y = 0; y < n[1]; ++y) {
            for (let x = 0; x < n[0]; ++x, ++cell) {
                if (!cells[cell]) {
                    continue;
                }
                const p = [from[0] + side * (x + 0.5), from[1] + side * (y + 0.5), from[2] + side * (z + 0.5)];
                const at = (k) => size[k] * (rows[k][0] * p[0] + rows[k][1] * p[1] + rows[k][2] * p[2] + rows[k][3]);
                const [u, v, depth] = [at(0), at(1), at(2)];
                if (empty && (depth + reach[2] < 0 || depth - reach[2] > 1)) {
                    cells[cell] = 0;
                    continue;
                }
                const [u0, u1] = [Math.max(Math.floor(u - reach[0]), 1), Math.min(Math.floor(u + reach[0]), width - 2)];
                const [v0, v1] = [Math.max(Math.floor(v - reach[1]), 1), Math.min(Math.floor(v + reach[1]), height - 2)];
                let outside = true;
                for (let b = v0 >> chosen; v0 <= v1 && b <= v1 >> chosen && outside; ++b) {
                    for (let a = u0 >> chosen; u0 <= u1 && a <= u1 >> chosen && outside; ++a) {
                        const i = b * level.width + a;
                        outside = depth + reach[2] < level.low[i] || depth - reach[2] > level.high[i];
                    }
                }
                cells[cell] = outside ? 0 : 1;
            }
        }
    }
}

/** Of cells that are 1 or 0 how far the next 1 is, the longest axis counting (Rosenfeld and Pfaltz 1968). */
function distances(cells, n) {
    const far = cells.map((one) => (one ? 0 : 255));
    const stride = [1, n[0], n[0] * n[1]];
    for (const way of [-1, 1]) {
        // The 13 neighbours that this walk comes by before a cell.
        const before = [];
        for (let k = 0; k < 13; ++k) {
            before.push([k % 3 - 1, Math.floor(k / 3) % 3 - 1, Math.floor(k / 9) - 1].map((v) => -way * v));
        }
        const last = far.length - 1;
        for (let i = 0; i <= last; ++i) {
            const cell = way < 0 ? i : last - i;
            if (far[cell] === 0) {
                continue;
            }
            const at = [cell % n[0], Math.floor(cell / n[0]) % n[1], Math.floor(cell / stride[2])];
            for (const step of before) {
                const [x, y, z] = [at[0] + step[0], at[1] + step[1], at[2] + step[2]];
                if (x >= 0 && y >= 0 && z >= 0 && x < n[0] && y < n[1] && z < n[2]) {
                    far[cell] = Math.min(far[cell], far[cell + step[0] + step[1] * stride[1] + step[2] * stride[2]] + 1);
                }
            }
        }
    }
    return far;
}

/**
 * @param bounds  of what is drawn
 * @returns { n, from, side, far }: cells along each axis, the corner of the first one, their side, and the numbers, x fastest
 */
export function cellsOf(collider, { min, max }) {
    const size = max.map((v, k) => v - min[k]);
    const side = Math.max(...size) / kCells || 1;
    const grid = { from: min, side, n: size.map((one) => Math.max(Math.ceil(one / side - 1e-6), 1)) };
    const cells = new Uint8Array(grid.n[0] * grid.n[1] * grid.n[2]).fill(1);
    collider.info.maps.forEach((map, i) => {
        if (map.projection === "orthographic" && map.encloses && map.compare !== "gap") {
            clear(cells, grid, collider, i);
        }
    });
    return { ...grid, far: distances(cells, grid.n) };
}
