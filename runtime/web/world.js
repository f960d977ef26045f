// SPDX-License-Identifier: Apache-2.0
// Worlds, and the folders in the file system of the WebAssembly module that hold the files of worlds and scenes.
import { Collider, runQuery } from "./collider.js";
import { ReliefError, bytesOf, check, urlIn, worldFiles } from "./fetch.js";
import { call, callForHandle, init, instance, wasm } from "./wasm.js";

let folders = 0;

/** Creates a folder in the file system of the WebAssembly module; free it with removeFolder(). */
export function makeFolder() {
    const folder = `/scene${folders++}`;
    wasm.FS.mkdir(folder);
    wasm.FS.mount(wasm.FS.filesystems.MEMFS, {}, folder);
    return folder;
}

export function removeFolder(folder) {
    wasm.FS.unmount(folder);
    wasm.FS.rmdir(folder);
}

export function writeIn(folder, name, content) {
    const parts = name.split("/");
    check(!parts.some((part) => part === "" || part === "." || part === ".."),
          `'${name}' is outside the scene's folder; use a relative path without '..'`);
    if (content instanceof Collider) {
        content.handle; // throws if disposed
    } else {
        check(content instanceof Uint8Array || typeof content === "string",
              `the file '${name}' must be a Collider, a Uint8Array or a string`);
    }
    wasm.FS.mkdirTree([folder, ...parts.slice(0, -1)].join("/"));
    wasm.FS.writeFile(`${folder}/${name}`, content instanceof Collider ? content.bytes : content);
}

async function worldOf(source, stream) {
    const [{ files, base }] = await Promise.all([worldFiles(source, stream !== undefined), init()]);
    try {
        return new World(files, stream && { ...stream, load: (name, signal) => bytesOf(urlIn(base, name), signal) });
    } catch (error) {
        throw new ReliefError(`${base}: ${error.message}`);
    }
}

export async function loadWorld(source) {
    return worldOf(source);
}

export async function streamWorld(source, options = {}) {
    checkStream("streamWorld()", options, ["radius", "memory"]);
    return worldOf(source, options);
}

/** @param what  the function that takes the options, for messages. */
function checkStream(what, options, keys) {
    const wrong = Object.keys(options).find((key) => !keys.includes(key));
    check(wrong === undefined, `${what} has no option '${wrong}'; it has ${keys.join(", ")}`);
    check(Number.isFinite(options.radius) && options.radius > 0,
          `${what} needs a radius above 0, within which the world has full detail`);
    check(options.memory === undefined || (Number.isFinite(options.memory) && options.memory > 0),
          `${what}: memory must be a number of megabytes above 0`);
}

export class World {
    #handle = 0;

    constructor(files, stream) {
        instance();
        this.files = { ...files };
        this.stream = null;
        if (stream) {
            checkStream("streaming a World", stream, ["radius", "memory", "load"]);
            check(typeof stream.load === "function",
                  "streaming a World needs 'load', a function that returns the bytes of a file");
            this.stream = { ...stream };
        }
        const folder = makeFolder();
        try {
            for (const [name, content] of Object.entries(this.files)) {
                writeIn(folder, name, content);
            }
            this.#handle = callForHandle(stream ? "relief_world_load_coarse" : "relief_world_load", `${folder}/world.json`);
        } finally {
            removeFolder(folder);
        }
        const text = this.files["world.json"];
        const { unit, colliders, bodies } = JSON.parse(typeof text === "string" ? text : new TextDecoder().decode(text));
        Object.assign(this, { unit, colliders, bodies });
        const low = new Float32Array(3);
        const high = new Float32Array(3);
        call("relief_world_bounds", this.#handle, low, high);
        this.bounds = { min: [...low], max: [...high] };
    }

    get handle() {
        check(this.#handle, "this world has been disposed of");
        return this.#handle;
    }

    query(points) {
        return runQuery("relief_world_query", this.handle, points, "body");
    }

    dispose() {
        if (this.#handle) {
            wasm._relief_world_free(this.#handle);
            this.#handle = 0;
        }
    }
}
