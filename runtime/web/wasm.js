// SPDX-License-Identifier: Apache-2.0
// Loads the WebAssembly module, which serves all contexts of a page, and calls its functions.
import { decompress } from "fzstd";

import { ReliefError, check } from "./fetch.js";
import createReliefWasm from "./relief_wasm.mjs";

let loading = null; // promise of the WebAssembly instance
export let wasm = null;

// The development server of Vite serves this module from its dependency cache, which lacks the .wasm file.
const cached = /^(.*\/node_modules\/)\.vite\/deps[^/]*\//.exec(import.meta.url);
const wasmBeside = cached ? `${cached[1]}relief-particles/relief_wasm.wasm` : null;

export function init({ wasmUrl = wasmBeside, ...options } = {}) {
    loading ??= createReliefWasm({
        ...(wasmUrl ? { locateFile: () => String(wasmUrl) } : {}),
        ...options,
        decompress: (bytes, size) => decompress(bytes, new Uint8Array(size)),
        print: () => {},
        printErr: () => {},
    }).then(
        (made) => (wasm = made),
        (error) => {
            loading = null;
            throw new ReliefError(`cannot start the WebAssembly module of Relief: ${error.message ?? error}`);
        },
    );
    return loading;
}

export function instance() {
    check(wasm, "Relief is not loaded yet; await init() or load() first");
    return wasm;
}

/** Reads a string from WebAssembly memory, and removes the folder of scene files from it. */
export const textAt = (at) => wasm.UTF8ToString(at).replaceAll(/\/scene\d+\//g, "");

function lastError() {
    return new ReliefError(textAt(wasm._relief_error()));
}

/** Copies a string or a typed array to WebAssembly memory and returns its address. */
function copyToWasm(value) {
    const size = typeof value === "string" ? wasm.lengthBytesUTF8(value) + 1 : Math.max(value.byteLength, 1);
    const at = wasm._malloc(size);
    check(at !== 0, `out of memory for ${size} bytes; use fewer particles or a smaller collider`);
    if (typeof value === "string") {
        wasm.stringToUTF8(value, at, size);
    } else {
        wasm.HEAPU8.set(bytesIn(value), at);
    }
    return at;
}

const bytesIn = ({ buffer, byteOffset, byteLength }) => new Uint8Array(buffer, byteOffset, byteLength);

/**
 * Calls an exported function. Strings and typed arrays are passed as copies; arrays other than Uint8Array are copied
 * back afterwards. A trap, which ends the instance, is rethrown as a ReliefError.
 */
export function call(name, ...args) {
    const functions = instance();
    const copies = new Map();
    try {
        const plain = args.map((one) => {
            if (typeof one === "number") {
                return one;
            }
            copies.set(one, copyToWasm(one));
            return copies.get(one);
        });
        const result = functions[`_${name}`](...plain);
        for (const [one, at] of copies) {
            if (ArrayBuffer.isView(one) && !(one instanceof Uint8Array)) {
                bytesIn(one).set(wasm.HEAPU8.subarray(at, at + one.byteLength));
            }
        }
        return result;
    } catch (error) {
        throw error instanceof ReliefError ? error
            : new ReliefError(`Relief crashed (${error.message ?? error}); reload the page`);
    } finally {
        copies.forEach((at) => wasm._free(at));
    }
}

/** Like call(), for functions that return null on failure. */
export function callForHandle(name, ...args) {
    const handle = call(name, ...args);
    if (handle === 0) {
        throw lastError();
    }
    return handle;
}

/** Like call(), for functions that return a negative number on failure. */
export function callChecked(name, ...args) {
    const code = call(name, ...args);
    if (code < 0) {
        throw lastError();
    }
    return code;
}
