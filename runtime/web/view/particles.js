// The particles on the page: one system of Relief, of a preset or of a scene that was dropped in.
import { ParticleSystem } from "relief-particles";
import { kDefaults, presetScene } from "./presets.js";

const kStepsAFrame = 3; // where the page is slow, time goes slower

export class Particles {
    #owed = 0;

    constructor(gl) {
        this.gl = gl;
        this.system = null;
        this.preset = null; // "scene": a dropped one
        this.settings = null;
        this.paused = false;
        this.steps = 0; // grows with whatever the system does
    }

    /** @param body  of body.js */
    startPreset(preset, body, settings) {
        this.body = body;
        const wanted = settings ?? kDefaults[preset];
        const scene = presetScene(preset, body.name, body.box, wanted);
        this.#replace(() => new ParticleSystem(this.gl, { scene, files: { [body.name]: body.collider } }), preset);
        this.settings = wanted;
    }

    startScene(text, files) {
        this.#replace(() => new ParticleSystem(this.gl, { scene: text, files }), "scene");
        this.settings = null;
    }

    #replace(make, preset) {
        const made = make(); // the old one plays on where this fails
        this.stop();
        this.system = made;
        this.preset = preset;
        this.info = made.info;
    }

    stop() {
        this.system?.dispose();
        this.system = null;
        this.preset = null;
        this.#owed = 0;
    }

    /** Settings of the sliders. A system of another size is a new one. */
    change(settings) {
        const before = this.settings;
        this.settings = { ...before, ...settings };
        if (!this.system) {
            return;
        }
        if (this.settings.count !== before.count) {
            this.startPreset(this.preset, this.body, this.settings);
            return;
        }
        const { collider, time, particles, ...rest } = presetScene(this.preset, this.body.name, this.body.box, this.settings);
        this.system.set(rest);
    }

    restart() {
        this.system?.restart();
        this.info = this.system?.info;
        this.steps += 1;
    }

    step() {
        this.system.step();
        this.steps += 1;
    }

    /** As many steps as `seconds` ask for. */
    advance(seconds) {
        if (!this.system || this.paused) {
            return;
        }
        const { dt } = this.info;
        this.#owed = Math.min(this.#owed + seconds, kStepsAFrame * dt);
        for (let i = 0; this.#owed >= 0.98 * dt && i < kStepsAFrame; ++i) {
            this.step();
            this.#owed = Math.max(this.#owed - dt, 0);
        }
    }

    draw({ view, projection }, width, height) {
        this.system?.draw({ view, projection, framebuffer: null, width, height });
    }

    /** How many live: told by the CPU's books, now and then. */
    get alive() {
        return this.system?.info.alive ?? 0;
    }
}
