// SPDX-License-Identifier: Apache-2.0
// The bodies of a scene: picking, names, facts and errors.
import { bindTexture, drawScreen, kScreenVertex, program, texture } from "./gl.js";
import { clamp, inverse, length, mix, shortNumber, sub, transform } from "./math.js";

// Colours for percentages of wrong points. Their limits, 1 and 5, match the grades of the verdict.
const kGood = [0.42, 0.62, 0.45];
const kFair = [0.93, 0.66, 0.20];
const kPoor = [0.85, 0.18, 0.13];
const kPicked = [0.36, 0.60, 0.98];
const css = (color) => `rgb(${color.map((v) => Math.round(255 * v)).join(" ")})`;

export const kWrongLegend = `linear-gradient(90deg, ${css(kGood)}, ${css(kFair)} 50%, ${css(kPoor)})`;
export const wrongColor = (percent) => (percent <= 1 ? mix(kGood, kFair, Math.max(percent, 0))
    : mix(kFair, kPoor, Math.min((percent - 1) / 4, 1)));

export const bytesText = (bytes) => (bytes >= 1e6 ? `${(bytes / 1e6).toFixed(2)} MB` : `${shortNumber(bytes / 1e3)} kB`);

const kDepthFragment = `
precision highp sampler2D;
uniform sampler2D u_depth;
uniform vec2 u_at;
out vec4 o_color;
void main() {
    o_color = vec4(texelFetch(u_depth, ivec2(u_at), 0).r, 0.0, 0.0, 1.0);
}`;

/** Reads one depth value by a shader, because WebGL2 cannot read depth buffers back. */
class DepthReader {
    constructor(gl) {
        this.gl = gl;
        this.program = program(gl, kScreenVertex, kDepthFragment);
        this.pixel = texture(gl, gl.R32F, 1, 1, gl.RED, gl.FLOAT);
        this.target = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.pixel, 0);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }

    /** Returns the depth in [0, 1]. picture: a Target; x, y: pixel from the bottom left. */
    read(picture, x, y) {
        const { gl } = this;
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
        gl.viewport(0, 0, 1, 1);
        gl.disable(gl.BLEND);
        gl.disable(gl.DEPTH_TEST);
        bindTexture(gl, 0, picture.depth);
        this.program.set({ u_depth: { int: 0 }, u_at: [x, y] });
        drawScreen(gl);
        bindTexture(gl, 0, null);
        const value = new Float32Array(4);
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.FLOAT, value);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        return value[0];
    }
}

export class Bodies {
    /**
     * @param placed  the drawable bodies of the scene
     * @param info  the same bodies in SystemInfo of the ParticleSystem
     * @param data  data of the page
     */
    constructor(gl, placed, info, data) {
        Object.assign(this, { gl, placed, info, data });
        this.picked = -1;
        this.tinted = false; // colours by wrong points, if measured
        this.depths = new DepthReader(gl);
        this.meshes = new Map(); // container file name to mesh name
        for (const [name, bytes] of Object.entries(data.files)) {
            if (name.endsWith(".json")) {
                JSON.parse(new TextDecoder().decode(bytes)).colliders?.forEach((one) => this.meshes.set(one.file, one.mesh));
            }
        }
        this.nodes = data.check?.accuracy?.bodies; // a mesh cut into tiles has one entry here, but several bodies
        const measured = this.nodes?.flatMap((node) => Array(node.tiles).fill(node));
        // Null unless the level and the world have the same bodies.
        this.measured = measured?.length === placed.length ? measured : null;
    }

    /** Returns the colour of a body; undefined: the colour of the theme. */
    color(i) {
        const wrong = this.tinted && this.measured ? wrongColor(this.measured[i].wrong_percent) : undefined;
        return i === this.picked ? mix(wrong ?? kPicked, kPicked, 0.6) : wrong;
    }

    /** Returns the body at a place of the picture, or −1. x, y: fractions of its sides, from the lower left. */
    at(picture, matrices, x, y) {
        const { width, height } = picture;
        const pixel = [clamp(Math.floor(x * width), 0, width - 1), clamp(Math.floor(y * height), 0, height - 1)];
        const depth = this.depths.read(picture, ...pixel);
        if (!(depth < 1)) {
            return -1;
        }
        const clip = [2 * (pixel[0] + 0.5) / width - 1, 2 * (pixel[1] + 0.5) / height - 1, 2 * depth - 1];
        const [a, b, c, w] = transform(inverse(matrices.camera), clip);
        return this.nearest([a / w, b / w, c / w], 1e-3 * length(sub([a / w, b / w, c / w], matrices.eye)));
    }

    /** Returns the body whose surface is nearest to a point, or −1 if none is nearer than `within`. */
    nearest(point, within) {
        let best = -1;
        let least = within;
        this.placed.forEach(({ collider, box, model }, i) => {
            if (!collider) {
                return; // deforming body
            }
            const scale = length(model);
            const p = transform(inverse(model), point).slice(0, 3);
            const room = Math.max(within / scale, 0.01 * box.longest);
            if (p.some((v, k) => v < box.min[k] - room || v > box.max[k] + room)) {
                return;
            }
            // Query inside the box: beyond it, a collider may return far outside.
            const inside = p.map((v, k) => clamp(v, box.min[k], box.max[k]));
            const distance = (Math.abs(collider.query(inside).distance[0]) + length(sub(p, inside))) * scale;
            if (distance < least) {
                [best, least] = [i, distance];
            }
        });
        return best;
    }

    /** Returns facts about a body as pairs of label and value. */
    facts(i) {
        const { file, deforms } = this.info[i];
        const base = file.split("/").pop();
        const bytes = this.data.files[file]?.length;
        const { model } = this.placed[i];
        const wrong = this.measured?.[i];
        return [
            ["mesh", this.meshes.get(base)],
            [deforms ? "mesh file" : "collider", base],
            ["size", bytes && bytesText(bytes)],
            ["scale", shortNumber(length(model))],
            ["at", [...model.slice(12, 15)].map(shortNumber).join(", ")],
            ["wrong points", wrong && `${shortNumber(wrong.wrong_percent)} %`],
        ].filter(([, value]) => value !== undefined && value !== "");
    }

    /** Returns the node name of a body, or its file name if the node has none. */
    name(i) {
        return this.info[i].node || this.info[i].file.split("/").pop();
    }
}
