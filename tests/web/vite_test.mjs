// SPDX-License-Identifier: Apache-2.0
// The package as web developers use it: packed by npm, installed into a new folder with Vite, bundled, and played.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { once } from "node:events";
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { launch, openPage, root, serve } from "./lib/browser.mjs";
import { bakeCube } from "./lib/boxes.mjs";
import { scratch } from "./lib/native.mjs";

const kMain = `import { Relief, ParticleSystem } from "relief-particles";
const gl = document.querySelector("canvas").getContext("webgl2");
const collider = await Relief.load("cube.relief");
const system = new ParticleSystem(gl, { collider, scene: { particles: { capacity: 4096 } } });
for (let i = 0; i < 10; ++i) {
    system.step(1 / 60);
}
window.answer = { ...system.info, error: gl.getError() };
`;

test("npm pack, install and vite build give a working page", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    const npm = (...words) => execFileSync("npm", [...words, "--no-audit", "--no-fund", "--loglevel=error"],
                                           { cwd: folder, encoding: "utf8" });
    const [packed] = JSON.parse(npm("pack", path.join(root, "out/npm"), "--json"));
    assert.equal(packed.name, "relief-particles");
    assert.deepEqual(packed.files.map((file) => file.path).sort(), [
        "LICENSE", "README.md", "SCENE.md", "arguments.js", "collider.js", "context.js", "fetch.js", "package.json", "particle_system.js",
        "pass_state.js", "relief.d.ts", "relief.js", "relief_wasm.mjs", "relief_wasm.wasm", "wasm.js", "world.js"]);
    writeFileSync(path.join(folder, "package.json"), '{ "name": "page", "private": true, "type": "module" }');
    npm("install", "--prefer-offline", "--ignore-scripts", `./${packed.filename}`, "vite@5.4.21");
    const installed = path.join(folder, "node_modules/relief-particles");
    for (const name of readdirSync(installed).filter((one) => one.endsWith(".md"))) {
        for (const [, target] of readFileSync(path.join(installed, name), "utf8").matchAll(/\]\(([^)\s#]+)/g)) {
            assert.ok(existsSync(path.join(installed, target)), `${name} links to ${target}, which is not in the package`);
        }
    }
    writeFileSync(path.join(folder, "index.html"), `<!doctype html><link rel="icon" href="data:,"><title>A page</title><canvas></canvas>
<script type="module" src="/main.js"></script>`);
    writeFileSync(path.join(folder, "main.js"), kMain);
    mkdirSync(path.join(folder, "public"));
    bakeCube(folder);
    cpSync(path.join(folder, "cube.relief"), path.join(folder, "public/cube.relief"));
    execFileSync(process.execPath, ["node_modules/vite/bin/vite.js", "build", "--target", "es2022", "--logLevel", "warn"],
                 { cwd: folder });

    // The development server without settings for this package: it may reload the page after it has found all modules.
    const development = spawn(process.execPath, ["node_modules/vite/bin/vite.js", "--host", "127.0.0.1", "--logLevel", "info"],
                              { cwd: folder, env: { ...process.env, NO_COLOR: "1" } });
    t.after(() => development.kill());
    let output = "";
    while (!/127\.0\.0\.1:\d+/.test(output)) {
        output += String((await once(development.stdout, "data"))[0]);
    }
    const server = await serve({ "/": path.join(folder, "dist") });
    const browser = await launch();
    t.after(async () => {
        await browser.close();
        server.close();
    });
    for (const url of [server.url, `http://${/127\.0\.0\.1:\d+/.exec(output)[0]}`]) {
        const { page, messages } = await openPage(browser, url);
        await page.waitForFunction("window.answer", undefined, { timeout: 120_000 });
        const answer = await page.evaluate("window.answer");
        assert.ok(answer.alive > 50, `${answer.alive} particles`);
        assert.equal(answer.time.toFixed(3), "0.167");
        assert.equal(answer.error, 0);
        assert.deepEqual(messages.filter((line) => !/\[vite\]/.test(line)), []);
    }
});
