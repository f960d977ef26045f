// SPDX-License-Identifier: Apache-2.0
// Draws the page. Bodies are redrawn only when they change; otherwise their picture is kept, and particles are drawn
// over it with its depth buffer.
import { Geometry, Target, bindTexture, drawScreen, drawnBySoftware, kScreenVertex, program } from "./gl.js";
import { kBodyVertex, kCopyFragment, kFloorFragment, kLiveVertex, kMeshFragment, kSkyFragment } from "./body_shaders.js";
import { add, identity, normalize, scale } from "./math.js";

const kThemes = {
    dark: {
        low: [0.10, 0.115, 0.135], high: [0.155, 0.175, 0.205], line: [0.30, 0.33, 0.38], base: [0.70, 0.71, 0.73],
        mesh: [0.66, 0.70, 0.76], sky: [0.50, 0.53, 0.58], earth: [0.17, 0.17, 0.19],
    },
    light: {
        low: [0.90, 0.91, 0.925], high: [0.80, 0.83, 0.865], line: [0.66, 0.69, 0.73], base: [0.80, 0.795, 0.78],
        mesh: [0.72, 0.77, 0.83], sky: [0.60, 0.61, 0.63], earth: [0.33, 0.32, 0.31],
    },
};

function quad(gl) {
    return new Geometry(gl, new Float32Array(12), new Uint32Array([0, 1, 2, 0, 2, 3]));
}

export class View {
    #fine = 1;

    constructor(gl) {
        this.gl = gl;
        this.software = drawnBySoftware(gl); // supersampling would take seconds
        this.bodies = []; // all drawn bodies
        this.body = null; // the body in the panel
        this.mesh = null; // Geometry, in object space
        this.picture = null; // ParticleSystem.drawMeshes(), or null
        this.kept = null; // picture of the bodies: a Target, up to twice the resolution of the canvas
        this.dirty = true;
        this.programs = {
            mesh: program(gl, kBodyVertex, kMeshFragment),
            live: program(gl, kLiveVertex, kMeshFragment),
            floor: program(gl, kBodyVertex, kFloorFragment),
            sky: program(gl, kScreenVertex, kSkyFragment),
            copy: program(gl, kScreenVertex, kCopyFragment),
        };
        this.floor = quad(gl);
        this.plane = quad(gl);
    }

    /** Draws everything except particles. look: App.look; still: nothing moves, so supersample if possible. */
    drawBodies(matrices, width, height, look, still) {
        const fine = still && !this.software && width * height <= 2.5e6 ? 2 : 1;
        if (!this.dirty && fine <= this.#fine && this.kept?.width === width * this.#fine &&
            this.kept.height === height * this.#fine) {
            return;
        }
        const { gl } = this;
        if (!this.kept || this.kept.width !== width * fine || this.kept.height !== height * fine) {
            this.kept?.dispose();
            this.kept = new Target(gl, width * fine, height * fine);
        }
        this.#fine = fine;
        this.dirty = false;
        if (look.show === "picture") {
            const { view, projection } = matrices;
            this.picture({ view, projection, framebuffer: this.kept.name, width: width * fine, height: height * fine });
            return;
        }
        this.kept.bind();
        const theme = kThemes[look.theme];
        gl.disable(gl.BLEND);
        gl.disable(gl.CULL_FACE);
        gl.disable(gl.DEPTH_TEST);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        this.programs.sky.set({ u_low: theme.low, u_high: theme.high });
        drawScreen(gl);
        gl.enable(gl.DEPTH_TEST);
        gl.depthFunc(gl.LEQUAL);
        const common = this.#lights(matrices, theme, look);
        const split = Math.round(look.split * width * fine);
        const parts = !this.mesh ? [["surface", 0, width * fine]]
            : look.show === "split" ? [["mesh", 0, split], ["surface", split, width * fine - split]]
            : [[look.show, 0, width * fine]];
        gl.enable(gl.SCISSOR_TEST);
        for (const [what, x, w] of parts) {
            gl.scissor(x, 0, w, height * fine);
            if (what === "mesh") {
                this.#drawMesh(common, theme, look);
            } else {
                this.bodies.forEach((body, i) => body.draw({
                    ...common, u_base: look.color?.(i) ?? theme.base, u_map: { int: body === this.body ? look.map : -1 } }));
            }
        }
        gl.disable(gl.SCISSOR_TEST);
        if (look.slice) {
            this.#drawSlice(matrices.camera, look.slice);
        }
        if (look.floor !== null) {
            this.#drawFloor(matrices.camera, theme, look);
        }
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }

    #lights(matrices, theme, look) {
        const { view, camera, eye } = matrices;
        const key = normalize(add(add(scale([view[0], view[4], view[8]], -0.5), scale([view[2], view[6], view[10]], 0.6)),
                                  [0, 0.9, 0]));
        let cut = [0, 0, 0, 0];
        if (look.slice) {
            const { axis, at } = look.slice;
            const way = eye[axis] > at ? 1 : -1;
            cut = [0, 0, 0, way * at];
            cut[axis] = way;
        }
        return { u_camera: camera, u_eye: eye, u_key: key, u_cut: cut, u_sky: theme.sky, u_earth: theme.earth,
                 u_model: identity() };
    }

    #drawMesh(common, theme, look) {
        const heat = look.heat > 0;
        const program = heat ? this.body.use("heat") : this.programs.mesh;
        program.set({ ...common, u_base: theme.mesh, ...(heat && { u_range: look.heat, u_depth: look.depth }) });
        this.mesh.draw();
    }

    #drawSlice(camera, { axis, at, range }) {
        const { body } = this;
        const margin = 0.1 * body.box.longest;
        const corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map((side) => {
            const p = [0, 0, 0];
            p[axis] = at;
            [(axis + 1) % 3, (axis + 2) % 3].forEach((i, k) =>
                (p[i] = side[k] ? body.box.max[i] + margin : body.box.min[i] - margin));
            return p;
        });
        this.plane.move(Float32Array.from(corners.flat()));
        body.use("slice").set({ u_camera: camera, u_model: body.model, u_range: range });
        this.plane.draw();
    }

    #drawFloor(camera, theme, look) {
        const { gl } = this;
        const { center, radius, longest } = look.box;
        const r = 5 * radius;
        this.floor.move(Float32Array.from([[-1, -1], [1, -1], [1, 1], [-1, 1]].flatMap(([x, z]) =>
            [center[0] + r * x, look.floor - 1e-3 * longest, center[2] + r * z])));
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
        this.programs.floor.set({ u_camera: camera, u_model: identity(), u_background: theme.low, u_line: theme.line,
                                  u_middle: center, u_radius: r, u_grid: 10 ** Math.round(Math.log10(longest / 4)) });
        this.floor.draw();
        gl.disable(gl.BLEND);
    }

    /** Copies the kept picture and its depths to the canvas. */
    copyBodies(width, height) {
        const { gl } = this;
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        gl.viewport(0, 0, width, height);
        gl.disable(gl.BLEND);
        gl.enable(gl.DEPTH_TEST);
        gl.depthFunc(gl.ALWAYS);
        bindTexture(gl, 0, this.kept.color);
        bindTexture(gl, 1, this.kept.depth);
        this.programs.copy.set({ u_color: { int: 0 }, u_depth: { int: 1 }, u_fine: { int: this.#fine } });
        drawScreen(gl);
        bindTexture(gl, 0, null);
        bindTexture(gl, 1, null);
        gl.depthFunc(gl.LEQUAL);
    }
}
