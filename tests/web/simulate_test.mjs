// SPDX-License-Identifier: Apache-2.0
// 300 steps of snow on the bunny, in the browser and in relief-sim.
// Both spawn the same particles with the same draws. The shaders of two drivers differ in the last bits of some square
// roots, and a particle that slides along an edge may fall to either side. So most particles must match their native
// positions, and all must match in total: how many lie on the body, and how high.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { boxes } from "./lib/boxes.mjs";
import { libraryPage } from "./lib/library.mjs";
import { bunny, play, run, scratch } from "./lib/native.mjs";

const kScene = `[time]
steps = 300

[collider]
file = "bunny.relief"

[particles]
capacity = 20000
`;

async function compare(t, ...options) {
    const folder = scratch(t);
    run("relief", "bake", bunny, "-q", "-o", path.join(folder, "bunny.relief"), ...options);
    const native = play(folder, kScene);

    const { page, messages } = await libraryPage(t, folder);
    const [rows, info, error] = await page.evaluate(async (scene) => {
        const collider = await relief.load("/files/bunny.relief");
        const system = new relief.ParticleSystem(gl, { scene, files: { "bunny.relief": collider } });
        for (let i = 0; i < 300; ++i) {
            system.step();
        }
        return [[...system.read()], system.info, gl.getError()];
    }, kScene);
    assert.equal(error, 0, "a GL error");
    assert.deepEqual(messages, []);

    const web = new Map();
    for (let i = 0; i < rows.length; i += 12) {
        web.set(rows[i + 11], { place: rows.slice(i, i + 3), age: rows[i + 3], collisions: rows[i + 9] });
    }
    assert.ok([...web.values()].filter((one) => one.collisions > 0).length > 5_000, "most have hit the body");
    assert.equal(info.time.toFixed(3), "5.000");
    assert.ok(native.size > 10_000, `${native.size} particles`);
    assert.ok([...native.values()].filter((one) => one.age > 3).length > 5_000);
    assert.deepEqual([...web.keys()].sort((a, b) => a - b), [...native.keys()].sort((a, b) => a - b));
    const side = Math.max(...info.bounds.max.map((to, i) => to - info.bounds.min[i]));
    const away = [...native].map(([id, one]) => {
        const other = web.get(id);
        assert.ok(Math.abs(one.age - other.age) < 1e-4);
        return Math.hypot(...one.place.map((value, i) => value - other.place[i])) / side;
    });
    const beyond = (limit) => away.filter((distance) => distance > limit).length / away.length;
    const height = (all) => all.reduce((sum, one) => sum + one.place[1], 0) / all.length / side;
    const lower = height([...web.values()]) - height([...native.values()]);
    t.diagnostic(`${native.size} particles; largest distance ${Math.max(...away)} sides; ${100 * beyond(1e-4)} % above 1e-4, ` +
                 `${100 * beyond(1e-2)} % above 1e-2; mean heights differ by ${lower}`);
    assert.ok(beyond(1e-4) < 0.02 && beyond(1e-2) < 0.005 && Math.abs(lower) < 1e-4);
}

test("300 steps of snow agree with relief-sim", { timeout: 120_000 }, (t) => compare(t, "--budget", "200kB"));

test("300 steps of snow among patches agree with relief-sim", { timeout: 120_000 }, (t) => compare(t, "--map", "patches:budget=200kB"));

test("particles spawned by the page do not pass a floor thinner than a step", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    writeFileSync(path.join(folder, "floor.obj"), boxes([{ low: [-2, -0.1, -2], high: [2, 0, 2] }]));
    run("relief", "bake", path.join(folder, "floor.obj"), "-q", "-o", path.join(folder, "floor.relief"), "--budget", "20kB");
    const { page, messages } = await libraryPage(t, folder);
    const below = await page.evaluate(async () => {
        const collider = await relief.load("/files/floor.relief");
        return [{ sweep: 0 }, {}].map((collision) => {
            const system = new relief.ParticleSystem(gl, { collider, scene: {
                collision, particles: { capacity: 1000 }, time: { dt: 1 / 240 }, forces: { gravity: [0, 0, 0], drag: 0 }, ground: { enabled: false } } });
            system.spawn(Array.from({ length: 1000 }, (_, i) => ({ position: [0, 1 + i / 1000, 0], velocity: [0, -20, 0], lifetime: 9 })));
            for (let i = 0; i < 15; ++i) {
                system.step(1 / 30);
            }
            const count = system.read().filter((y, i) => i % 12 === 1 && y < -0.1).length;
            system.dispose();
            return count;
        });
    });
    assert.ok(below[0] > 500, `${below[0]} pass without a sweep`);
    assert.equal(below[1], 0);
    assert.equal(messages.length, 1, "a warning without a sweep");
});
