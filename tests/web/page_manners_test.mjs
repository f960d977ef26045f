// SPDX-License-Identifier: Apache-2.0
// How the page of `relief view` behaves without being told: it snows, keeps up on a slow machine, and shows
// no control that does nothing.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { bakeCube } from "./lib/boxes.mjs";
import { Quality } from "../../runtime/web/view/quality.js";
import { scratch } from "./lib/native.mjs";
import { pageData, viewer } from "./lib/view.mjs";

function cube(t) {
    const folder = scratch(t);
    bakeCube(folder);
    return { folder, data: pageData("cube.relief", readFileSync(path.join(folder, "cube.relief"))) };
}

test("it snows at once, unless motion is unwanted; nothing that plays, no controls for it", { timeout: 300_000 }, async (t) => {
    const { folder, data } = cube(t);
    const open = await viewer(t, folder);
    const moving = await open(data, { reducedMotion: "no-preference", viewport: { width: 300, height: 240 } });
    await moving.page.waitForFunction("reliefView.preset === 'snow' && reliefView.particles.system?.info.alive > 100", undefined, { timeout: 200_000 });
    assert.deepEqual(moving.said, []);
    await moving.close();

    const { page, said } = await open(data, { viewport: { width: 500, height: 700 } });
    assert.equal(await page.evaluate("reliefView.particles.system"), null);
    await page.click("#tab-particles");
    const controls = "#sheet-particles :is(input, button):not(#preset input)";
    assert.deepEqual(await page.locator(controls).evaluateAll((all) => all.filter((one) => one.offsetParent).map((one) => one.id)), []);
    await page.click("[value=rain] + span");
    assert.equal(await page.locator(controls).evaluateAll((all) => all.filter((one) => one.offsetParent && !one.disabled).length), 2);
    await page.click("[value=none] + span");
    assert.ok(!await page.isVisible("#playing"));
    assert.deepEqual(said, []);
});

test("rain is streaks along its way", { timeout: 300_000 }, async (t) => {
    const { folder, data } = cube(t);
    const open = await viewer(t, folder);
    const { page, said } = await open(data, { viewport: { width: 500, height: 500 }, colorScheme: "dark" });
    await page.evaluate(() => (reliefView.particles.paused = true));
    await page.click("#tab-particles");
    await page.click("[value=rain] + span");
    const shape = await page.evaluate(() => {
        const { view, camera, particles, look, body } = reliefView;
        const picture = () => {
            view.dirty = true;
            return reliefView.pixelsNow();
        };
        particles.start({ collider: body.collider, scene: reliefView.weather("rain", body.box, 1024) });
        look.floor = null;
        view.bodies = [];
        camera.pitch = 0;
        camera.distance *= 0.35;
        const before = picture();
        for (let i = 0; i < 30; ++i) particles.step();
        const { data, width, height } = picture();
        const wet = (x, y) => Math.abs(data[4 * (y * width + x) + 2] - before.data[4 * (y * width + x) + 2]) > 12;
        // Runs of pixels that a drop has changed, across and down.
        const runs = (across) => {
            const lengths = [];
            for (let a = 0; a < (across ? height : width); ++a) {
                let run = 0;
                for (let b = 0; b <= (across ? width : height); ++b) {
                    const is = b < (across ? width : height) && (across ? wet(b, a) : wet(a, b));
                    if (!is && run > 0) lengths.push(run);
                    run = is ? run + 1 : 0;
                }
            }
            return lengths.reduce((x, y) => x + y, 0) / lengths.length;
        };
        return { across: runs(true), down: runs(false) };
    });
    assert.ok(shape.down > 4 * shape.across, `drops are ${shape.across.toFixed(1)} pixels wide and ${shape.down.toFixed(1)} long`);
    assert.deepEqual(said, []);
});

test("where frames take 50 ms the page draws less, says so, and draws all of it once it rests", { timeout: 300_000 }, async (t) => {
    const { folder, data } = cube(t);
    const open = await viewer(t, folder);
    const { page, said } = await open(data, { viewport: { width: 220, height: 200 } });
    const drawn = () => page.evaluate(() => reliefView.gl.drawingBufferWidth / document.getElementById("canvas").clientWidth);
    // The clock of a slow machine.
    await page.evaluate(() => {
        let now = performance.now();
        window.requestAnimationFrame = (f) => setTimeout(() => f((now += 50)), 0);
        reliefView.startPreset("snow");
    });
    await page.waitForFunction("reliefView.quality.pixels === 0.5", undefined, { timeout: 200_000 });
    assert.ok(await drawn() <= 0.51, `${await drawn()} of the pixels each way`);
    assert.match(await page.locator("#quality").textContent(), /^Coarser, to keep up: 50 % of the pixels each way$/);
    assert.ok(await page.isVisible("#quality"));
    await page.evaluate(() => (reliefView.particles.paused = true));
    await page.waitForFunction("document.getElementById('quality').hidden", undefined, { timeout: 60_000 });
    assert.equal(await drawn(), 1);
    assert.deepEqual(said, []);
});

test("finer pixels come back where frames are quick, and are not tried where they would be slow", () => {
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
    // A machine that needs its time for pixels: full ones take 60 ms.
    const slow = (pixels) => Math.max(60 * pixels ** 2, 16.7);
    frames(slow, 10_000);
    assert.deepEqual(frames(slow, 60_000), new Set([0.71]));
    frames(() => 1500, 20_000); // a page that slept
    assert.equal(quality.pixels, 0.71);
});
