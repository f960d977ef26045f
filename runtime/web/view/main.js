// SPDX-License-Identifier: Apache-2.0
// The page of `relief view`: application state and render loop.
import { Bodies } from "./bodies.js";
import { Body, LiveBody } from "./body.js";
import { Camera, FlightKeys, followInput } from "./camera.js";
import { Geometry } from "./gl.js";
import { boxOf, transform } from "./math.js";
import { PageCollider } from "./page_collider.js";
import { readPageData, readWasm } from "./page_data.js";
import { $, Panel } from "./panel.js";
import { Particles } from "./particles.js";
import { Quality } from "./quality.js";
import { View } from "./view.js";
import { WorldPanel } from "./world_panel.js";

const canvas = $("canvas");
const kLost = "The GPU was reset; the page reloads when the browser restores it.";
const dark = matchMedia("(prefers-color-scheme: dark)");

/** Shows a message; null hides it. */
function showMessage(message) {
    $("message").hidden = !message;
    $("message").querySelector("p").textContent = message ?? "";
}

class App {
    constructor() {
        this.look = { show: "surface", split: 0.5, map: -1, heat: 0, depth: 0, slice: null, floor: null, box: null };
        this.data = null; // result of readPageData()
        this.pin = null; // marked position
        this.followed = null; // the last camera of the scene
        this.camera = new Camera(() => this.changed());
        this.flight = new FlightKeys(this.camera);
        this.bodies = null; // Bodies of a scene
        this.quality = new Quality();
        this.lastChange = 0;
        this.lastFrame = 0;
        this.waiting = false; // a frame is requested
        this.panel = new Panel(this);
        dark.addEventListener("change", () => this.changed());
        $("message").querySelector("button").onclick = () => showMessage(null);
    }

    /** Runs f and shows its error as a message. */
    async attempt(f) {
        try {
            await f();
        } catch (error) {
            this.#showError(error);
        }
    }

    #showError(error) {
        const text = (error.message ?? String(error)).trim();
        showMessage(this.gl?.isContextLost() ? kLost : text[0].toUpperCase() + text.slice(1) + (/[.!?]$/.test(text) ? "" : "."));
    }

    async start() {
        followInput(canvas, this.camera, (x, y) => this.attempt(() => this.#pick(x, y)));
        canvas.addEventListener("webglcontextlost", (event) => {
            event.preventDefault();
            showMessage(kLost);
        });
        canvas.addEventListener("webglcontextrestored", () => location.reload());
        new ResizeObserver(() => this.changed()).observe(canvas);
        await this.attempt(async () => {
            this.data = readPageData();
            const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, depth: true,
                                                     powerPreference: "high-performance" });
            if (!gl || (this.data?.scene && !gl.getExtension("EXT_color_buffer_float"))) {
                throw new Error(`this browser does not support WebGL2${gl ? " with EXT_color_buffer_float" : ""}: ` +
                                "enable hardware acceleration, or try another browser");
            }
            this.gl = gl;
            await this.#begin();
        });
        this.ready = true;
    }

    async #begin() {
        $("title").hidden = $("panel").hidden = this.data === null;
        $("empty").hidden = this.data !== null;
        if (!this.data) {
            return;
        }
        const { gl, look } = this;
        const { collider, mesh, scene, files, file } = this.data;
        if (scene) {
            await reliefParticles.init({ wasmBinary: await readWasm() });
        }
        this.view = new View(gl);
        this.particles = new Particles(gl);
        this.body = this.view.body =
            new Body(gl, scene ? await reliefParticles.load(files[file]) : new PageCollider(collider));
        this.view.bodies = [this.body];
        look.box = this.body.box;
        if (mesh) {
            this.view.mesh = new Geometry(gl, mesh.vertices, mesh.triangles);
        }
        this.panel.refresh();
        this.camera.frame(look.box, this.panel.room());
        document.title = `${this.data.name} · Relief`;
        if (scene) {
            await this.#playScene();
        } else {
            this.ground = look.box.min[1];
            this.setFloor(true);
        }
    }

    /** Starts the scene and places its bodies. The first body with the page's own collider is shown in the panel. */
    async #playScene() {
        const { data, gl, view } = this;
        this.particles.start({ scene: data.scene, files: data.files });
        const { system } = this.particles;
        const { camera, ground, bounds, bodies } = system.info;
        const known = new Map([[data.file, this.body]]);
        const placed = [];
        for (const [i, { file, deforms, matrix }] of bodies.entries()) {
            if (deforms) {
                placed.push(new LiveBody(gl, view.programs.live, () => system.mesh(i)));
            } else {
                const body = known.get(file) ?? new Body(gl, await reliefParticles.load(data.files[file]));
                known.set(file, body);
                // Further instances have their own pose, and share everything else.
                placed.push(body === this.body && !placed.includes(body) ? body : Object.create(body));
            }
            placed[i].place(matrix);
        }
        view.bodies = placed;
        this.bodies = new Bodies(gl, placed, bodies, data);
        this.look.color = (i) => this.bodies.color(i);
        this.flight.on = true;
        this.worldPanel = new WorldPanel(this);
        this.ground = ground;
        this.look.box = boxOf(bounds);
        this.setFloor(true);
        if (system.info.meshes) {
            view.picture = (options) => system.drawMeshes(options);
            this.panel.offerPicture();
        }
        this.camera.box = this.look.box;
        this.camera.taken = false;
        this.#follow(camera);
        this.panel.show(data.check ? "errors" : "particles");
    }

    /** Picks the body of a scene under the pointer. x, y: fractions of the picture, from the lower left. */
    #pick(x, y) {
        if (this.bodies && this.view.kept) {
            const { width, height } = canvas;
            this.worldPanel.pick(this.bodies.at(this.view.kept, this.camera.matrices(width, height), x, y));
        }
    }

    /** Follows the camera of the scene until the user takes over. */
    #follow({ eye, target, fov }) {
        const now = `${eye} ${target} ${fov}`;
        if (!this.camera.taken && now !== this.followed) {
            this.camera.look(eye, target, fov * Math.PI / 180);
            this.camera.taken = false;
            this.followed = now;
        }
    }

    /** Restarts the scene, which controls the camera again. */
    restart() {
        this.particles.restart();
        this.camera.taken = false;
        this.followed = null;
        this.changed(false);
    }

    setFloor(wanted) {
        this.look.floor = wanted ? this.ground : null;
        this.changed();
    }

    /** Requests a frame. bodies: whether the bodies must be redrawn. */
    changed(bodies = true) {
        this.lastChange = performance.now();
        if (this.view && bodies) {
            this.view.dirty = true;
        }
        this.#wait();
    }

    #wait() {
        if (!this.waiting) {
            this.waiting = true;
            requestAnimationFrame((now) => this.#frame(now));
        }
    }

    #frame(now) {
        this.waiting = false;
        if (!this.body || this.gl.isContextLost()) {
            return;
        }
        try {
            this.#drawFrame(now);
        } catch (error) {
            this.particles.paused = true;
            if (this.look.show === "picture") {
                this.panel.setShow("surface"); // needs no mesh
            }
            this.#showError(error);
        }
    }

    /** sharp: at full resolution, even while something moves. */
    #drawFrame(now, sharp = false) {
        const still = now - this.lastChange > 180;
        const playing = this.particles.system && !this.particles.paused;
        const moving = playing || !still;
        this.quality.frame(now, moving);
        const fraction = moving && !sharp ? this.quality.pixels : 1;
        const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((side) =>
            Math.max(1, Math.round(side * fraction * Math.min(devicePixelRatio || 1, 2.5))));
        if (canvas.width !== width || canvas.height !== height) {
            Object.assign(canvas, { width, height });
            this.view.dirty = true;
        }
        this.camera.shift = this.panel.shift();
        this.flight.advance(Math.min((now - this.lastFrame) / 1000, 0.1));
        this.particles.advance(Math.min((now - this.lastFrame) / 1000, 0.1));
        this.lastFrame = now;
        if (this.bodies && this.particles.steps !== this.movedAt) {
            this.movedAt = this.particles.steps; // the system stepped or restarted
            const { bodies, camera } = this.particles.system.info;
            bodies.forEach(({ moves, deforms, matrix }, i) => {
                if (moves || deforms) {
                    this.view.bodies[i].place(matrix);
                    this.view.dirty = true;
                }
            });
            this.#follow(camera);
            this.view.dirty ||= this.look.show === "picture"; // the weather changed
        }
        const matrices = this.camera.matrices(width, height);
        this.view.drawBodies(matrices, width, height, { ...this.look, theme: dark.matches ? "dark" : "light" },
                             still && fraction === 1 && !(playing && this.look.show === "picture"));
        this.view.copyBodies(width, height);
        this.particles.draw(matrices, width, height);
        this.#placePin(matrices.camera);
        this.panel.tick(now, fraction);
        if (moving || fraction < 1) {
            this.#wait();
        }
    }

    #placePin(camera) {
        const [x, y, , w] = this.pin ? transform(camera, this.pin) : [0, 0, 0, -1];
        $("pin").hidden = w <= 0;
        $("pin").style.translate = `${50 + 50 * x / w}vw ${50 - 50 * y / w}vh`;
    }

    /** Returns the colours of all pixels, from the bottom left; for tests. */
    pixelsNow() {
        this.#drawFrame(performance.now(), true);
        const { gl } = this;
        const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
        const data = new Uint8Array(4 * width * height);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
        return { width, height, data, error: gl.getError() };
    }
}

const app = new App();
window.reliefView = app;
await app.start();
