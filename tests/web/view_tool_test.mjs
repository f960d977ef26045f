// SPDX-License-Identifier: Apache-2.0
// Pages made by `relief view` and `relief-sim --page`: a checked sheet, a scene of several bodies, and a world.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { boxes } from "./lib/boxes.mjs";
import { root } from "./lib/browser.mjs";
import { bunny, run, scratch } from "./lib/native.mjs";
import { openFile } from "./lib/view.mjs";

const kViewport = { viewport: { width: 700, height: 400 }, reducedMotion: "reduce" };

const opened = (t, file, more = {}) => openFile(t, file, { ...kViewport, ...more });

/** Bakes a sheet in the folder, and makes its page. */
function viewSheet(folder, ...words) {
    const [mesh, sheet, page] = ["sheet.obj", "sheet.relief", "sheet.html"].map((name) => path.join(folder, name));
    writeFileSync(mesh, square);
    run("relief", "bake", mesh, "-q", "-o", sheet, "--budget", "60kB", "--as", "shell");
    run("relief", "view", sheet, "-o", page, ...words);
    return [mesh, sheet, page];
}

const square = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 4 3 2 1\n";

test("the check matches relief check; a sheet is the centre of its shell", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    const [mesh, sheet, made] = viewSheet(folder, "--mesh", path.join(folder, "sheet.obj"), "-q", "--samples", "5000");
    const check = (...words) => run("relief", "check", sheet, "--mesh", mesh, "--samples", "5000", ...words);
    const report = JSON.parse(check("--json"));
    const { page, messages } = await opened(t, made);
    await page.click("#tab-errors");
    const verdicts = check().split("\n").filter((line) => /^[^ :]+\.relief: /.test(line));
    assert.equal(await page.locator("#verdict").textContent(), verdicts.map((line) => line.replace(/^[^:]+: /, "")).join("; "));
    assert.equal(await page.locator("#verdict").getAttribute("class"), report.verdict.grade);
    assert.match(await page.locator("#sheets-note").textContent(), /Sheets have a thickness of [0-9.]+/);
    const depth = await page.evaluate("reliefView.look.depth");
    assert.ok(depth > 1e-3, `half the thickness is ${depth}`);
    // The heat map agrees: no pixel has the strong colours of the range's ends.
    const strong = await page.evaluate(() => {
        reliefView.panel.setShow("mesh");
        const { data } = reliefView.pixelsNow();
        let blue = 0;
        for (let i = 0; i < data.length; i += 4) blue += data[i + 2] - data[i] > 80;
        return blue / (data.length / 4);
    });
    assert.ok(strong < 0.01, `${(100 * strong).toFixed(1)} % of the picture is blue`);
    assert.deepEqual(messages, []);
});

test("the page of a check shows its numbers, worst places, parts and advice", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    const at = (name) => path.join(folder, name);
    // A slab and a ledge whose gap neither map sees, with a pillar too thin for their texels, whose name is markup.
    writeFileSync(at("slab.obj"), boxes([{ name: "slab", low: [-45, -1, -45], high: [45, 1, 45] },
                                         { name: "ledge", low: [-40, 11, -40], high: [40, 13, 40] },
                                         { name: "<b>pillar</b>", low: [43.75, 1, -0.25], high: [44.25, 7, 0.25] }]));
    run("relief", "bake", at("slab.obj"), "-q", "-o", at("slab.relief"), "--map", "fixed8:dir=-y,size=32");
    const report = JSON.parse(run("relief", "check", at("slab.relief"), "--mesh", at("slab.obj"), "-q", "--samples", "5000", "--json",
                                "--page", at("slab.html")));
    assert.ok(report.advice.length > 0 && report.verdict.lost_parts === 1, JSON.stringify(report.verdict));
    const { page, messages } = await opened(t, at("slab.html"));
    await page.click("#tab-errors");
    assert.equal(await page.locator("#verdict").getAttribute("class"), report.verdict.grade);
    assert.deepEqual(await page.locator("#advice li code").allTextContents(),
                     report.advice.filter((one) => one.helps || !one.tried).map((one) => one.command));
    assert.match(await page.locator("#parts").textContent(), /<b>pillar<\/b>.*texels/s);
    assert.match(await page.locator("#measures").textContent(), /surface unseen by maps.*samples of each kind5,000seed1/);
    const worst = report.worst_places.at(-1);
    await page.locator("#places button").last().click();
    const target = await page.evaluate("reliefView.camera.target");
    assert.ok(target.every((v, k) => Math.abs(v - worst.position[k]) < 1e-4), `${target} instead of ${worst.position}`);
    assert.equal(await page.locator("#explanation").textContent(), worst.explanation);
    assert.deepEqual(messages, []);
});

test("a scene's bodies are drawn in their places, and move", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    const at = (name) => path.join(folder, name);
    run("relief", "bake", bunny, "-q", "-o", at("b.relief"), "--paper", "--resolution", "48");
    writeFileSync(at("s.toml"), `
[[collider]]
file = "b.relief"
[[collider]]
file = "b.relief"
position = [3.0, 0.0, 0.0]
[[collider.key]]
time = 0.0
[[collider.key]]
time = 1.0
position = [3.0, 2.0, 0.0]
[particles]
capacity = 4096
[[emitter]]
box_min = [-1.0, 2.0, -1.0]
box_max = [1.0, 2.1, 1.0]
direction = [0.0, -1.0, 0.0]
speed = 1.0
rate = 500.0
`);
    run("relief-sim", at("s.toml"), "--page", at("s.html"));
    const { page, messages } = await opened(t, at("s.html"));
    await page.waitForFunction("reliefView.view.bodies.length === 2",
                               undefined, { timeout: 120_000 });
    const places = () => page.evaluate(() => reliefView.view.bodies.map((body) => [...body.model].slice(12, 15)));
    assert.deepEqual((await places())[0], [0, 0, 0]);
    await page.evaluate(() => (reliefView.particles.paused = true));
    const before = (await places())[1];
    await page.evaluate(() => {
        for (let i = 0; i < 30; ++i) reliefView.particles.step();
        reliefView.changed(); // a resting page does not redraw
    });
    await page.waitForFunction((y) => reliefView.view.bodies[1].model[13] > y + 0.2, before[1], { timeout: 60_000 });
    assert.ok(await page.evaluate("reliefView.particles.system.info.alive") > 100);
    assert.equal(await page.evaluate("reliefView.pixelsNow().error"), 0);
    assert.equal(await page.locator("#message p").textContent(), "");
    assert.deepEqual(messages, []);
});

test("a world's bodies are drawn in their places, and colliders are uploaded once", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    const at = (name) => path.join(folder, name);
    execFileSync("python3", [path.join(root, "tests/cli/level.py"), at("level.gltf"), "floor=6"]);
    run("relief", "bake", at("level.gltf"), "--world", at("w"), "--budget", "200kB", "-q");
    run("relief", "view", at("w/world.json"), "-o", at("w.html"));
    const { page, messages } = await opened(t, at("w.html"));
    await page.waitForFunction("reliefView.view.bodies.length === 5", undefined, { timeout: 120_000 });
    const { places, colliders, error } = await page.evaluate(() => {
        reliefView.particles.paused = true;
        const { bodies } = reliefView.view;
        return { places: bodies.map((one) => [...one.model].slice(12, 15)), error: reliefView.pixelsNow().error,
                 colliders: new Set(bodies.map((one) => (one.body ?? one).collider)).size };
    });
    assert.deepEqual(places.map((place) => place.map((x) => Math.round(1000 * x) / 1000)),
                     [[0, -0.5, 0], [0, 0, 0], [5, 0, 5], [-5, 0.1, 5], [-5, 0, -5]]);
    assert.equal(colliders, 3);
    assert.equal(error, 0);
    assert.equal(await page.locator("#message p").textContent(), "");
    assert.deepEqual(messages, []);
});

test("clicks pick bodies; a check colours bodies and lists the worst; keys fly", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    const at = (name) => path.join(folder, name);
    execFileSync("python3", [path.join(root, "tests/cli/level.py"), at("level.gltf"), "floor=6"]);
    execFileSync("python3", [path.join(root, "tests/cli/level.py"), at("moved.gltf"), "floor=6", "x=1"]);
    run("relief", "bake", at("level.gltf"), "--world", at("w"), "--budget", "200kB", "-q");
    run("relief", "view", at("w/world.json"), "--mesh", at("moved.gltf"), "-q", "--samples", "5000", "-o", at("w.html"));
    const { page, messages } = await opened(t, at("w.html"));
    await page.waitForFunction("reliefView.bodies?.placed.length === 5", undefined, { timeout: 120_000 });
    await page.setViewportSize({ width: 900, height: 500 }); // moves the panel to the side
    await page.evaluate(() => {
        reliefView.particles.paused = true;
        reliefView.camera.look([16, 26, 32], [0, 0.5, 0]);
        reliefView.pixelsNow();
    });
    const click = async (place) => {
        const [x, y] = await page.evaluate((p) => {
            reliefView.worldPanel.pick(-1); // its card may cover the place
            const { clientWidth: width, clientHeight: height } = document.getElementById("canvas");
            const m = reliefView.camera.matrices(width, height).camera;
            const [a, b, , w] = [0, 1, 2, 3].map((i) => m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i]);
            return [(0.5 + 0.5 * a / w) * width, (0.5 - 0.5 * b / w) * height];
        }, place);
        await page.mouse.click(x, y);
        return [x, y];
    };
    const picked = () => page.evaluate("document.getElementById('picked').hidden ? '' : document.getElementById('picked-name').textContent");
    const middle = (i) => page.evaluate((n) => {
        const { model, box } = reliefView.bodies.placed[n];
        const c = box.center;
        return [0, 1, 2].map((k) => model[k] * c[0] + model[4 + k] * c[1] + model[8 + k] * c[2] + model[12 + k]);
    }, i);
    for (const [i, name] of ["ground", "first", "second", "third", "wide"].entries()) {
        await click(i === 0 ? [-1.5, 0, 0.5] : await middle(i));
        assert.equal(await picked(), name);
    }
    await click(await middle(1));
    const facts = await page.locator("#picked-facts").textContent();
    assert.match(facts, /^meshboxcolliderbox-[0-9a-f]+\.reliefsize[0-9.]+ kBscale1at0, 0, 0wrong points[1-9][0-9.]+ %$/);
    // Dragging rotates and picks nothing; the sky is not a body.
    const [x, y] = await click(await middle(1));
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 30, y);
    await page.mouse.up();
    assert.equal(await picked(), "first");
    await page.evaluate(() => {
        reliefView.look.floor = null;
        reliefView.camera.look([8, 3, 16], [0, 6, 0]);
        reliefView.pixelsNow();
    });
    await page.mouse.click(300, 60);
    assert.equal(await picked(), "");

    // Only the node that moved is red. The errors match relief check, with a picture of each.
    assert.ok(await page.isChecked("#wrong"));
    const [first, wide] = await page.evaluate("[1, 4].map((i) => reliefView.bodies.color(i))");
    assert.ok(first[0] > 0.8 && first[1] < 0.3 && wide[0] < 0.5, `${first} ${wide}`);
    const check = JSON.parse(run("relief", "check", at("w/world.json"), "--mesh", at("moved.gltf"), "--samples", "5000", "--json"));
    assert.equal(await page.locator("#bodies li").count(), check.accuracy.worst.length);
    await page.click("#bodies li:first-child button");
    assert.equal(await picked(), "first");
    assert.ok(await page.evaluate("document.querySelector('#bodies img').naturalWidth") > 300);
    assert.match(await page.locator("#bodies .place >> nth=0").textContent(), /Its pose in the world differs from the level: bake the level again\.$/);
    await page.click("#wrong + span");
    assert.equal(await page.evaluate("reliefView.bodies.color(4)"), undefined);

    // W flies forwards, D to the right; dragging then rotates the camera in place.
    const eye = () => page.evaluate(() => {
        const { eye, target, distance } = reliefView.camera;
        return { eye, ahead: target.map((v, k) => (v - eye[k]) / distance) };
    });
    const before = await eye();
    await page.keyboard.down("KeyW");
    await page.waitForFunction((from) => Math.hypot(...reliefView.camera.eye.map((v, k) => v - from[k])) > 0.2, before.eye, { timeout: 60_000 });
    await page.keyboard.up("KeyW");
    const after = await eye();
    const way = after.eye.map((v, k) => v - before.eye[k]);
    const along = way.reduce((sum, v, k) => sum + v * before.ahead[k], 0);
    assert.ok(along > 0.999 * Math.hypot(...way), `${way} is not ahead, ${before.ahead}`);
    await page.evaluate("reliefView.camera.orbit(0.5, 0)");
    const turned = await eye();
    assert.ok(Math.hypot(...turned.eye.map((v, k) => v - after.eye[k])) < 0.1, "the camera rotates in place");
    assert.ok(turned.ahead.reduce((sum, v, k) => sum + v * after.ahead[k], 0) < 0.95);
    assert.equal(await page.evaluate("reliefView.pixelsNow().error"), 0);
    assert.equal(await page.locator("#message p").textContent(), "");
    assert.deepEqual(messages, []);
});

test("a deforming body is drawn at each step", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    const at = (name) => path.join(folder, name);
    writeFileSync(at("box.obj"), boxes([{ low: [0, 0, 0], high: [1, 1, 1] }]));
    writeFileSync(at("s.toml"), `
[collider]
mesh = "box.obj"
deform = { amplitude = 0.3, frequency = 0.5 }
resolution = 32
[particles]
capacity = 1024
`);
    run("relief-sim", at("s.toml"), "--page", at("s.html"));
    const { page } = await opened(t, at("s.html"));
    await page.evaluate(() => (reliefView.particles.paused = true));
    const covered = () => page.evaluate(() => {
        const { data, error } = reliefView.pixelsNow();
        return { error, bright: [...data.keys()].filter((i) => i % 4 === 0 && data[i] > 110).length };
    });
    const before = await covered();
    assert.ok(before.bright > 2000, `${before.bright} pixels of the box`);
    // Some frames have passed before the pause, and two times may cover the same number of pixels: so it compares three
    // times.
    const counts = [before.bright];
    for (let i = 0; i < 2; ++i) {
        await page.evaluate(() => {
            for (let step = 0; step < 20; ++step) reliefView.particles.step();
        });
        const after = await covered();
        assert.equal(after.error, 0);
        counts.push(after.bright);
    }
    assert.ok(Math.max(...counts) - Math.min(...counts) > 50, `${counts} pixels`);
    assert.equal(await page.locator("#message p").textContent(), "");
});

test("fingers rotate and zoom", { timeout: 300_000 }, async (t) => {
    const [, , made] = viewSheet(scratch(t));
    const { page, messages } = await opened(t, made, { hasTouch: true });
    const camera = () => page.evaluate(() => ({ distance: reliefView.camera.distance, ...reliefView.camera.matrices(4, 3) }));
    const session = await page.context().newCDPSession(page);
    const touch = (type, ...points) => session.send("Input.dispatchTouchEvent",
                                                    { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    const before = await camera();
    await touch("touchStart", [150, 200]);
    await touch("touchMove", [210, 220]);
    await touch("touchEnd");
    const turned = await camera();
    assert.notDeepEqual(turned.eye, before.eye);
    assert.ok(Math.abs(turned.distance - before.distance) < 1e-3 * before.distance);
    await touch("touchStart", [150, 200], [250, 200]);
    await touch("touchMove", [100, 200], [300, 200]);
    await touch("touchEnd");
    const near = await camera();
    assert.ok(Math.abs(near.distance / turned.distance - 0.5) < 0.1, `${near.distance} of ${turned.distance}`);
    assert.deepEqual(messages, []);
});
