// SPDX-License-Identifier: Apache-2.0
// The pages that `relief export` writes for three.js and PlayCanvas, with no other files than the packages: 100,000
// particles fall on the bunny, and none is deep inside.
// Tolerance: kDepth of the bunny's longest side, as far as a particle moves in a step, and kInside particles, which the
// next step moves out. Without collisions, 11,000 are inside. RELIEF_PICTURES=FOLDER keeps a picture of each page.
import assert from "node:assert/strict";
import { readFileSync, symlinkSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { distance, openCollider } from "../../out/npm/engines.js";
import { launch, modules, openPage, root, serve } from "./lib/browser.mjs";
import { bunny, run, scratch } from "./lib/native.mjs";

const kDepth = 0.03;
const kInside = 200;
const kSteps = 40;
const kStep = 1 / 30; // seconds
const kLinesMax = 20; // of code that collides: all before start() except imports
const kFlags = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan", "--use-vulkan=swiftshader",
                "--disable-gpu-watchdog"];

for (const [sample, engine, query] of [["three_webgpu", "three", "?webgpu"], ["three_webgl", "three", "?webgl"],
                                       ["playcanvas", "playcanvas", ""]]) {
    test(`particles of ${sample} stay outside the bunny`, { timeout: 600_000 }, async (t) => {
        const folder = scratch(t);
        const source = path.join(folder, "the #1 'bunny'.relief");
        run("relief", "bake", bunny, "-q", "-o", source, "--budget", "200kB");
        const exported = path.join(folder, "exported");
        run("relief", "export", source, "--engine", engine, exported, "-q");
        symlinkSync(modules, path.join(exported, "node_modules"));
        const { version } = JSON.parse(readFileSync(path.join(modules, engine, "package.json")));
        assert.match(readFileSync(path.join(exported, "RELIEF.md"), "utf8"), new RegExp(`npm install --prefix \\. ${engine}@${version}\n`));
        const code = readFileSync(path.join(exported, `${sample}.js`), "utf8").split("export async function start")[0]
            .split("\n").filter((line) => /\S/.test(line) && !/^ *\/[/*]|^import /.test(line));
        assert.ok(code.length >= 10 && code.length <= kLinesMax, `${code.length} lines of code`);
        const server = await serve({ "/": exported });
        const browser = await launch(kFlags);
        t.after(async () => {
            await browser.close();
            server.close();
        });
        const { page, messages } = await openPage(browser, `${server.url}/${query}`, { viewport: { width: 480, height: 360 } });
        page.setDefaultTimeout(500_000);
        await page.waitForFunction("window.sample || document.getElementById('note').textContent");
        assert.equal(await page.textContent("#note"), "");
        const places = await page.evaluate(async ([steps, seconds]) => {
            const { step, draw, read } = window.sample;
            Object.assign(window.sample, { step() {}, draw() {} }); // the page calls both once per frame
            for (let i = 0; i < steps; ++i) {
                step(seconds);
                if (i % 10 === 9) {
                    await read(); // waits for the GPU
                }
            }
            draw();
            return [...await read()];
        }, [kSteps, kStep]);
        const collider = openCollider(readFileSync(source));
        const side = Math.max(...collider.bounds.max.map((to, i) => to - collider.bounds.min[i]));
        const depths = Array.from({ length: places.length / 4 }, (_, i) => distance(collider, places.slice(4 * i, 4 * i + 3)) / side);
        assert.ok(depths.length >= 100_000, `${depths.length} particles`);
        const count = (from, to) => depths.filter((depth) => depth >= from && depth < to).length;
        const lowest = depths.reduce((low, depth) => Math.min(low, depth), 1);
        t.diagnostic(`${sample}: ${count(-1, 0)} inside, the deepest by ${-lowest} of the side; ${count(-0.005, 0.005)} on the surface`);
        assert.ok(lowest > -kDepth, `a particle is inside by ${-lowest} of the side`);
        assert.ok(count(-1, 0) <= kInside, `${count(-1, 0)} particles are inside`);
        assert.ok(count(-0.005, 0.005) > 1000, `only ${count(-0.005, 0.005)} particles reach the bunny`);
        if (process.env.RELIEF_PICTURES) {
            await page.screenshot({ path: path.join(process.env.RELIEF_PICTURES, `${sample}.png`) });
        }
        assert.deepEqual(messages.filter((line) => !line.includes("GPU stall due to ReadPixels")), []);
    });
}
