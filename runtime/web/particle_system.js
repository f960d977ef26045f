// SPDX-License-Identifier: Apache-2.0
// Particle systems: create one from a scene, step it, draw it, and read it back.
import { checkFinite, matrix, numbers, pixels } from "./arguments.js";
import { collider } from "./collider.js";
import { free, use, useUnlessLost } from "./context.js";
import { Fetches, ReliefError, check } from "./fetch.js";
import { call, callChecked, callForHandle, textAt, wasm } from "./wasm.js";
import { World, makeFolder, removeFolder, writeIn } from "./world.js";

const isTable = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

/** Converts a scene to JSON. Non-finite numbers become strings, which the reader rejects with their key. */
const jsonOf = (scene) => JSON.stringify(scene, (key, value) => {
    check(typeof value !== "function" && typeof value !== "symbol",
          `a scene can contain numbers, strings, booleans, lists and tables, but no ${typeof value}`);
    return ArrayBuffer.isView(value) ? [...value] : typeof value === "number" && !Number.isFinite(value) ? String(value) : value;
});

function merged(scene, patch) {
    const result = { ...scene };
    for (const [key, value] of Object.entries(patch)) {
        result[key] = isTable(value) && isTable(scene[key]) ? merged(scene[key], value) : value;
    }
    return result;
}

export class ParticleSystem {
    #gl;
    #losses;
    #folder;
    #handle = 0;
    #scene;
    #shaded;
    #onWarning;
    #onHits; // callback, or undefined
    #minHitSpeed;
    #fetches = null; // for a streamed world
    #pointsOfInterest = null; // 4 numbers per point

    constructor(gl, options = {}) {
        const wrong = Object.keys(options).find((key) => !["collider", "files", "minHitSpeed", "onHits", "onWarning", "scene", "shaded", "world"].includes(key));
        check(wrong === undefined,
              `ParticleSystem has no option '${wrong}'; it has collider, files, minHitSpeed, onHits, onWarning, scene, shaded and world`);
        if (options.collider) {
            collider("the option 'collider'", options.collider);
        }
        if (options.world) {
            check(options.world instanceof World,
                  "the option 'world' needs a World from loadWorld() or streamWorld(); did you forget to await it?");
            check(!options.collider,
                  "use either 'world' or 'collider'; to add colliders, name them in the scene and pass 'files'");
            options.world.handle; // throws if disposed
        }
        check(options.onWarning === undefined || typeof options.onWarning === "function",
              "the option 'onWarning' must be a function that takes a line");
        check(options.onHits === undefined || typeof options.onHits === "function",
              "the option 'onHits' must be a function that takes StepHits");
        const { minHitSpeed = 0 } = options;
        check(Number.isFinite(minHitSpeed) && minHitSpeed >= 0,
              "the option 'minHitSpeed' must be a speed, 0 or more");
        use(gl);
        this.#gl = gl;
        this.#shaded = options.shaded ?? true;
        this.#onWarning = options.onWarning ?? ((line) => console.warn(line));
        this.#onHits = options.onHits;
        this.#minHitSpeed = minHitSpeed;
        this.#fetches = options.world?.stream ? new Fetches(options.world.stream.load) : null;
        this.#folder = makeFolder();
        const files = { ...options.files };
        let scene = options.scene ?? {};
        if (typeof scene !== "string") {
            if (options.collider) {
                files["collider.relief"] = options.collider;
                scene = merged({ collider: { file: "collider.relief" } }, scene);
            } else if (options.world) {
                scene = { world: "world/world.json", ...scene };
                if (this.#fetches) {
                    const { radius, memory } = options.world.stream;
                    scene.stream = { radius, memory, ...scene.stream };
                } else if (scene.stream) { // a world from loadWorld() lacks coarse containers
                    const { colliders, files: given } = options.world;
                    const missing = colliders.find(({ coarse }) => coarse && !(coarse.file in given));
                    check(!missing,
                          `the scene has 'stream', but its world lacks '${missing?.coarse.file}'; ` +
                          "remove 'stream', or use streamWorld()");
                }
            } else if (!scene.collider && !scene.world) {
                throw new ReliefError("a ParticleSystem needs the option 'collider' or 'world', or a scene that names its colliders");
            }
        } else if (options.collider) {
            throw new ReliefError("a scene given as text excludes the option 'collider'; name the collider in the scene and pass it in 'files'");
        }
        for (const [name, content] of Object.entries(options.world?.files ?? {})) {
            files[`world/${name}`] = content;
        }
        this.#scene = scene;
        try {
            for (const [name, content] of Object.entries(files)) {
                writeIn(this.#folder, name, content);
            }
            this.#create();
        } catch (error) {
            this.dispose();
            throw error;
        }
    }

    /** Returns the text of the scene and its name in messages. */
    #text() {
        return typeof this.#scene === "string" ? [this.#scene, `${this.#folder}/scene.toml`]
            : [jsonOf(this.#scene), `${this.#folder}/scene`];
    }

    #create() {
        this.#losses = use(this.#gl);
        this.#handle = callForHandle("relief_player_create", ...this.#text(), this.#shaded ? 1 : 0, this.#fetches ? 1 : 0);
        if (this.#pointsOfInterest) {
            callChecked("relief_player_near", this.#handle, this.#pointsOfInterest, this.#pointsOfInterest.length / 4);
        }
        if (this.#onHits) {
            callChecked("relief_player_list_hits", this.#handle, this.#minHitSpeed);
        }
    }

    get handle() {
        check(this.#handle,
              this.#folder === null ? "this system has been disposed of" : "this system failed to restart");
        return this.#handle;
    }

    #ready() {
        this.handle;
        useUnlessLost(this.#gl, this.#losses, "restart() the system");
    }

    restart() {
        check(this.#folder !== null, "this system has been disposed of");
        use(this.#gl);
        this.#free();
        this.#create();
    }

    set(patch) {
        check(typeof this.#scene !== "string",
              "set() cannot change a scene given as text; create a new system");
        check(isTable(patch), "set() takes a part of a scene: an object with the keys of scene.toml");
        this.#ready();
        const before = this.#scene;
        this.#scene = merged(before, patch);
        if (Array.isArray(before.collider) && patch.collider?.length === before.collider.length) {
            this.#scene.collider = before.collider.map((one, i) => merged(one, patch.collider[i] ?? {}));
        }
        const emitters = JSON.stringify(this.#scene.emitter) !== JSON.stringify(before.emitter);
        try {
            callChecked("relief_player_change", this.handle, ...this.#text(), emitters ? 1 : 0);
        } catch (error) {
            this.#scene = before;
            throw error;
        }
    }

    step(dt) {
        this.#ready();
        const seconds = dt ?? this.info.dt;
        const given = typeof seconds === "number" ? seconds : JSON.stringify(seconds);
        check(typeof seconds === "number" && seconds >= 0 && seconds <= 1,
              `step(${given}): a step must be 0 to 1 seconds; limit it by Math.min(seconds, 1 / 30)`);
        if (seconds > 0) {
            const warnings = callChecked("relief_player_step", this.handle, seconds);
            this.#fetch();
            this.#passHits();
            if (warnings > 0) {
                this.#passWarnings();
            }
        }
    }

    /** Passes new hits to the callback, which may dispose of the system. */
    #passHits() {
        const head = new Float64Array(4);
        while (this.#handle && this.#onHits && call("relief_player_next_hits", this.#handle, head)) {
            const [step, time, dropped, count] = head;
            const rows = new Float32Array(16 * count);
            call("relief_player_hits", this.#handle, rows);
            this.#onHits({ step, time, dropped, rows });
        }
    }

    /** Passes warnings about colliders that failed to load to the callback. */
    #passWarnings() {
        for (const line of JSON.parse(textAt(call("relief_player_warnings", this.#handle)))) {
            this.#onWarning(line);
        }
    }

    /** Starts the fetches that the runtime requests. */
    #fetch() {
        for (let next; this.#fetches && (next = JSON.parse(textAt(call("relief_player_next", this.#handle))));) {
            const { collider, file } = next;
            this.#fetches.start(file, (bytes, reason) => this.#receive(collider, file, bytes, reason));
        }
    }

    #receive(collider, file, bytes, reason) {
        try {
            let fault = reason;
            try {
                if (bytes) {
                    callChecked("relief_player_give", this.#handle, collider, bytes, bytes.length);
                }
            } catch (error) { // out of memory
                fault = `${file}: ${error.message}`;
            }
            if (fault !== null) {
                callChecked("relief_player_refuse", this.#handle, collider, fault);
            }
        } catch {
            // The instance has ended; the next step reports it.
        }
    }

    setPointsOfInterest(points) {
        const places = Array.isArray(points) ? points : [];
        const wrong = places.findIndex((one) => one?.position?.length !== 3 || !(one.radius > 0));
        check(Array.isArray(points) && wrong < 0,
              "setPointsOfInterest() takes a list of { position: [x, y, z], radius } with a radius above 0" +
              (wrong >= 0 ? `; item ${wrong} is invalid` : ""));
        this.#ready();
        const list = checkFinite("setPointsOfInterest()", Float32Array.from(places.flatMap(({ position, radius }) => [...position, radius])));
        callChecked("relief_player_near", this.handle, list, list.length / 4);
        this.#pointsOfInterest = list;
    }

    async loaded() {
        while (true) {
            this.#ready();
            const underWay = callChecked("relief_player_load", this.handle);
            this.#fetch();
            this.#passWarnings();
            if (underWay === 0) {
                return;
            }
            await this.#fetches.next();
        }
    }

    spawn(births) {
        this.#ready();
        const rows = Array.isArray(births) && births.every((one) => one !== null && typeof one === "object")
            ? births.flatMap(({ position, velocity = [0, 0, 0], lifetime = 1, type = 0 }, i) => {
                if (position?.length !== 3 || velocity?.length !== 3) {
                    throw new ReliefError(`birth ${i} needs a position of three numbers; a velocity must have three, too`);
                }
                return [...position, ...velocity, lifetime, type];
            })
            : births;
        const list = checkFinite("births", numbers("births", rows, 8));
        return callChecked("relief_player_spawn", this.handle, list, list.length / 8);
    }

    draw(options) {
        this.#draw(0, options);
    }

    drawMeshes(options) {
        this.#draw(1, options);
    }

    /** meshes: 0 or 1. */
    #draw(meshes, { view, projection, framebuffer, width, height, srgb = true } = {}) {
        this.#ready();
        const gl = this.#gl;
        const matrices = Float32Array.of(...matrix("view", view), ...matrix("projection", projection));
        const target = framebuffer === undefined ? gl.getParameter(gl.DRAW_FRAMEBUFFER_BINDING) : framebuffer;
        const [wide, high] = target
            ? gl.getParameter(gl.VIEWPORT).slice(2)
            : [gl.drawingBufferWidth, gl.drawingBufferHeight];
        const size = [pixels("width", width ?? wide), pixels("height", height ?? high)];
        if (size.includes(0)) {
            return; // hidden page
        }
        let name = 0;
        if (target) {
            name = wasm.GL.getNewId(wasm.GL.framebuffers);
            wasm.GL.framebuffers[name] = target;
        }
        try {
            callChecked("relief_player_draw", this.handle, meshes, matrices, name, ...size, srgb ? 1 : 0);
        } finally {
            if (name) {
                wasm.GL.framebuffers[name] = null;
            }
        }
    }

    get info() {
        return JSON.parse(textAt(call("relief_player_info", this.handle)));
    }

    textures() {
        this.#ready();
        const named = (which) => wasm.GL.textures[call("relief_player_texture", this.handle, which)];
        return { position: named(0), velocity: named(1), birth: named(2) };
    }

    mesh(body) {
        this.#ready();
        const names = new Int32Array(5);
        if (!Number.isInteger(body) || body < 0 || !call("relief_player_mesh", this.handle, body, names)) {
            return null;
        }
        const [positions, corners, vertexShift, triangleShift, triangles] = names;
        return { positions: wasm.GL.textures[positions], corners: wasm.GL.textures[corners], vertexShift, triangleShift, triangles };
    }

    animation(body) {
        this.#ready();
        return Number.isInteger(body) && body >= 0 ? JSON.parse(textAt(call("relief_player_animation", this.handle, body))) : null;
    }

    pose(body, joints = [], weights = []) {
        this.#ready();
        check(Number.isInteger(body) && body >= 0 && joints.length % 16 === 0,
              "pose() needs the index of a body, and 16 numbers per joint");
        callChecked("relief_player_pose", this.handle, body, checkFinite("pose()", Float32Array.from(joints)), joints.length / 16,
                    checkFinite("pose()", Float32Array.from(weights)), weights.length);
    }

    read() {
        this.#ready();
        const rows = new Float32Array(12 * callChecked("relief_player_read", this.handle));
        call("relief_player_states", this.handle, rows);
        return rows;
    }

    #free() {
        const old = this.#handle;
        this.#handle = 0;
        this.#fetches?.stop();
        if (old) {
            free(this.#gl, this.#losses, "relief_player_free", old);
        }
    }

    dispose() {
        this.#free();
        if (this.#folder !== null) {
            removeFolder(this.#folder);
        }
        this.#folder = null;
    }
}
