// SPDX-License-Identifier: Apache-2.0
// Materials and [[spawn]] in the browser: the same births on one material and the same deaths on another as in
// relief-sim. The hits read back by the page, from a WebGL2 without mapped buffers, match the list of relief-sim.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { libraryPage } from "./lib/library.mjs";
import { distances, play, run, scratch } from "./lib/native.mjs";

const kSteps = 120;
// A slab, one half oak, the other ice.
const kMesh = `v -1 0 -1\nv 0 0 -1\nv 1 0 -1\nv -1 0 1\nv 0 0 1\nv 1 0 1
v -1 0.2 -1\nv 0 0.2 -1\nv 1 0.2 -1\nv -1 0.2 1\nv 0 0.2 1\nv 1 0.2 1
usemtl oak\nf 1 2 5 4\nf 7 10 11 8\nf 1 4 10 7\nf 4 5 11 10\nf 2 1 7 8
usemtl ice\nf 2 3 6 5\nf 8 11 12 9\nf 3 9 12 6\nf 5 6 12 11\nf 3 2 8 9
`;
const kScene = `[time]
dt = 0.0078125
steps = ${kSteps}
[collider]
file = "slab.relief"
[[material]]
name = "ice"
lifetime_loss = 49.5
[particles]
capacity = 5000
[emitter]
box_min = [-0.9, 0.4, -0.9]
box_max = [0.9, 0.6, 0.9]
burst = 400
rate = 0.0
lifetime = 50.0
[forces]
gravity = [0.0, -9.8, 0.0]
drag = 0.0
[ground]
enabled = false
[[type]]
name = "drop"
on_collision = "stop"
[[type]]
name = "chip"
on_collision = "stop"
[[spawn]]
on = "collision"
parent = "drop"
material = "oak"
type = "chip"
count = 2
speed = [0.5, 1.0]
lifetime = 40
`;

test("hits have the same materials as in relief-sim", { timeout: 120_000 }, async (t) => {
    const folder = scratch(t);
    writeFileSync(path.join(folder, "slab.obj"), kMesh);
    run("relief", "bake", path.join(folder, "slab.obj"), "-q", "-o", path.join(folder, "slab.relief"), "--budget", "200kB");
    const particles = play(folder, kScene, "--events", path.join(folder, "hits.jsonl"));
    const hits = readFileSync(path.join(folder, "hits.jsonl"), "utf8").trim().split("\n").map((line) => JSON.parse(line));
    const drops = hits.filter((hit) => hit.type === 0);
    const oak = drops.filter((hit) => hit.material === "oak").length;
    assert.ok(oak > 100 && drops.length - oak > 100, `${oak} of ${drops.length}`);
    assert.ok(drops.every((hit) => Math.abs(hit.position[0]) < 0.01 || (hit.position[0] < 0) === (hit.material === "oak")));

    const { page, messages } = await libraryPage(t, folder);
    const [rows, info, reports, error] = await page.evaluate(async ([scene, steps]) => {
        const collider = await relief.load("/files/slab.relief");
        const reports = [];
        const system = new relief.ParticleSystem(gl, {
            scene,
            files: { "slab.relief": collider },
            onHits: ({ step, time, dropped, rows }) => reports.push({ step, time, dropped, rows: [...rows] }),
        });
        for (let i = 0; i < steps; ++i) {
            system.step();
        }
        return [[...system.read()], system.info, reports, gl.getError()];
    }, [kScene, kSteps]);
    assert.equal(error, 0, "a GL error");
    assert.deepEqual(messages, []);
    assert.equal(info.born, 400 + 2 * oak);
    // Drops on ice live for half a second, part of which they have spent falling: none remain at the end.
    assert.ok(particles.size < info.born - 100, `${particles.size} of ${info.born}`);
    const far = Math.max(...distances(rows, particles));
    assert.ok(far < 1e-3, `a particle is ${far} from its position in relief-sim`);

    assert.deepEqual(reports.map(({ step }) => step), Array.from({ length: kSteps - 2 }, (_, i) => i + 1));
    const received = reports.flatMap(({ step, time, dropped, rows: all }) => {
        assert.equal(dropped, 0);
        return Array.from({ length: all.length / 16 }, (_, i) => ({ step, end: time, row: all.slice(16 * i, 16 * i + 16) }));
    });
    const listed = hits.filter((hit) => hit.step <= kSteps - 2);
    assert.equal(received.length, listed.length);
    listed.forEach((hit, i) => {
        const { step, end, row } = received[i];
        assert.equal(step, hit.step);
        assert.equal(info.materials[row[12]], hit.material);
        assert.equal(row[13], hit.type);
        assert.equal(row[15], hit.id % 2 ** 24);
        const off = [...hit.position.map((x, k) => x - row[k]), end - row[3] - hit.time, hit.speed - row[7],
                     ...hit.velocity.map((x, k) => x - row[4 + k]), ...hit.normal.map((x, k) => x - row[8 + k])];
        assert.ok(Math.max(...off.map(Math.abs)) < 1e-3, `${off}`);
    });
});

test("the options onHits and minHitSpeed are validated", { timeout: 60_000 }, async (t) => {
    const folder = scratch(t);
    const { page } = await libraryPage(t, folder);
    const errors = await page.evaluate(() => errorsOf(() => new relief.ParticleSystem(gl, { onHits: 3 }),
                                                    () => new relief.ParticleSystem(gl, { onHits: () => {}, minHitSpeed: -1 })));
    assert.match(errors[0], /option 'onHits' must be a function/);
    assert.match(errors[1], /option 'minHitSpeed' must be a speed/);
});
