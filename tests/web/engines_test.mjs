// SPDX-License-Identifier: Apache-2.0
// relief-particles/collider: a collider without WebAssembly. The reference is the C++ library, through `relief`.
// Damaged containers get the verdict of `relief check`; distances in JavaScript are the floats of `relief query`; the
// shader texts run in Chromium, with these tolerances:
//   - no distance has another sign;
//   - distances differ by at most kUlps units in the last place of the greater of the distance and the root cell;
//   - components of normals differ by at most kNormals; those of places and velocities after a contact by kMotion times
//     the distances from the origin and from the surface.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import path from "node:path";
import test, { after, before } from "node:test";
import { gzipSync } from "node:zlib";

import { collide, distance, openCollider } from "../../out/npm/engines.js";
import { launch, modules, openPage, root, serve } from "./lib/browser.mjs";
import { bin, bunny, run, scratch } from "./lib/native.mjs";
import { generator } from "./lib/random.mjs";
import { containerOf, randomTree, seal, writeTrees } from "./lib/trees.mjs";

const kPoints = 10_000; // per collider
const kUlps = 4;
const kNormals = 1e-6;
const kMotion = 1e-6;
const kFar = Math.fround(1e30);
const kBytesMax = 15_000;
const { decompress: unzstd } = createRequire(path.join(modules, "index.js"))("fzstd");
const decompress = (packed, size) => unzstd(packed, new Uint8Array(size));

/** Ten colliders with points in and around them: trees of every kind of leaf, and baked meshes. */
function makeColliders(folder) {
    const made = writeTrees(folder);
    for (const mesh of ["bunny.obj", "horse.3ds", "cat.3ds"]) {
        made.push(`${mesh}.relief`);
        run("relief", "bake", path.join(path.dirname(bunny), mesh), "-q", "-o", path.join(folder, made.at(-1)), "--budget", "50kB");
    }
    return made.map((name, k) => {
        const file = path.join(folder, name);
        const random = generator(k);
        const { floats } = openCollider(readFileSync(file));
        // Points in map space, a little beyond the roots, through the inverse of a rotation with scale.
        const inMap = () => [0, 1, 2].map((i) => (1.1 * random() - 0.05) * floats[13 + i] - floats[4 * i + 3]);
        const points = Array.from({ length: kPoints }, inMap).flatMap((q) => [0, 1, 2].map((i) => Math.fround(
            floats[12] ** 2 * (floats[i] * q[0] + floats[4 + i] * q[1] + floats[8 + i] * q[2]))));
        writeFileSync(`${file}.points`, Float32Array.from(points));
        return { name, file, points };
    });
}

/** Distance and normal of each point by the C++ library: four floats each. */
function reference({ file, points }) {
    const lines = Array.from({ length: points.length / 3 }, (_, i) => points.slice(3 * i, 3 * i + 3).join(","));
    writeFileSync(`${file}.csv`, lines.join("\n"));
    return run("relief", "query", file, "--points", `${file}.csv`, "-o", "-", "--distance", "plane").trim().split("\n").slice(1)
        .map((line) => line.split(",").slice(3, 7).map(Number)).flatMap(([f, ...normal]) => [...normal, Number.isFinite(f) ? f : kFar]);
}

test("the module is small, needs no WebAssembly, and has the texts of shaders/engines", async () => {
    const text = readFileSync(path.join(root, "out/npm/engines.js"));
    assert.ok(gzipSync(text, { level: 9 }).length <= kBytesMax, `${gzipSync(text, { level: 9 }).length} bytes`);
    assert.doesNotMatch(text.toString(), /WebAssembly|^import/m);
    const sources = await import("../../out/npm/engines.js");
    for (const name of ["glsl", "wgsl"]) {
        assert.equal(sources[name], readFileSync(path.join(root, `shaders/engines/relief.${name}`), "utf8"));
    }
});

const folder = mkdtempSync(path.join(tmpdir(), "relief-engines-"));
let colliders = [];
before(() => (colliders = makeColliders(folder).map((one) => ({ ...one, expected: reference(one) }))));
after(() => rmSync(folder, { recursive: true, force: true }));

test("distances in JavaScript are the floats of the C++ library", { timeout: 300_000 }, () => {
    for (const { name, file, points, expected } of colliders) {
        const collider = openCollider(readFileSync(file));
        const normal = new Float32Array(3);
        let differ = 0;
        for (let i = 0; i < kPoints; ++i) {
            const d = distance(collider, points.slice(3 * i, 3 * i + 3), normal);
            differ += [...normal, d].some((value, k) => value !== Math.fround(expected[4 * i + k])) ? 1 : 0;
        }
        assert.equal(differ, 0, `${name}: ${differ} points differ`);
    }
});

for (const [language, runs] of [["WGSL", "onWebGpu"], ["GLSL", "onWebGl"]]) {
    test(`${language} in Chromium agrees with the C++ library`, { timeout: 300_000 }, async (t) => {
        const server = await serve({ "/": path.join(root, "tests/web/lib"), "/files": folder, "/package": path.join(root, "out/npm") });
        const browser = await launch(["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"]);
        t.after(async () => {
            await browser.close();
            server.close();
        });
        const { page, messages } = await openPage(browser, `${server.url}/blank.html`);
        const { texts, contact } = await page.evaluate(async ([name, files]) => {
            const queries = await import("/engine_queries.js");
            return { texts: await queries[name](files), contact: queries.kContact };
        }, [runs, colliders.map(({ name }) => `/files/${name}`)]);
        for (const [k, { name, file, points, expected }] of colliders.entries()) {
            const collider = openCollider(readFileSync(file));
            const root = collider.floats[12];
            const answers = new Float32Array(Uint8Array.from(Buffer.from(texts[k], "base64")).buffer);
            assert.equal(answers.length, 12 * kPoints);
            const worst = { signs: 0, ulps: 0, normal: 0, motion: 0 };
            const count = { inside: 0, hits: 0, cells: 0 };
            for (let i = 0; i < kPoints; ++i) {
                const p = points.slice(3 * i, 3 * i + 3);
                const answer = answers.subarray(12 * i, 12 * i + 12);
                const [normal, d] = [expected.slice(4 * i, 4 * i + 3), expected[4 * i + 3]];
                const ulp = 2 ** (Math.floor(Math.log2(Math.max(Math.abs(d), root))) - 23);
                worst.signs += answer[3] < 0 !== d < 0 ? 1 : 0;
                worst.ulps = Math.max(worst.ulps, Math.abs(answer[3] - d) / ulp);
                worst.normal = Math.max(worst.normal, ...normal.map((value, j) => Math.abs(value - answer[j])));
                const [position, velocity] = [[...p], [p[1], -p[2], p[0]]];
                const size = Math.hypot(...p) + Math.abs(d === kFar ? 0 : d);
                const isHit = collide(collider, position, velocity, contact) < 0;
                worst.motion = Math.max(worst.motion, ...[...position, ...velocity].map((value, j) =>
                    Math.abs(value - answer[4 + j + (j > 2 ? 1 : 0)]) / size));
                count.inside += d < 0 ? 1 : 0;
                count.hits += isHit ? 1 : 0;
                count.cells += d === kFar ? 0 : 1;
            }
            t.diagnostic(`${name}: ${JSON.stringify({ ...count, ...worst })}`);
            assert.ok(count.cells > 0.5 * kPoints && count.hits > 0.05 * kPoints && count.inside > 0.02 * kPoints, name);
            assert.ok(worst.signs === 0 && worst.ulps <= kUlps && worst.normal <= kNormals && worst.motion <= kMotion,
                      `${name}: ${JSON.stringify(worst)}`);
        }
        assert.deepEqual(messages.filter((line) => !line.includes("GPU stall due to ReadPixels")), []);
    });
}

/**
 * Verdicts of the C++ library: whether it accepts each container. `relief check` also reads the animation, which is not
 * part of the validation of a container.
 */
function acceptedByLibrary(folder, names) {
    const { stdout, stderr } = spawnSync(path.join(bin, "relief"), ["check", "--json", ...names],
                                 { cwd: folder, encoding: "utf8", maxBuffer: 1 << 28 });
    const reports = stdout.trim().split(/(?<=^\})\n/m).map(JSON.parse);
    const valid = new Set(reports.filter(({ fatal, errors }) => fatal + errors === 0).map(({ file }) => file));
    for (const [, file] of stderr.matchAll(/'([^']*)': its animation is not/g)) {
        valid.add(file);
    }
    assert.ok(reports.length > 0.9 * names.length); // files that are no containers at all have no report
    return names.map((name) => valid.has(name));
}

/** Compares the verdicts on containers. @returns how many both accept */
function compareVerdicts(t, containers) {
    const place = scratch(t);
    const names = containers.map((bytes, i) => {
        writeFileSync(path.join(place, `${i}.relief`), bytes);
        return `${i}.relief`;
    });
    const accepted = acceptedByLibrary(place, names);
    let both = 0;
    containers.forEach((bytes, i) => {
        let error;
        let collider;
        try {
            collider = openCollider(bytes, { decompress });
        } catch (thrown) {
            error = thrown;
            assert.ok(error instanceof Error && error.constructor === Error && !error.message.includes("\n"), error.stack);
        }
        if (accepted[i] && error) {
            assert.match(error.message, /^unsupported: /, `container ${i}`);
        }
        assert.ok(accepted[i] || error, `container ${i} is invalid, but was opened`);
        if (collider) {
            const random = generator(i);
            for (let k = 0; k < 20; ++k) {
                const answer = distance(collider, [0, 1, 2].map(() => 4 * random()));
                assert.ok(!Number.isNaN(answer), `container ${i}`);
            }
            ++both;
        }
    });
    return both;
}

const small = () => containerOf(randomTree(12, [1, 2, 1], 2).words);

test("truncated and longer containers are rejected", { timeout: 120_000 }, (t) => {
    const { bytes } = small();
    const cut = Array.from({ length: bytes.length }, (_, size) => bytes.slice(0, size));
    assert.equal(compareVerdicts(t, [bytes, ...cut, Uint8Array.from([...bytes, 0])]), 1);
});

test("containers with extreme fields get the verdict of the C++ library", { timeout: 120_000 }, (t) => {
    const { bytes, hashAt, payloadAt } = small();
    const changed = [];
    for (let at = 0; at < payloadAt + 64; at += 4) {
        for (const value of [0, 1, 2, 0xffff, 0x7fffffff, 0x80000000, 0xffffffff]) {
            const copy = bytes.slice();
            new DataView(copy.buffer).setUint32(at, value, true);
            changed.push(at < 56 || at > 60 ? seal(copy, hashAt, payloadAt) : copy);
        }
    }
    const both = compareVerdicts(t, changed);
    t.diagnostic(`${changed.length} containers, ${both} valid`);
    assert.ok(both > 100 && both < changed.length - 500);
});

test("2,000 mutations get the verdict of the C++ library", { timeout: 120_000 }, (t) => {
    const { bytes, hashAt, payloadAt } = small();
    const random = generator(57);
    const changed = Array.from({ length: 2000 }, (_, i) => {
        const copy = bytes.slice();
        for (let k = 0; k < 1 + i % 3; ++k) {
            copy[Math.floor(random() * copy.length)] ^= 1 << Math.floor(8 * random());
        }
        return i % 8 === 0 ? copy : seal(copy, hashAt, payloadAt);
    });
    const both = compareVerdicts(t, changed);
    t.diagnostic(`${both} valid`);
    assert.ok(both > 100 && both < 1900);
});

test("pinned containers of every format, and compressed ones", { timeout: 60_000 }, (t) => {
    const pinned = path.join(root, "tests/formats/pinned");
    const files = readdirSync(pinned).filter((name) => name.endsWith(".relief")).map((name) => readFileSync(path.join(pinned, name)));
    assert.ok(files.length >= 8);
    const place = scratch(t);
    run("relief", "bake", bunny, "-q", "-o", path.join(place, "packed.relief"), "--budget", "20kB", "--compress", "19");
    const packed = readFileSync(path.join(place, "packed.relief"));
    const random = generator(8);
    const changed = Array.from({ length: 200 }, () => {
        const copy = Uint8Array.from(packed);
        copy[Math.floor(random() * copy.length)] ^= 1 << Math.floor(8 * random());
        return copy;
    });
    assert.equal(compareVerdicts(t, [...files, packed, ...changed]), 1);
    assert.throws(() => openCollider(packed), /compressed with zstd; pass \{ decompress \}, or bake again with --compress 0/);
    assert.throws(() => openCollider(readFileSync(path.join(pinned, "2.0-none-formats.relief"))), /^Error: unsupported: .*; bake again without --map/);
});

test("the corpus of the fuzzers gets the verdict of the C++ library", { timeout: 60_000 }, (t) => {
    const corpus = path.join(root, "tests/fuzz/corpus/container");
    const inputs = readdirSync(corpus).map((name) => Uint8Array.from(readFileSync(path.join(corpus, name))));
    assert.ok(inputs.length > 100);
    const sealed = inputs.filter(({ length }) => length >= 64).map((bytes) => seal(bytes.slice()));
    assert.ok(compareVerdicts(t, [...inputs, ...sealed]) >= 1);
});

test("other input is rejected in one line", () => {
    assert.throws(() => openCollider("bunny.relief"), /needs an ArrayBuffer or a Uint8Array/);
    assert.throws(() => openCollider(new ArrayBuffer(0)), /0 bytes, but a header has 64/);
    assert.throws(() => openCollider(readFileSync(bunny)), /not a \.relief container; bake the mesh/);
    const { bytes } = small();
    bytes[12] = 3;
    assert.throws(() => openCollider(seal(bytes)), /container version 3\.0; this reader supports version 2/);
});
