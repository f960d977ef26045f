// SPDX-License-Identifier: Apache-2.0
// The page of `relief view`, opened from disk with a bunny: each feature once, and every invalid input. The console
// must stay empty, and no GL error may remain.
import assert from "node:assert/strict";
import path from "node:path";
import test from "node:test";

import { bunny, run, scratch } from "./lib/native.mjs";
import { dataOf, openFile, scenePage, viewer, withData } from "./lib/view.mjs";

function bake(folder) {
    const file = path.join(folder, "bunny.relief");
    run("relief", "bake", bunny, "-q", "-o", file, "--holes", "keep", "--resolution", "64");
    return file;
}

/** Runs in the page. Returns the fraction of the canvas that differs from the previous picture, and stores this one. */
const kChange = `(() => {
    const now = reliefView.pixelsNow();
    if (now.error) throw new Error("GL error " + now.error);
    const before = window.pictureBefore;
    window.pictureBefore = now.data;
    if (!before || before.length !== now.data.length) return 1;
    let changed = 0;
    for (let i = 0; i < now.data.length; i += 4)
        changed += Math.abs(now.data[i] - before[i]) + Math.abs(now.data[i + 1] - before[i + 1]) +
            Math.abs(now.data[i + 2] - before[i + 2]) > 12;
    return changed / (now.data.length / 4);
})()`;

test("each feature of the page changes the picture", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    run("relief", "view", bake(folder), "--mesh", bunny, "-q", "--samples", "5000", "-o", path.join(folder, "made.html"));
    const made = dataOf(path.join(folder, "made.html"));
    const { page, messages } = await openFile(t, path.join(folder, "made.html"), { viewport: { width: 760, height: 400 }, colorScheme: "dark" });
    const message = () => page.locator("#message p").textContent();
    const changed = async (what, least, action) => {
        await page.evaluate(kChange);
        await action();
        const share = await page.evaluate(kChange);
        assert.ok(share >= least, `${what}: ${(100 * share).toFixed(2)} % of the picture changed`);
    };
    await changed("only the maps", 0.002, () => page.evaluate(() => reliefView.panel.setShow("surface")));
    await changed("coloured by map", 0.02, () => page.evaluate(() => document.getElementById("tint").click()));
    await changed("turned by a key", 0.02, () => page.keyboard.press("ArrowLeft"));
    await changed("nearer by a key", 0.02, () => page.keyboard.press("+"));
    await changed("a slice", 0.02, () => page.evaluate(() => document.getElementById("slice-on").click()));
    await changed("across another axis", 0.01, () => page.click("[name=axis][value='0'] + span"));
    await changed("the slice moved", 0.01, () => page.locator("#slice-at").fill("0.52"));
    assert.equal(await page.evaluate("reliefView.look.slice.axis"), 0);
    await page.evaluate(() => document.getElementById("slice-on").click());
    assert.equal(await page.evaluate("reliefView.look.slice"), null);

    await page.click("#tab-maps");
    await changed("a map", 0.01, () => page.locator("#maps button").first().click());
    await page.waitForFunction("reliefView.panel.picturesDone");
    const drawn = await page.evaluate(() => [...document.querySelectorAll("#maps canvas")].every((canvas) =>
        canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.some((v) => v > 0)));
    assert.ok(drawn, "every map has a picture");

    await page.click("#tab-errors");
    await changed("the heat map", 0.02, () => page.evaluate(() => reliefView.panel.setShow("mesh")));
    const before = await page.evaluate("reliefView.camera.distance");
    await page.locator("#places button").first().click();
    assert.notEqual(await page.evaluate("reliefView.camera.distance"), before);
    await page.waitForFunction("!document.getElementById('pin').hidden");
    assert.equal(await page.locator("#explanation").textContent(), made.check.worst_places[0].explanation);

    assert.equal(await message(), "");
    assert.deepEqual(messages, []);
});

test("patches show their cells", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    const patches = path.join(folder, "patches.relief");
    run("relief", "bake", bunny, "-q", "-o", patches, "--map", "patches:budget=200kB");
    run("relief", "view", patches, "--mesh", bunny, "-q", "--samples", "5000", "-o", path.join(folder, "made.html"));
    const { page, messages } = await openFile(t, path.join(folder, "made.html"), { viewport: { width: 760, height: 400 }, colorScheme: "dark" });
    await page.evaluate(() => {
        reliefView.panel.setShow("surface");
        reliefView.look.floor = null;
        reliefView.panel.frame();
    });
    await page.evaluate(kChange);
    const change = async (least, action) => {
        await page.evaluate(action);
        const share = await page.evaluate(kChange);
        assert.ok(share >= least, `${action}: ${(100 * share).toFixed(2)} % of the picture changed`);
    };
    await change(0.05, "document.getElementById('tint').click()");
    await change(0.05, "document.getElementById('tint').click()");
    await change(0.02, "document.getElementById('slice-on').click()");
    await change(0.02, "document.getElementById('slice-on').click()");
    await change(0.05, "document.getElementById('tab-errors').querySelector('input').click(), reliefView.panel.setShow('mesh')");

    await page.click("#tab-maps");
    await page.waitForFunction("reliefView.panel.picturesDone");
    assert.match(await page.locator("#maps button").textContent(), /0 patches in \d+ × \d+ × \d+ roots, up to [1-9]\d* levels/);
    assert.ok(await page.locator("#patches-note").isVisible());
    // The smallest cells are the darkest, and all levels are visible.
    const colors = await page.evaluate(() => {
        const canvas = document.querySelector("#maps canvas");
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        const chroma = new Set();
        for (let i = 0; i < data.length; i += 4) {
            if (data[i + 3] > 0) chroma.add(Math.round(8 * data[i] / data[i + 2]));
        }
        return chroma.size;
    });
    assert.ok(colors >= 3, `${colors} colours`);
    assert.equal(await page.locator("#message p").textContent(), "");
    assert.deepEqual(messages, []);
});

test("particles meet the body and restart; nothing overflows a small window", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    const emitter = `
[[emitter]]
box_min = [-0.5, 1.1, -0.5]
box_max = [0.5, 1.3, 0.5]
velocity = [0, -2, 0]
rate = 5000
`;
    const { page, messages } = await openFile(t, scenePage(folder, bake(folder), emitter), { viewport: { width: 420, height: 800 } });
    await page.evaluate(() => (reliefView.particles.paused = true));
    await page.click("#tab-particles");
    const contacts = await page.evaluate(() => {
        for (let i = 0; i < 60; ++i) {
            reliefView.particles.step();
        }
        return reliefView.particles.system.read().filter((value, i) => i % 12 === 9 && value > 0).length;
    });
    assert.ok(contacts > 20, `${contacts} particles have hit the body`);
    await page.click("#restart");
    await page.waitForFunction("reliefView.particles.system.info.time === 0");

    const wide = await page.evaluate("document.documentElement.scrollWidth");
    assert.ok(wide <= 420, `the page is ${wide} pixels wide`);
    const beyond = await page.evaluate(() => [...document.querySelectorAll("#panel *, #title *")]
        .filter((one) => one.offsetParent && one.getBoundingClientRect().right > 421).map((one) => one.outerHTML.slice(0, 80)));
    assert.deepEqual(beyond, []);
    assert.deepEqual(messages, []);
});

test("invalid input gives a message, and the page stays usable", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    const file = bake(folder);
    const made = path.join(folder, "bunny.html");
    run("relief", "view", file);
    const data = dataOf(made);
    const open = await viewer(t);
    const sentence = async (page_file, pattern) => {
        const { page, messages, close } = await open(page_file);
        assert.match(await page.locator("#message p").textContent(), pattern);
        assert.deepEqual(messages, []);
        await close();
    };
    const cut = structuredClone(data);
    cut.collider.textures.find(({ texels }) => texels).texels = "AAAA";
    for (const [other, pattern] of [["{ broken", /this page is damaged/i], [{ ...data, format: 1 }, /format 1/], [cut, /truncated/],
                                    [{ ...data, collider: { ...data.collider, block: "%%%" } }, /cannot be decoded/],
                                    [{ ...data, mesh: { name: "m", vertices: "AAAAAA==", triangles: "" } }, /truncated/]]) {
        await sentence(withData(made, other), pattern);
    }
    const scene = scenePage(folder, file);
    const played = dataOf(scene);
    const bytes = Buffer.from(played.files["bunny.relief"], "base64");
    for (const damaged of [Buffer.from(bytes).fill(0x5a, 100, 400), bytes.subarray(0, 500)]) {
        await sentence(withData(scene, { ...played, files: { "bunny.relief": damaged.toString("base64") } }), /\.$/);
    }
    await sentence(withData(scene, { ...played, scene: "[collider]\nfile = \"b.relief\"\n" }), /b\.relief/);

    const { page, messages } = await open(withData(made, null));
    assert.ok(await page.isVisible("#empty"), "an empty page shows a hint");
    assert.deepEqual(messages, []);
});

test("missing features give a message; a lost context is restored", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    const file = bake(folder);
    const made = path.join(folder, "bunny.html");
    run("relief", "view", file);
    const open = await viewer(t);
    const { page, messages } = await open(made);
    await page.evaluate(() => {
        window.loss = reliefView.gl.getExtension("WEBGL_lose_context");
        window.loss.loseContext();
    });
    await page.waitForFunction(() => /The GPU was reset/.test(document.querySelector("#message p").textContent));
    await page.evaluate(() => {
        window.bodyBefore = reliefView.body;
        window.loss.restoreContext();
    });
    // The page reloads itself, and briefly has no reliefView.
    await page.waitForFunction("window.reliefView?.body && reliefView.body !== window.bodyBefore");
    assert.equal(await page.locator("#message p").textContent(), "");
    assert.equal(await page.evaluate("reliefView.pixelsNow().error"), 0);
    assert.deepEqual(messages.filter((line) => !/CONTEXT_LOST_WEBGL/.test(line)), []);

    const without = async (script, pattern, page_file = made) => {
        const { page: other, close } = await open(page_file);
        await other.addInitScript(script);
        await other.reload();
        await other.waitForFunction("window.reliefView?.ready");
        assert.match(await other.locator("#message p").textContent(), pattern);
        await close();
    };
    await without(() => {
        const get = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
            return kind === "webgl2" ? null : get.call(this, kind, ...rest);
        };
    }, /does not support WebGL2/);
    await without(() => {
        const get = WebGL2RenderingContext.prototype.getExtension;
        WebGL2RenderingContext.prototype.getExtension = function (name) {
            return name === "EXT_color_buffer_float" ? null : get.call(this, name);
        };
    }, /EXT_color_buffer_float/, scenePage(folder, file));
    await without(() => {
        const get = WebGL2RenderingContext.prototype.getParameter;
        WebGL2RenderingContext.prototype.getParameter = function (name) {
            return name === this.MAX_TEXTURE_SIZE ? 64 : get.call(this, name);
        };
    }, /texture|texels/i);
});
