// SPDX-License-Identifier: Apache-2.0
// A scene drawn from its meshes in a browser: the same picture as in relief-sim, with snow and footprints; and the page
// of such a scene.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { boxes } from "./lib/boxes.mjs";
import { root, pageMessages } from "./lib/browser.mjs";
import { libraryPage } from "./lib/library.mjs";
import { run, scratch } from "./lib/native.mjs";
import { dataOf, viewer, withData } from "./lib/view.mjs";

const kSteps = 60;
const [kWidth, kHeight] = [320, 180];

// A figure walks over green ground past a red block while it starts to snow.
const kScene = `
[[collider]]
file = "ground.relief"
[[collider]]
file = "block.relief"
[[collider]]
file = "walker.relief"
play = { clip = "walk", resolution = 64 }
color = [0.1, 0.2, 0.9]
[[collider.key]]
time = 0.0
[[collider.key]]
time = 1.0
position = [0.0, 0.0, 1.3]
[time]
dt = 0.016666667
steps = ${kSteps}
[particles]
capacity = 64
[emitter]
rate = 1
start = 50
box_min = [0, 5, 0]
box_max = [1, 6, 1]
[ground]
enabled = false
[camera]
[[camera.key]]
time = 0.0
eye = [2.5, 3.0, 4.5]
target = [0.0, 0.5, 0.5]
[[camera.key]]
time = 1.0
eye = [2.0, 3.0, 4.5]
target = [0.0, 0.5, 0.5]
[render]
size = [${kWidth}, ${kHeight}]
meshes = "meshes"
first_frame = 0
steps_per_frame = ${kSteps}
[[render.weather]]
time = 0.2
[[render.weather]]
time = 0.5
sun = 0.5
snow = 1.0
`;

function makeScene(folder) {
    mkdirSync(path.join(folder, "meshes"));
    writeFileSync(path.join(folder, "meshes/ground.obj"), boxes([{ low: [-4, -0.5, -4], high: [4, 0, 4], color: [0.3, 0.5, 0.2] }]));
    writeFileSync(path.join(folder, "meshes/block.obj"), boxes([{ low: [-2, 0, -1], high: [-1, 1, 0], color: [0.8, 0.05, 0.05] }]));
    for (const name of ["ground", "block"]) {
        run("relief", "bake", path.join(folder, `meshes/${name}.obj`), "-q", "-o", path.join(folder, `${name}.relief`), "--budget", "20kB");
    }
    execFileSync("python3", [path.join(root, "samples/walker.py"), path.join(folder, "walker.gltf")]);
    run("relief", "bake", path.join(folder, "walker.gltf"), "-q", "--animated", "-o", path.join(folder, "walker.relief"), "--resolution", "64");
    writeFileSync(path.join(folder, "scene.toml"), kScene);
}

test("a scene drawn from its meshes looks as in relief-sim", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    makeScene(folder);
    run("relief-sim", path.join(folder, "scene.toml"), "-q", "--frames", path.join(folder, "frames"));
    const { page, messages } = await libraryPage(t, folder);
    const got = await page.evaluate(async ([text, steps, width, height]) => {
        const bytes = async (name) => new Uint8Array(await (await fetch(`/files/${name}`)).arrayBuffer());
        const names = ["ground.relief", "block.relief", "walker.relief", "meshes/ground.obj", "meshes/block.obj"];
        const files = Object.fromEntries(await Promise.all(names.map(async (name) => [name, await bytes(name)])));
        await relief.init();
        const system = new relief.ParticleSystem(gl, { scene: text, files });
        const unit = (v) => v.map((x) => x / Math.hypot(...v));
        const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        /** The scene's current camera. */
        const camera = () => {
            const { eye, target, fov } = system.info.camera;
            const back = unit(eye.map((x, k) => x - target[k]));
            const right = unit(cross([0, 1, 0], back));
            const up = cross(back, right);
            const [near, far] = [0.05, 200];
            const tall = 1 / Math.tan(0.5 * fov * Math.PI / 180);
            return {
                view: [right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
                       -dot(right, eye), -dot(up, eye), -dot(back, eye), 1],
                projection: [tall * height / width, 0, 0, 0, 0, tall, 0, 0, 0, 0, (far + near) / (near - far), -1,
                             0, 0, 2 * far * near / (near - far), 0],
            };
        };
        // At twice the resolution, because frames of relief-sim average 2 x 2 pixels.
        const color = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, color);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, 2 * width, 2 * height);
        const depth = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, depth);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, 2 * width, 2 * height);
        const framebuffer = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, color, 0);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, depth, 0);
        const drawn = () => {
            system.drawMeshes({ ...camera(), framebuffer, width: 2 * width, height: 2 * height });
            const fine = new Uint8Array(16 * width * height);
            gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
            gl.readPixels(0, 0, 2 * width, 2 * height, gl.RGBA, gl.UNSIGNED_BYTE, fine);
            const mean = [];
            for (let y = height - 1; y >= 0; --y) {
                for (let x = 0; x < width; ++x) {
                    const at = 4 * (4 * width * y + 2 * x);
                    for (let k = 0; k < 3; ++k) {
                        mean.push((fine[at + k] + fine[at + 4 + k] + fine[at + 8 * width + k] + fine[at + 8 * width + 4 + k]) / 4);
                    }
                }
            }
            return mean;
        };
        const native = async (i) => {
            const image = await createImageBitmap(new Blob([await bytes(`frames/frame_000${i}.png`)]), { colorSpaceConversion: "none" });
            const context = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d");
            context.drawImage(image, 0, 0);
            const { data } = context.getImageData(0, 0, width, height);
            return data.filter((_, i) => i % 4 < 3);
        };
        /** The number of different pixels, and the mean difference per channel. */
        const compare = (a, b) => {
            let [pixels, sum] = [0, 0];
            for (let i = 0; i < a.length; i += 3) {
                const off = [0, 1, 2].map((k) => Math.abs(a[i + k] - b[i + k]));
                pixels += Math.max(...off) > 24;
                sum += off[0] + off[1] + off[2];
            }
            return [pixels, sum / a.length];
        };
        const first = drawn();
        for (let i = 0; i < steps; ++i) {
            system.step();
        }
        const last = drawn(); // with the footprints of all steps in between
        system.restart();
        const again = drawn();
        const plain = new relief.ParticleSystem(gl, { scene: { collider: { file: "g.relief" } }, files: { "g.relief": files["ground.relief"] } });
        let refused = "";
        try {
            plain.drawMeshes({ ...camera(), width, height });
        } catch (error) {
            refused = error.message;
        }
        return { meshes: system.info.meshes, without: plain.info.meshes, refused, first: compare(first, await native(0)), last: compare(last, await native(1)),
                 changed: compare(first, last), again: compare(first, again), gl: gl.getError() };
    }, [kScene, kSteps, kWidth, kHeight]);
    t.diagnostic(`different pixels and mean difference: first ${got.first}, last ${got.last}, between them ${got.changed}`);
    assert.equal(got.meshes, true);
    assert.equal(got.without, false);
    assert.match(got.refused, /needs render\.meshes/);
    for (const [pixels, mean] of [got.first, got.last]) {
        assert.ok(pixels < 0.01 * kWidth * kHeight && mean < 1.5, `${pixels} pixels, ${mean}`);
    }
    assert.ok(got.changed[0] > 0.2 * kWidth * kHeight, "snow covers the ground");
    assert.deepEqual(got.again, [0, 0]); // nothing remains of the previous run
    assert.equal(got.gl, 0);
    assert.deepEqual(pageMessages(messages), []);
});

test("the page draws a scene from its meshes or its maps", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    makeScene(folder);
    run("relief-sim", path.join(folder, "scene.toml"), "-q", "--page", path.join(folder, "made.html"));
    const made = dataOf(path.join(folder, "made.html"));
    assert.equal(Buffer.from(made.files["meshes/block.obj"], "base64").toString(), readFileSync(path.join(folder, "meshes/block.obj"), "utf8"));
    const open = await viewer(t);
    const { page, messages } = await open(path.join(folder, "made.html"), { viewport: { width: 480, height: 300 }, colorScheme: "light" });
    const shares = () => page.evaluate(() => {
        reliefView.particles.paused = true;
        const { data, error } = reliefView.pixelsNow();
        let [red, blue] = [0, 0];
        for (let i = 0; i < data.length; i += 4) {
            red += data[i] > 2 * data[i + 1] && data[i] > 2 * data[i + 2] && data[i] > 60;
            blue += data[i + 2] > 1.5 * data[i] && data[i + 2] > 1.3 * data[i + 1] && data[i + 2] > 60;
        }
        return { red, blue, error };
    });
    const pixels = 480 * 300;
    // The camera is the scene's until the user moves it; near geometry is not clipped.
    const eye = () => page.evaluate("reliefView.camera.eye");
    const picture = await shares();
    const wanted = () => page.evaluate("reliefView.particles.system.info.camera.eye");
    const off = (a, b) => Math.hypot(...a.map((v, k) => v - b[k]));
    assert.ok(off(await eye(), await wanted()) < 1e-5 && off(await wanted(), [2.5, 3, 4.5]) < 0.2);
    assert.ok(picture.red > 0.005 * pixels && picture.blue > 0.002 * pixels, JSON.stringify(picture));
    await page.click("#tab-view");
    assert.ok(await page.locator("#show-picture").isVisible());
    assert.ok(!await page.locator("#show-mesh").isVisible());
    // A click also finds the block in the picture.
    await page.evaluate(() => reliefView.worldPanel.pick(reliefView.bodies.at(reliefView.view.kept, reliefView.camera.matrices(480, 300), 0.5, 0.5)));
    assert.notEqual(await page.locator("#picked-name").textContent(), "");
    await page.click("#show-surface span");
    const maps = await shares();
    assert.ok(maps.red === 0 && maps.error === 0, JSON.stringify(maps));
    await page.click("#show-picture span");
    assert.ok((await shares()).red > 0.005 * pixels);
    const after = async (steps) => {
        await page.evaluate((n) => {
            for (let i = 0; i < n; ++i) {
                reliefView.particles.step();
            }
            reliefView.pixelsNow();
        }, steps);
        return eye();
    };
    const before = await eye();
    const moved = await after(30);
    assert.ok(off(moved, before) > 0.2 && off(moved, await wanted()) < 1e-5);
    await page.evaluate("reliefView.camera.orbit(0.5, 0)");
    const taken = await eye();
    assert.deepEqual(await after(10), taken);
    // A slice shows the maps. After a restart the camera is the scene's again.
    await page.evaluate("document.getElementById('slice-on').click()");
    assert.equal(await page.evaluate("reliefView.look.show"), "surface");
    await page.evaluate("reliefView.restart()");
    assert.ok(off(await after(5), await wanted()) < 1e-5);
    assert.equal(await page.locator("#message p").textContent(), "");
    assert.deepEqual(pageMessages(messages), []);

    // The tool names a missing mesh, and so does a page whose data lacks it.
    delete made.files["meshes/block.obj"];
    const broken = await open(withData(path.join(folder, "made.html"), made), { viewport: { width: 480, height: 300 } });
    await broken.page.waitForFunction("document.querySelector('#message p').textContent !== ''");
    assert.match(await broken.page.locator("#message p").textContent(), /render\.meshes: .*has no mesh 'block\.ply' or 'block\.obj'/);
    assert.equal(await broken.page.evaluate("reliefView.look.show"), "surface");
    writeFileSync(path.join(folder, "meshes/block.obj"), "v 0 0\n");
    assert.throws(() => run("relief-sim", path.join(folder, "scene.toml"), "-q", "--page", path.join(folder, "other.html")), /block\.obj/);
});
