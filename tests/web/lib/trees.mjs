// SPDX-License-Identifier: Apache-2.0
// Containers of patches written by hand: random trees with every kind of leaf, and damaged files whose checksums are right.
// Needs only Node.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";

import { xxh3 } from "../../../runtime/web/engines/xxh3.js";
import { generator } from "./random.mjs";

/** The 13 frames: [diagonal, first axis, mirrored]. */
const kFrames = [[0, 0, 0], [0, 1, 0], [0, 2, 0], [1, 0, 0], [1, 1, 0], [1, 2, 0], [1, 0, 1], [1, 1, 1], [1, 2, 1],
                 [2, 0, 0], [2, 0, 1], [2, 0, 2], [2, 0, 3]];

/**
 * A random tree as words, two for each texel. Its patches cycle through all frames and sizes.
 * @returns { words, kinds }: how many records there are of each kind
 */
export function randomTree(seed, roots, levels) {
    const random = generator(seed);
    const below = (end) => Math.floor(random() * end);
    const nodes = [];
    const kinds = { flat: 0, split: 0, pair: 0, patches: Array(39).fill(0) };
    let patches = seed;
    const add = (level) => nodes.push({ kind: level < levels ? ["flat", "split", "patch"][below(3)] : ["flat", "patch"][below(2)] });
    for (let i = 0; i < roots[0] * roots[1] * roots[2]; ++i) {
        add(0);
    }
    for (let level = 0, at = 0; level < levels; ++level) {
        for (const end = nodes.length; at < end; ++at) {
            if (nodes[at].kind === "split") {
                nodes[at].children = below(256);
                nodes[at].first = 1 + nodes.length;
                for (let octant = 0; octant < 8; ++octant) {
                    if ((nodes[at].children >> octant) & 1) {
                        add(level + 1);
                    }
                }
            }
        }
    }
    const heights = [];
    const place = () => 1 + nodes.length + heights.length / 2;
    const patch = () => {
        const [size, [diagonal, first, mirrored]] = [patches % 3, kFrames[Math.floor(patches / 3) % 13]];
        ++kinds.patches[patches++ % 39];
        const [codes, last] = [Array.from({ length: [3, 8, 24][size] }, () => below(256)), below(256)];
        const base = 2048 + Math.floor(512 * (0.2 + 0.4 * random()) * (1 + diagonal));
        // A range of 1/8 to 1.9 heights.
        const scale = 16 * (9 + below(4)) + below(16);
        const low = (3 | (size << 2) | (below(2) << 4) | (diagonal << 5) | (first << 7) | (mirrored << 9) | (base << 11) | (last << 23)) >>> 0;
        if (size === 0) {
            return [low, (codes[0] | (codes[1] << 8) | (codes[2] << 16) | (scale << 24)) >>> 0];
        }
        const record = [low, (place() | (scale << 24)) >>> 0];
        for (let i = 0; i < codes.length; i += 4) {
            heights.push((codes[i] | (codes[i + 1] << 8) | (codes[i + 2] << 16) | (codes[i + 3] << 24)) >>> 0);
        }
        return record;
    };
    const bits = new DataView(new ArrayBuffer(4));
    const records = nodes.flatMap(({ kind, children, first }) => {
        if (kind === "split") {
            ++kinds.split;
            return [(2 | (children << 2) | (below(256) << 10) | (below(127) << 18) | (below(127) << 25)) >>> 0,
                    (first | (below(256) << 24)) >>> 0];
        }
        if (kind === "flat") {
            ++kinds.flat;
            const isInside = below(2);
            bits.setFloat32(0, (isInside ? -2 : 2) * random());
            return [(isInside | (below(255) << 16) | (below(255) << 24)) >>> 0, bits.getUint32(0)];
        }
        if (below(3) > 0) {
            return patch();
        }
        ++kinds.pair;
        const both = [...patch(), ...patch()];
        const record = [15 | (below(2) << 4), place()];
        heights.push(...both);
        return record;
    });
    return { words: Uint32Array.from([(roots[0] | (roots[1] << 16)) >>> 0, (roots[2] | (levels << 16)) >>> 0, ...records, ...heights]), kinds };
}

/** Writes a FlatBuffers table front to back, with forward offsets. */
class Writer {
    bytes = [];

    align(size) {
        while (this.bytes.length % size !== 0) {
            this.bytes.push(0);
        }
        return this.bytes.length;
    }
    number(value, size) {
        let rest = BigInt(value);
        for (let i = 0; i < size; ++i, rest >>= 8n) {
            this.bytes.push(Number(rest & 0xffn));
        }
    }
    floats(values) {
        this.bytes.push(...new Uint8Array(Float32Array.from(values).buffer));
    }
    patch(at, value) {
        [0, 8, 16, 24].forEach((shift, i) => (this.bytes[at + i] = (value >>> shift) & 0xff));
    }
    /** Fills the offset at `from` with the place of what follows. */
    follow(from) {
        this.align(4);
        this.patch(from, this.bytes.length - from);
    }
    text(from, text) {
        this.follow(from);
        this.number(text.length, 4);
        this.bytes.push(...Buffer.from(text), 0);
    }
    /** fields: [size, alignment, write] or undefined. @returns the place of each field */
    table(from, fields) {
        this.align(8);
        const places = this.bytes.length;
        const head = 4 + 2 * fields.length;
        for (let i = 0; i < head; ++i) {
            this.bytes.push(0);
        }
        const at = this.align(8);
        this.patch(from, at - from);
        this.number(at - places, 4);
        const written = fields.map((field) => {
            if (!field) {
                return 0;
            }
            const place = this.align(field[1]);
            field[2]();
            return place;
        });
        [head, this.bytes.length - at, ...written.map((place) => (place === 0 ? 0 : place - at))].forEach((value, i) => {
            this.bytes[places + 2 * i] = value & 0xff;
            this.bytes[places + 2 * i + 1] = value >> 8;
        });
        return written;
    }
}

/**
 * A container with one map of patches. Its last bytes are the payload.
 * transform: 12 numbers, the rows of object_to_map, a rotation with scale; root: the edge of a root cell; map: other
 * values of its fields. The bounds are those of the root cells.
 * @returns { bytes, hashAt, payloadAt }: the container, and places in it
 */
export function containerOf(words, { transform = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0], root = 1, ...map } = {}) {
    const texels = words.length / 2;
    let width = 16;
    while (width * 16384 < texels) {
        width *= 2;
    }
    const height = Math.ceil(texels / width);
    const payload = new Uint8Array(8 * width * height);
    payload.set(new Uint8Array(words.buffer, words.byteOffset, words.byteLength));
    const writer = new Writer();
    const offset = [4, 4, () => writer.number(0, 4)];
    const [byte, word] = [1, 4].map((size) => (value) => [size, size, () => writer.number(value, size)]);
    const floats = (values) => [4 * values.length, 4, () => writer.floats(values)];
    writer.number(0, 4);
    writer.bytes.push(...Buffer.from("RLF2"));
    const roots = [words[0] & 0xffff, words[0] >>> 16, words[1] & 0xffff];
    const ends = [0, 1, 2].map((i) => roots.reduce(([low, high], count, k) => {
        const along = [0, count].map((q) => root ** 2 * transform[4 * k + i] * (q - transform[4 * k + 3]));
        return [low + Math.min(...along), high + Math.max(...along)];
    }, [0, 0]));
    const collider = writer.table(0, [floats(ends.map(([low]) => low)), floats(ends.map(([, high]) => high)), offset, offset, offset]);
    writer.text(collider[2], "m");
    const provenance = writer.table(collider[3], [offset, offset, [8, 8, () => writer.number(12, 8)], offset]);
    writer.text(provenance[0], "tree.obj");
    writer.text(provenance[1], "00112233445566778899aabbccddeeff");
    writer.text(provenance[3], "test");
    writer.follow(collider[4]);
    writer.number(1, 4);
    const list = writer.bytes.length;
    writer.number(0, 4);
    const fields = { format: 5, compare: 0, width, height, encloses: 1, emptyIsOutside: 1, compression: 0, decode: 1, rawSize: payload.length,
                     storedSize: payload.length, ...map };
    const places = writer.table(list, [byte(fields.format), byte(fields.compare), word(fields.width), word(fields.height), floats(transform),
                                       floats([root, root, root]), byte(fields.encloses), byte(fields.emptyIsOutside), byte(fields.compression),
                                       [32, 8, () => [0, fields.storedSize, fields.rawSize, xxh3(payload)].forEach((value) => writer.number(value, 8))],
                                       byte(fields.decode)]);
    const end = 64 + writer.bytes.length;
    const at = Math.ceil(end / 64) * 64;
    writer.patch(places[9], at);
    const bytes = new Uint8Array(at + payload.length);
    bytes.set([0xab, ...Buffer.from("RELIEF"), 0xbb, 13, 10, 26, 10, 2, 0, 0, 0, 64]);
    bytes.set(writer.bytes, 64);
    bytes.set(payload, at);
    const view = new DataView(bytes.buffer);
    view.setBigUint64(24, BigInt(bytes.length), true);
    view.setBigUint64(32, 64n, true);
    view.setBigUint64(40, BigInt(writer.bytes.length), true);
    return { bytes: seal(bytes), hashAt: 64 + places[9] + 24, payloadAt: at };
}

/**
 * Corrects the checksums, so that readers reach the checks behind them. hashAt, payloadAt: as of containerOf(), for the
 * checksum of the payload.
 */
export function seal(bytes, hashAt, payloadAt) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    if (hashAt) {
        view.setBigUint64(hashAt, xxh3(bytes.subarray(payloadAt)), true);
    }
    const size = view.getBigUint64(40, true);
    if (size >= 9n && size <= BigInt(bytes.length - 64)) {
        view.setBigUint64(48, xxh3(bytes.subarray(64, 64 + Number(size))), true);
    }
    view.setBigUint64(56, xxh3(bytes.subarray(0, 56)), true);
    return bytes;
}

/** Writes seven trees with every kind of leaf, three of them turned and scaled. @returns the names of the files */
export function writeTrees(folder) {
    const turned = { transform: [0, 0, 2, 1, 0, -2, 0, 2.5, 2, 0, 0, 0.25], root: 0.5 };
    const kinds = { flat: 0, split: 0, pair: 0, patches: Array(39).fill(0) };
    const names = [[1, [1, 2, 1], 5], [2, [3, 2, 4], 3], [3, [3, 2, 4], 3], [4, [7, 1, 2], 4], [5, [4, 4, 4], 1], [6, [2, 2, 2], 4],
                   [7, [5, 4, 3], 3]].map(([seed, roots, levels]) => {
        const tree = randomTree(seed, roots, levels);
        assert.ok(tree.kinds.split > 0);
        ["flat", "split", "pair"].forEach((kind) => (kinds[kind] += tree.kinds[kind]));
        tree.kinds.patches.forEach((n, i) => (kinds.patches[i] += n));
        writeFileSync(path.join(folder, `tree${seed}.relief`), containerOf(tree.words, seed % 2 === 0 ? turned : {}).bytes);
        return `tree${seed}.relief`;
    });
    assert.ok(Math.min(kinds.flat, kinds.split, kinds.pair, ...kinds.patches) >= 5, JSON.stringify(kinds));
    return names;
}
