// SPDX-License-Identifier: Apache-2.0
// The particles of a page that plays a scene: one ParticleSystem.
const kStepsPerFrameMax = 3; // slow pages run the simulation slower than real time

export class Particles {
    #owed = 0;

    constructor(gl) {
        this.gl = gl;
        this.system = null;
        this.paused = false;
        this.steps = 0; // incremented by every change of the system
    }

    /** @param options  options of ParticleSystem */
    start(options) {
        this.system = new reliefParticles.ParticleSystem(this.gl, options);
        this.dt = this.system.info.dt;
        this.steps += 1;
    }

    restart() {
        this.system.restart();
        this.steps += 1;
    }

    step() {
        this.system.step();
        this.steps += 1;
    }

    /** Runs as many steps as fit into `seconds`. */
    advance(seconds) {
        if (!this.system || this.paused) {
            return;
        }
        this.#owed = Math.min(this.#owed + seconds, kStepsPerFrameMax * this.dt);
        for (let i = 0; this.#owed >= 0.98 * this.dt && i < kStepsPerFrameMax; ++i) {
            this.step();
            this.#owed = Math.max(this.#owed - this.dt, 0);
        }
    }

    draw({ view, projection }, width, height) {
        this.system?.draw({ view, projection, framebuffer: null, width, height });
    }
}
