// Where particles touched: the last contact of each place in the state textures, kept on the GPU.
import { Target, bindTexture, drawScreen, kScreenVertex, program } from "./gl.js";

const kLasts = 6; // seconds that a mark is seen

const kKeepFragment = `
precision highp sampler2D;
uniform sampler2D u_position;
uniform sampler2D u_velocity;
uniform float u_now;
out vec4 o_mark;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float contact = texelFetch(u_velocity, at, 0).w;
    vec4 position = texelFetch(u_position, at, 0);
    if (!(contact > 0.5) || position.w < 0.0 || position.y < -1e8) {
        discard;
    }
    o_mark = vec4(position.xyz, u_now);
}`;

const kDrawVertex = `
precision highp sampler2D;
uniform sampler2D u_marks;
uniform mat4 u_camera;
uniform float u_now;
uniform float u_size;
uniform float u_pixels;
out float v_fresh;
void main() {
    int width = textureSize(u_marks, 0).x;
    vec4 mark = texelFetch(u_marks, ivec2(gl_VertexID % width, gl_VertexID / width), 0);
    v_fresh = mark.w > 0.0 ? 1.0 - (u_now - mark.w) / ${kLasts.toFixed(1)} : 0.0;
    gl_Position = v_fresh > 0.0 ? u_camera * vec4(mark.xyz, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
    gl_Position.z -= 6e-4 * gl_Position.w;
    gl_PointSize = clamp(u_size * u_pixels / gl_Position.w, 1.5, 24.0);
}`;

const kDrawFragment = `
in float v_fresh;
uniform vec3 u_tint;
out vec4 o_color;
void main() {
    float beside = length(gl_PointCoord - 0.5) * 2.0;
    o_color = vec4(u_tint, (1.0 - smoothstep(0.6, 1.0, beside)) * 0.75 * v_fresh);
}`;

export class Marks {
    #programs;
    #target = null;

    constructor(gl) {
        this.gl = gl;
        this.#programs = { keep: program(gl, kScreenVertex, kKeepFragment), draw: program(gl, kDrawVertex, kDrawFragment) };
    }

    clear() {
        this.#target?.dispose();
        this.#target = null;
    }

    /** After a step. textures: of ParticleSystem; info: its info. */
    keep(textures, info) {
        const { gl } = this;
        const height = Math.ceil(info.capacity / info.width);
        if (!this.#target) {
            this.#target = new Target(gl, info.width, height, true);
            this.#target.bind();
            gl.clearColor(0, 0, 0, 0);
            gl.clear(gl.COLOR_BUFFER_BIT);
        }
        this.#target.bind();
        gl.disable(gl.BLEND);
        gl.disable(gl.DEPTH_TEST);
        bindTexture(gl, 0, textures.position);
        bindTexture(gl, 1, textures.velocity);
        this.#programs.keep.set({ u_position: { int: 0 }, u_velocity: { int: 1 }, u_now: info.time });
        drawScreen(gl);
        bindTexture(gl, 0, null);
        bindTexture(gl, 1, null);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }

    draw(matrices, height, now, size, tint) {
        if (!this.#target) {
            return;
        }
        const { gl } = this;
        gl.enable(gl.DEPTH_TEST);
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
        gl.depthMask(false);
        bindTexture(gl, 0, this.#target.color);
        this.#programs.draw.set({ u_marks: { int: 0 }, u_camera: matrices.camera, u_now: now, u_size: size,
                                  u_pixels: 0.5 * height * matrices.projection[5], u_tint: tint });
        gl.bindVertexArray(null);
        gl.drawArrays(gl.POINTS, 0, this.#target.width * this.#target.height);
        bindTexture(gl, 0, null);
        gl.depthMask(true);
        gl.disable(gl.BLEND);
    }

    /** How many places hold a mark; waits for the GPU. */
    count() {
        if (!this.#target) {
            return 0;
        }
        const { gl } = this;
        const all = new Float32Array(4 * this.#target.width * this.#target.height);
        this.#target.bind();
        gl.readPixels(0, 0, this.#target.width, this.#target.height, gl.RGBA, gl.FLOAT, all);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        return all.filter((v, i) => i % 4 === 3 && v > 0).length;
    }
}
