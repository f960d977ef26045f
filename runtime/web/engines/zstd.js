// SPDX-License-Identifier: Apache-2.0
// Checks compressed bytes (RFC 8878, section 3.1.1) before the caller's function decompresses them.
import { check, viewOf } from "./bytes.js";

/** Returns whether bytes are exactly one zstd frame that states `size` as its content size. */
function exactFrame(bytes, size) {
    const view = viewOf(bytes);
    if (bytes.length < 9 || view.getUint32(0, true) !== 0xfd2fb528) {
        return false;
    }
    const descriptor = bytes[4];
    const isSingleSegment = (descriptor & 0x20) !== 0;
    const sizeBytes = [isSingleSegment ? 1 : 0, 2, 4, 8][descriptor >>> 6];
    const sizeAt = 5 + (isSingleSegment ? 0 : 1) + [0, 1, 2, 4][descriptor & 3];
    let at = sizeAt + sizeBytes;
    if (sizeBytes === 0 || (descriptor & 8) !== 0 || at > bytes.length) {
        return false;
    }
    let stated = sizeBytes === 2 ? 256 : 0;
    for (let i = 0; i < sizeBytes; ++i) {
        stated += bytes[sizeAt + i] * 256 ** i;
    }
    for (let isLast = false; !isLast;) {
        if (at + 3 > bytes.length) {
            return false;
        }
        const block = bytes[at] | (bytes[at + 1] << 8) | (bytes[at + 2] << 16);
        const kind = (block >>> 1) & 3;
        isLast = (block & 1) !== 0;
        at += 3 + (kind === 1 ? 1 : block >>> 3);
        if (kind === 3) {
            return false;
        }
    }
    return stated === size && at + (descriptor & 4) === bytes.length;
}

/** Decompresses bytes with the caller's function. what: the subject of messages. */
export function unpack(packed, size, decompress, what) {
    check(decompress, `${what} is compressed with zstd; pass { decompress }, or bake again with --compress 0`);
    check(exactFrame(packed, size), `${what} is not exactly one zstd frame with a content size of ${size} bytes`);
    let raw;
    try {
        raw = decompress(packed, size);
    } catch (error) {
        check(false, `${what} cannot be decompressed: ${error.message}`);
    }
    check(raw instanceof Uint8Array && raw.length === size, `${what} does not decompress to ${size} bytes`);
    return raw;
}
