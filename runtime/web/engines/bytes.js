// SPDX-License-Identifier: Apache-2.0
// Bytes and errors, shared by the readers of this folder.
export function check(valid, text) {
    if (!valid) {
        throw new Error(text);
    }
}

export const viewOf = (bytes) => new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
export const bytesOf = (view) => new Uint8Array(view.buffer, view.byteOffset, view.byteLength);

/** Returns whether a view is UTF-8 without control characters. */
export function isPlainText(view) {
    try {
        return !/[\0-\x1f\x7f-\x9f]/.test(new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(view));
    } catch {
        return false;
    }
}
