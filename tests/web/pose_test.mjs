// SPDX-License-Identifier: Apache-2.0
// set() moves a collider during play, as keys do in relief-sim.
import assert from "node:assert/strict";
import test from "node:test";

import { bakeCube } from "./lib/boxes.mjs";
import { libraryPage } from "./lib/library.mjs";
import { scratch } from "./lib/native.mjs";
import { assertSamePushes, pushedInReliefSim, pushedTables } from "./lib/pushed.mjs";

const kSteps = 64;

test("a pose set before each step pushes like pose keys", { timeout: 60_000 }, async (t) => {
    const folder = scratch(t);
    bakeCube(folder);
    const native = pushedInReliefSim(folder, kSteps, `[[collider]]
file = "cube.relief"
[[collider.key]]
time = 0.0
position = [0.0, 0.0, 0.0]
[[collider.key]]
time = 1.0
position = [0.0, 1.0, 0.0]
`);

    const { page, messages } = await libraryPage(t, folder);
    const { rows, matrix, several, errors, gl } = await page.evaluate(async ([steps, rest]) => {
        const collider = await relief.load("/files/cube.relief");
        const system = new relief.ParticleSystem(gl, { collider, scene: { ...rest, collider: { position: [0, 0, 0] } } });
        for (let i = 1; i <= steps; ++i) {
            system.set({ collider: { position: [0, i / steps, 0] } });
            system.step();
        }
        const rows = [...system.read()];
        system.set({ collider: { angle: 32 } });
        // With two colliders, one moves and the other stays.
        const two = new relief.ParticleSystem(gl, {
            scene: { ...rest, collider: [{ file: "c.relief" }, { file: "c.relief", position: [4, 0, 0] }] }, files: { "c.relief": collider },
        });
        two.set({ collider: [{}, { position: [5, 0, 0] }] });
        const still = new relief.ParticleSystem(gl, { collider, scene: rest });
        return {
            rows, matrix: system.info.bodies[0].matrix, several: two.info.bodies.map((body) => body.matrix[12]),
            errors: await errorsOf(() => still.set({ collider: { position: [0, 1, 0] } }),
                                   () => system.set({ collider: { file: "other.relief" } }),
                                   () => system.set({ collider: { scale: 2 } }),
                                   () => still.set({ forces: { gravity: [0, -1, 0] } })),
            gl: gl.getError(),
        };
    }, [kSteps, pushedTables(kSteps)]);
    assertSamePushes(rows, native);
    assert.ok(Math.abs(matrix[13] - 1) < 1e-6 && Math.abs(matrix[0] - Math.cos(32 * Math.PI / 180)) < 1e-5, `${matrix}`);
    assert.deepEqual(several, [0, 5]);
    assert.match(errors[0], /position: \[0, 0, 0\]/);
    assert.match(errors[1], /only position, axis, angle and clip can change/);
    assert.match(errors[2], /only position, axis, angle and clip can change/);
    assert.equal(errors[3], "no error");
    assert.equal(gl, 0);
    assert.deepEqual(messages, []);
});
