// relief-particles: Relief's runtime in a browser. relief.d.ts says what each function takes and returns.
//
// One WebAssembly instance serves all contexts of a page. Whatever draws or steps leaves the context's state as it was.
import { decompress } from "fzstd";

import { withPassState } from "./pass_state.js";
import createReliefWasm from "./relief_wasm.mjs";

export class ReliefError extends Error {
    constructor(message) {
        super(message);
        this.name = "ReliefError";
    }
}

let loading = null; // promise of the instance
let wasm = null;
const contexts = new WeakMap(); // WebGL2 context to what is known of it, see know()
let nowhere = 0; // emscripten's handle of a context that does nothing
let folders = 0;

// Vite's development server serves this module from its cache of dependencies, where no file lies beside it.
const cached = /^(.*\/node_modules\/)\.vite\/deps[^/]*\//.exec(import.meta.url);
const besides = cached ? `${cached[1]}relief-particles/relief_wasm.wasm` : null;

export function init({ wasmUrl = besides, ...options } = {}) {
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
            throw new ReliefError(`Relief's WebAssembly does not start: ${error.message ?? error}`);
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

/** Calls an exported function. A trap, which ends the instance, becomes a sentence. */
function call(name, ...args) {
    try {
        return instance()[`_${name}`](...args);
    } catch (error) {
        if (error instanceof ReliefError) {
            throw error;
        }
        throw new ReliefError(`Relief stopped (${error.message ?? error}); load the page again`);
    }
}

function lastError() {
    return new ReliefError(wasm.UTF8ToString(wasm._relief_error()));
}

function checked(result) {
    if (result === 0) {
        throw lastError();
    }
    return result;
}

function succeeded(code) {
    if (code < 0) {
        throw lastError();
    }
    return code;
}

function allocate(bytes) {
    const at = call("malloc", Math.max(bytes, 1));
    if (at === 0) {
        throw new ReliefError(`no room for ${bytes} bytes in this page; use fewer particles, or a smaller collider`);
    }
    return at;
}

/** f(addresses…) with that many bytes each, freed afterwards. */
function withMemory(sizes, f) {
    const addresses = [];
    try {
        for (const size of sizes) {
            addresses.push(allocate(size));
        }
        return f(...addresses);
    } finally {
        addresses.forEach((at) => wasm._free(at));
    }
}

function withText(text, f) {
    const size = wasm.lengthBytesUTF8(text) + 1;
    return withMemory([size], (at) => {
        wasm.stringToUTF8(text, at, size);
        return f(at);
    });
}

/** What is kept of a context: emscripten's handle, how often it was lost, and whether its extension is on. */
function know(gl) {
    let known = contexts.get(gl);
    if (known === undefined) {
        if (typeof WebGL2RenderingContext === "undefined" || !(gl instanceof WebGL2RenderingContext)) {
            throw new ReliefError(gl === null
                ? "this browser gave no WebGL2 context; try another browser, or newer drivers"
                : "particles need a WebGL2 context, as canvas.getContext('webgl2') gives it");
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

/** Makes a context the current one; refuses those that cannot hold particles. Returns how often it was lost before. */
function use(gl) {
    instance();
    const known = know(gl);
    if (gl.isContextLost()) {
        throw new ReliefError("the WebGL context is lost, and what was on the GPU with it; wait for " +
                              "'webglcontextrestored', then restart() systems and make new GpuColliders");
    }
    if (!known.ready) {
        if (!gl.getExtension("EXT_color_buffer_float")) {
            throw new ReliefError("this browser's WebGL2 does not render to float textures (EXT_color_buffer_float); " +
                                  "try another browser, or newer drivers");
        }
        known.ready = true;
    }
    wasm.GL.makeContextCurrent(known.handle);
    return known.losses;
}

/** As use(), for what was made when the context had been lost so often. */
function useAsOf(gl, losses, cure) {
    if (use(gl) !== losses) {
        throw new ReliefError(`the WebGL context was lost since; ${cure}`);
    }
}

/** Frees what belongs to a context. A context does not know what it lost; that is only crossed off emscripten's lists. */
function free(gl, losses, name, handle) {
    const known = know(gl);
    if (known.losses !== losses || gl.isContextLost()) {
        const nothing = new Proxy({}, { get: (kept, key) => kept[key] ?? (key === "canvas" ? undefined : () => null) });
        nowhere ||= wasm.GL.registerContext(nothing, { majorVersion: 2, enableExtensionsByDefault: false });
        wasm.GL.makeContextCurrent(nowhere);
    } else {
        wasm.GL.makeContextCurrent(known.handle);
    }
    call(name, handle);
}

// --- what a page hands over

const kinds = "a URL, a Response, a Blob, an ArrayBuffer or a Uint8Array";

async function fetched(source) {
    try {
        return source instanceof Response ? source : await fetch(source);
    } catch (error) {
        throw new ReliefError(`${source.url ?? source}: the server does not answer (${error.message})`);
    }
}

async function bytesOf(source) {
    if (source instanceof Uint8Array) {
        return source;
    }
    if (source instanceof ArrayBuffer) {
        return new Uint8Array(source);
    }
    if (typeof Blob !== "undefined" && source instanceof Blob) {
        return new Uint8Array(await source.arrayBuffer());
    }
    if (typeof source !== "string" && !(source instanceof URL) && !(source instanceof Request) &&
        !(source instanceof Response)) {
        throw new ReliefError(`load() takes ${kinds}`);
    }
    const response = await fetched(source);
    const name = response.url || source;
    if (!response.ok) {
        throw new ReliefError(`${name}: the server answers ${response.status} ${response.statusText}`.trim());
    }
    if (/^text\/html/.test(response.headers.get("content-type"))) {
        throw new ReliefError(`${name}: the server sends a web page, no collider; is the path right?`);
    }
    return new Uint8Array(await response.arrayBuffer());
}

/** Numbers of an array or a typed array, a multiple of `each`. */
function numbers(what, values, each) {
    if (!Array.isArray(values) && !ArrayBuffer.isView(values)) {
        throw new ReliefError(`${what} are an array of numbers, ${each} for each`);
    }
    const list = values instanceof Float32Array ? values : Float32Array.from(values);
    if (list.length % each !== 0) {
        throw new ReliefError(`${what}: ${list.length} numbers are not ${each} for each`);
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
    const list = value?.elements ?? value; // three.js keeps them there
    if (!(Array.isArray(list) || ArrayBuffer.isView(list)) || list.length !== 16) {
        throw new ReliefError(`draw() needs ${what}: 16 numbers, column by column`);
    }
    return checkFinite(what, Float32Array.from(list));
}

function pixels(what, value) {
    if (!Number.isInteger(value) || value < 0) {
        throw new ReliefError(`draw(): the ${what} is ${value}; it is a number of pixels`);
    }
    return value;
}

function index(what, value, count) {
    if (!Number.isInteger(value) || value < 0 || value >= count) {
        throw new ReliefError(`there is no ${what} ${value}; there are ${count}, from 0 on`);
    }
    return value;
}

function collider(what, value) {
    if (!(value instanceof Collider)) {
        throw new ReliefError(`${what} needs a Collider, as load() gives it; did you forget to await it?`);
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

export function readMesh(name, bytes) {
    instance();
    return withText(String(name), (text) => withMemory([bytes.length, 16], (at, out) => {
        wasm.HEAPU8.set(bytes, at);
        const mesh = checked(call("relief_mesh_read", text, at, bytes.length, out));
        const [positions, count, triangles, corners] = wasm.HEAPU32.subarray(out >> 2, (out >> 2) + 4);
        const read = { vertices: wasm.HEAPF32.slice(positions >> 2, (positions >> 2) + 3 * count),
                       triangles: wasm.HEAPU32.slice(triangles >> 2, (triangles >> 2) + corners) };
        wasm._relief_mesh_free(mesh);
        return read;
    }));
}

function query(points, ask) {
    const xyz = checkFinite("points", numbers("points", points, 3));
    const count = xyz.length / 3;
    return withMemory([12 * count, 20 * count], (at, samples) => {
        wasm.HEAPF32.set(xyz, at >> 2);
        ask(at, count, samples);
        const answers = { distance: new Float32Array(count), normal: new Float32Array(3 * count), map: new Int32Array(count) };
        for (let i = 0, from = samples >> 2; i < count; ++i, from += 5) { // relief_sample of runtime/c_api/relief.h
            answers.distance[i] = wasm.HEAPF32[from];
            answers.normal.set(wasm.HEAPF32.subarray(from + 1, from + 4), 3 * i);
            answers.map[i] = wasm.HEAP32[from + 4];
        }
        return answers;
    });
}

export class Collider {
    #handle;

    constructor(bytes) {
        instance();
        if (!(bytes instanceof Uint8Array)) {
            throw new ReliefError("a Collider is made of a Uint8Array; load() takes other things");
        }
        this.bytes = bytes;
        this.#handle = withMemory([bytes.length], (at) => {
            wasm.HEAPU8.set(bytes, at);
            return checked(call("relief_collider_read", at, bytes.length));
        });
        Object.assign(this, { info: JSON.parse(wasm.UTF8ToString(call("relief_collider_info", this.handle))) });
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
        return query(points, (at, count, samples) => call("relief_collider_query", this.handle, at, count, samples));
    }

    texels(map) {
        const { width, height, faces } = this.info.maps[index("map", map, this.info.maps.length)];
        const count = 8 * width * height * faces;
        return withMemory([4 * count], (at) => {
            succeeded(call("relief_collider_texels", this.handle, map, at));
            return wasm.HEAPF32.slice(at >> 2, (at >> 2) + count);
        });
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
    #query = 0;

    constructor(gl, from) {
        this.#losses = use(gl);
        this.#gl = gl;
        this.collider = collider("a GpuCollider", from);
        this.#handle = checked(call("relief_textures_create", from.handle));
        this.glsl = kPrecision + wasm.UTF8ToString(call("relief_textures_glsl", this.#handle));
    }

    #ready() {
        if (!this.#handle) {
            throw new ReliefError("this GpuCollider is disposed of");
        }
        useAsOf(this.#gl, this.#losses, "make a new GpuCollider");
    }

    query(points) {
        this.#ready();
        this.#query ||= checked(call("relief_gpu_query_create", this.#handle));
        return query(points, (at, count, samples) => succeeded(call("relief_gpu_query", this.#query, at, count, samples)));
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
            throw new ReliefError("attach() needs a WebGLProgram that is linked");
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

    /** Leaves its three textures and its block bound: that is what it is for. */
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
            free(this.#gl, this.#losses, "relief_gpu_query_free", this.#query);
            free(this.#gl, this.#losses, "relief_textures_free", this.#handle);
            this.#handle = this.#query = 0;
        }
    }
}

// --- scenes as text

const isTable = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
const isTables = (value) => Array.isArray(value) && value.length > 0 && value.every(isTable);

const tomlKey = (key) => (/^[A-Za-z0-9_-]+$/.test(key) ? key : JSON.stringify(key));

function tomlValue(value) {
    if (typeof value === "string") {
        return JSON.stringify(value);
    }
    if (Array.isArray(value) || ArrayBuffer.isView(value)) {
        return `[${Array.from(value, tomlValue).join(", ")}]`;
    }
    if (isTable(value)) {
        return `{ ${Object.entries(value).map(([key, one]) => `${tomlKey(key)} = ${tomlValue(one)}`).join(", ")} }`;
    }
    if (typeof value === "function" || typeof value === "symbol" || value === undefined || value === null) {
        throw new ReliefError(`a scene holds numbers, texts, true, false, lists and tables, but no ${value}`);
    }
    if (typeof value === "number" && !Number.isFinite(value)) {
        return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
    }
    return String(value);
}

/** A scene as an object with the keys of scene.toml, as that file's text. */
export function toToml(scene) {
    const lines = [];
    const write = (table, path) => {
        const given = Object.entries(table).filter(([, value]) => value !== undefined && value !== null);
        for (const [key, value] of given.filter(([, value]) => !isTable(value) && !isTables(value))) {
            lines.push(`${tomlKey(key)} = ${tomlValue(value)}`);
        }
        for (const [key, value] of given.filter(([, value]) => isTable(value) || isTables(value))) {
            const name = [...path, key].map(tomlKey).join(".");
            for (const one of isTable(value) ? [value] : value) {
                lines.push("", isTable(value) ? `[${name}]` : `[[${name}]]`);
                write(one, [...path, key]);
            }
        }
    };
    write(scene, []);
    return `${lines.join("\n").trim()}\n`;
}

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

    constructor(gl, options = {}) {
        const wrong = Object.keys(options).find((key) => !["collider", "files", "scene", "shaded"].includes(key));
        if (wrong !== undefined) {
            throw new ReliefError(`ParticleSystem has no option '${wrong}'; it has collider, files, scene and shaded`);
        }
        if (options.collider) {
            collider("the option 'collider'", options.collider);
        }
        use(gl);
        this.#gl = gl;
        this.#shaded = options.shaded ?? true;
        this.#folder = `/scene${folders++}`;
        wasm.FS.mkdir(this.#folder);
        wasm.FS.mount(wasm.FS.filesystems.MEMFS, {}, this.#folder); // to be given back as a whole
        const files = { ...options.files };
        let scene = options.scene ?? {};
        if (typeof scene !== "string") {
            if (options.collider) {
                files["collider.relief"] = options.collider;
                scene = merged({ collider: { file: "collider.relief" } }, scene);
            } else if (!scene.collider) {
                throw new ReliefError("a ParticleSystem needs the option 'collider', or a scene that names its colliders");
            }
        } else if (options.collider) {
            throw new ReliefError("a scene given as text names its colliders itself: give them in 'files'");
        }
        this.#scene = scene;
        try {
            for (const [name, content] of Object.entries(files)) {
                this.#write(name, content);
            }
            this.#create();
        } catch (error) {
            this.dispose();
            throw error;
        }
    }

    #write(name, content) {
        const parts = name.split("/");
        if (parts.some((part) => part === "" || part === "." || part === "..")) {
            throw new ReliefError(`'${name}' is no file of the scene's folder`);
        }
        if (content instanceof Collider) {
            content.handle; // throws where it is disposed of
        } else if (!(content instanceof Uint8Array) && typeof content !== "string") {
            throw new ReliefError(`the file '${name}' is a Collider, a Uint8Array or a text`);
        }
        wasm.FS.mkdirTree([this.#folder, ...parts.slice(0, -1)].join("/"));
        wasm.FS.writeFile(`${this.#folder}/${name}`, content instanceof Collider ? content.bytes : content);
    }

    #path() {
        const path = `${this.#folder}/scene.toml`;
        wasm.FS.writeFile(path, this.toToml());
        return path;
    }

    /** Errors name the scene as the page knows it. */
    #tell(f) {
        try {
            return f();
        } catch (error) {
            throw new ReliefError(error.message.replaceAll(`${this.#folder}/`, ""));
        }
    }

    #create() {
        this.#losses = use(this.#gl);
        this.#handle = this.#tell(() =>
            withText(this.#path(), (path) => checked(call("relief_player_create", path, this.#shaded ? 1 : 0))));
    }

    get handle() {
        if (!this.#handle) {
            throw new ReliefError(this.#folder === null ? "this system is disposed of" : "this system did not restart");
        }
        return this.#handle;
    }

    #ready() {
        this.handle;
        useAsOf(this.#gl, this.#losses, "restart() the system");
    }

    toToml() {
        return typeof this.#scene === "string" ? this.#scene : toToml(this.#scene);
    }

    /** Starts over, with nothing alive; also after 'webglcontextrestored'. */
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
            throw new ReliefError("a scene given as text is not changed in parts; make a new system");
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
            this.#tell(() =>
                withText(this.#path(), (path) =>
                    succeeded(call("relief_player_change", this.handle, path, emitters ? 1 : 0))));
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
            throw new ReliefError(`step(${given}): a step lasts from 0 to 1 second; a page that slept takes ` +
                                  "Math.min(seconds, 1 / 30)");
        }
        if (seconds > 0) {
            succeeded(call("relief_player_step", this.handle, seconds));
        }
    }

    spawn(births) {
        this.#ready();
        const rows = Array.isArray(births) && births.every((one) => one !== null && typeof one === "object")
            ? births.flatMap(({ position, velocity = [0, 0, 0], lifetime = 1, type = 0 }, i) => {
                if (position?.length !== 3 || velocity?.length !== 3) {
                    throw new ReliefError(`birth ${i} needs a position of three numbers, and such a velocity if any`);
                }
                return [...position, ...velocity, lifetime, type];
            })
            : births;
        const list = checkFinite("births", numbers("births", rows, 8));
        return withMemory([4 * list.length], (at) => {
            wasm.HEAPF32.set(list, at >> 2);
            return succeeded(call("relief_player_spawn", this.handle, at, list.length / 8));
        });
    }

    draw({ view, projection, framebuffer, width, height, srgb = true } = {}) {
        this.#ready();
        const gl = this.#gl;
        const matrices = [...matrix("view", view), ...matrix("projection", projection)];
        const target = framebuffer === undefined ? gl.getParameter(gl.DRAW_FRAMEBUFFER_BINDING) : framebuffer;
        const [wide, high] = target
            ? gl.getParameter(gl.VIEWPORT).slice(2)
            : [gl.drawingBufferWidth, gl.drawingBufferHeight];
        const size = [pixels("width", width ?? wide), pixels("height", height ?? high)];
        if (size.includes(0)) {
            return; // a page that is hidden
        }
        let name = 0;
        if (target) {
            name = wasm.GL.getNewId(wasm.GL.framebuffers);
            wasm.GL.framebuffers[name] = target;
        }
        try {
            withMemory([128], (at) => {
                wasm.HEAPF32.set(matrices, at >> 2);
                succeeded(call("relief_player_draw", this.handle, at, name, ...size, srgb ? 1 : 0));
            });
        } finally {
            if (name) {
                wasm.GL.framebuffers[name] = null;
            }
        }
    }

    get info() {
        const info = JSON.parse(wasm.UTF8ToString(call("relief_player_info", this.handle)));
        info.bodies.forEach((body) => (body.file = body.file.replace(`${this.#folder}/`, "")));
        return info;
    }

    textures() {
        this.#ready();
        const named = (which) => wasm.GL.textures[call("relief_player_texture", this.handle, which)];
        return { position: named(0), velocity: named(1), birth: named(2) };
    }

    mesh(body) {
        this.#ready();
        return withMemory([20], (at) => {
            if (!Number.isInteger(body) || body < 0 || !call("relief_player_mesh", this.handle, body, at)) {
                return null;
            }
            const [positions, corners, vertexShift, triangleShift, triangles] = wasm.HEAP32.subarray(at >> 2, (at >> 2) + 5);
            return { positions: wasm.GL.textures[positions], corners: wasm.GL.textures[corners], vertexShift,
                     triangleShift, triangles };
        });
    }

    read() {
        this.#ready();
        const count = succeeded(call("relief_player_read", this.handle));
        return withMemory([48 * count], (at) => {
            call("relief_player_states", this.handle, at);
            return wasm.HEAPF32.slice(at >> 2, (at >> 2) + 12 * count);
        });
    }

    #free() {
        const old = this.#handle;
        this.#handle = 0;
        if (old) {
            free(this.#gl, this.#losses, "relief_player_free", old);
        }
    }

    dispose() {
        this.#free();
        if (this.#folder !== null) {
            wasm.FS.unmount(this.#folder);
            wasm.FS.rmdir(this.#folder);
        }
        this.#folder = null;
    }
}

export const Relief = { init, load, readMesh, Collider, GpuCollider, ParticleSystem, ReliefError, toToml };
export default Relief;
