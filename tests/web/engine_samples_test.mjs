// SPDX-License-Identifier: Apache-2.0
// The pages of samples/web/engines: 100,000 particles of each engine fall on the bunny, and none is deep inside.
// Tolerance: kDepth of the bunny's longest side, as far as a particle moves in a step, and kInside particles, which the
// next step moves out. Without collisions, 11,000 are inside. RELIEF_PICTURES=FOLDER keeps a picture of each page.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { distance, openCollider } from "../../out/npm/engines.js";
import { launch, openPage, root, serve } from "./lib/browser.mjs";
import { bin, scratch } from "./lib/native.mjs";

const kDepth = 0.03;
const kInside = 200;
const kSteps = 40;
const kStep = 1 / 30; // seconds
const kFlags = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan", "--use-vulkan=swiftshader",
                "--disable-gpu-watchdog"];

for (const engine of ["three_webgpu", "three_webgl", "playcanvas"]) {
    test(`particles of ${engine} stay outside the bunny`, { timeout: 600_000 }, async (t) => {
        const folder = scratch(t);
        execFileSync(path.join(root, "samples/web/engines/prepare.sh"), [folder], { env: { ...process.env, RELIEF_BIN: bin } });
        const server = await serve({ "/": folder });
        const browser = await launch(kFlags);
        t.after(async () => {
            await browser.close();
            server.close();
        });
        const { page, messages } = await openPage(browser, `${server.url}/?${engine}#test`, { viewport: { width: 480, height: 360 } });
        page.setDefaultTimeout(500_000);
        await page.waitForFunction("window.sample || document.getElementById('note').textContent");
        assert.equal(await page.textContent("#note"), "");
        const places = await page.evaluate(async ([steps, seconds]) => {
            for (let i = 0; i < steps; ++i) {
                window.sample.step(seconds);
                if (i % 10 === 9) {
                    await window.sample.read(); // waits for the GPU
                }
            }
            return [...await window.sample.read()];
        }, [kSteps, kStep]);
        const collider = openCollider(readFileSync(path.join(folder, "body.relief")));
        const side = Math.max(...collider.bounds.max.map((to, i) => to - collider.bounds.min[i]));
        const depths = Array.from({ length: places.length / 4 }, (_, i) => distance(collider, places.slice(4 * i, 4 * i + 3)) / side);
        assert.ok(depths.length >= 100_000, `${depths.length} particles`);
        const count = (from, to) => depths.filter((depth) => depth >= from && depth < to).length;
        const lowest = depths.reduce((low, depth) => Math.min(low, depth), 1);
        t.diagnostic(`${engine}: ${count(-1, 0)} inside, the deepest by ${-lowest} of the side; ${count(-0.005, 0.005)} on the surface`);
        assert.ok(lowest > -kDepth, `a particle is inside by ${-lowest} of the side`);
        assert.ok(count(-1, 0) <= kInside, `${count(-1, 0)} particles are inside`);
        assert.ok(count(-0.005, 0.005) > 1000, `only ${count(-0.005, 0.005)} particles reach the bunny`);
        if (process.env.RELIEF_PICTURES) {
            await page.evaluate(() => window.sample.draw());
            await page.screenshot({ path: path.join(process.env.RELIEF_PICTURES, `${engine}.png`) });
        }
        assert.deepEqual(messages.filter((line) => !line.includes("GPU stall due to ReadPixels")), []);
    });
}
