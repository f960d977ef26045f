// The page of `relief view`: what is open, and the loop that draws it.
import { init, load, readMesh } from "relief-particles";
import { Body, LiveBody } from "./body.js";
import { Camera, followPointers } from "./camera.js";
import { $, say } from "./controls.js";
import { Geometry } from "./gl.js";
import { boundsOf, boxOf, identity, shortNumber } from "./math.js";
import { measure } from "./errors.js";
import { followDrops, readPageData, readWasm } from "./page_data.js";
import { Panel } from "./panel.js";
import { Particles } from "./particles.js";
import { Quality } from "./quality.js";
import { View } from "./view.js";

const canvas = $("canvas");
const kSentences = {
    lost: "The GPU was reset, and what was on it is lost; the page begins anew when the browser gives it back.",
    webgl: "This browser gives no WebGL2, which the page draws with: turn on hardware acceleration, or try another browser.",
    floats: "This browser's WebGL2 does not render to float textures (EXT_color_buffer_float), which the page needs: " +
        "try another browser, or newer drivers.",
    memory: "There is too little memory for this: open a smaller collider, or ask for fewer particles.",
};

const kOpens = ".relief, .toml, .obj and .ply files";
const kOtherMesh = /\.(3ds|3mf|b3d|blend|dae|fbx|glb|gltf|lwo|lxo|ms3d|off|smd|stl|x)$/i;

function unknownFile(name) {
    return `"${name}": this page opens ${kOpens}` +
        (kOtherMesh.test(name) ? `; bake it with 'relief bake ${name} -o ${name.replace(/\.\w+$/, "")}.relief', and drop that here` : "");
}

const calm = matchMedia("(prefers-reduced-motion: reduce)");
const dark = matchMedia("(prefers-color-scheme: dark)");

const sentenceOf = (error) => {
    const text = error instanceof RangeError && /alloc|memory|length/i.test(error.message) ? kSentences.memory
        : (error.message ?? String(error)).trim();
    return text[0].toUpperCase() + text.slice(1) + (/[.!?]$/.test(text) ? "" : ".");
};

class App {
    constructor() {
        this.look = { show: "surface", split: 0.5, map: -1, heat: 0, depth: 0, slice: null, floor: null, box: null };
        this.floorWanted = true;
        this.opened = null; // { name, file (the name of its bytes), bytes, mesh, check, scene, files }
        this.camera = new Camera(() => this.changed());
        this.quality = new Quality();
        this.lastChange = 0;
        this.lastFrame = 0;
        this.asked = false;
        this.panel = new Panel(this);
        dark.addEventListener("change", () => this.changed());
    }

    /** Runs f; a failure is said on the page, which goes on. */
    async attempt(f) {
        try {
            return await f();
        } catch (error) {
            if (this.gl?.isContextLost()) {
                say(kSentences.lost);
            } else {
                say(sentenceOf(error));
            }
            return undefined;
        }
    }

    start() {
        followPointers(canvas, this.camera);
        followDrops((files) => this.attempt(() => this.openFiles(files)), (over) => ($("hover").hidden = !over));
        canvas.addEventListener("webglcontextlost", (event) => {
            event.preventDefault();
            this.#close(); // what is lost must not be given back to the context that comes after it
            say(kSentences.lost);
        });
        canvas.addEventListener("webglcontextrestored", () => this.attempt(() => this.begin()));
        new ResizeObserver(() => this.changed()).observe(canvas);
        return this.attempt(async () => {
            const data = readPageData();
            const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, depth: true,
                                                     powerPreference: "high-performance" });
            if (!gl) {
                throw new Error(kSentences.webgl);
            }
            if (!gl.getExtension("EXT_color_buffer_float")) {
                throw new Error(kSentences.floats);
            }
            this.gl = gl;
            await init({ wasmBinary: await readWasm() });
            this.opened = data && { name: data.name, file: data.shows ?? data.name, bytes: data.collider, mesh: data.mesh,
                                    check: data.check, scene: data.scene, files: data.files };
            this.#follow(data?.serve);
            await this.begin();
            if (data?.scene) {
                this.panel.show("particles");
            }
        }).finally(() => {
            $("drop").hidden = this.opened !== null;
            this.ready = true;
        });
    }

    #follow(events) {
        if (events) {
            new EventSource(events).addEventListener("message", () => location.reload());
        }
    }

    #close() {
        this.gl.useProgram(null); // none that is deleted stays the current one
        this.view?.bodies.forEach((body) => body.dispose());
        this.particles?.stop();
        this.view?.dispose();
        this.view = null;
        this.body = null;
    }

    /** Everything on the GPU anew, of what is open. */
    async begin() {
        this.#close();
        say(null);
        this.view = new View(this.gl);
        this.particles = new Particles(this.gl);
        this.mesh = null;
        this.placed = null;
        Object.assign(this.look, { map: -1, heat: 0, slice: null, floor: null, show: "surface" });
        this.measured = null;
        $("title").hidden = $("panel").hidden = this.opened === null;
        $("drop").hidden = this.opened !== null;
        if (this.opened) {
            await this.#show(this.opened);
        }
        this.panel.refresh();
        this.changed();
    }

    async #show({ name, file, bytes, mesh, check, scene, files }) {
        let bounds = mesh && boundsOf(mesh.vertices);
        if (bytes) {
            const collider = await load(bytes);
            this.body = this.view.body = new Body(this.gl, collider, file);
            this.view.bodies = [this.body];
            bounds = collider.bounds;
        }
        this.look.box = boxOf(bounds);
        this.setFloor(this.floorWanted);
        this.camera.frame(this.look.box, this.panel.room());
        if (mesh) {
            this.view.mesh = new Geometry(this.gl, mesh.vertices, mesh.triangles);
            this.look.show = this.body ? "split" : "mesh";
            this.mesh = mesh;
        }
        document.title = `${name} · Relief`;
        if (scene) {
            this.playScene(scene, { ...files, ...(this.body ? { [file]: bytes } : {}) });
        }
        if (this.mesh && this.body) {
            this.measured = measure(this.body.collider, this.mesh);
            this.measured.check = check ?? null;
        }
        if (this.body && !scene && !calm.matches) {
            this.startPreset("snow");
        }
    }

    async openFiles(list) {
        const files = {};
        for (const file of list) {
            files[file.name] = new Uint8Array(await file.arrayBuffer());
        }
        const named = (pattern) => Object.keys(files).find((name) => pattern.test(name));
        const scene = named(/\.toml$/i);
        const mesh = named(/\.(obj|ply)$/i);
        let collider = named(/\.relief$/i);
        if (!scene && !mesh && !collider) {
            throw new Error(list.length ? unknownFile(list[0].name) : `no file was dropped; this page opens ${kOpens}`);
        }
        const before = this.opened;
        const next = collider ? { name: collider, file: collider, bytes: files[collider], mesh: null, check: null }
            : { ...(before ?? { name: mesh ?? scene, bytes: null, mesh: null }), check: null };
        if (collider) {
            (await load(files[collider])).dispose(); // what is open stays where this one is damaged
        }
        if (scene && !next.bytes) {
            throw new Error(`${scene} needs its collider: drop the .relief that it names together with it`);
        }
        if (mesh) {
            next.mesh = { name: mesh, ...readMesh(mesh, files[mesh]) };
        }
        if (scene && !collider && before) {
            this.playScene(new TextDecoder().decode(files[scene]), { [before.file]: before.bytes, ...before.files, ...files });
            this.panel.show("particles");
            return;
        }
        this.opened = { ...next, scene: scene ? new TextDecoder().decode(files[scene]) : null, files };
        await this.begin();
        if (mesh && !next.bytes) {
            say(`${mesh} is a mesh alone. Bake it with 'relief bake ${mesh} -o ${mesh.replace(/\.\w+$/, "")}.relief', and drop ` +
                "the .relief here too.");
        } else if (mesh) {
            this.panel.show("errors");
        } else if (scene) {
            this.panel.show("particles");
        }
    }

    playScene(text, files) {
        this.particles.startScene(text, files);
        this.#placeBodies(files).catch((error) => say(sentenceOf(error)));
        const { camera, ground } = this.particles.info;
        this.camera.look(camera.eye, camera.target, camera.fov * Math.PI / 180);
        this.look.floor = this.floorWanted ? ground : null;
        this.panel.refresh();
        this.changed();
    }

    /** The scene's bodies, each where it stands; the first of the page's own file stays the one that is asked. */
    async #placeBodies(files) {
        const { system } = this.particles;
        const { bodies, bounds } = this.particles.info;
        const placed = [];
        for (const [i, { file, deforms, matrix }] of bodies.entries()) {
            const own = this.body && file === this.opened.file && !placed.includes(this.body);
            placed.push(deforms ? new LiveBody(this.gl, this.view.programs.live, () => system.mesh(i))
                : own ? this.body : new Body(this.gl, await load(files[file]), file));
            placed[i].place(matrix);
        }
        this.#unplaceBodies();
        this.placed = placed;
        this.view.bodies = placed;
        this.look.box = boxOf(bounds);
        this.changed();
    }

    /** Where moving bodies are by now. */
    #moveBodies() {
        this.particles.system?.info.bodies.forEach(({ moves, deforms, matrix }, i) => {
            if (this.placed && (moves || deforms)) {
                this.placed[i].place(matrix);
                this.view.dirty = true;
            }
        });
    }

    /** The body alone again. */
    #unplaceBodies() {
        this.view.bodies.filter((one) => one !== this.body).forEach((one) => one.dispose());
        this.view.bodies = this.body ? [this.body] : [];
        this.placed = null;
    }

    startPreset(preset) {
        if (this.placed) {
            this.#unplaceBodies();
            this.body?.place(identity());
            this.look.box = this.body?.box ?? this.look.box;
            this.setFloor(this.floorWanted);
        }
        if (preset === "none") {
            this.particles.stop();
        } else {
            this.particles.startPreset(preset, this.body);
        }
        this.panel.refreshParticles();
        this.changed(false);
    }

    setFloor(wanted) {
        this.floorWanted = wanted;
        const ground = this.particles?.preset === "scene" ? this.particles.info.ground : this.look.box?.min[1];
        this.look.floor = wanted ? ground ?? null : null;
        this.changed();
    }

    /** The bodies are drawn again; without `bodies` only what is before them. */
    changed(bodies = true) {
        this.lastChange = performance.now();
        if (this.view && bodies) {
            this.view.dirty = true;
        }
        if (!this.asked) {
            this.asked = true;
            requestAnimationFrame((now) => this.#frame(now));
        }
    }

    get playing() {
        return Boolean(this.particles.system) && !this.particles.paused;
    }

    #frame(now) {
        this.asked = false;
        if (!this.gl || !this.view || this.gl.isContextLost()) {
            return;
        }
        try {
            this.#drawFrame(now);
        } catch (error) {
            this.particles.paused = true;
            say(this.gl.isContextLost() ? kSentences.lost : sentenceOf(error));
        }
    }

    /** sharp: with all pixels, whatever moves. */
    #drawFrame(now, sharp = false) {
        const still = now - this.lastChange > 180;
        const moving = this.playing || !still;
        this.quality.frame(now, moving);
        const share = moving && !sharp ? this.quality.pixels : 1;
        const pixels = share * Math.min(devicePixelRatio || 1, 2.5);
        const width = Math.max(1, Math.round(canvas.clientWidth * pixels));
        const height = Math.max(1, Math.round(canvas.clientHeight * pixels));
        if (canvas.width !== width || canvas.height !== height) {
            canvas.width = width;
            canvas.height = height;
            this.view.dirty = true;
        }
        this.panel.tellQuality(share);
        this.camera.shift = this.panel.shift();
        this.particles.advance(Math.min((now - this.lastFrame) / 1000, 0.1));
        this.lastFrame = now;
        if (this.particles.steps !== this.movedAt && this.particles.preset === "scene") {
            this.movedAt = this.particles.steps; // by the clock, by hand, or back to the beginning
            this.#moveBodies();
        }
        const matrices = this.camera.matrices(width, height);
        this.view.drawBodies(matrices, width, height, { ...this.look, theme: dark.matches ? "dark" : "light" }, still && share === 1);
        this.view.copyBodies(width, height);
        this.particles.draw(matrices, width, height);
        this.view.drawLines(matrices.camera, width, height);
        this.panel.tick(now);
        if (moving || share < 1) {
            this.asked = true;
            requestAnimationFrame((next) => this.#frame(next));
        }
    }

    /** Colours of the pixel there, for tests: canvas pixels from the bottom left. */
    pixelsNow() {
        this.#drawFrame(performance.now(), true);
        const { gl } = this;
        const all = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
        gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, all);
        return { width: gl.drawingBufferWidth, height: gl.drawingBufferHeight, data: all, error: gl.getError() };
    }

    get facts() {
        if (!this.body) {
            return this.mesh ? `${(this.mesh.triangles.length / 3).toLocaleString("en")} triangles, no collider` : "";
        }
        const { info } = this.body.collider;
        const maps = info.maps.length === 1 ? "1 map" : `${info.maps.length} maps`;
        const size = this.opened.bytes.length;
        const bytes = size >= 1e6 ? `${(size / 1e6).toFixed(2)} MB` : `${Math.round(size / 1e3)} kB`;
        const of = info.mesh.triangles ? ` of ${info.mesh.triangles.toLocaleString("en")} triangles` : "";
        return `${maps}, ${bytes}${of}, ${shortNumber(this.look.box.longest)}${info.unit ? ` ${info.unit}` : ""} long`;
    }
}

const app = new App();
window.reliefView = app;
app.start();
