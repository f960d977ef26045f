// SPDX-License-Identifier: Apache-2.0
// The page of one collider, which needs no web build. Compares its picture with closed forms of a ball and a cube, and
// its shaders with `relief query`, for each kind of map.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { gpuQuery } from "./lib/gpu_query.js";
import { run, scratch } from "./lib/native.mjs";
import { generator } from "./lib/random.mjs";
import { keptDepths, openFile, viewer } from "./lib/view.mjs";

const animated = "/usr/share/assimp/models/glTF2/glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf";

/** A ball of radius 1 as OBJ. */
function ball(rows) {
    const points = [];
    const faces = [];
    const at = (j, i) => 1 + j * 2 * rows + i % (2 * rows);
    for (let j = 0; j <= rows; ++j) {
        for (let i = 0; i < 2 * rows; ++i) {
            const [a, b] = [Math.PI * j / rows, Math.PI * i / rows];
            points.push(`v ${Math.sin(a) * Math.cos(b)} ${Math.cos(a)} ${-Math.sin(a) * Math.sin(b)}\n`);
            faces.push(...(j === rows ? [] : [`f ${at(j, i)} ${at(j + 1, i)} ${at(j + 1, i + 1)}\n`, `f ${at(j, i)} ${at(j + 1, i + 1)} ${at(j, i + 1)}\n`]));
        }
    }
    return points.join("") + faces.join("");
}

/** Runs in the page. Compares rays through pixels with a ball of radius 1, or a box with these half sides. */
function compare({ half, step }) {
    const { gl, body, camera, look, panel, view } = reliefView;
    look.floor = null;
    document.getElementById("panel").hidden = document.getElementById("title").hidden = true; // they cover the picture
    panel.frame();
    const { data, width, height, error } = reliefView.pixelsNow();
    const depths = keptDepths(reliefView);
    const fine = view.kept.width / width;
    const program = body.use("surface").name;
    const [eye, key, base, sky, earth] = ["u_eye", "u_key", "u_base", "u_sky", "u_earth"].map((name) => gl.getUniform(program, gl.getUniformLocation(program, name)));
    const { view: V, projection: P } = camera.matrices(width, height);
    const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const unit = (a) => a.map((v) => v / Math.hypot(...a));
    const hitBall = (d) => {
        const [a, b, c] = [dot(d, d), dot(d, eye), dot(eye, eye) - 1];
        const root = b * b - a * c;
        const t = (-b - Math.sqrt(root)) / a;
        return root > 0 ? { t, n: d.map((v, k) => eye[k] + t * v) } : null;
    };
    const hitBox = (d) => {
        const [enters, leaves] = [-1, 1].map((way) => d.map((v, k) => (way * Math.sign(v) * half[k] - eye[k]) / v));
        const t = Math.max(...enters);
        const axis = enters.indexOf(t);
        return t < Math.min(...leaves) ? { t, n: d.map((v, k) => (k === axis ? -Math.sign(v) : 0)) } : null;
    };
    const cast = (px, py) => {
        const [x, y] = [(2 * px / width - 1 + P[8]) / P[0], (2 * py / height - 1 + P[9]) / P[5]];
        const d = [0, 1, 2].map((k) => x * V[4 * k] + y * V[4 * k + 1] - V[4 * k + 2]);
        return { d, hit: half ? hitBox(d) : hitBall(d) };
    };
    // As in body_shaders.js.
    const shade = (n, d) => {
        const to_eye = unit(d.map((v) => -v));
        const lit = Math.max(dot(n, key), 0);
        const rim = (1 - Math.max(dot(n, to_eye), 0)) ** 3;
        const shine = Math.max(dot(n, unit(to_eye.map((v, k) => v + key[k]))), 0) ** 40;
        return [0, 1, 2].map((k) => {
            const around = earth[k] + (sky[k] - earth[k]) * (0.5 + 0.5 * n[1]);
            return 255 * Math.min(Math.max(base[k] * (around + 0.62 * lit) + 0.1 * rim * sky[k] + 0.06 * shine, 0), 1);
        });
    };
    const found = { error, hits: 0, misses: 0, wrong: 0, depth: 0, off: 0 };
    for (let py = 2; py < height - 2; py += step) {
        for (let px = 2; px < width - 2; px += step) {
            const { d, hit } = cast(px + 0.5, py + 0.5);
            const around = [[-2, -2], [2, -2], [-2, 2], [2, 2]].map(([a, b]) => cast(px + 0.5 + a, py + 0.5 + b).hit);
            if (around.some((one) => !one !== !hit || (hit && dot(one.n, hit.n) < 0.8))) {
                continue; // at an edge or the outline
            }
            const z = 2 * depths[fine * (py * fine * width + px)] - 1;
            found.wrong += z < 1 - 1e-6 !== Boolean(hit);
            found[hit ? "hits" : "misses"] += 1;
            if (hit && z < 1 - 1e-6) {
                found.depth = Math.max(found.depth, Math.abs(P[14] / (z + P[10]) - hit.t));
                const at = 4 * (py * width + px);
                found.off += shade(hit.n, d).some((v, k) => Math.abs(v - data[at + k]) > 8);
            }
        }
    }
    return found;
}

test("balls and cubes are drawn in the right place with the right light", { timeout: 120_000 }, async (t) => {
    const folder = scratch(t);
    const at = (name) => path.join(folder, name);
    writeFileSync(at("ball.obj"), ball(64));
    const open = await viewer(t);
    for (const [name, half, mesh, ...options] of [["ball", null, at("ball.obj"), "--budget", "60kB"],
                                            ["front-back", null, at("ball.obj"), "--holes", "keep", "--resolution", "64"],
                                            ["cube, at rest", [1, 1, 1], animated, "--animated", "--resolution", "64"]]) {
        run("relief", "bake", mesh, "-q", "-o", at(`${name}.relief`), ...options);
        run("relief", "view", at(`${name}.relief`));
        const { page, messages } = await open(at(`${name}.html`), { viewport: { width: 240, height: 180 } });
        assert.equal(await page.locator("#message p").textContent(), "");
        assert.equal(/, at rest$/.test(await page.locator("#facts").textContent()), mesh === animated);
        await page.evaluate(`window.keptDepths = ${keptDepths}`);
        const found = await page.evaluate(compare, { half, step: 3 });
        t.diagnostic(`${name}: ${JSON.stringify(found)}`);
        assert.equal(found.error, 0);
        assert.equal(found.wrong, 0, `${found.wrong} rays`);
        assert.ok(found.hits > 300 && found.misses > 300, name);
        assert.ok(found.depth < 0.04, `${name}: depth error ${found.depth}`);
        assert.ok(found.off < 0.01 * found.hits, `${name}: ${found.off} of ${found.hits} colours differ by more than 8 of 255`);
        assert.deepEqual(messages, []);
    }
});

test("the shaders of a page match relief query, for each kind of map", { timeout: 120_000 }, async (t) => {
    const folder = scratch(t);
    const at = (name) => path.join(folder, name);
    writeFileSync(at("ball.obj"), ball(16));
    const kinds = ["float:dir=+x,size=32", "fixed8:dir=-z,size=32", "cube:size=16", "front-back:dir=+y,size=32", "patches:budget=10kB"];
    run("relief", "bake", at("ball.obj"), "-q", "-o", at("kinds.relief"), ...kinds.flatMap((map) => ["--map", map]));
    run("relief", "view", at("kinds.relief"));
    const random = generator(1);
    const points = Array.from({ length: 3 * 2000 }, () => Math.fround(2.4 * random() - 1.2));
    const rows = points.flatMap((_, i) => (i % 3 === 0 ? [points.slice(i, i + 3).join(",")] : []));
    writeFileSync(at("points.csv"), `${rows.join("\n")}\n`);
    const answers = run("relief", "query", at("kinds.relief"), "--points", at("points.csv"), "-o", "-", "--distance", "plane").trim().split("\n").slice(1)
        .map((line) => line.split(",").map((word) => (word === "inf" ? 1e30 : Number(word))));
    const { page } = await openFile(t, at("kinds.html"), { viewport: { width: 200, height: 150 } });
    await page.evaluate(`window.gpuQuery = ${gpuQuery}`);
    const { distance, normal, map } = await page.evaluate((list) => {
        reliefView.gl.getExtension("EXT_color_buffer_float"); // to read float textures
        return gpuQuery(reliefView.gl, reliefView.body.gpu, list);
    }, points);
    assert.equal(answers.length, distance.length);
    const unlike = answers.filter(([, , , f, x, y, z, decides], i) => map[i] !== decides || Math.abs(f - distance[i]) > 1e-4 * Math.max(1, Math.abs(f)) ||
        Math.hypot(...[x, y, z].map((v, k) => v - normal[3 * i + k])) > 1e-3);
    assert.ok(unlike.length < 5, `${unlike.length} of ${answers.length} points, the first ${unlike[0]}`); // ties, by rounding
    assert.deepEqual([...new Set(map)].filter((i) => i >= 0).sort(), [0, 1, 2, 3, 4]);
});
