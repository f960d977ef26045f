// SPDX-License-Identifier: Apache-2.0
// Checks the materials of a container as formats/materials.cpp does. This reader does not use them.
import { bytesOf, check, isPlainText, viewOf } from "./bytes.js";
import { unpack } from "./zstd.js";

const kNodesMax = 1 << 20;
const kLevelsMax = 20;
const kNodeBytes = 12;
const kAxes = 9;

const isFraction = (value) => value >= 0 && value <= 1;

function checkNodes(bytes, leaves) {
    const view = viewOf(bytes);
    const count = bytes.length / kNodeBytes;
    let known = Math.min(count, 1);
    let [levelEnd, level] = [known, 1];
    for (let i = 0; i < count; ++i) {
        if (i === levelEnd) {
            ++level;
            levelEnd = known;
        }
        const head = view.getUint32(kNodeBytes * i, true);
        const mask = head & 0xff;
        check(i < known && level <= kLevelsMax && head >>> 8 === (mask === 0 ? 0 : known),
              `material node ${i} is out of order`);
        for (let octant = 0; octant < 8; ++octant) {
            const isNode = ((mask >>> octant) & 1) !== 0;
            const leaf = bytes[kNodeBytes * i + 4 + octant];
            known += isNode ? 1 : 0;
            check(isNode ? leaf === 0 : leaf < leaves, `material node ${i} has an octant with an invalid material`);
        }
    }
    check(known === count, "material nodes are missing");
}

export function validateMaterials({ list, sides, origin, size, nodes, compression, nodesSize }, decompress) {
    const names = list.map(({ name }) => {
        check(name.byteLength <= 256 && isPlainText(name), "a material's name is too long, or not clean UTF-8");
        return new TextDecoder("utf-8", { ignoreBOM: true }).decode(name);
    });
    check(names.every((name) => !/[\u202a-\u202e\u2066-\u2069]/.test(name)) && new Set(names).size === names.length,
          "a material's name is not clean UTF-8, or that of another one");
    check(list.every((one) => isFraction(one.restitution) && isFraction(one.friction) && isFraction(one.areaFraction) &&
                              one.lifetimeLoss >= 0 && one.lifetimeLoss <= 1e6),
          "a material has a number out of range");
    const pairs = (sides?.byteLength ?? 0) / 3;
    const leaves = list.length + pairs;
    check(pairs <= 255 && leaves <= 256,
          `there are ${pairs} pairs of sides; together with the materials, more than 256`);
    for (let i = 0; i < pairs; ++i) {
        const [axis, towards, against] = [0, 1, 2].map((k) => sides.getUint8(3 * i + k));
        check(axis < kAxes && towards < list.length && against < list.length,
              "a pair of sides has an invalid axis or material");
    }
    const stored = nodes ? bytesOf(nodes) : new Uint8Array(0);
    let raw = stored;
    if (nodes || nodesSize !== 0) {
        check(nodesSize <= kNodesMax * kNodeBytes && nodesSize % kNodeBytes === 0 &&
              (compression === 0 ? nodesSize === stored.length : compression === 1 && nodesSize > stored.length),
              "materials.nodes_size does not match the stored nodes");
        raw = compression === 0 ? stored : unpack(stored, nodesSize, decompress, "the tree of the materials");
    }
    const corner = [0, 4, 8].map((at) => origin.getFloat32(at, true));
    check(list.length > 0 || (pairs === 0 && size === 0 && raw.length === 0 && corner.every((x) => x === 0)),
          "there is a material tree, but no materials");
    check([...corner, size].every(Number.isFinite) && size >= 0 && (size > 0 || raw.length === 0),
          "the cube of the materials is not finite, or empty");
    checkNodes(raw, leaves);
}
