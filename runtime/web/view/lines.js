// Lines of a width in pixels, in space: what is hidden shows faintly.
import { Geometry, program } from "./gl.js";

const kVertex = `
in vec3 a_position;
in vec3 a_other;
in vec3 a_color;
uniform mat4 u_camera;
uniform vec2 u_pixels;
uniform float u_width;
out vec3 v_color;
out float v_side;
void main() {
    vec4 here = u_camera * vec4(a_position, 1.0);
    vec4 there = u_camera * vec4(a_other, 1.0);
    vec2 way = (there.xy / max(there.w, 1e-4) - here.xy / max(here.w, 1e-4)) * u_pixels;
    vec2 across = length(way) > 0.0 ? normalize(vec2(-way.y, way.x)) : vec2(0.0, 1.0);
    // Both ends of a line come in twice; the second time round it is the other side.
    float side = (gl_VertexID & 1) == 0 ? 1.0 : -1.0;
    bool first = (gl_VertexID & 2) == 0;
    v_side = first ? side : -side;
    here.xy += side * across * (0.5 * u_width + 1.0) * 2.0 / u_pixels * here.w;
    here.z -= 1e-4 * here.w;
    gl_Position = here;
    v_color = a_color;
}`;

const kFragment = `
in vec3 v_color;
in float v_side;
uniform float u_width;
uniform float u_opacity;
out vec4 o_color;
void main() {
    float beside = abs(v_side) * (0.5 * u_width + 1.0);
    o_color = vec4(v_color, u_opacity * (1.0 - smoothstep(0.5 * u_width - 0.5, 0.5 * u_width + 0.5, beside)));
}`;

export class Lines {
    constructor(gl) {
        this.gl = gl;
        this.program = program(gl, kVertex, kFragment);
        this.geometry = null;
    }

    /** @param segments  [from, to, color] each */
    set(segments) {
        this.geometry?.dispose();
        this.geometry = null;
        if (segments.length === 0) {
            return;
        }
        const position = [];
        const other = [];
        const color = [];
        const indices = [];
        for (const [from, to, tint] of segments) {
            const first = position.length / 3;
            position.push(...from, ...from, ...to, ...to);
            other.push(...to, ...to, ...from, ...from);
            color.push(...tint, ...tint, ...tint, ...tint);
            indices.push(first, first + 1, first + 2, first, first + 2, first + 3);
        }
        this.geometry = new Geometry(this.gl, {
            a_position: Float32Array.from(position),
            a_other: Float32Array.from(other),
            a_color: Float32Array.from(color),
        }, Uint32Array.from(indices));
    }

    draw(camera, pixels, width) {
        if (!this.geometry) {
            return;
        }
        const { gl } = this;
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
        gl.depthMask(false);
        for (const [test, opacity] of [[gl.LEQUAL, 0.95], [gl.GREATER, 0.22]]) {
            gl.depthFunc(test);
            this.program.set({ u_camera: camera, u_pixels: pixels, u_width: width, u_opacity: opacity });
            this.geometry.draw();
        }
        gl.depthFunc(gl.LEQUAL);
        gl.depthMask(true);
        gl.disable(gl.BLEND);
    }
}
