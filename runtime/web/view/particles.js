// SPDX-License-Identifier: Apache-2.0
// The particles of a page that plays a scene: one system of relief-particles.
const kStepsAFrame = 3; // where the page is slow, time goes slower

export class Particles {
    #owed = 0;

    constructor(gl) {
        this.gl = gl;
        this.system = null;
        this.paused = false;
        this.steps = 0; // grows with whatever the system does
    }

    /** @param options  of a ParticleSystem */
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

    /** As many steps as fit into `seconds`. */
    advance(seconds) {
        if (!this.system || this.paused) {
            return;
        }
        this.#owed = Math.min(this.#owed + seconds, kStepsAFrame * this.dt);
        for (let i = 0; this.#owed >= 0.98 * this.dt && i < kStepsAFrame; ++i) {
            this.step();
            this.#owed = Math.max(this.#owed - this.dt, 0);
        }
    }

    draw({ view, projection }, width, height) {
        this.system?.draw({ view, projection, framebuffer: null, width, height });
    }
}
