// A collider in space: its textures, its triangles, and the programs that ask it.
import { GpuCollider } from "./relief.js";
import { identity, inverseSimilarity, boxOf, transform } from "./math.js";
import { Geometry, program } from "./gl.js";
import { kBodyVertex, kHeatFragment, kSliceFragment, kSurfaceFragment } from "./body_shaders.js";
import { surfaceOf } from "./surface.js";

const kCells = [40, 144]; // along the longest side: at once, and then in peace

export class Body {
    #programs = {};
    #alive = true;

    /** @param name  of its file */
    constructor(gl, collider, name, model = identity()) {
        Object.assign(this, { gl, collider, name, model });
        this.box = boxOf(collider.bounds);
        this.toObject = inverseSimilarity(model);
        this.gpu = new GpuCollider(gl, collider);
        this.surface = null;
        this.spacing = 0;
    }

    /** Triangles, coarse and then fine; changed() after each. */
    async build(changed) {
        for (const cells of kCells) {
            const found = await surfaceOf(this.collider, this.box, cells, () => this.#alive);
            if (!found) {
                return;
            }
            this.surface?.dispose();
            this.surface = new Geometry(this.gl, { a_position: found.vertices }, found.indices);
            this.triangles = found.indices.length / 3;
            this.spacing = found.spacing;
            changed();
        }
    }

    /** A program with the field's functions in it, ready to be drawn with. */
    use(kind) {
        const fragments = { surface: kSurfaceFragment, heat: kHeatFragment, slice: kSliceFragment };
        if (!this.#programs[kind]) {
            this.#programs[kind] = program(this.gl, kBodyVertex, fragments[kind], this.gpu.glsl);
            this.gpu.attach(this.#programs[kind].name);
        }
        this.gpu.bind();
        return this.#programs[kind];
    }

    place(model) {
        this.model = model;
        this.toObject = inverseSimilarity(model);
    }

    eyeInObject(eye) {
        return transform(this.toObject, eye).slice(0, 3);
    }

    dispose() {
        this.#alive = false;
        this.surface?.dispose();
        Object.values(this.#programs).forEach((one) => this.gl.deleteProgram(one.name));
        this.gpu.dispose();
    }
}
