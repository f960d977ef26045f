// SPDX-License-Identifier: Apache-2.0
// The Godot add-on of samples/godot in the official web template of Godot 4.6: headless Chromium, WebGL2 in software,
// Compatibility renderer. The particles are read back from the GPU.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdir, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { root } from "../web/lib/browser.mjs";
import { readFolder, startGodot } from "./godot.mjs";
import { insideTest, readObj } from "./mesh.mjs";

const bin = process.env.RELIEF_BIN ?? path.join(root, "build/release/bin");
const relief = path.join(bin, "relief");
const run = (...args) => execFileSync(relief, args, { encoding: "utf8", maxBuffer: 1 << 28 });
const kMesh = "/usr/share/glmark2/models/bunny.obj";
const kPoints = 4096;
const kHalfExtent = [1, 0.98, 0.78]; // of the mesh, above the floor
const kPyramid = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1.3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

// The inverse of the pose of the body "turned" in project/main.gd.
const inBody = ([x, y, z]) => [-z / 0.8, y / 0.8, (x - 0.1) / 0.8];

let folder, godot, files, points, mesh;
const container = (name) => path.join(folder, name);
const lines = (prefix) => godot.messages.filter((line) => line.startsWith(`log: ${prefix}:`))
    .map((line) => line.slice(prefix.length + 6).split("\n")[0].trim());

/** Half of the points lie near vertices of the mesh, half in a box around it. */
function choosePoints({ vertices }) {
    let state = 1;
    const random = () => (state = (state * 48271) % 2147483647) / 2147483647 - 0.5;
    const chosen = Array.from({ length: kPoints }, (_, i) => {
        const vertex = vertices[(i * 997) % vertices.length];
        return vertex.map((x) => Math.fround(i % 2 === 0 ? x + 0.02 * random() : 2.4 * random()));
    });
    chosen[1] = [NaN, 0, 0];
    chosen[3] = [1e30, 0, 0];
    chosen[5] = [0, -Infinity, 0];
    return chosen;
}

/** Rows of `relief query` at the points: x, y, z, distance, normal; not for points that are not finite. */
async function queried(file) {
    const finite = points.filter((p) => p.every(Number.isFinite));
    await writeFile(container("points.csv"), finite.map((p) => p.join(",") + "\n").join(""));
    const csv = run("query", file, "--points", container("points.csv"), "-o", "-", "--distance", "plane");
    const rows = csv.trim().split("\n").slice(1)
        .map((line) => line.split(",").map((word) => (word === "inf" ? Infinity : Number(word))));
    return points.map((p) => (p.every(Number.isFinite) ? rows.shift() : [...p, Infinity]));
}

/** The functions of the page for levels, changed for Godot as it describes, in a shader that evaluates points. */
async function levelShader() {
    const page = await readFile(path.join(root, "bake/engines/README.md"), "utf8");
    const block = (name) => page.split(`<!-- glsl: ${name} -->\n\`\`\`glsl\n`)[1].split("```")[0];
    let level = block("level").replace(/^(uniform \w+ usampler2D \w+);/gm, "$1 : filter_nearest, repeat_disable;");
    for (const code of block("level in Godot").split("\n\n")) {
        const begin = level.indexOf(code.split("\n")[0]);
        assert.ok(begin >= 0, code);
        level = level.slice(0, begin) + code + level.slice(level.indexOf("\n}\n", begin) + 2);
    }
    const query = await readFile(path.join(root, "tests/godot/project/query.gdshader"), "utf8");
    return query.replace("void process", `${level}\nvoid process`)
        .replace("reliefDistance(relief_texels, collider, p)", "levelDistance(p)");
}

before(async () => {
    folder = await mkdtemp(path.join(os.tmpdir(), "relief-godot-"));
    mesh = await readObj(kMesh);
    points = choosePoints(mesh);
    await writeFile(container("pyramid.obj"), kPyramid);
    run("bake", kMesh, "-o", container("bunny.relief"), "--prefer", "inside", "-q");
    const maps = { small: [1], two: [1, 1] };
    for (const [name, each] of Object.entries(maps)) {
        run("bake", container("pyramid.obj"), "-o", container(`${name}.relief`), "-q",
            ...each.flatMap(() => ["--map", "patches:budget=2000"]));
    }
    run("bake", container("pyramid.obj"), "-o", container("compressed.relief"), "-q", "--compress", "3");
    run("bake", container("pyramid.obj"), "-o", container("paper.relief"), "-q", "--map", "fixed8:size=16");
    execFileSync("python3", [path.join(root, "tests/cli/level.py"), container("level.glb")]);
    run("bake", container("level.glb"), "--world", container("level"), "--budget", "200kB", "-q");
    run("export", container("level/world.json"), "--engine", "godot", container("exported"), "-q");
    const bytes = Object.fromEntries(await Promise.all(["bunny", "small", "two", "compressed", "paper"].map(
        async (name) => [name, await readFile(container(`${name}.relief`))])));
    const page = await readFile(path.join(root, "samples/godot/README.md"), "utf8");
    const newer = Buffer.from(bytes.small);
    newer[12] = 3;
    files = {
        ...(await readFolder(path.join(root, "samples/godot"))),
        ...(await readFolder(path.join(root, "tests/godot/project"))),
        ...(await readFolder(container("exported"))),
        "level.gdshader": Buffer.from(await levelShader()),
        "bunny.relief": bytes.bunny,
        "small.relief": bytes.small,
        "page.gdshader": Buffer.from(/```glsl\n(.*?)```/s.exec(page)[1]),
        "points.bin": Buffer.from(new Float32Array(points.flatMap((p) => [...p, 0])).buffer),
        "hostile/compressed.relief": bytes.compressed,
        "hostile/empty.relief": Buffer.alloc(0),
        "hostile/newer.relief": newer,
        "hostile/paper.relief": bytes.paper,
        "hostile/truncated.relief": bytes.bunny.subarray(0, 500000),
        "hostile/two.relief": bytes.two,
    };
    godot = await startGodot(files, path.join(folder, "site"));
});
after(async () => {
    await godot?.close();
    await rm(folder, { recursive: true, force: true });
});

test("the shaders compile, with the example of the page", async () => {
    console.log(`1 MB loaded in ${Number(await godot.line("loaded:"))} ms`);
    await godot.line("evaluated");
    assert.deepEqual(godot.messages.filter((line) => /shader/i.test(line)), []);
});

// A stand-in for the editor's classes: the script compiles, and handles a failed bake.
test("the plugin's menu bakes meshes", async () => {
    assert.equal(await godot.line("updated:"), "res://rock.relief");
    assert.deepEqual(lines("menu"), ["[]", '["Bake Relief collider"]']);
    assert.ok(godot.messages.some((line) => line.includes("res://rock.glb: relief bake failed")));
});

test("hostile containers give one line and no collider", async () => {
    await godot.line("hostile");
    const causes = {
        "compressed.relief": "is compressed; bake it again with --compress 0",
        "empty.relief": "is not a Relief container",
        "newer.relief": "has version 3, not 2; bake it again",
        "paper.relief": "has a map of another kind than patches; bake it again without --map and --paper",
        "truncated.relief": /^has 500000 bytes, not \d+; copy it again$/,
        "two.relief": "has 2 maps; bake it again without --map and --paper",
    };
    assert.deepEqual(lines("file").sort(), Object.keys(causes).map((file) => `${file} true`));
    for (const [file, cause] of Object.entries(causes)) {
        const prefix = `error: res://hostile/${file}: `;
        const found = godot.messages.filter((line) => line.startsWith(prefix))
            .map((line) => line.slice(prefix.length).trim());
        assert.equal(found.length, 1, file);
        assert.match(found[0], cause instanceof RegExp ? cause : new RegExp(`^${cause}$`));
    }
    assert.deepEqual(lines("good"), [""]);
    assert.equal(lines("truncated").length, 11);
    assert.equal(lines("flipped").length, files["small.relief"].length);
    for (const error of [...lines("truncated"), ...lines("longer"), ...lines("flipped")]) {
        assert.match(error, /^(is|has) .+/);
    }
});

test("changed containers with valid checksums get the verdict of relief check", async () => {
    await godot.line("hostile");
    const constants = lines("constants")[0];
    const changed = lines("changed").map((line) => line.split("|").map((part) => part.trim()));
    assert.equal(changed.length, 300);
    const count = { accepted: 0, rejected: 0, unread: 0 };
    for (const [i, [error, found, base64]] of changed.entries()) {
        const file = container(`changed${i}.relief`);
        await writeFile(file, Buffer.from(base64, "base64"));
        const check = spawnSync(relief, ["check", file], { encoding: "utf8" });
        const codes = check.stdout.match(/RLF-1\d+/g) ?? [];
        if (check.status === 0 || error !== "") {
            assert.equal(error === "", check.status === 0, `${i}: ${error || "accepted"}; ${check.stderr}`);
            count[error === "" ? "accepted" : "rejected"] += 1;
        } else { // the loader does not read the damaged field, such as the name of the mesh
            const unread = ["RLF-1102", "RLF-1202", "RLF-1203", "RLF-1204"];
            assert.ok(codes.every((code) => unread.includes(code)), `${i}: ${check.stdout}`);
            assert.equal(found, constants);
            count.unread += 1;
        }
    }
    console.log(`300 changed containers: ${JSON.stringify(count)}`);
    assert.ok(count.accepted > 50 && count.rejected > 50);
});

test("4,096 points have the distances and normals of relief query", async () => {
    await godot.line("evaluated");
    const expected = await queried(container("bunny.relief"));
    const found = await godot.particles("points");
    let [distance, normal, equal, inside] = [0, 0, 0, 0];
    for (const [i, row] of expected.entries()) {
        const [nx, ny, nz, f] = found[i].custom;
        assert.equal(f < 0, row[3] < 0, `sign at ${points[i]}`);
        inside += f < 0 ? 1 : 0;
        if (Number.isFinite(row[3])) {
            distance = Math.max(distance, Math.abs(f - row[3]));
            normal = Math.max(normal, ...[nx, ny, nz].map((x, k) => Math.abs(x - row[4 + k])));
            equal += f === Math.fround(row[3]) ? 1 : 0;
        } else {
            assert.deepEqual([nx, ny, nz, f], [0, 0, 0, Math.fround(1e30)]);
            equal += 1;
        }
    }
    console.log(`4096 points, ${inside} inside: ${equal} distances equal, largest difference ${distance}, ` +
                `of normals ${normal}`);
    assert.ok(inside > 500);
    assert.ok(distance < 2.5e-7 && normal < 5e-7);
});

// Far from all bodies, the distance is a bound.
test("4,096 points of an exported level have the distances of relief query", async () => {
    await godot.line("evaluated");
    const found = await godot.particles("level");
    let [inside, near, distance] = [0, 0, 0];
    for (const [i, [, , , expected]] of (await queried(container("level/world.json"))).entries()) {
        const f = found[i].custom[3];
        assert.equal(f < 0, expected < 0, `sign at ${points[i]}`);
        inside += f < 0 ? 1 : 0;
        if (Math.abs(expected) < 0.1) {
            near += 1;
            distance = Math.max(distance, Math.abs(f - expected));
        }
    }
    console.log(`level: ${inside} of 4096 points inside, ${near} near; largest difference ${distance}`);
    assert.ok(inside > 300 && near > 300 && distance < 2e-6);
});

// "free" has an empty collider: it shows that the test would find particles inside.
test("no more of 10,000 particles are inside the mesh than relief check predicts", async () => {
    const report = JSON.parse(run("check", container("bunny.relief"), "--mesh", kMesh, "--json"));
    const inside = insideTest(mesh);
    await godot.line("end", 300);
    for (const system of ["bounce", "rest", "turned", "free"]) {
        for (let snapshot = 0; snapshot < 3; ++snapshot) {
            const particles = (await godot.particles(`${system} ${snapshot}`)).map(
                (particle) => (system === "turned" ? { ...particle, position: inBody(particle.position) } : particle));
            const near = particles.filter(({ position }) => position.every((x, k) => Math.abs(x) < kHalfExtent[k]));
            const wrong = particles.filter(({ position }) => inside(position)).length;
            const resting = near.filter(({ velocity }) => velocity.every((x) => x === 0)).length;
            console.log(`${system} ${snapshot}: ${near.length} of ${particles.length} particles around the bunny, ` +
                        `${resting} at rest, ${wrong} inside the mesh`);
            assert.ok(particles.length >= 10000 && near.length > 1000);
            assert.equal(wrong / particles.length <= report.accuracy.near.wrong_percent / 100, system !== "free");
            assert.equal(resting > 1000, system === "rest");
        }
    }
});

// In the third life. If a particle kept its velocity, it would fall by 2 per second.
test("particles are at rest when they are born again", async () => {
    await godot.line("end", 300);
    for (let snapshot = 0; snapshot < 3; ++snapshot) {
        const speeds = (await godot.particles(`again ${snapshot}`)).map(({ velocity }) => Math.hypot(...velocity));
        const [least, greatest] = [Math.min(...speeds), Math.max(...speeds)];
        console.log(`again ${snapshot}: speeds from ${least} to ${greatest}`);
        assert.ok(speeds.length >= 10000 && greatest < 0.4 * 2 + 0.05);
    }
});
