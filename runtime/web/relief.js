// SPDX-License-Identifier: Apache-2.0
// relief-particles: the Relief runtime in a browser. relief.d.ts documents the API.
//
// One WebAssembly instance serves all contexts of a page. Functions that draw or step restore the state of the context.
import { decompress } from "fzstd";

import { Fetches, ReliefError, bytesOf, urlIn, worldFiles } from "./fetch.js";
import { withPassState } from "./pass_state.js";
import createReliefWasm from "./relief_wasm.mjs";

export { ReliefError };

let loading = null; // promise of the WebAssembly instance
let wasm = null;
const contexts = new WeakMap(); // WebGL2 context to its record (recordOf())
let nullContext = 0; // emscripten handle of a context whose functions do nothing
let folders = 0;

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

function instance() {
    if (!wasm) {
        throw new ReliefError("Relief is not loaded yet; await init() or load() first");
    }
    return wasm;
}

/** Reads a string of the WebAssembly memory, without the folder of scene files. */
const textAt = (at) => wasm.UTF8ToString(at).replaceAll(/\/scene\d+\//g, "");

function lastError() {
    return new ReliefError(textAt(wasm._relief_error()));
}

/** Copies a string or a typed array to WebAssembly memory and returns its address. */
function copyToWasm(value) {
    const size = typeof value === "string" ? wasm.lengthBytesUTF8(value) + 1 : Math.max(value.byteLength, 1);
    const at = wasm._malloc(size);
    if (at === 0) {
        throw new ReliefError(`out of memory for ${size} bytes; use fewer particles or a smaller collider`);
    }
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
function call(name, ...args) {
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
function callForHandle(name, ...args) {
    const handle = call(name, ...args);
    if (handle === 0) {
        throw lastError();
    }
    return handle;
}

/** Like call(), for functions that return a negative number on failure. */
function callChecked(name, ...args) {
    const code = call(name, ...args);
    if (code < 0) {
        throw lastError();
    }
    return code;
}

/** Returns the record of a context: emscripten handle, number of losses, and whether its extension is enabled. */
function recordOf(gl) {
    let known = contexts.get(gl);
    if (known === undefined) {
        if (typeof WebGL2RenderingContext === "undefined" || !(gl instanceof WebGL2RenderingContext)) {
            throw new ReliefError(gl === null
                ? "this browser provides no WebGL2 context; try another browser or newer drivers"
                : "particles need a WebGL2 context from canvas.getContext('webgl2')");
        }
        const handle = wasm.GL.registerContext(withPassState(gl), { majorVersion: 2, enableExtensionsByDefault: false });
        known = { handle, losses: 0, ready: false };
        contexts.set(gl, known);
        gl.canvas.addEventListener("webglcontextlost", () => {
            known.losses += 1;
            known.ready = false;
        });
    }
    return known;
}

/** Makes a context current and returns its number of losses. Throws if the context cannot hold particles. */
function use(gl) {
    instance();
    const known = recordOf(gl);
    if (gl.isContextLost()) {
        throw new ReliefError("the WebGL context is lost; wait for 'webglcontextrestored', " +
                              "then restart() systems and create new GpuColliders");
    }
    if (!known.ready) {
        if (!gl.getExtension("EXT_color_buffer_float")) {
            throw new ReliefError("this browser cannot render to float textures (EXT_color_buffer_float); " +
                                  "try another browser or newer drivers");
        }
        known.ready = true;
    }
    wasm.GL.makeContextCurrent(known.handle);
    return known.losses;
}

/** Like use(), but also throws if the context was lost since it had `losses` losses. */
function useUnlessLost(gl, losses, cure) {
    if (use(gl) !== losses) {
        throw new ReliefError(`the WebGL context was lost meanwhile; ${cure}`);
    }
}

/** Frees an object of a context. For objects lost with their context, only the emscripten tables are updated. */
function free(gl, losses, name, handle) {
    const known = recordOf(gl);
    if (known.losses !== losses || gl.isContextLost()) {
        const nothing = new Proxy({}, { get: (kept, key) => kept[key] ?? (key === "canvas" ? undefined : () => null) });
        nullContext ||= wasm.GL.registerContext(nothing, { majorVersion: 2, enableExtensionsByDefault: false });
        wasm.GL.makeContextCurrent(nullContext);
    } else {
        wasm.GL.makeContextCurrent(known.handle);
    }
    call(name, handle);
}

// --- arguments

/** Validates an array or typed array whose length is a multiple of `each`, and returns it as a Float32Array. */
function numbers(what, values, each) {
    if (!Array.isArray(values) && !ArrayBuffer.isView(values)) {
        throw new ReliefError(`${what} must be an array of numbers, ${each} per item`);
    }
    const list = values instanceof Float32Array ? values : Float32Array.from(values);
    if (list.length % each !== 0) {
        throw new ReliefError(`${what}: the number of values, ${list.length}, is not a multiple of ${each}`);
    }
    return list;
}

function checkFinite(what, list) {
    const at = list.findIndex((one) => !Number.isFinite(one));
    if (at >= 0) {
        throw new ReliefError(`${what}: number ${at} is ${list[at]}`);
    }
    return list;
}

function matrix(what, value) {
    const list = value?.elements ?? value; // a three.js Matrix4
    if (!(Array.isArray(list) || ArrayBuffer.isView(list)) || list.length !== 16) {
        throw new ReliefError(`draw() needs ${what}: 16 numbers in column-major order`);
    }
    return checkFinite(what, Float32Array.from(list));
}

function pixels(what, value) {
    if (!Number.isInteger(value) || value < 0) {
        throw new ReliefError(`draw(): the ${what} is ${value}; use a number of pixels, 0 or more`);
    }
    return value;
}

function index(what, value, count) {
    if (!Number.isInteger(value) || value < 0 || value >= count) {
        throw new ReliefError(`there is no ${what} ${value}; there are ${count}, numbered from 0`);
    }
    return value;
}

function collider(what, value) {
    if (!(value instanceof Collider)) {
        throw new ReliefError(`${what} needs a Collider from load(); did you forget to await it?`);
    }
    return value;
}

export async function load(source) {
    const [bytes] = await Promise.all([bytesOf(source), init()]);
    try {
        return new Collider(bytes);
    } catch (error) {
        const name = source.url ?? source.name ?? (typeof source === "string" || source instanceof URL ? source : "");
        throw name ? new ReliefError(`${name}: ${error.message}`) : error;
    }
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
    if (wrong !== undefined) {
        throw new ReliefError(`${what} has no option '${wrong}'; it has ${keys.join(", ")}`);
    }
    if (!(Number.isFinite(options.radius) && options.radius > 0)) {
        throw new ReliefError(`${what} needs a radius above 0, within which the world has full detail`);
    }
    if (options.memory !== undefined && !(Number.isFinite(options.memory) && options.memory > 0)) {
        throw new ReliefError(`${what}: memory must be a number of megabytes above 0`);
    }
}

/** Creates a folder in the file system of the WebAssembly module; free it with removeFolder(). */
function makeFolder() {
    const folder = `/scene${folders++}`;
    wasm.FS.mkdir(folder);
    wasm.FS.mount(wasm.FS.filesystems.MEMFS, {}, folder);
    return folder;
}

function removeFolder(folder) {
    wasm.FS.unmount(folder);
    wasm.FS.rmdir(folder);
}

function writeIn(folder, name, content) {
    const parts = name.split("/");
    if (parts.some((part) => part === "" || part === "." || part === "..")) {
        throw new ReliefError(`'${name}' is outside the scene's folder; use a relative path without '..'`);
    }
    if (content instanceof Collider) {
        content.handle; // throws if disposed
    } else if (!(content instanceof Uint8Array) && typeof content !== "string") {
        throw new ReliefError(`the file '${name}' must be a Collider, a Uint8Array or a string`);
    }
    wasm.FS.mkdirTree([folder, ...parts.slice(0, -1)].join("/"));
    wasm.FS.writeFile(`${folder}/${name}`, content instanceof Collider ? content.bytes : content);
}

/** Runs a query and splits its relief_samples (runtime/c_api/relief.h) into arrays; `which` names the last one. */
function runQuery(query, handle, points, which) {
    const xyz = checkFinite("points", numbers("points", points, 3));
    const count = xyz.length / 3;
    const samples = new Float32Array(5 * count);
    call(query, handle, xyz, count, samples);
    const words = new Int32Array(samples.buffer);
    const answers = { distance: new Float32Array(count), normal: new Float32Array(3 * count), [which]: new Int32Array(count) };
    for (let i = 0; i < count; ++i) {
        answers.distance[i] = samples[5 * i];
        answers.normal.set(samples.subarray(5 * i + 1, 5 * i + 4), 3 * i);
        answers[which][i] = words[5 * i + 4];
    }
    return answers;
}

export class World {
    #handle = 0;

    constructor(files, stream) {
        instance();
        this.files = { ...files };
        this.stream = null;
        if (stream) {
            checkStream("streaming a World", stream, ["radius", "memory", "load"]);
            if (typeof stream.load !== "function") {
                throw new ReliefError("streaming a World needs 'load', a function that returns the bytes of a file");
            }
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
        if (!this.#handle) {
            throw new ReliefError("this world is disposed of");
        }
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

export class Collider {
    #handle;

    constructor(bytes) {
        if (!(bytes instanceof Uint8Array)) {
            throw new ReliefError("new Collider() needs a Uint8Array; load() accepts other sources");
        }
        this.bytes = bytes;
        this.#handle = callForHandle("relief_collider_read", bytes, bytes.length);
        this.info = JSON.parse(textAt(call("relief_collider_info", this.handle)));
    }

    get handle() {
        if (!this.#handle) {
            throw new ReliefError("this collider is disposed of");
        }
        return this.#handle;
    }
    get bounds() {
        return this.info.bounds;
    }

    query(points) {
        return runQuery("relief_collider_query", this.handle, points, "map");
    }

    texels(map) {
        const { width, height, faces, format } = this.info.maps[index("map", map, this.info.maps.length)];
        if (format === "patches") {
            throw new ReliefError(`map ${map} contains patches and has no texels; use tree(${map})`);
        }
        const texels = new Float32Array(8 * width * height * faces);
        callChecked("relief_collider_texels", this.handle, map, texels);
        return texels;
    }

    tree(map) {
        const { bytes, format } = this.info.maps[index("map", map, this.info.maps.length)];
        if (format !== "patches") {
            throw new ReliefError(`map ${map} has no tree, because its format is ${format}; use texels(${map})`);
        }
        const words = new Uint32Array(bytes / 4);
        callChecked("relief_collider_tree", this.handle, map, words);
        return words;
    }

    dispose() {
        if (this.#handle) {
            wasm._relief_collider_free(this.#handle);
            this.#handle = 0;
        }
    }
}

const kPrecision = ["float", "int", "sampler2D", "usampler2D", "sampler3D"].map((type) => `precision highp ${type};\n`).join("");

export class GpuCollider {
    #gl;
    #losses;
    #handle;

    constructor(gl, from) {
        this.#losses = use(gl);
        this.#gl = gl;
        this.collider = collider("a GpuCollider", from);
        this.#handle = callForHandle("relief_textures_create", from.handle);
        this.glsl = kPrecision + textAt(call("relief_textures_glsl", this.#handle));
    }

    #ready() {
        if (!this.#handle) {
            throw new ReliefError("this GpuCollider is disposed of");
        }
        useUnlessLost(this.#gl, this.#losses, "create a new GpuCollider");
    }

    #places(unit, block) {
        const gl = this.#gl;
        index("texture unit", unit, gl.getParameter(gl.MAX_COMBINED_TEXTURE_IMAGE_UNITS) - 2);
        index("uniform block binding", block, gl.getParameter(gl.MAX_UNIFORM_BUFFER_BINDINGS));
    }

    attach(program, unit = 0, block = 0) {
        this.#ready();
        this.#places(unit, block);
        const gl = this.#gl;
        if (!(program instanceof WebGLProgram) || !gl.getProgramParameter(program, gl.LINK_STATUS)) {
            throw new ReliefError("attach() needs a linked WebGLProgram");
        }
        const before = gl.getParameter(gl.CURRENT_PROGRAM);
        gl.useProgram(program);
        ["u_relief_float", "u_relief_fixed", "u_relief_front_back"].forEach((name, i) =>
            gl.uniform1i(gl.getUniformLocation(program, name), unit + i));
        const at = gl.getUniformBlockIndex(program, "ReliefCollider");
        if (at !== gl.INVALID_INDEX) {
            gl.uniformBlockBinding(program, at, block);
        }
        gl.useProgram(before);
    }

    bind(unit = 0, block = 0) {
        this.#ready();
        this.#places(unit, block);
        const gl = this.#gl;
        const [active, buffer] = [gl.ACTIVE_TEXTURE, gl.UNIFORM_BUFFER_BINDING].map((one) => gl.getParameter(one));
        call("relief_textures_bind", this.#handle, unit, block);
        gl.activeTexture(active);
        gl.bindBuffer(gl.UNIFORM_BUFFER, buffer);
    }

    dispose() {
        if (this.#handle) {
            free(this.#gl, this.#losses, "relief_textures_free", this.#handle);
            this.#handle = 0;
        }
    }
}

const isTable = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

/** Converts a scene to JSON. Non-finite numbers become strings, which the reader rejects with their key. */
const jsonOf = (scene) => JSON.stringify(scene, (key, value) => {
    if (typeof value === "function" || typeof value === "symbol") {
        throw new ReliefError(`a scene can contain numbers, strings, booleans, lists and tables, but no ${String(value)}`);
    }
    return ArrayBuffer.isView(value) ? [...value] : typeof value === "number" && !Number.isFinite(value) ? String(value) : value;
});

function merged(scene, patch) {
    const result = { ...scene };
    for (const [key, value] of Object.entries(patch)) {
        result[key] = isTable(value) && isTable(scene[key]) ? merged(scene[key], value) : value;
    }
    return result;
}

export class ParticleSystem {
    #gl;
    #losses;
    #folder;
    #handle = 0;
    #scene;
    #shaded;
    #warn;
    #hits; // callback, or undefined
    #hitSpeed;
    #fetches = null; // for a streamed world
    #near = null; // 4 numbers per point

    constructor(gl, options = {}) {
        const wrong = Object.keys(options).find((key) => !["collider", "files", "hits", "hitSpeed", "scene", "shaded", "warn", "world"].includes(key));
        if (wrong !== undefined) {
            throw new ReliefError(`ParticleSystem has no option '${wrong}'; it has collider, files, hits, hitSpeed, scene, shaded, warn and world`);
        }
        if (options.collider) {
            collider("the option 'collider'", options.collider);
        }
        if (options.world) {
            if (!(options.world instanceof World)) {
                throw new ReliefError("the option 'world' needs a World from loadWorld() or streamWorld(); did you forget to await it?");
            }
            if (options.collider) {
                throw new ReliefError("use either 'world' or 'collider'; name more colliders in the scene, with 'files'");
            }
            options.world.handle; // throws if disposed
        }
        if (options.warn !== undefined && typeof options.warn !== "function") {
            throw new ReliefError("the option 'warn' must be a function that takes a line");
        }
        if (options.hits !== undefined && typeof options.hits !== "function") {
            throw new ReliefError("the option 'hits' must be a function that takes StepHits");
        }
        const { hitSpeed = 0 } = options;
        if (!(Number.isFinite(hitSpeed) && hitSpeed >= 0)) {
            throw new ReliefError("the option 'hitSpeed' must be a speed, 0 or more");
        }
        use(gl);
        this.#gl = gl;
        this.#shaded = options.shaded ?? true;
        this.#warn = options.warn ?? ((line) => console.warn(line));
        this.#hits = options.hits;
        this.#hitSpeed = hitSpeed;
        this.#fetches = options.world?.stream ? new Fetches(options.world.stream.load) : null;
        this.#folder = makeFolder();
        const files = { ...options.files };
        let scene = options.scene ?? {};
        if (typeof scene !== "string") {
            if (options.collider) {
                files["collider.relief"] = options.collider;
                scene = merged({ collider: { file: "collider.relief" } }, scene);
            } else if (options.world) {
                scene = { world: "world/world.json", ...scene };
                if (this.#fetches) {
                    const { radius, memory } = options.world.stream;
                    scene.stream = { radius, memory, ...scene.stream };
                } else if (scene.stream) {
                    this.#checkCoarse(options.world);
                }
            } else if (!scene.collider && !scene.world) {
                throw new ReliefError("a ParticleSystem needs the option 'collider' or 'world', or a scene that names its colliders");
            }
        } else if (options.collider) {
            throw new ReliefError("a scene given as text must name its colliders; pass them in 'files'");
        }
        for (const [name, content] of Object.entries(options.world?.files ?? {})) {
            files[`world/${name}`] = content;
        }
        this.#scene = scene;
        try {
            for (const [name, content] of Object.entries(files)) {
                writeIn(this.#folder, name, content);
            }
            this.#create();
        } catch (error) {
            this.dispose();
            throw error;
        }
    }

    /** Returns the text of the scene and its name in messages. */
    #text() {
        return typeof this.#scene === "string" ? [this.#scene, `${this.#folder}/scene.toml`]
            : [jsonOf(this.#scene), `${this.#folder}/scene`];
    }

    #create() {
        this.#losses = use(this.#gl);
        this.#handle = callForHandle("relief_player_create", ...this.#text(), this.#shaded ? 1 : 0, this.#fetches ? 1 : 0);
        if (this.#near) {
            callChecked("relief_player_near", this.#handle, this.#near, this.#near.length / 4);
        }
        if (this.#hits) {
            callChecked("relief_player_list_hits", this.#handle, this.#hitSpeed);
        }
    }

    /** Throws if the world lacks coarse containers, like one from loadWorld(). */
    #checkCoarse({ colliders, files }) {
        const missing = colliders.find(({ coarse }) => coarse && !(coarse.file in files));
        if (missing) {
            throw new ReliefError(`the scene has 'stream', but its world lacks '${missing.coarse.file}'; ` +
                                  "remove 'stream', or use streamWorld()");
        }
    }

    get handle() {
        if (!this.#handle) {
            throw new ReliefError(this.#folder === null ? "this system is disposed of" : "this system failed to restart");
        }
        return this.#handle;
    }

    #ready() {
        this.handle;
        useUnlessLost(this.#gl, this.#losses, "restart() the system");
    }

    restart() {
        if (this.#folder === null) {
            throw new ReliefError("this system is disposed of");
        }
        use(this.#gl);
        this.#free();
        this.#create();
    }

    set(patch) {
        if (typeof this.#scene === "string") {
            throw new ReliefError("set() cannot change a scene given as text; create a new system");
        }
        if (!isTable(patch)) {
            throw new ReliefError("set() takes a part of a scene: an object with the keys of scene.toml");
        }
        this.#ready();
        const before = this.#scene;
        this.#scene = merged(before, patch);
        if (Array.isArray(before.collider) && patch.collider?.length === before.collider.length) {
            this.#scene.collider = before.collider.map((one, i) => merged(one, patch.collider[i] ?? {}));
        }
        const emitters = JSON.stringify(this.#scene.emitter) !== JSON.stringify(before.emitter);
        try {
            callChecked("relief_player_change", this.handle, ...this.#text(), emitters ? 1 : 0);
        } catch (error) {
            this.#scene = before;
            throw error;
        }
    }

    step(dt) {
        this.#ready();
        const seconds = dt ?? this.info.dt;
        if (!(typeof seconds === "number" && seconds >= 0 && seconds <= 1)) {
            const given = typeof seconds === "number" ? seconds : JSON.stringify(seconds);
            throw new ReliefError(`step(${given}): a step must be 0 to 1 seconds; limit it by ` +
                                  "Math.min(seconds, 1 / 30)");
        }
        if (seconds > 0) {
            const warnings = callChecked("relief_player_step", this.handle, seconds);
            this.#fetch();
            this.#passHits();
            if (warnings > 0) {
                this.#passWarnings();
            }
        }
    }

    /** Passes on the hits that have arrived. The callback may dispose of the system. */
    #passHits() {
        const head = new Float64Array(4);
        while (this.#handle && this.#hits && call("relief_player_next_hits", this.#handle, head)) {
            const [step, time, dropped, count] = head;
            const rows = new Float32Array(16 * count);
            call("relief_player_hits", this.#handle, rows);
            this.#hits({ step, time, dropped, rows });
        }
    }

    /** Passes on warnings about colliders that failed to load. */
    #passWarnings() {
        for (const line of JSON.parse(textAt(call("relief_player_warnings", this.#handle)))) {
            this.#warn(line);
        }
    }

    /** Starts the fetches that the runtime requests. */
    #fetch() {
        for (let next; this.#fetches && (next = JSON.parse(textAt(call("relief_player_next", this.#handle))));) {
            const { collider, file } = next;
            this.#fetches.start(file, (bytes, reason) => this.#receive(collider, file, bytes, reason));
        }
    }

    #receive(collider, file, bytes, reason) {
        try {
            let fault = reason;
            try {
                if (bytes) {
                    callChecked("relief_player_give", this.#handle, collider, bytes, bytes.length);
                }
            } catch (error) { // out of memory
                fault = `${file}: ${error.message}`;
            }
            if (fault !== null) {
                callChecked("relief_player_refuse", this.#handle, collider, fault);
            }
        } catch {
            // The instance has ended; the next step reports it.
        }
    }

    near(points) {
        const places = Array.isArray(points) ? points : [];
        const wrong = places.findIndex((one) => one?.position?.length !== 3 || !(one.radius > 0));
        if (!Array.isArray(points) || wrong >= 0) {
            throw new ReliefError("near() takes a list of { position: [x, y, z], radius } with a radius above 0" +
                                  (wrong >= 0 ? `; item ${wrong} is invalid` : ""));
        }
        this.#ready();
        const list = checkFinite("near()", Float32Array.from(places.flatMap(({ position, radius }) => [...position, radius])));
        callChecked("relief_player_near", this.handle, list, list.length / 4);
        this.#near = list;
    }

    async loaded() {
        while (true) {
            this.#ready();
            const underWay = callChecked("relief_player_load", this.handle);
            this.#fetch();
            this.#passWarnings();
            if (underWay === 0) {
                return;
            }
            await this.#fetches.next();
        }
    }

    spawn(births) {
        this.#ready();
        const rows = Array.isArray(births) && births.every((one) => one !== null && typeof one === "object")
            ? births.flatMap(({ position, velocity = [0, 0, 0], lifetime = 1, type = 0 }, i) => {
                if (position?.length !== 3 || velocity?.length !== 3) {
                    throw new ReliefError(`birth ${i} needs a position of three numbers; a velocity must have three, too`);
                }
                return [...position, ...velocity, lifetime, type];
            })
            : births;
        const list = checkFinite("births", numbers("births", rows, 8));
        return callChecked("relief_player_spawn", this.handle, list, list.length / 8);
    }

    draw(options) {
        this.#draw("relief_player_draw", options);
    }

    drawMeshes(options) {
        this.#draw("relief_player_draw_meshes", options);
    }

    #draw(how, { view, projection, framebuffer, width, height, srgb = true } = {}) {
        this.#ready();
        const gl = this.#gl;
        const matrices = Float32Array.of(...matrix("view", view), ...matrix("projection", projection));
        const target = framebuffer === undefined ? gl.getParameter(gl.DRAW_FRAMEBUFFER_BINDING) : framebuffer;
        const [wide, high] = target
            ? gl.getParameter(gl.VIEWPORT).slice(2)
            : [gl.drawingBufferWidth, gl.drawingBufferHeight];
        const size = [pixels("width", width ?? wide), pixels("height", height ?? high)];
        if (size.includes(0)) {
            return; // hidden page
        }
        let name = 0;
        if (target) {
            name = wasm.GL.getNewId(wasm.GL.framebuffers);
            wasm.GL.framebuffers[name] = target;
        }
        try {
            callChecked(how, this.handle, matrices, name, ...size, srgb ? 1 : 0);
        } finally {
            if (name) {
                wasm.GL.framebuffers[name] = null;
            }
        }
    }

    get info() {
        return JSON.parse(textAt(call("relief_player_info", this.handle)));
    }

    textures() {
        this.#ready();
        const named = (which) => wasm.GL.textures[call("relief_player_texture", this.handle, which)];
        return { position: named(0), velocity: named(1), birth: named(2) };
    }

    mesh(body) {
        this.#ready();
        const names = new Int32Array(5);
        if (!Number.isInteger(body) || body < 0 || !call("relief_player_mesh", this.handle, body, names)) {
            return null;
        }
        const [positions, corners, vertexShift, triangleShift, triangles] = names;
        return { positions: wasm.GL.textures[positions], corners: wasm.GL.textures[corners], vertexShift, triangleShift, triangles };
    }

    animation(body) {
        this.#ready();
        return Number.isInteger(body) && body >= 0 ? JSON.parse(textAt(call("relief_player_animation", this.handle, body))) : null;
    }

    pose(body, joints = [], weights = []) {
        this.#ready();
        if (!Number.isInteger(body) || body < 0 || joints.length % 16 !== 0) {
            throw new ReliefError("pose() needs the number of a body, and 16 numbers per joint");
        }
        callChecked("relief_player_pose", this.handle, body, checkFinite("pose()", Float32Array.from(joints)), joints.length / 16,
                    checkFinite("pose()", Float32Array.from(weights)), weights.length);
    }

    read() {
        this.#ready();
        const rows = new Float32Array(12 * callChecked("relief_player_read", this.handle));
        call("relief_player_states", this.handle, rows);
        return rows;
    }

    #free() {
        const old = this.#handle;
        this.#handle = 0;
        this.#fetches?.stop();
        if (old) {
            free(this.#gl, this.#losses, "relief_player_free", old);
        }
    }

    dispose() {
        this.#free();
        if (this.#folder !== null) {
            removeFolder(this.#folder);
        }
        this.#folder = null;
    }
}

export const Relief = { init, load, loadWorld, streamWorld, Collider, GpuCollider, ParticleSystem, ReliefError, World };
export default Relief;
