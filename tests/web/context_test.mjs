// SPDX-License-Identifier: Apache-2.0
// A GPU reset between steps (WEBGL_lose_context) causes a ReliefError. After the browser restores the context,
// restart() and new GpuColliders work.
import assert from "node:assert/strict";
import test from "node:test";

import { bakeCube } from "./lib/boxes.mjs";
import { libraryPage } from "./lib/library.mjs";
import { scratch } from "./lib/native.mjs";

test("a lost context is reported, and restored", { timeout: 60_000 }, async (t) => {
    const folder = scratch(t);
    bakeCube(folder);
    const { page, messages } = await libraryPage(t, folder);
    const report = await page.evaluate(async () => {
        const { gpuQuery } = await import("/gpu_query.js");
        const collider = await relief.load("/files/cube.relief");
        const scene = { particles: { capacity: 4096 }, emitter: { rate: 6000, lifetime: 2 },
                        render: { point_size: 0.1 } };
        const [system, second, gone] = [0, 1, 2].map(() => new relief.ParticleSystem(gl, { collider, scene, shaded: false }));
        const gpu = new relief.GpuCollider(gl, collider);
        const other = document.createElement("canvas").getContext("webgl2"); // is not lost
        const elsewhere = new relief.ParticleSystem(other, { collider, scene, shaded: false });
        const view = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -12, 1];
        const projection = [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.02, -1, 0, 0, -0.2, 0];
        const outcomes = {};
        const trial = (name, f) => {
            try {
                outcomes[name] = ["no error", String(f())];
            } catch (error) {
                outcomes[name] = [error.name, error.message];
            }
        };
        const lit = () => {
            gl.clearColor(0, 0, 0, 1);
            gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
            system.draw({ view, projection });
            const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
            gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
            return pixels.filter((value, i) => i % 4 === 0 && value > 60).length;
        };
        for (let i = 0; i < 30; ++i) {
            system.step(1 / 60);
        }
        elsewhere.step(1 / 60);
        const litBefore = lit();

        const extension = gl.getExtension("WEBGL_lose_context");
        gl.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
        const event = (name) => new Promise((done) => gl.canvas.addEventListener(name, done, { once: true }));
        const lost = event("webglcontextlost");
        extension.loseContext();
        trial("step", () => system.step(1 / 60));
        trial("draw", () => system.draw({ view, projection }));
        trial("read", () => system.read());
        trial("bind", () => gpu.bind());
        trial("a new system", () => new relief.ParticleSystem(gl, { collider, scene }));
        trial("dispose", () => gone.dispose());
        await lost;
        trial("step later", () => system.step(1 / 60));
        trial("restart", () => system.restart());
        trial("another context's step", () => elsewhere.step(1 / 60));
        trial("the CPU's query", () => collider.query([0, 0, 0]).distance[0] < 0);

        await new Promise((done) => setTimeout(done, 50));
        const restored = event("webglcontextrestored");
        extension.restoreContext();
        await restored;
        trial("step after", () => system.step(1 / 60));
        trial("bind after", () => gpu.bind());
        trial("dispose after", () => (second.dispose(), gpu.dispose()));
        trial("restart after", () => system.restart());
        for (let i = 0; i < 30; ++i) {
            system.step(1 / 60);
            elsewhere.step(1 / 60);
        }
        const fresh = new relief.GpuCollider(gl, collider);
        const inside = gpuQuery(gl, fresh, [0, 0, 0, 0, 3, 0]).distance;
        const alive = [system.read().length / 12, elsewhere.read().length / 12];
        const litAfter = lit();
        fresh.dispose();
        system.dispose();
        return { outcomes, litBefore, litAfter, inside: [...inside], alive, errors: [gl.getError(), other.getError()] };
    });
    t.diagnostic(JSON.stringify(report));
    const { outcomes } = report;
    for (const name of ["step", "draw", "read", "bind", "a new system", "step later", "restart"]) {
        assert.equal(outcomes[name][0], "ReliefError", name);
        assert.match(outcomes[name][1], /context is lost.*webglcontextrestored/, name);
    }
    for (const [name, cure] of [["step", "restart\\(\\)"], ["bind", "GpuCollider"]]) {
        assert.match(outcomes[`${name} after`].join(": "), new RegExp(`^ReliefError: .*lost meanwhile; .*${cure}`));
    }
    for (const name of ["dispose", "another context's step", "the CPU's query", "dispose after", "restart after"]) {
        assert.equal(outcomes[name][0], "no error", `${name}: ${outcomes[name][1]}`);
    }
    assert.equal(outcomes["the CPU's query"][1], "true");
    assert.ok(report.inside[0] < 0 && report.inside[1] > 0, `${report.inside}`);
    assert.ok(report.alive.every((count) => count > 1000), `${report.alive}`);
    assert.ok(report.litBefore > 500 && report.litAfter > 0.8 * report.litBefore, `${report.litBefore}, ${report.litAfter}`);
    assert.deepEqual(report.errors.map((error) => (error === 37442 ? 0 : error)), [0, 0]); // CONTEXT_LOST_WEBGL, once
    assert.deepEqual(messages.filter((line) => !/CONTEXT_LOST_WEBGL: loseContext/.test(line)), []);
});
