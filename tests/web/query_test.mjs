// SPDX-License-Identifier: Apache-2.0
// Queries a collider of every format at 10,000 points in the browser. The same C++ as WebAssembly must give exactly the
// results of the native tool; the WebGL2 shader is compared with a tolerance.
// Tolerance of the shader: distances within 1e-5 of the box's longest side and normals within 1e-5, except for one in
// 1,000 points, which may be at a texel's edge and fall into the neighbour.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { libraryPage } from "./lib/library.mjs";
import { bunny, run, scratch } from "./lib/native.mjs";
import { generator } from "./lib/random.mjs";

const kPoints = 10_000;
const kColliders = {
    planned: "--budget 200kB",
    paper: "--paper --resolution 128",
    float: "--resolution 128 --decode projected --map float:dir=+x",
    "float plane": "--resolution 128 --map float:dir=-y,compare=greater,up=1/2/3",
    fixed8: "--resolution 128 --decode projected --map fixed8:dir=+z",
    "fixed8 plane": "--resolution 128 --map fixed8:dir=1/2/3,compare=greater",
    "front-back of halfs": "--resolution 128 --decode projected --depth half --map front-back:dir=-z",
    "front-back": "--resolution 128 --map front-back:dir=-z",
    patches: "--map patches:budget=100kB",
    cube: "--resolution 128 --decode projected --map cube:compare=greater",
    "cube from outside": "--resolution 128 --map cube:center=0/10/0,compare=less",
    "all of them, as zstd": "--compress 19 --map float:dir=+x,size=128 --map fixed8:dir=-y,size=128 " +
        "--map front-back:dir=1/1/1,size=100x50 --map cube:size=32 --map cube:size=48,decode=projected --map patches:budget=20kB",
};

function writePoints(file) {
    const vertices = readFileSync(bunny, "utf8").split("\n").filter((line) => line.startsWith("v "))
        .map((line) => line.split(/\s+/).slice(1, 4).map(Number));
    const low = [0, 1, 2].map((i) => Math.min(...vertices.map((v) => v[i])));
    const high = [0, 1, 2].map((i) => Math.max(...vertices.map((v) => v[i])));
    const random = generator(5);
    const points = Array.from({ length: kPoints }, () =>
        low.map((from, i) => Math.fround(from + (1.2 * random() - 0.1) * (high[i] - from))));
    writeFileSync(file, `x,y,z\n${points.map((p) => p.join(",")).join("\n")}\n`);
    return { points: points.flat(), side: Math.max(...high.map((to, i) => to - low[i])) };
}

/** A line of `relief query` as numbers; NaN if no map votes. */
function nativeSample(line) {
    const [, , , f, x, y, z, map] = line.split(",");
    return { distance: f === "" ? NaN : Number(f), normal: [x, y, z].map(Number), map: map === "" ? -1 : Number(map) };
}

const sampleAt = ({ distance, normal, map }, i) =>
    ({ distance: distance[i], normal: normal.slice(3 * i, 3 * i + 3), map: map[i] });

function differs(a, b, lengths, normals) {
    if (a.map !== b.map) {
        return true;
    }
    const far = (d) => !(Math.abs(d) < 1e29);
    return a.map >= 0 && !(far(a.distance) && far(b.distance)) &&
        (Math.abs(a.distance - b.distance) > lengths ||
         a.normal.some((value, i) => Math.abs(value - b.normal[i]) > normals));
}

test("10,000 queries match the native tool", { timeout: 120_000 }, async (t) => {
    const folder = scratch(t);
    const { points, side } = writePoints(path.join(folder, "points.csv"));
    const { page, messages } = await libraryPage(t, folder);
    for (const [name, options] of Object.entries(kColliders)) {
        const file = path.join(folder, "body.relief");
        run("relief", "bake", bunny, "-q", "-o", file, ...options.split(" "));
        const native = run("relief", "query", file, "--points", path.join(folder, "points.csv"), "-o", "-",
                           "--distance", "plane").trim().split("\n").slice(1).map(nativeSample);
        assert.equal(native.length, kPoints);
        const [cpu, gpu, error] = await page.evaluate(async (at) => {
            const { gpuQuery } = await import("/gpu_query.js");
            const collider = await relief.load("/files/body.relief");
            const gpu = new relief.GpuCollider(gl, collider);
            const plain = ({ distance, normal, map }) => ({ distance: [...distance], normal: [...normal], map: [...map] });
            const answers = [plain(collider.query(at)), gpuQuery(gl, gpu, at), gl.getError()];
            gpu.dispose();
            collider.dispose();
            return answers;
        }, points);
        assert.equal(error, 0, `${name}: a GL error`);
        const votes = native.filter((sample) => sample.map >= 0 && Math.abs(sample.distance) < side).length;
        const inside = native.filter((sample) => sample.distance < 0).length;
        assert.ok(votes > 1000 && inside > 300, `${name}: ${votes} distances, ${inside} inside`);
        const wrong = native.filter((sample, i) => differs(sampleAt(cpu, i), sample, 1e-7 * side, 1e-7)).length;
        assert.equal(wrong, 0, `${name}: WebAssembly differs at ${wrong} points`);
        const apart = native.filter((sample, i) => differs(sampleAt(gpu, i), sample, 1e-5 * side, 1e-5)).length;
        t.diagnostic(`${name}: ${votes} distances, ${inside} inside, the shader differs at ${apart}`);
        assert.ok(apart <= kPoints / 1000, `${name}: the shader differs at ${apart} points`);
    }
    assert.deepEqual(messages, []);
});
