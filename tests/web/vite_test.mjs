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
import { bunny, run, scratch } from "./lib/native.mjs";

const kMain = `import { Relief, ParticleSystem } from "relief-particles";
const gl = document.querySelector("canvas").getContext("webgl2");
const collider = await Relief.load("cube.relief");
const system = new ParticleSystem(gl, { collider, scene: { particles: { capacity: 4096 } } });
for (let i = 0; i < 10; ++i) {
    system.step(1 / 60);
}
window.answer = { ...system.info, error: gl.getError() };
`;

const kVite = "vite@5.4.21";
const kQuiet = ["--no-audit", "--no-fund", "--loglevel=error", "--prefer-offline", "--ignore-scripts"];

test("npm pack, install and vite build give a working page", { timeout: 300_000 }, async (t) => {
    const folder = scratch(t);
    const npm = (...words) => execFileSync("npm", [...words, ...kQuiet], { cwd: folder, encoding: "utf8" });
    const [packed] = JSON.parse(npm("pack", path.join(root, "out/npm"), "--json"));
    assert.equal(packed.name, "relief-particles");
    assert.deepEqual(packed.files.map((file) => file.path).sort(), [
        "LICENSE", "README.md", "SCENE.md", "arguments.js", "collider.js", "context.js", "engines.d.ts", "engines.js", "fetch.js", "package.json", "particle_system.js",
        "pass_state.js", "relief.d.ts", "relief.js", "relief_wasm.mjs", "relief_wasm.wasm", "wasm.js", "world.js"]);
    writeFileSync(path.join(folder, "package.json"), '{ "name": "page", "private": true, "type": "module" }');
    npm("install", `./${packed.filename}`, kVite);
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

// As RELIEF.md of the export states it.
for (const engine of ["three", "playcanvas"]) {
    test(`vite build bundles the exported page of ${engine}`, { timeout: 600_000 }, async (t) => {
        const folder = scratch(t);
        const page = path.join(folder, "page");
        run("relief", "bake", bunny, "-q", "-o", path.join(folder, "bunny.relief"), "--budget", "20kB");
        run("relief", "export", path.join(folder, "bunny.relief"), "--engine", engine, page, "-q");
        const [, install] = /^ *npm (install .*)$/m.exec(readFileSync(path.join(page, "RELIEF.md"), "utf8"));
        execFileSync("npm", [...install.split(" "), kVite, ...kQuiet], { cwd: page });
        execFileSync(process.execPath, ["node_modules/vite/bin/vite.js", "build", "--logLevel", "error"], { cwd: page });
        const server = await serve({ "/": path.join(page, "dist") });
        const browser = await launch();
        t.after(async () => {
            await browser.close();
            server.close();
        });
        const { page: opened, messages } = await openPage(browser, `${server.url}/?webgl`);
        await opened.waitForFunction("window.sample || document.getElementById('note').textContent");
        const places = await opened.evaluate("window.sample.read()");
        assert.ok(Object.keys(places).length >= 400_000 && Object.values(places).every(Number.isFinite));
        assert.deepEqual(messages.filter((line) => !line.includes("GPU stall due to ReadPixels")), []);
    });
}
