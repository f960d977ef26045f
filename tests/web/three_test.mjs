// SPDX-License-Identifier: Apache-2.0
// samples/web: particles hide the meshes of a three.js picture, and are hidden by them.
// A wall of resting particles is seen head-on. A ball in front of it and one that intersects it hide the wall; a ball
// behind it is hidden.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import path from "node:path";
import test from "node:test";

import { launch, openPage, root, serve } from "./lib/browser.mjs";
import { bin, scratch } from "./lib/native.mjs";

test("particles and three.js meshes occlude each other", { timeout: 60_000 }, async (t) => {
    const folder = scratch(t);
    execFileSync(path.join(root, "samples/web/prepare.sh"), [folder], { env: { ...process.env, RELIEF_BIN: bin } });
    const server = await serve({ "/": folder });
    const browser = await launch();
    t.after(async () => {
        await browser.close();
        server.close();
    });
    const { page, messages } = await openPage(browser, `${server.url}/#test`, { viewport: { width: 480, height: 360 } });
    await page.waitForFunction("!document.getElementById('note').textContent.startsWith('Loading')", undefined,
                               { timeout: 30_000 });
    assert.match(await page.textContent("#note"), /Drag/);
    const answer = await page.evaluate(() => {
        const { THREE, renderer, camera, controls, scene, box, side, system, draw } = window.sample;
        const gl = renderer.getContext();
        for (let i = 0; i < 30; ++i) {
            system.step(1 / 15);
        }
        const falling = system.info.alive;
        // The wall, and the balls.
        system.set({ emitter: { rate: 0.001, lifetime: 1 }, forces: { gravity: [0, 0, 0] }, render: { point_size: 0.03 * side } });
        system.restart();
        const at = box.position;
        const births = [];
        for (let x = -0.8; x <= 0.8; x += 0.015) {
            for (let y = -0.3; y <= 0.3; y += 0.015) {
                births.push({ position: [at.x + x * side, at.y + 0.75 * side + y * side, at.z], lifetime: 100 });
            }
        }
        const ball = (x, z) => {
            const made = new THREE.Mesh(new THREE.SphereGeometry(0.12 * side, 32, 16), box.material);
            made.position.set(at.x + x * side, at.y + 0.75 * side, at.z + z * side);
            scene.add(made);
            return made;
        };
        const [before, inside, behind] = [ball(-0.5, 0.2), ball(0, 0), ball(0.5, -0.2)];
        const accepted = system.spawn(births);
        for (let i = 0; i < 30; ++i) {
            system.step(1 / 60); // particles fade in
        }
        camera.position.set(at.x, at.y + 0.75 * side, at.z + 3 * side);
        controls.target.set(at.x, at.y + 0.75 * side, at.z);
        controls.enableDamping = false;
        draw();
        const red = (mesh) => {
            const place = mesh.position.clone().project(camera);
            const pixel = new Uint8Array(4);
            gl.readPixels(Math.round((0.5 + 0.5 * place.x) * gl.drawingBufferWidth),
                          Math.round((0.5 + 0.5 * place.y) * gl.drawingBufferHeight), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
            return pixel[0] - pixel[2]; // the meshes are red, the particles white
        };
        return { falling, births: births.length, accepted, before: red(before), inside: red(inside), behind: red(behind),
                 error: gl.getError() };
    });
    t.diagnostic(JSON.stringify(answer));
    assert.ok(answer.falling > 5000, `${answer.falling} fall`);
    assert.equal(answer.accepted, answer.births);
    assert.ok(answer.before > 40 && answer.inside > 40, "meshes in front of particles hide them");
    assert.ok(answer.behind < 15, "meshes behind particles are hidden");
    assert.equal(answer.error, 0);
    assert.deepEqual(messages, []);
});
