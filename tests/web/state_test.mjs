// SPDX-License-Identifier: Apache-2.0
// Relief restores a page's WebGL2 state. The page sets all state to unusual values, then loads, steps, draws, queries,
// restarts and disposes, and compares the state after each.
import assert from "node:assert/strict";
import test from "node:test";

import { pageMessages } from "./lib/browser.mjs";
import { bakeCube } from "./lib/boxes.mjs";
import { libraryPage } from "./lib/library.mjs";
import { scratch } from "./lib/native.mjs";

test("the page's GL state is unchanged", { timeout: 60_000 }, async (t) => {
    const folder = scratch(t);
    bakeCube(folder);
    const { page, messages } = await libraryPage(t, folder);
    const answer = await page.evaluate(async () => {
        const { recordState, setOddState } = await import("/odd_state.js");
        setOddState(gl);
        const before = recordState(gl);
        const report = { pieces: Object.keys(before).length, changed: [], errors: [] };
        const check = (what) => {
            const after = recordState(gl);
            report.changed.push(...Object.keys(before).filter((key) => before[key] !== after[key])
                .map((key) => `${what}: ${key} was ${before[key]}, is ${after[key]}`));
            for (let error = gl.getError(); error !== 0; error = gl.getError()) {
                report.errors.push(`${what}: ${error}`);
            }
        };
        const collider = await relief.load("/files/cube.relief");
        const scene = { particles: { capacity: 4096 }, emitter: { rate: 20000, lifetime: 2 }, render: { sort_frames: 4 } };
        const system = new relief.ParticleSystem(gl, { collider, scene });
        check("new ParticleSystem");
        const view = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -8, 1];
        const projection = [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.02, -1, 0, 0, -0.2, 0];
        for (let i = 0; i < 3; ++i) {
            system.step(1 / 60);
            check("step");
            system.draw({ view, projection, width: 64, height: 64 });
            check("draw");
        }
        system.spawn([{ position: [0, 2, 0], lifetime: 1 }]);
        check("spawn");
        system.set({ forces: { gravity: [0, -1, 0] }, emitter: { rate: 100 } });
        check("set");
        report.alive = system.read().length / 12;
        check("read");
        system.restart();
        check("restart");
        system.step();
        check("step after restart");
        const gpu = new relief.GpuCollider(gl, collider);
        check("new GpuCollider");
        gpu.dispose();
        check("GpuCollider.dispose");
        system.dispose();
        check("ParticleSystem.dispose");
        collider.dispose();
        const wobbling = new relief.ParticleSystem(gl, {
            scene: {
                collider: { mesh: "cube.obj", resolution: 32, deform: { amplitude: 0.1, frequency: 1 } },
                particles: { capacity: 4096 },
            },
            files: { "cube.obj": new Uint8Array(await (await fetch("/files/cube.obj")).arrayBuffer()) },
        });
        check("a system that deforms");
        wobbling.step();
        check("step of a system that deforms");
        wobbling.draw({ view, projection, width: 64, height: 64 });
        check("draw of a system that deforms");
        wobbling.dispose();
        const bytes = async (name) => new Uint8Array(await (await fetch(`/files/${name}`)).arrayBuffer());
        const pictured = new relief.ParticleSystem(gl, {
            scene: { collider: { file: "cube.relief" }, render: { meshes: "meshes" } },
            files: { "cube.relief": await bytes("cube.relief"), "meshes/cube.obj": await bytes("cube.obj") },
        });
        for (let i = 0; i < 2; ++i) {
            pictured.drawMeshes({ view, projection, width: 64, height: 64 });
            check("drawMeshes");
        }
        pictured.dispose();
        return report;
    });
    assert.ok(answer.pieces > 300, `${answer.pieces} pieces`);
    assert.ok(answer.alive > 100, `${answer.alive} particles`);
    assert.deepEqual(answer.changed, []);
    assert.deepEqual(answer.errors, []);
    assert.deepEqual(pageMessages(messages), []);
});
