// A body that plays a clip pushes particles as in relief-sim; set() changes its clip, and pose() has a pose of the page's own.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { libraryPage } from "./lib/library.mjs";
import { run, scratch } from "./lib/native.mjs";
import { assertPushedAlike, pushedNatively, pushedTables } from "./lib/pushed.mjs";

const kSteps = 48;
/** A cube of side 2 whose node rises by 1 in 1 s, or sinks. */
function writeLift(file) {
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((i) => [i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1]);
    const faces = [0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6];
    const bytes = Buffer.concat([Buffer.from(new Float32Array([...corners, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, -1, 0]).buffer),
                                 Buffer.from(new Uint16Array(faces).buffer)]);
    const view = (byteOffset, byteLength) => ({ buffer: 0, byteOffset, byteLength });
    const clip = (name, output) => ({ name, samplers: [{ input: 1, output }],
                                      channels: [{ sampler: 0, target: { node: 0, path: "translation" } }] });
    writeFileSync(file, JSON.stringify({
        asset: { version: "2.0" }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ name: "lift", mesh: 0 }],
        meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 4 }] }],
        animations: [clip("rise", 2), clip("sink", 3)],
        buffers: [{ byteLength: bytes.length, uri: `data:application/octet-stream;base64,${bytes.toString("base64")}` }],
        bufferViews: [view(0, 96), view(96, 8), view(104, 24), view(128, 24), view(152, 72)],
        accessors: [{ bufferView: 0, componentType: 5126, count: 8, type: "VEC3", min: [-1, -1, -1], max: [1, 1, 1] },
                    { bufferView: 1, componentType: 5126, count: 2, type: "SCALAR", min: [0], max: [1] },
                    { bufferView: 2, componentType: 5126, count: 2, type: "VEC3" },
                    { bufferView: 3, componentType: 5126, count: 2, type: "VEC3" },
                    { bufferView: 4, componentType: 5123, count: 36, type: "SCALAR" }],
    }));
}

// Sparks of the lift's top as it rises: as natively, on its side of the moment, and refused where it has no such part.
test("births on a surface are those of relief-sim", { timeout: 60_000 }, async (t) => {
    const folder = scratch(t);
    writeLift(path.join(folder, "lift.gltf"));
    run("relief", "bake", path.join(folder, "lift.gltf"), "--animated", "-q", "-o", path.join(folder, "lift.relief"));
    writeFileSync(path.join(folder, "scene.toml"), `time = { dt = 0.015625, steps = 32 }
particles = { capacity = 1000 }
forces = { gravity = [0, 0, 0], drag = 0 }
ground = { enabled = false }
[[collider]]
file = "lift.relief"
play = { clip = "rise", resolution = 128 }
[[emitter]]
shape = "surface"
attach = 0
group = "lift"
speed = 0.25
inherit = 1
rate = 400
lifetime = 50
`);
    run("relief-sim", path.join(folder, "scene.toml"), "-q", "--dump", path.join(folder, "final.ply"));
    const bytes = readFileSync(path.join(folder, "final.ply"));
    const native = [];
    for (let at = bytes.indexOf("end_header\n") + 11; at < bytes.length; at += 40) {
        native[bytes.readUInt32LE(at + 32)] = [0, 4, 8].map((k) => bytes.readFloatLE(at + k));
    }
    const { page, said } = await libraryPage(t, folder);
    const { rows, errors, gl } = await page.evaluate(async () => {
        const lift = await relief.load("/files/lift.relief");
        const make = (keys) => new relief.ParticleSystem(gl, { scene: {
            time: { dt: 0.015625, steps: 32 }, particles: { capacity: 1000 }, forces: { gravity: [0, 0, 0], drag: 0 },
            ground: { enabled: false }, collider: [{ file: "lift.relief", play: { clip: "rise", resolution: 128 } }],
            emitter: [{ shape: "surface", attach: 0, speed: 0.25, inherit: 1, rate: 400, lifetime: 50, ...keys }],
        }, files: { "lift.relief": lift } });
        const system = make({ group: "lift" });
        for (let i = 0; i < 32; ++i) {
            system.step();
        }
        const rows = [...system.read()];
        const error = (f) => {
            try {
                f();
                return "no error";
            } catch (one) {
                return one.message;
            }
        };
        // The emitters begin anew with other keys, and stay as they are where these are wrong.
        system.set({ emitter: [{ shape: "surface", attach: 0, rate: 100, speed: 1 }] });
        system.step();
        return { rows, gl: gl.getError(), errors: [
            error(() => make({ group: "Head" })), error(() => make({ material: "skin" })), error(() => make({ attach: 1 })),
            error(() => system.set({ emitter: [{ shape: "surface", attach: 0, group: "tail" }] }))] };
    });
    assert.equal(rows.length / 12, native.filter(Boolean).length);
    assert.ok(native.length > 190);
    let far = 0;
    for (let i = 0; i < rows.length; i += 12) {
        far = Math.max(far, Math.hypot(...native[rows[i + 11]].map((x, k) => x - rows[i + k])));
    }
    assert.ok(far < 1e-3, `a spark is ${far} from where relief-sim has it`);
    assert.match(errors[0], /emitter\.group: there is no joint or node .*'Head'; it has 'lift'/);
    assert.match(errors[1], /emitter\.material: there is no material 'skin'; it has none with a name/);
    assert.match(errors[2], /attach/);
    assert.match(errors[3], /'tail'/);
    assert.equal(gl, 0);
    assert.deepEqual(said, []);
});

test("a body that plays a clip pushes as natively", { timeout: 60_000 }, async (t) => {
    const folder = scratch(t);
    writeLift(path.join(folder, "lift.gltf"));
    run("relief", "bake", path.join(folder, "lift.gltf"), "--animated", "-q", "-o", path.join(folder, "lift.relief"));
    const native = pushedNatively(folder, kSteps, '[[collider]]\nfile = "lift.relief"\nplay = { clip = "rise", resolution = 128 }\n');

    const { page, said } = await libraryPage(t, folder);
    const { rows, posed, animation, still, tops, triangles, errors, gl } = await page.evaluate(async ([steps, tables]) => {
        const lift = await relief.load("/files/lift.relief");
        const scene = { ...tables, collider: [{ file: "lift.relief", play: { clip: "rise", resolution: 128 } }] };
        const make = () => new relief.ParticleSystem(gl, { scene, files: { "lift.relief": lift } });
        const system = make();
        for (let i = 1; i <= steps; ++i) {
            system.step();
        }
        const rows = [...system.read()];
        const animation = system.animation(0);
        const still = system.animation(1);
        const { triangles } = system.mesh(0);
        const tops = [system.info.bodies[0].matrix[13]];
        system.set({ collider: [{ play: { clip: "sink" } }] });
        system.step();
        tops.push(system.info.bodies[0].matrix[13]);
        // The same way by matrices of the page.
        const own = make();
        for (let i = 1; i <= steps; ++i) {
            own.pose(0, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, i / 64, 0, 1]);
            own.step();
        }
        const posed = [...own.read()];
        own.pose(0);
        const error = (f) => {
            try {
                f();
                return "no error";
            } catch (one) {
                return one.message;
            }
        };
        return {
            rows, posed, animation, still, tops, triangles,
            errors: [error(() => system.set({ collider: [{ play: { clip: "run" } }] })),
                     error(() => system.set({ collider: [{ play: { clip: "rise", resolution: 64 } }] })),
                     error(() => system.pose(0, [1, 2, 3])),
                     error(() => system.pose(0, new Float32Array(32))),
                     error(() => system.pose(7, new Float32Array(16)))],
            gl: gl.getError(),
        };
    }, [kSteps, pushedTables(kSteps)]);
    for (const found of [rows, posed]) {
        assertPushedAlike(found, native);
        let inside = 0;
        for (let i = 0; i < found.length; i += 12) {
            inside += found[i + 1] < 1 + kSteps / 64 - 0.02;
        }
        assert.equal(inside, 0);
    }
    assert.deepEqual(animation, { clips: [{ name: "rise", seconds: 1 }, { name: "sink", seconds: 1 }], joints: ["lift"], weights: 0 });
    assert.equal(still, null);
    assert.equal(triangles, 12);
    assert.ok(Math.abs(tops[0] - kSteps / 64) < 1e-5 && tops[1] < -0.7, `${tops}`);
    assert.match(errors[0], /'run' is no clip of .*'rise', 'sink'/);
    assert.match(errors[1], /only position, axis, angle and clip change/);
    assert.match(errors[2], /16 numbers a joint/);
    assert.match(errors[3], /2 joints/);
    assert.match(errors[4], /plays no clip/);
    assert.equal(gl, 0);
    assert.deepEqual(said, []);
});
