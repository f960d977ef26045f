// SPDX-License-Identifier: Apache-2.0
// A drawable collider: its textures, its box, and the programs that evaluate it.
import { add, boxOf, identity, sub } from "./math.js";
import { cellsOf } from "./cells.js";
import { Geometry, bindTexture, program } from "./gl.js";
import { kBodyVertex, kHeatFragment, kSliceFragment, kSurfaceFragment } from "./body_shaders.js";

// Margin around the bounds, in longest sides; anything inside a map beyond it is not part of the body.
const kSlack = 0.0035;
const kDeep = 0.014;
const kClearUnit = 3; // texture unit after those of the collider
const kBoxSides = [0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5];

export class Body {
    constructor(gl, collider) {
        Object.assign(this, { gl, collider, programs: {} });
        this.place(identity());
        this.box = boxOf(collider.bounds);
        this.gpu = collider.onGpu?.(gl) ?? new reliefParticles.GpuCollider(gl, collider);
        const slack = [0, 0, 0].fill(kSlack * this.box.longest);
        this.drawn = { min: sub(this.box.min, slack), max: add(this.box.max, slack) };
        const corners = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((i) =>
            [0, 1, 2].map((k) => ((i >> k) & 1 ? this.drawn.max : this.drawn.min)[k]));
        this.cells = cellsOf(collider, this.drawn);
        this.clear = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_3D, this.clear);
        gl.texStorage3D(gl.TEXTURE_3D, 1, gl.R8, ...this.cells.n);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        gl.texSubImage3D(gl.TEXTURE_3D, 0, 0, 0, 0, ...this.cells.n, gl.RED, gl.UNSIGNED_BYTE, this.cells.clear);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
        gl.bindTexture(gl.TEXTURE_3D, null);
        this.sides = new Geometry(gl, Float32Array.from(corners), Uint32Array.from(kBoxSides));
    }

    /** Returns a program that can evaluate the collider, and binds the collider. */
    use(kind) {
        const fragments = { surface: kSurfaceFragment, heat: kHeatFragment, slice: kSliceFragment };
        if (!this.programs[kind]) {
            this.programs[kind] = program(this.gl, kBodyVertex, fragments[kind], this.gpu.glsl);
            this.gpu.attach(this.programs[kind].name);
        }
        this.gpu.bind();
        return this.programs[kind];
    }

    /** Draws the surface of the maps. values: uniforms shared by all bodies. */
    draw(values) {
        const { gl, box, drawn } = this;
        const { maps, finest_texel: texel } = this.collider.info;
        // A ray crosses each row and column of a map once; patches have up to `longest / texel` of them.
        const steps = maps.reduce((sum, { projection, width, height }) =>
            sum + (projection === "local" ? 6 * (box.longest / texel) : 2 * (width + height)), 256);
        this.use("surface").set({
            ...values, u_model: this.model, u_box_min: drawn.min, u_box_max: drawn.max,
            u_deep: kDeep * box.longest, u_tiny: Math.max(1e-3 * texel, 1e-6 * box.longest),
            u_clear: { int: kClearUnit }, u_cells_from: this.cells.from, u_cell: this.cells.side,
            u_steps: { int: Math.min(steps, 60000) },
        });
        bindTexture(gl, kClearUnit, this.clear, gl.TEXTURE_3D);
        gl.enable(gl.CULL_FACE);
        gl.cullFace(gl.FRONT);
        this.sides.draw();
        bindTexture(gl, kClearUnit, null, gl.TEXTURE_3D);
        gl.cullFace(gl.BACK);
        gl.disable(gl.CULL_FACE);
    }

    /** model: object space to world space. */
    place(model) {
        this.model = Float32Array.from(model);
    }
}

/** A deforming body. mesh() returns its LiveMesh (relief.d.ts). */
export class LiveBody {
    constructor(gl, program, mesh) {
        Object.assign(this, { gl, program, mesh });
    }

    place(model) {
        this.model = Float32Array.from(model);
    }

    draw({ u_map, ...values }) {
        const { gl } = this;
        const { positions, corners, vertexShift, triangleShift, triangles } = this.mesh();
        bindTexture(gl, 0, positions);
        bindTexture(gl, 1, corners);
        this.program.set({ ...values, u_model: this.model, u_positions: { int: 0 }, u_corners: { int: 1 },
                           u_vertex_shift: { int: vertexShift }, u_triangle_shift: { int: triangleShift } });
        gl.bindVertexArray(null);
        gl.drawArrays(gl.TRIANGLES, 0, 3 * triangles);
        bindTexture(gl, 0, null);
        bindTexture(gl, 1, null);
    }
}
