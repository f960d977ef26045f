// SPDX-License-Identifier: Apache-2.0
// A streamed world of tiles: which files are fetched and when, drops rest on the loaded ground, and the effect of
// missing or damaged files. The hills of tests/cli/heights.py have a closed form.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { cpSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { root, pageMessages } from "./lib/browser.mjs";
import { libraryPage } from "./lib/library.mjs";
import { run, scratch } from "./lib/native.mjs";
import { openFile } from "./lib/view.mjs";

const kRadius = 30;
const kSteps = 130; // until all lie on the ground
/** Drops that fall on an area of 40 m by 40 m. */
const emitterAt = (x, z) => ({
    box_min: [x, 62, z], box_max: [x + 40, 66, z + 40], burst: 500, rate: 0, lifetime: 100,
    velocity: [0, -30, 0], velocity_spread: [0, 0, 0],
});
const kScene = {
    time: { dt: 1 / 64 }, particles: { capacity: 1024 }, emitter: emitterAt(20, 20),
    forces: { gravity: [0, -9.81, 0], drag: 0 }, ground: { enabled: false },
};

/** The hills of heights.py, bilinear between samples, at 100 m for a sample of 65535. */
function ground(x, z) {
    const sample = (i, j) => Math.round(20000 + 9000 * Math.sin(i / 11) + 6000 * Math.cos(j / 7));
    const [i, j] = [Math.floor(x), Math.floor(z)];
    const [s, t] = [x - i, z - j];
    return ((1 - t) * ((1 - s) * sample(i, j) + s * sample(i + 1, j)) +
            t * ((1 - s) * sample(i, j + 1) + s * sample(i + 1, j + 1))) * 100 / 65535;
}

/** The greatest depth of a particle below the ground, and the number of particles. */
function below(rows) {
    let deepest = -Infinity;
    for (let i = 0; i < rows.length; i += 12) {
        deepest = Math.max(deepest, ground(rows[i], rows[i + 2]) - rows[i + 1]);
    }
    return { count: rows.length / 12, deepest };
}

/** Bakes a world of nine tiles, eight of them with a coarse container. @returns it as JSON */
function bakeTiles(folder) {
    execFileSync("python3", [path.join(root, "tests/cli/heights.py"), path.join(folder, "hills.r16"), "560"]);
    run("relief", "bake", path.join(folder, "hills.r16"), "--heights", "low=0,high=100,tile=256", "--world", path.join(folder, "w"), "-q");
    const world = JSON.parse(readFileSync(path.join(folder, "w/world.json"), "utf8"));
    assert.equal(world.colliders.length, 9);
    assert.equal(world.colliders.filter((one) => one.coarse).length, 8);
    assert.ok(world.bodies.every((one) => one.scale === 1 && one.rotation[3] === 1));
    return world;
}

/** Files of tiles that have a coarse container and whose boxes intersect a ball. */
function tilesIn(world, center, radius) {
    return world.bodies.flatMap((body) => {
        const { file, coarse, min, max } = world.colliders[body.collider];
        const off = [0, 1, 2].map((k) => {
            const at = center[k] - body.position[k];
            return at - Math.min(Math.max(at, min[k]), max[k]);
        });
        return coarse && Math.hypot(...off) <= radius ? [file] : [];
    }).sort();
}

/** Tiles near the drops of emitterAt(). */
const tilesAt = (world, x, z) => tilesIn(world, [x + 20, 64, z + 20], Math.hypot(20, 2, 20) + kRadius);

/** Collects the names of files that the page fetches from now on. */
function fetched(page) {
    const names = [];
    page.on("request", (request) => {
        const at = new URL(request.url()).pathname;
        if (at.startsWith("/files/")) {
            names.push(path.basename(at));
        }
    });
    return () => names.splice(0).sort();
}

test("tiles are fetched on demand, and drops rest on them", { timeout: 180_000 }, async (t) => {
    const folder = scratch(t);
    const world = bakeTiles(folder);
    const { page, messages } = await libraryPage(t, folder);
    const taken = fetched(page);
    await page.evaluate(async ({ scene, radius }) => {
        window.scene = scene;
        window.world = await relief.streamWorld("/files/w/world.json", { radius, memory: 64 });
        window.system = new relief.ParticleSystem(gl, { world, scene });
    }, { scene: kScene, radius: kRadius });
    assert.deepEqual(taken(), ["world.json", ...world.colliders.map((one) => (one.coarse ?? one).file)].sort());

    // Once nearby tiles are loaded, results are bit-identical to those of a system with all tiles.
    const near = await page.evaluate(async (steps) => {
        const before = { ...system.info.stream };
        await system.loaded();
        for (let i = 0; i < steps; ++i) {
            system.step();
        }
        return { before, after: system.info.stream, rows: [...system.read()] };
    }, kSteps);
    const first = tilesAt(world, 20, 20);
    assert.ok(first.length >= 1 && first.length < 8, first.join(" "));
    assert.deepEqual(taken(), first);
    assert.equal(near.before.loaded, 0);
    assert.deepEqual([near.after.requested, near.after.loaded, near.after.failed], [first.length, first.length, 0]);
    const whole = await page.evaluate(async (steps) => {
        const full = await relief.loadWorld("/files/w/world.json");
        const all = new relief.World({ ...world.files, ...full.files }); // has all files, including the coarse ones
        const systems = [new relief.ParticleSystem(gl, { world: full, scene }),
                         new relief.ParticleSystem(gl, { world: all, scene: { ...scene, stream: { radius: 30 } } }),
                         new relief.ParticleSystem(gl, { world: new relief.World(world.files, { radius: 30, load: () => new Promise(() => {}) }), scene })];
        for (let i = 0; i < steps; ++i) {
            systems.forEach((one) => one.step());
        }
        return { rows: systems.map((one) => [...one.read()]), stream: systems.map((one) => one.info.stream) };
    }, kSteps);
    assert.deepEqual(near.rows, whole.rows[0]);
    assert.deepEqual(near.rows, whole.rows[1]);
    assert.equal(whole.stream[0], null);
    assert.ok(whole.stream[1].loaded >= first.length && whole.stream[1].loaded === whole.stream[1].requested);
    assert.equal(whole.stream[2].loaded, 0);
    assert.equal(below(near.rows).count, 500);
    assert.ok(below(near.rows).deepest < 0.05, JSON.stringify(below(near.rows)));
    assert.ok(below(whole.rows[2]).deepest > 0.2, JSON.stringify(below(whole.rows[2]))); // the coarse ground differs
    taken();

    // The emitter moves: nothing blocks, and the tiles there arrive in time for its drops.
    const second = tilesAt(world, 440, 340);
    const fresh = second.filter((file) => !first.includes(file));
    assert.ok(fresh.length >= 1);
    const gone = await page.evaluate(async ({ steps, emitter }) => {
        system.set({ emitter });
        for (let i = 0; i < steps; ++i) {
            system.step();
            await new Promise((done) => setTimeout(done, 5));
        }
        return { stream: system.info.stream, rows: [...system.read()] };
    }, { steps: kSteps, emitter: emitterAt(440, 340) });
    assert.deepEqual(taken(), fresh);
    assert.deepEqual([gone.stream.requested, gone.stream.loaded, gone.stream.failed], [second.length, second.length, 0]);
    assert.equal(below(gone.rows).count, 1000);
    assert.ok(below(gone.rows).deepest < 0.05, JSON.stringify(below(gone.rows)));

    // So do positions set by the program, and the camera's position.
    const center = [20, 40, 500];
    const there = tilesIn(world, center, 10);
    const eye = [540, 40, 20];
    const seen = tilesIn(world, eye, kRadius);
    const known = [...first, ...second];
    assert.ok(there.some((file) => !known.includes(file)) && seen.some((file) => !known.includes(file) && !there.includes(file)));
    await page.evaluate(async (position) => {
        system.setPointsOfInterest([{ position, radius: 10 }]);
        await system.loaded();
    }, center);
    assert.deepEqual(taken(), there.filter((file) => !known.includes(file)));
    await page.evaluate(async ([x, y, z]) => {
        system.draw({ view: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -z, 1], projection: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.02, -1, 0, 0, -0.2, 0] });
        await system.loaded();
    }, eye);
    assert.deepEqual(taken(), seen.filter((file) => !known.includes(file) && !there.includes(file)));

    // Restarts, and disposal during downloads.
    const again = await page.evaluate(async () => {
        system.restart();
        const begun = system.info.stream.loaded;
        await system.loaded();
        const { requested, loaded } = system.info.stream;
        system.restart();
        system.step();
        const waits = system.loaded().catch((error) => error.message);
        system.dispose();
        const kept = world.query([100, 30, 100]).distance[0];
        world.dispose();
        return { begun, requested, loaded, end: await waits, kept, gl: gl.getError() };
    });
    assert.ok(again.begun === 0 && again.requested === again.loaded && again.loaded > 0, JSON.stringify(again));
    assert.match(again.end, /disposed of/);
    assert.ok(Math.abs(again.kept) < 60, String(again.kept));
    assert.equal(again.gl, 0);
    // Disposal aborts fetches, and a driver reports copies into textures that were never drawn.
    assert.deepEqual(pageMessages(messages).filter((line) => !/^failed: /.test(line)), []);
});

test("a missing or damaged tile is reported once, and its coarse tile stays", { timeout: 120_000 }, async (t) => {
    const folder = scratch(t);
    const world = bakeTiles(folder);
    const tiles = tilesIn(world, [256, 40, 256], 40); // around a corner of four
    assert.ok(tiles.length >= 3);
    const [gone, broken] = tiles;
    rmSync(path.join(folder, "w", gone));
    const bytes = readFileSync(path.join(folder, "w", broken));
    bytes[bytes.length >> 1] ^= 1;
    writeFileSync(path.join(folder, "w", broken), bytes);
    cpSync(path.join(folder, "w"), path.join(folder, "cut"), { recursive: true });
    rmSync(path.join(folder, "cut", world.colliders[0].coarse.file));
    const { page, messages } = await libraryPage(t, folder);
    const got = await page.evaluate(async ({ scene, steps }) => {
        const world = await relief.streamWorld("/files/w/world.json", { radius: 40 });
        const lines = [];
        const systems = [new relief.ParticleSystem(gl, { world, scene, onWarning: (line) => lines.push(line) }),
                         new relief.ParticleSystem(gl, { world, scene })];
        for (let i = 0; i < steps; ++i) {
            systems.forEach((one) => one.step());
            await new Promise((done) => setTimeout(done, 5));
        }
        const [info, rows] = [systems[0].info, [...systems[0].read()]];
        const full = new relief.ParticleSystem(gl, { world: new relief.World(world.files, { radius: 40, load: () => "no bytes" }), scene,
                                                     onWarning: (line) => lines.push(line) });
        await full.loaded();
        const plain = new relief.ParticleSystem(gl, { world: new relief.World(world.files, { radius: 1, load: () => {} }), scene });
        const cube = new relief.ParticleSystem(gl, { scene: { ...scene, collider: { file: "a.relief" } },
                                                     files: { "a.relief": Object.entries(world.files).find(([name]) => name.endsWith(".relief"))[1] } });
        const text = `world = "world/world.json"\n[particles]\ncapacity = 16\n`;
        const make = (more) => new relief.ParticleSystem(gl, { world, scene, ...more });
        return {
            lines, info: info.stream, rows,
            errors: await errorsOf(
                () => relief.streamWorld("/files/w/world.json"),
                () => relief.streamWorld("/files/w/world.json", { radius: 0 }),
                () => relief.streamWorld("/files/w/world.json", { radius: 1, memory: "64" }),
                () => relief.streamWorld("/files/w/world.json", { radius: 1, speed: 2 }),
                () => relief.streamWorld("/files/cut/world.json", { radius: 1 }),
                () => new relief.World(world.files, { radius: 1 }),
                () => new relief.World(world.files),
                () => make({ scene: { ...scene, stream: { memory: 0.01 } } }),
                () => make({ scene: text }),
                () => make({ onWarning: "loud" }),
                () => plain.setPointsOfInterest({ position: [0, 0, 0], radius: 1 }),
                () => plain.setPointsOfInterest([{ position: [0, 0, 0], radius: 1 }, { position: [0, 0, 0] }]),
                () => plain.setPointsOfInterest([{ position: [0, NaN, 0], radius: 1 }]),
                () => cube.setPointsOfInterest([]),
                () => plain.set({ stream: undefined }),
                () => plain.set({ stream: { memory: 3 } }),
                () => cube.set({ stream: { radius: 3 } }),
            ),
            allowed: await errorsOf(() => plain.set({ stream: { radius: 3 } }),
                                     () => make({ scene: `${text}[stream]\nradius = 2.0\n` })),
            gl: gl.getError(),
        };
    }, { scene: { ...kScene, emitter: emitterAt(236, 236) }, steps: kSteps });
    const count = tilesAt(world, 236, 236).length;
    const named = got.lines.slice(0, 2).sort((a, b) => a.includes(broken) - b.includes(broken));
    assert.match(named[0], new RegExp(`^http.*/files/w/${gone}: the server returned 404 .*; its coarse collider remains in use$`));
    assert.match(named[1], new RegExp(`${broken}.* does not match its hash.*; its coarse collider remains in use$`));
    assert.deepEqual([got.info.requested, got.info.loaded, got.info.failed], [count, count - 2, 2]);
    assert.equal(below(got.rows).count, 500);
    assert.ok(below(got.rows).deepest < 3, JSON.stringify(below(got.rows))); // tolerance of the coarse ground
    assert.equal(got.lines.slice(2).length, count);
    assert.ok(got.lines.slice(2).every((line) => /'load' returned no Uint8Array/.test(line)));
    const expected = [/streamWorld\(\) needs a radius above 0/, /needs a radius above 0/, /memory must be a number/, /no option 'speed'/, /404/, /needs 'load'/,
                      /No such file/, /resident colliders.*raise the limit/, /has no \[stream\]/, /'onWarning' must be a function/, /setPointsOfInterest\(\) takes a list/,
                      /item 1 is invalid/, /setPointsOfInterest\(\): number 1 is NaN/, /use streamWorld\(\)/, /only the radius of 'stream' can change/, /only the radius of 'stream' can change/,
                      /stream needs .world/];
    assert.equal(got.errors.length, expected.length);
    got.errors.forEach((message, i) => {
        assert.match(message, /^ReliefError: /);
        assert.match(message, expected[i], `error ${i}`);
    });
    assert.deepEqual(got.allowed, ["no error", "no error"]);
    assert.equal(got.gl, 0);
    // Without 'onWarning' the system logs the same warnings to the console, once each.
    const warned = messages.filter((line) => line.startsWith("warning: "));
    assert.equal(warned.length, 2, messages.join("\n"));
    assert.deepEqual(messages.filter((line) => !line.startsWith("warning: ") && !line.includes("404")), []);
});

test("a page plays a scene with [stream] from its own files", { timeout: 120_000 }, async (t) => {
    const folder = scratch(t);
    bakeTiles(folder);
    writeFileSync(path.join(folder, "s.toml"), `world = "w/world.json"
[stream]
radius = 30.0
[particles]
capacity = 256
[[emitter]]
box_min = [20.0, 62.0, 20.0]
box_max = [60.0, 66.0, 60.0]
velocity = [0.0, -30.0, 0.0]
rate = 100.0
`);
    run("relief-sim", path.join(folder, "s.toml"), "--page", path.join(folder, "s.html"));
    const { page, messages } = await openFile(t, path.join(folder, "s.html"));
    const stream = await page.evaluate(() => {
        reliefView.particles.paused = true;
        reliefView.particles.step();
        return reliefView.particles.system.info.stream;
    });
    assert.ok(stream.loaded > 0 && stream.loaded === stream.requested && stream.failed === 0, JSON.stringify(stream));
    assert.equal(await page.locator("#message p").textContent(), "");
    assert.deepEqual(pageMessages(messages), []);
});
