// SPDX-License-Identifier: Apache-2.0
// Default behaviour of the page of `relief view`: it keeps up on a slow machine, loads nothing, and shows no control
// without effect.
import assert from "node:assert/strict";
import path from "node:path";
import test from "node:test";
import { pathToFileURL } from "node:url";

import { bakeCube } from "./lib/boxes.mjs";
import { launch, openPage } from "./lib/browser.mjs";
import { PageCollider } from "../../runtime/web/view/page_collider.js";
import { Quality } from "../../runtime/web/view/quality.js";
import { run, scratch } from "./lib/native.mjs";
import { dataOf, openFile, scenePage } from "./lib/view.mjs";

test("a collider's page has no particle controls, and cannot load anything", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    bakeCube(folder);
    run("relief", "view", path.join(folder, "cube.relief"));
    const browser = await launch();
    t.after(() => browser.close());
    const { page, messages } = await openPage(browser, pathToFileURL(path.join(folder, "cube.html")).href,
                                          { viewport: { width: 200, height: 150 }, bypassCSP: false });
    await page.locator("#title").waitFor();
    assert.deepEqual(await page.locator("#tab label:visible").allTextContents(), ["View", "Maps"]);
    assert.equal(await page.evaluate(() => fetch("data:,x").then(() => "loads", () => "refused")), "refused");
    assert.ok(messages.every((line) => /Content Security Policy|failed: data:/.test(line)), messages.join("\n"));
});

test("a page reads the same texels as relief-particles, for each kind of map", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    bakeCube(folder);
    const file = path.join(folder, "kinds.relief");
    const kinds = ["float:dir=+x,size=16x12", "fixed8:dir=-z,size=16", "cube:size=8", "front-back:dir=+y,size=16x24,depth=half",
                   "front-back:dir=1/2/3,size=16,depth=unorm16,decode=projected", "patches:budget=4kB"];
    run("relief", "bake", path.join(folder, "cube.obj"), "-q", "-o", file, ...kinds.flatMap((map) => ["--map", map]));
    run("relief", "view", file);
    const collider = new PageCollider(dataOf(path.join(folder, "kinds.html")).collider);
    const { page } = await openFile(t, scenePage(folder, file), { viewport: { width: 200, height: 150 } });
    const [info, ...maps] = await page.evaluate(() => {
        const { collider: other } = reliefView.body;
        return [other.info, ...other.info.maps.map(({ format }, i) => [...(format === "patches" ? other.tree(i) : other.texels(i))])];
    });
    assert.deepEqual(collider.info, info);
    for (const [i, texels] of maps.entries()) {
        const own = info.maps[i].format === "patches" ? collider.tree(i) : collider.texels(i);
        const unlike = texels.filter((v, k) => !Object.is(v, own[k]) && !(Math.abs(v - own[k]) < 1e-6));
        assert.deepEqual([own.length, unlike], [texels.length, []], kinds[i]);
    }
});

test("at 50 ms per frame the page lowers its resolution; at rest it draws all pixels", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    bakeCube(folder);
    const { page, messages } = await openFile(t, scenePage(folder, path.join(folder, "cube.relief")), { viewport: { width: 220, height: 200 } });
    const drawn = () => page.evaluate(() => reliefView.gl.drawingBufferWidth / document.getElementById("canvas").clientWidth);
    // A simulated clock of a slow machine.
    await page.evaluate(() => {
        let now = performance.now();
        window.requestAnimationFrame = (f) => setTimeout(() => f((now += 50)), 0);
        reliefView.changed();
    });
    await page.waitForFunction("reliefView.quality.pixels === 0.5", undefined, { timeout: 200_000 });
    assert.ok(await drawn() <= 0.51, `${await drawn()} of the pixels each way`);
    assert.match(await page.locator("#quality").textContent(), /^Reduced resolution: 50 % per side$/);
    assert.ok(await page.isVisible("#quality"));
    await page.evaluate(() => (reliefView.particles.paused = true));
    await page.waitForFunction("document.getElementById('quality').hidden", undefined, { timeout: 60_000 });
    assert.equal(await drawn(), 1);
    assert.deepEqual(messages, []);
});

test("the resolution rises only if frames stay fast", () => {
    const quality = new Quality();
    let now = 0;
    const frames = (took, ms) => {
        const seen = new Set();
        for (const end = now + ms; now < end;) {
            quality.frame((now += took(quality.pixels)), true);
            seen.add(quality.pixels);
        }
        return seen;
    };
    frames(() => 50, 3000);
    assert.equal(quality.pixels, 0.5);
    frames(() => 16, 20_000);
    assert.equal(quality.pixels, 1);
    // A machine limited by pixels: frames at full resolution take 60 ms.
    const slow = (pixels) => Math.max(60 * pixels ** 2, 16.7);
    frames(slow, 10_000);
    assert.deepEqual(frames(slow, 60_000), new Set([0.71]));
    frames(() => 1500, 20_000); // the page was suspended
    assert.equal(quality.pixels, 0.71);
});
