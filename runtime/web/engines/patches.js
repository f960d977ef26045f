// SPDX-License-Identifier: Apache-2.0
// Trees of patches on the CPU: formats/patch_tree.cpp in JavaScript. Math.fround() after each operation makes results
// bit-identical to that file; formats/README.md specifies the arithmetic.
const f = Math.fround;
const kLevelsMax = 15;
const kTexelsMax = 1 << 24;
const kSides = [2, 3, 5, 0]; // heights along a side of a patch; 0 for a pair
const kBelowOne = 1 - 2 ** -24; // f(kBelowOne * n) is the largest float below the integer n
const kFarOutside = f(1e30);
const kNearest = 1 / 1024; // minimum distance between the surface and cells without a patch, in cells

const kindOf = (low) => low & 3;
const isPair = (low) => (low & 15) === 15;
const countBits = (bits) => {
    let count = 0;
    for (let rest = bits; rest !== 0; rest &= rest - 1) {
        ++count;
    }
    return count;
};

const scalar = new DataView(new ArrayBuffer(4));
const floatOf = (bits) => {
    scalar.setUint32(0, bits);
    return scalar.getFloat32(0);
};

/** The contents of texel 0. */
export const treeSize = (words) =>
    ({ roots: [words[0] & 0xffff, words[0] >>> 16, words[1] & 0xffff], levels: words[1] >>> 16 });

/** Throws if a record refers to texels that do not exist. words: two for each texel. */
export function validateTree(words) {
    const count = words.length / 2;
    const check = (valid, texel, text) => {
        if (!valid) {
            throw new Error(`texel ${texel} ${text}; bake the mesh again`);
        }
    };
    check(count <= kTexelsMax, count, `exceeds the limit of ${kTexelsMax} texels`);
    const { roots, levels } = treeSize(words);
    const rootCount = roots[0] * roots[1] * roots[2];
    check(rootCount > 0 && levels <= kLevelsMax && 1 + rootCount <= count, 0,
          "of its tree of patches declares an invalid size");
    // Texels at … end − 1 are the records of one level, and the next level begins at `end`.
    let [at, end] = [1, 1 + rootCount];
    const leaves = [];
    for (let level = 0; at < end; ++level) {
        let next = end;
        for (; at < end; ++at) {
            const [low, high] = [words[2 * at], words[2 * at + 1]];
            if (kindOf(low) === 2) {
                const children = countBits((low >>> 2) & 0xff);
                check(level < levels && (high & 0xffffff) === next && next + children <= count, at,
                      "is a split cell whose children are not the next texels");
                next += children;
            } else if (kindOf(low) === 3) {
                leaves.push(at);
            } else {
                check(((low >>> 16) & 0xff) !== 0xff && low >>> 24 !== 0xff, at, "has the invalid normal index 255");
                check(Number.isFinite(floatOf(high)), at, "contains a number that is not finite");
            }
        }
        end = next;
    }
    const isBehind = (high, used) => (high & 0xffffff) >= end && (high & 0xffffff) + used <= count;
    const checkPatch = (texel) => {
        const [low, high] = [words[2 * texel], words[2 * texel + 1]];
        const side = kSides[(low >>> 2) & 3];
        check(kindOf(low) === 3 && side > 0 && ((low >>> 5) & 3) < 3 && ((low >>> 7) & 3) < 3, texel,
              "is a patch of an unknown kind");
        check(side === 2 || isBehind(high, (side * side - 1) / 8), texel, "is a patch whose heights are out of place");
    };
    for (const texel of leaves) {
        const [low, high] = [words[2 * texel], words[2 * texel + 1]];
        if (isPair(low)) {
            check(isBehind(high, 2), texel, "is a pair whose patches are out of place");
            checkPatch(high & 0xffffff);
            checkPatch((high & 0xffffff) + 1);
        } else {
            checkPatch(texel);
        }
    }
}

const dot = (ax, ay, az, bx, by, bz) => f(f(ax * bx) + f(f(ay * by) + f(az * bz)));
const lengthOf = (x, y, z) => f(Math.sqrt(f(f(f(x * x) + f(y * y)) + f(z * z))));

// The latest vote, in map space; reused, so that calls do not allocate memory.
const vote = { distance: 0, x: 0, y: 0, z: 0 };

function setVote(distance, x, y, z) {
    vote.distance = distance;
    vote.x = x;
    vote.y = y;
    vote.z = z;
}

/** (x, y, z): the point in the unit cube of the cell. */
function votePatch(words, texel, x, y, z) {
    const [low, high] = [words[2 * texel], words[2 * texel + 1]];
    const diagonal = (low >>> 5) & 3;
    const axis = (low >>> 7) & 3;
    let a = axis === 0 ? x : axis === 1 ? y : z;
    let b = axis === 0 ? y : axis === 1 ? z : x;
    const c = axis === 0 ? z : axis === 1 ? x : y;
    a = (low & 0x200) !== 0 ? f(1 - a) : a;
    b = (low & 0x400) !== 0 ? f(1 - b) : b;
    let [u, v, w] = [b, c, a];
    if (diagonal !== 0) {
        u = f(0.5 * f(f(a - b) + 1));
        w = f(a + b);
    }
    if (diagonal === 2) {
        v = f(0.25 * f(f(f(a + b) - f(2 * c)) + 2));
        w = f(w + c);
    }
    const side = kSides[(low >>> 2) & 3];
    const squares = side - 1;
    const [column, row] = [f(u * squares), f(v * squares)];
    const [i, j] = [column, row].map((place) => Math.min(Math.max(Math.floor(place), 0), squares - 1));
    const [s, t] = [f(column - i), f(row - j)];
    const code = (index) => {
        if (index === side * side - 1) {
            return (low >>> 23) & 0xff;
        }
        const word = side === 2 ? high : words[2 * (high & 0xffffff) + Math.floor(index / 4)];
        return (word >>> (8 * (index & 3))) & 0xff;
    };
    const corner = j * side + i;
    const [c00, c10, c01, c11] = [corner, corner + 1, corner + side, corner + side + 1].map(code);
    const scale = high >>> 24;
    const step = f(f(1 + (scale & 15) / 16) * 2 ** ((scale >>> 4) - 12) * f(1 / 255));
    const lower = f(c00 + f(s * (c10 - c00)));
    const upper = f(c01 + f(s * (c11 - c01)));
    const base = (((low >>> 11) & 0xfff) - 2048) / 512;
    const height = f(base + f(step * f(lower + f(t * f(upper - lower)))));
    const slope = f(step * squares);
    const byU = f(slope * f(c10 - c00 + f(t * (c11 - c01 - (c10 - c00)))));
    const byV = f(slope * f(upper - lower));
    let [ga, gb, gc] = [1, -byU, -byV];
    if (diagonal === 1) {
        [ga, gb] = [f(1 - f(0.5 * byU)), f(1 + f(0.5 * byU))];
    } else if (diagonal === 2) {
        [ga, gb] = [f(f(1 - f(0.5 * byU)) - f(0.25 * byV)), f(f(1 + f(0.5 * byU)) - f(0.25 * byV))];
        gc = f(1 + f(0.5 * byV));
    }
    ga = (low & 0x200) !== 0 ? -ga : ga;
    gb = (low & 0x400) !== 0 ? -gb : gb;
    const [gx, gy, gz] = axis === 0 ? [ga, gb, gc] : axis === 1 ? [gc, ga, gb] : [gb, gc, ga];
    const perLength = f(1 / f(Math.sqrt(dot(gx, gy, gz, gx, gy, gz))));
    const sign = (low & 16) !== 0 ? -1 : 1;
    const factor = sign * perLength;
    setVote(sign * f(f(w - height) * perLength), f(factor * gx), f(factor * gy), f(factor * gz));
}

/** Returns the decoded normal of an index on the octahedron: formats/normal_index.cpp. */
function flatNormal(s, t) {
    const [u, v] = [f((Math.min(s, 254) - 127) / 127), f((Math.min(t, 254) - 127) / 127)];
    const z = f(f(1 - Math.abs(u)) - Math.abs(v));
    const x = z < 0 ? (u < 0 ? -1 : 1) * f(1 - Math.abs(v)) : u;
    const y = z < 0 ? (v < 0 ? -1 : 1) * f(1 - Math.abs(u)) : v;
    return [x, y, z];
}

/** Returns the decoded normal of the coarse index of a split cell; exact, but not of unit length. */
function coarseNormal(s, t) {
    const [x, y] = [s - 63, t - 63];
    const z = 63 - Math.abs(x) - Math.abs(y);
    const beyond = Math.max(-z, 0);
    return [x < 0 ? x + beyond : x - beyond, y < 0 ? y + beyond : y - beyond, z];
}

/** Sets `vote` for a point in map space, within the roots. */
function votePatches(words, { roots, levels }, px, py, pz) {
    const [i, j, k] = [Math.floor(px), Math.floor(py), Math.floor(pz)];
    let texel = 1 + (k * roots[1] + j) * roots[0] + i;
    let [x, y, z] = [f(px - i), f(py - j), f(pz - k)];
    let cell = 1;
    let low = words[2 * texel];
    let isInside = kindOf(low) === 1;
    for (let level = 0; level < levels && kindOf(low) === 2; ++level) {
        const [cx, cy, cz] = [2 * x, 2 * y, 2 * z];
        const octant = (cx >= 1 ? 1 : 0) + (cy >= 1 ? 2 : 0) + (cz >= 1 ? 4 : 0);
        const children = (low >>> 2) & 0xff;
        if (((children >>> octant) & 1) === 0) {
            isInside = ((low >>> (10 + octant)) & 1) !== 0;
            break;
        }
        x = f(cx - (octant & 1));
        y = f(cy - ((octant >>> 1) & 1));
        z = f(cz - (octant >>> 2));
        cell *= 0.5;
        texel = (words[2 * texel + 1] & 0xffffff) + countBits(children & ((1 << octant) - 1));
        low = words[2 * texel];
        isInside = kindOf(low) === 1;
    }
    const high = words[2 * texel + 1];
    if (kindOf(low) === 3) {
        if (isPair(low)) {
            const first = high & 0xffffff;
            votePatch(words, first, x, y, z);
            const { distance, x: nx, y: ny, z: nz } = vote;
            votePatch(words, first + 1, x, y, z);
            const secondDecides = (low & 16) !== 0 ? vote.distance > distance : vote.distance < distance;
            if (!secondDecides) {
                setVote(distance, nx, ny, nz);
            }
        } else {
            votePatch(words, texel, x, y, z);
        }
        vote.distance = f(vote.distance * cell);
        return;
    }
    const isCoarse = kindOf(low) === 2;
    const normal = isCoarse ? coarseNormal((low >>> 18) & 127, low >>> 25) : flatNormal(low >>> 24, (low >>> 16) & 255);
    const length = lengthOf(...normal);
    const [nx, ny, nz] = normal.map((component) => f(component / length));
    const along = dot(nx, ny, nz, f(x - 0.5), f(y - 0.5), f(z - 0.5));
    const onSide = (distance, nearest) => (isInside ? Math.min(distance, -nearest) : Math.max(distance, nearest));
    const distance = isCoarse ? f(cell * onSide(f(along + ((high >>> 24) - 128) / 128), kNearest))
                              : onSide(f(floatOf(high) + f(cell * along)), cell * kNearest);
    setVote(distance, nx, ny, nz);
}

const row = (constants, at, [x, y, z]) =>
    f(f(constants[at] * x) + f(f(constants[at + 1] * y) + f(f(constants[at + 2] * z) + constants[at + 3])));

/** Like distance(), but extrapolates the surface up to `reach` beyond the root cells. */
function near(collider, point, reach, normal) {
    const constants = collider.floats;
    const root = constants[12];
    const p = [f(point[0]), f(point[1]), f(point[2])];
    const q = [row(constants, 0, p), row(constants, 4, p), row(constants, 8, p)];
    const clamped = q.map((x, i) => Math.min(Math.max(x, 0), f(kBelowOne * constants[13 + i])));
    const within = clamped.every((x, i) => x === q[i]); // false for NaN
    const to = q.map((x, i) => f(f(root * root) * f(x - clamped[i])));
    const way = within ? [0, 0, 0]
        : [0, 1, 2].map((k) => f(f(constants[k] * to[0]) + f(f(constants[4 + k] * to[1]) + f(constants[8 + k] * to[2]))));
    if (!within && !(reach > 0 && dot(...way, ...way) < f(reach * reach))) {
        normal?.fill(0, 0, 3);
        return kFarOutside;
    }
    votePatches(collider.words, treeSize(collider.words), ...clamped);
    const left = f(vote.distance * root);
    if (left === -Infinity) { // an overflow is not inside
        normal?.fill(0, 0, 3);
        return kFarOutside;
    }
    for (let i = 0; normal && i < 3; ++i) {
        const part = (at, component) => f(f(constants[at + i] * root) * component);
        normal[i] = f(part(0, vote.x) + f(part(4, vote.y) + part(8, vote.z)));
    }
    return within ? left : f(left + dot(...way, normal[0], normal[1], normal[2]));
}

export function distance(collider, point, normal) {
    return near(collider, point, 0, normal);
}

export function collide(collider, position, velocity, { radius = 0, restitution = 0, friction = 0, normal } = {}) {
    const n = [0, 0, 0];
    const left = f(near(collider, position, f(radius), n) - f(radius));
    if (left < 0) {
        const speed = dot(f(velocity[0]), f(velocity[1]), f(velocity[2]), ...n);
        for (let i = 0; i < 3; ++i) {
            position[i] = f(f(position[i]) - f(left * n[i]));
            const along = f(f(velocity[i]) - f(speed * n[i]));
            const bounced = f(f(f(1 - f(friction)) * along) - f(f(f(restitution) * speed) * n[i]));
            velocity[i] = speed < 0 ? bounced : velocity[i];
        }
    }
    for (let i = 0; normal && i < 3; ++i) {
        normal[i] = left < 0 ? n[i] : 0;
    }
    return left;
}
