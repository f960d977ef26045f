// SPDX-License-Identifier: Apache-2.0
// XXH3-64 without seed (https://github.com/Cyan4973/xxHash/blob/dev/doc/xxhash_spec.md), for at least 9 bytes.
import { viewOf } from "./bytes.js";

const kMask = 0xffffffffffffffffn;
const kPrime32 = [0x9e3779b1n, 0x85ebca77n, 0xc2b2ae3dn];
const kPrime64 = [0x9e3779b185ebca87n, 0xc2b2ae3d27d4eb4fn, 0x165667b19e3779f9n, 0x85ebca77c2b2ae63n, 0x27d4eb2f165667c5n];
const kSecret = Uint8Array.from(
    ("b8fe6c3923a44bbe7c01812cf721ad1cded46de9839097db7240a4a4b7b3671fcb79e64eccc0e578825ad07dccff7221" +
     "b8084674f743248ee03590e6813a264c3c2852bb91c300cb88d0658b1b532ea371644897a20df94e3819ef46a9deacd8" +
     "a8fa763fe39c343ff9dcbbc7c70b4f1d8a51e04bcdb45931c89f7ec9d9787364eac5ac8334d3ebc3c581a0fffa1363eb" +
     "170ddd51b7f0da49d316552629d4689e2b16be587d47a1fc8ff8b8d17ad031ce45cb3a8f95160428afd7fbcabb4b407e")
        .match(/../g), (digits) => parseInt(digits, 16));

const secret = viewOf(kSecret);
const secretAt = (at) => secret.getBigUint64(at, true);

const fold = (a, b) => {
    const product = a * b;
    return (product & kMask) ^ (product >> 64n);
};

function avalanche(hash) {
    hash ^= hash >> 37n;
    hash = (hash * 0x165667919e3779f9n) & kMask;
    return hash ^ (hash >> 32n);
}

const swapped = (word) => {
    const bytes = new DataView(new ArrayBuffer(8));
    bytes.setBigUint64(0, word, true);
    return bytes.getBigUint64(0);
};

/** 9 to 240 bytes. */
function hashShort(view) {
    const length = view.byteLength;
    const at = (i) => view.getBigUint64(i, true);
    const mix = (i, key) => fold(at(i) ^ secretAt(key), at(i + 8) ^ secretAt(key + 8));
    if (length <= 16) {
        const low = at(0) ^ secretAt(24) ^ secretAt(32);
        const high = at(length - 8) ^ secretAt(40) ^ secretAt(48);
        return avalanche((BigInt(length) + swapped(low) + high + fold(low, high)) & kMask);
    }
    let hash = BigInt(length) * kPrime64[0];
    if (length <= 128) {
        for (let i = 16 * Math.floor((length - 1) / 32); i >= 0; i -= 16) {
            hash += mix(i, 2 * i) + mix(length - i - 16, 2 * i + 16);
        }
        return avalanche(hash & kMask);
    }
    for (let i = 0; i < 128; i += 16) {
        hash += mix(i, i);
    }
    hash = avalanche(hash & kMask);
    for (let i = 128; i + 16 <= length; i += 16) {
        hash += mix(i, i - 128 + 3);
    }
    return avalanche((hash + mix(length - 16, 136 - 17)) & kMask);
}

/** More than 240 bytes. Splits the accumulators into 32-bit halves, because a BigInt per word is ten times slower. */
function hashLong(bytes) {
    const view = viewOf(bytes);
    const accumulators = BigUint64Array.of(kPrime32[2], kPrime64[0], kPrime64[1], kPrime64[2], kPrime64[3], kPrime32[1],
                                           kPrime64[4], kPrime32[0]);
    const halves = new Uint32Array(accumulators.buffer); // little-endian, as all platforms of browsers
    const stripe = (at, key) => {
        for (let i = 0; i < 16; i += 2) {
            const low = view.getUint32(at + 4 * i, true);
            const high = view.getUint32(at + 4 * i + 4, true);
            const a = (low ^ secret.getUint32(key + 4 * i, true)) >>> 0;
            const b = (high ^ secret.getUint32(key + 4 * i + 4, true)) >>> 0;
            // a * b in two steps, each exact in a double.
            const upper = (a >>> 16) * b;
            const lower = (a & 0xffff) * b + (upper % 65536) * 65536;
            let sum = halves[i] + (lower % 4294967296);
            halves[i] = sum;
            halves[i + 1] += Math.floor(upper / 65536) + Math.floor(lower / 4294967296) + (sum > 0xffffffff ? 1 : 0);
            const other = i ^ 2;
            sum = halves[other] + low;
            halves[other] = sum;
            halves[other + 1] += high + (sum > 0xffffffff ? 1 : 0);
        }
    };
    const last = bytes.length - 64;
    for (let at = 0, key = 0; at < bytes.length - 64; at += 64) {
        stripe(at, key);
        key += 8;
        if (key === 128) {
            accumulators.forEach((word, i) => {
                accumulators[i] = ((word ^ (word >> 47n) ^ secretAt(128 + 8 * i)) * kPrime32[0]) & kMask;
            });
            key = 0;
        }
    }
    stripe(last, 121);
    let hash = BigInt(bytes.length) * kPrime64[0];
    for (let i = 0; i < 8; i += 2) {
        hash += fold(accumulators[i] ^ secretAt(11 + 8 * i), accumulators[i + 1] ^ secretAt(19 + 8 * i));
    }
    return avalanche(hash & kMask);
}

/** Returns the hash of at least 9 bytes, as a BigInt. */
export const xxh3 = (bytes) => (bytes.length > 240 ? hashLong(bytes) : hashShort(viewOf(bytes)));
