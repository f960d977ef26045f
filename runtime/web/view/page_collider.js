// SPDX-License-Identifier: Apache-2.0
// The collider of a page without a scene: its uniform block, textures and GLSL (runtime/layout/gpu_image.h), and facts.
// Implements the members of relief-particles' Collider and GpuCollider that the page uses.
import { bindTexture, texture } from "./gl.js";
import { damaged, fromBase64 } from "./page_data.js";

const kMapBytes = 144; // per map in the uniform block, after a header of 16 bytes
const kFirstTexel = 112; // byte offset of place.x in a map
const kDepthSteps = 65534;
const kCubeDepth = 1.7320509;
const kTextures = [["u_relief_float", "RGBA32F", "RGBA", "FLOAT", Float32Array], ["u_relief_fixed", "RGBA8", "RGBA", "UNSIGNED_BYTE", Uint8Array],
                   ["u_relief_front_back", "RGBA16UI", "RGBA_INTEGER", "UNSIGNED_SHORT", Uint16Array]];
const kPrecision = ["float", "int", "sampler2D", "usampler2D", "sampler3D"].map((type) => `precision highp ${type};\n`).join("");

const fixedDepth = (code, most) => (code === 0 ? NaN : (code - 1) * most / kDepthSteps);
/** Decodes a half float, which is 0 or more. */
const halfDepth = (bits) => (bits === 0 ? NaN : bits < 1024 ? bits * 2 ** -24 : (1024 + (bits & 1023)) * 2 ** ((bits >> 10) - 25));

/** Decodes an octahedral normal with index (s, t). */
function normalAt(s, t) {
    const [x, y] = [(s - 127) / 127, (t - 127) / 127];
    const z = 1 - Math.abs(x) - Math.abs(y);
    const fold = (a, b) => (z < 0 ? (a < 0 ? -1 : 1) * (1 - Math.abs(b)) : a);
    const n = [fold(x, y), fold(y, x), z];
    const l = Math.hypot(...n);
    return n.map((v) => v / l);
}

export class PageCollider {
    constructor({ info, glsl, block, textures }) {
        this.info = info;
        this.glsl = kPrecision + glsl;
        this.block = fromBase64(block, "collider");
        this.textures = textures.map(({ width, height, texels }, i) => {
            const Words = kTextures[i][4];
            const bytes = texels && fromBase64(texels, "collider");
            if (bytes && bytes.length !== 4 * Words.BYTES_PER_ELEMENT * width * height) {
                throw damaged("its collider is truncated");
            }
            return { width, height, texels: bytes && new Words(bytes.buffer) };
        });
    }

    get bounds() {
        return this.info.bounds;
    }

    #first(map) {
        return new DataView(this.block.buffer).getInt32(16 + kMapBytes * map + kFirstTexel, true);
    }

    /** Like Collider.texels() in relief.d.ts. */
    texels(map) {
        const { width, height, faces, format, encoding } = this.info.maps[map];
        const first = this.#first(map);
        const out = new Float32Array(8 * width * height * faces).map((_, i) => (i % 4 === 0 ? NaN : 0));
        const [floats, fixed, words] = this.textures.map(({ texels }) => texels);
        const put = (at, depth, s, t) => {
            if (!Number.isNaN(depth)) {
                out.set([depth, ...normalAt(s, t)], at);
            }
        };
        for (let i = 0; i < width * height * faces; ++i) {
            if (format === "float") {
                const [x, y, z, depth] = floats.subarray(4 * (first + i), 4 * (first + i) + 4);
                out.set(depth < 0 ? [] : [depth, x, y, z], 8 * i);
            } else if (format === "front-back") {
                const at = 4 * (first + i);
                for (let end = 0; end < 2; ++end) {
                    const code = words[at + 2 + end];
                    put(8 * i + 4 * end, encoding === "half" ? halfDepth(code) : fixedDepth(code, 1), words[at + end] >> 8, words[at + end] & 255);
                }
            } else {
                const [s, t, high, low] = fixed.subarray(4 * (first + i), 4 * (first + i) + 4);
                put(8 * i, fixedDepth(256 * high + low, format === "cube" ? kCubeDepth : 1), s, t);
            }
        }
        return out;
    }

    /** Like Collider.tree() in relief.d.ts. */
    tree(map) {
        const first = 4 * this.#first(map);
        return new Uint32Array(this.textures[2].texels.slice(first, first + this.info.maps[map].bytes / 2).buffer);
    }

    onGpu(gl) {
        return new PageTextures(gl, this);
    }
}

class PageTextures {
    constructor(gl, { glsl, block, textures }) {
        Object.assign(this, { gl, glsl });
        const most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
        this.textures = textures.map(({ width, height, texels }, i) => {
            const [, internal, format, type, Words] = kTextures[i];
            if (texels && Math.max(width, height) > most) {
                throw new Error(`this collider has a ${width} × ${height} texture; this browser allows sides up to ${most}: ` +
                                "bake it with a smaller --budget");
            }
            const size = texels ? [width, height] : [1, 1];
            return texture(gl, gl[internal], ...size, gl[format], gl[type], texels ?? new Words(4));
        });
        this.block = gl.createBuffer();
        gl.bindBuffer(gl.UNIFORM_BUFFER, this.block);
        gl.bufferData(gl.UNIFORM_BUFFER, block, gl.STATIC_DRAW);
        gl.bindBuffer(gl.UNIFORM_BUFFER, null);
    }

    /**
     * Sets the samplers of a program to three units from `unit` on, and its uniform block. Call it once per program.
     */
    attach(program, unit = 0) {
        const { gl } = this;
        gl.useProgram(program);
        kTextures.forEach(([sampler], i) => gl.uniform1i(gl.getUniformLocation(program, sampler), unit + i));
        const block = gl.getUniformBlockIndex(program, "ReliefMaps");
        if (block !== gl.INVALID_INDEX) {
            gl.uniformBlockBinding(program, block, 0);
        }
    }

    bind(unit = 0) {
        const { gl } = this;
        this.textures.forEach((one, i) => bindTexture(gl, unit + i, one));
        gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.block);
    }
}
