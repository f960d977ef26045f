// SPDX-License-Identifier: Apache-2.0
// WebGL2 helpers: programs, targets, buffers.

/** Returns whether the context uses a software renderer. */
export function drawnBySoftware(gl) {
    const name = gl.getParameter(gl.RENDERER);
    const info = /^WebKit/.test(name) ? gl.getExtension("WEBGL_debug_renderer_info") : null; // some browsers mask the name
    return /llvmpipe|softpipe|swrast|SwiftShader|Software|Basic Render/i.test(info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : name);
}

export function program(gl, vertex, fragment, prefix = "") {
    const made = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, `#version 300 es\nprecision highp float;\n${vertex}`],
                                [gl.FRAGMENT_SHADER,
                                 `#version 300 es\n${prefix || "precision highp float;\nprecision highp int;\n"}${fragment}`]]) {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        gl.attachShader(made, shader);
        gl.deleteShader(shader);
    }
    gl.bindAttribLocation(made, 0, "a_position");
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) {
        const logs = gl.getAttachedShaders(made).map((shader) => gl.getShaderInfoLog(shader)).join(" ").trim();
        throw new Error(`this browser failed to compile a shader of this page: ${logs || gl.getProgramInfoLog(made)}`);
    }
    const places = new Map();
    return {
        name: made,
        /**
         * Sets uniforms by their values: a number, 2 to 4 numbers, or a matrix of 16; { int } for integers and
         * samplers.
         */
        set(values) {
            gl.useProgram(made);
            for (const [key, value] of Object.entries(values)) {
                if (!places.has(key)) {
                    places.set(key, gl.getUniformLocation(made, key));
                }
                const at = places.get(key);
                if (typeof value === "number") {
                    gl.uniform1f(at, value);
                } else if (value.int !== undefined) {
                    gl.uniform1i(at, value.int);
                } else if (value.length === 16) {
                    gl.uniformMatrix4fv(at, false, value);
                } else {
                    gl[`uniform${value.length}fv`](at, value);
                }
            }
        },
    };
}

/** Indexed geometry. positions: three numbers per vertex. */
export class Geometry {
    constructor(gl, positions, indices) {
        this.gl = gl;
        this.array = gl.createVertexArray();
        this.count = indices.length;
        gl.bindVertexArray(this.array);
        this.buffers = [[gl.ARRAY_BUFFER, positions], [gl.ELEMENT_ARRAY_BUFFER, indices]].map(([target, values]) => {
            const buffer = gl.createBuffer();
            gl.bindBuffer(target, buffer);
            gl.bufferData(target, values, gl.STATIC_DRAW);
            return buffer;
        });
        gl.enableVertexAttribArray(0);
        gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
        gl.bindVertexArray(null);
    }

    move(positions) {
        this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.buffers[0]);
        this.gl.bufferData(this.gl.ARRAY_BUFFER, positions, this.gl.DYNAMIC_DRAW);
    }

    draw() {
        this.gl.bindVertexArray(this.array);
        this.gl.drawElements(this.gl.TRIANGLES, this.count, this.gl.UNSIGNED_INT, 0);
        this.gl.bindVertexArray(null);
    }
}

export function texture(gl, internal, width, height, format, type, data = null) {
    const made = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, made);
    gl.texImage2D(gl.TEXTURE_2D, 0, internal, width, height, 0, format, type, data);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
        gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    }
    gl.bindTexture(gl.TEXTURE_2D, null);
    return made;
}

/** A framebuffer with textures for colour and depth. */
export class Target {
    constructor(gl, width, height) {
        Object.assign(this, { gl, width, height });
        this.color = texture(gl, gl.RGBA8, width, height, gl.RGBA, gl.UNSIGNED_BYTE);
        this.depth = texture(gl, gl.DEPTH_COMPONENT24, width, height, gl.DEPTH_COMPONENT, gl.UNSIGNED_INT);
        this.name = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.name);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.color, 0);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depth, 0);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }

    bind() {
        this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, this.name);
        this.gl.viewport(0, 0, this.width, this.height);
    }

    dispose() {
        this.gl.deleteFramebuffer(this.name);
        this.gl.deleteTexture(this.color);
        this.gl.deleteTexture(this.depth);
    }
}

export function bindTexture(gl, unit, name, target = gl.TEXTURE_2D) {
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(target, name);
}

/** Draws a triangle that covers the target; kScreenVertex computes its corners. */
export function drawScreen(gl) {
    gl.bindVertexArray(null);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
}

export const kScreenVertex = `
out vec2 v_uv;
void main() {
    v_uv = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    gl_Position = vec4(2.0 * v_uv - 1.0, 0.0, 1.0);
}`;
