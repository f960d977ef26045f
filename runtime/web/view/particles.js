// SPDX-License-Identifier: Apache-2.0
// The particles on the page: one system of Relief, with rain, snow or the page's scene in it.
import { ParticleSystem } from "relief-particles";

const kStepsAFrame = 3; // where the page is slow, time goes slower

/** "rain" or "snow" on a box. L: its longest side. */
export function weather(preset, { center: c, max, longest: L, size }, capacity = 65536) {
    const rain = preset === "rain";
    const over = (way, height) => [0, 1, 2].map((k) => (k === 1 ? max[1] + height * L : c[k] + way * (0.6 * size[k] + 0.05 * L)));
    const lasting = (seconds) => ({ rate: capacity / seconds, duration: 1e5 }); // as keeps that many alive
    return {
        particles: { capacity },
        forces: { gravity: [0, (rain ? -3 : -2.2) * L, 0], wind: [rain ? 0 : 0.12 * L, 0, 0], drag: rain ? 0.5 : 4.5 },
        ...(rain ? { collision: { sweep: 0.015 * L }, render: { sprite: "quad" } }
            : { curl_noise: { amplitude: 0.12 * L, scale: 0.6 * L } }),
        type: [rain ? { radius: 0.004 * L, restitution: 0.35, friction: 0.1, lifetime_loss: 0.12, size: 0.0035 * L, stretch: 0.025,
                        color: [[0, 0.55, 0.72, 0.95], [1, 0.8, 0.9, 1]], opacity: [[0, 0], [0.06, 0.7], [0.85, 0.65], [1, 0]] }
            : { radius: 0.006 * L, friction: 1, on_collision: "stop", size: 0.011 * L, color: [0.97, 0.98, 1], opacity: 0.95 }],
        emitter: rain ? { box_min: over(-1, 0.25), box_max: over(1, 0.6), velocity: [0, -1.4 * L, 0],
                          velocity_spread: [0.03 * L, 0.15 * L, 0.03 * L], lifetime: [1.8, 2.4], ...lasting(2.4) }
            : { box_min: over(-1, 0.12), box_max: over(1, 0.5), velocity: [0, -0.4 * L, 0],
                velocity_spread: [0.08 * L, 0.06 * L, 0.08 * L], lifetime: [11, 14], ...lasting(14) },
    };
}

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
        this.stop();
        this.system = new ParticleSystem(this.gl, options);
        this.dt = this.system.info.dt;
        this.steps += 1;
    }

    stop() {
        this.system?.dispose();
        this.system = null;
        this.#owed = 0;
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
