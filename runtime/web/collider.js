// SPDX-License-Identifier: Apache-2.0
// Colliders: read, query, and bind one to a WebGL2 program.
import { checkFinite, index, numbers } from "./arguments.js";
import { free, use, useUnlessLost } from "./context.js";
import { ReliefError, bytesOf, check } from "./fetch.js";
import { call, callChecked, callForHandle, init, textAt, wasm } from "./wasm.js";

/** Runs a query and splits its relief_samples (relief_runtime.h) into arrays; `which` names the last one. */
export function runQuery(query, handle, points, which) {
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

export async function load(source) {
    const [bytes] = await Promise.all([bytesOf(source), init()]);
    try {
        return new Collider(bytes);
    } catch (error) {
        const name = source.url ?? source.name ?? (typeof source === "string" || source instanceof URL ? source : "");
        throw name ? new ReliefError(`${name}: ${error.message}`) : error;
    }
}

export function collider(what, value) {
    check(value instanceof Collider, `${what} needs a Collider from load(); did you forget to await it?`);
    return value;
}

export class Collider {
    #handle;

    constructor(bytes) {
        check(bytes instanceof Uint8Array, "new Collider() needs a Uint8Array; load() accepts other sources");
        this.bytes = bytes;
        this.#handle = callForHandle("relief_collider_read", bytes, bytes.length);
        this.info = JSON.parse(textAt(call("relief_collider_info", this.handle)));
    }

    get handle() {
        check(this.#handle, "this collider has been disposed of");
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
        check(format !== "patches", `map ${map} contains patches and has no texels; use tree(${map})`);
        const texels = new Float32Array(8 * width * height * faces);
        callChecked("relief_collider_texels", this.handle, map, texels);
        return texels;
    }

    tree(map) {
        const { bytes, format } = this.info.maps[index("map", map, this.info.maps.length)];
        check(format === "patches",
              `map ${map} has no tree, because its format is ${format}; use texels(${map})`);
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
        check(this.#handle, "this GpuCollider has been disposed of");
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
        check(program instanceof WebGLProgram && gl.getProgramParameter(program, gl.LINK_STATUS),
              "attach() needs a linked WebGLProgram");
        const before = gl.getParameter(gl.CURRENT_PROGRAM);
        gl.useProgram(program);
        ["u_relief_float", "u_relief_fixed", "u_relief_front_back"].forEach((name, i) =>
            gl.uniform1i(gl.getUniformLocation(program, name), unit + i));
        const at = gl.getUniformBlockIndex(program, "ReliefMaps");
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
