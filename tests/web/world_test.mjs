// SPDX-License-Identifier: Apache-2.0
// A world of the level from tests/cli/level.py in the browser: plays as in relief-sim, also while a body moves; CPU
// queries; and invalid worlds.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import path from "node:path";
import test from "node:test";

import { root } from "./lib/browser.mjs";
import { libraryPage } from "./lib/library.mjs";
import { distances, play, run, scratch, tomlOf } from "./lib/native.mjs";

const kSteps = 60;

test("a world plays as in relief-sim, and its bodies move", { timeout: 120_000 }, async (t) => {
    const folder = scratch(t);
    execFileSync("python3", [path.join(root, "tests/cli/level.py"), path.join(folder, "level.gltf")]);
    run("relief", "bake", path.join(folder, "level.gltf"), "--world", path.join(folder, "w"), "--budget", "200kB", "-q");
    const scene = {
        time: { dt: 0.015625, steps: kSteps }, particles: { capacity: 500 },
        emitter: { box_min: [4, 2.1, 4], box_max: [6, 2.6, 6], burst: 400, rate: 0, lifetime: 50, velocity: [0, -1, 0], velocity_spread: [0, 0, 0] },
        forces: { gravity: [0, -5, 0], drag: 0 }, ground: { enabled: false },
    };
    const keys = `[[collider]]
node = "second"
[[collider.key]]
time = 0.0
[[collider.key]]
time = ${kSteps / 64}
position = [5.0, 1.0, 5.0]
`;
    const playNatively = (more) => play(folder, `world = "w/world.json"\n${tomlOf(scene)}${more}`, "--shaders", "fragment");
    const native = { still: playNatively(""), moved: playNatively(keys) };
    const { page, messages } = await libraryPage(t, folder);
    const got = await page.evaluate(async ([scene, steps]) => {
        const world = await relief.loadWorld("/files/w/world.json");
        const still = new relief.ParticleSystem(gl, { world, scene });
        const moved = new relief.ParticleSystem(gl, { world, scene: { ...scene, collider: [{ node: "second" }] } });
        for (let i = 1; i <= steps; ++i) {
            still.step();
            moved.set({ collider: [{ position: [5, i / steps, 5] }] });
            moved.step();
        }
        const queried = world.query([5, 1.9, 5, 0, 30, 0]);
        const [body, ...others] = moved.info.bodies;
        const text = (change) => new TextEncoder().encode(JSON.stringify(change(JSON.parse(new TextDecoder().decode(world.files["world.json"])))));
        const changed = (change) => () => (new relief.World({ ...world.files, "world.json": text(change) }));
        return {
            still: [...still.read()], moved: [...moved.read()], bounds: world.bounds, nodes: world.bodies.map((one) => one.node),
            queried: { distance: [...queried.distance], normal: [...queried.normal], body: [...queried.body] },
            first: { node: body.node, file: body.file, y: body.matrix[13] }, others: others.map((one) => one.node),
            errors: await errorsOf(
                () => relief.loadWorld("/files/none/world.json"),
                () => relief.loadWorld("/files/level.gltf"),
                () => relief.loadWorld(new Response("{}")),
                changed((one) => ({ ...one, bodies: [{ ...one.bodies[0], collider: 9 }] })),
                changed((one) => ({ ...one, colliders: [{ ...one.colliders[0], hash: "0".repeat(32) }] , bodies: one.bodies.slice(0, 1) })),
                () => new relief.ParticleSystem(gl, { world: {}, scene }),
                () => new relief.ParticleSystem(gl, { world, scene: { ...scene, collider: [{ node: "window" }] } }),
                () => still.set({ collider: [{ node: "second", position: [0, 0, 0] }] }),
            ),
            gl: gl.getError(),
        };
    }, [scene, kSteps]);

    for (const name of ["still", "moved"]) {
        const off = distances(got[name], native[name]).filter((distance) => distance > 1e-3).length;
        assert.ok(off <= 4, `${name}: ${off} of 400 particles differ`);
    }
    assert.notDeepEqual(got.still, got.moved);
    assert.deepEqual(got.nodes, ["ground", "first", "second", "third", "wide"]);
    assert.deepEqual(got.first, { node: "second", file: got.first.file, y: 1 });
    assert.match(got.first.file, /world\/box-[0-9a-f]+\.relief$/);
    assert.deepEqual(got.others, ["ground", "first", "third", "wide"]);
    assert.ok(Math.abs(got.bounds.min[0] + 20) < 0.01 && Math.abs(got.bounds.max[1] - 2) < 0.01, JSON.stringify(got.bounds));
    assert.equal(got.queried.body[0], 2);
    assert.ok(Math.abs(got.queried.distance[0] + 0.1) < 0.01 && got.queried.normal[1] > 0.99, JSON.stringify(got.queried));
    assert.ok(got.queried.distance[1] > 20);
    const expected = [/404/, /not a world\.json/, /this Response has no URL/, /bodies\[0\]\.collider = 9 is not one of the 3/, /does not match its hash/, /needs a World/,
                      /'window' is not a node of a body/, /collider 0: .*create a new system/];
    got.errors.forEach((message, i) => {
        assert.match(message, /^ReliefError: /);
        assert.match(message, expected[i]);
    });
    assert.equal(got.gl, 0);
    assert.deepEqual(messages.filter((line) => !line.includes("404")), []); // of the missing world
});
