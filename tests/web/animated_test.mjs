// SPDX-License-Identifier: Apache-2.0
// A body that plays a clip pushes particles as in relief-sim. set() changes its clip, and pose() sets a pose of the
// page.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import path from "node:path";
import test from "node:test";

import { root } from "./lib/browser.mjs";
import { libraryPage } from "./lib/library.mjs";
import { distances, play, run, scratch, tomlOf } from "./lib/native.mjs";
import { assertSamePushes, pushedInReliefSim, pushedTables } from "./lib/pushed.mjs";

const kSteps = 48;
/** A cube of side 2 with two clips: its node rises or sinks by 1 in 1 s. */
function bakeLift(folder) {
    execFileSync("python3", [path.join(root, "tests/bake/python/lift.py"), path.join(folder, "lift.gltf"), "rise=0,1,0", "sink=0,-1,0"]);
    run("relief", "bake", path.join(folder, "lift.gltf"), "--animated", "-q", "-o", path.join(folder, "lift.relief"));
}

// Sparks from the top of the rising lift: as in relief-sim, at the surface at their time of birth, and an error if the
// part is missing.
test("births on a surface match relief-sim", { timeout: 60_000 }, async (t) => {
    const folder = scratch(t);
    bakeLift(folder);
    const tables = { time: { dt: 0.015625, steps: 32 }, particles: { capacity: 1000 }, forces: { gravity: [0, 0, 0], drag: 0 },
                     ground: { enabled: false } };
    const emitter = { shape: "surface", attach: 0, speed: 0.25, inherit: 1, rate: 400, lifetime: 50 };
    const native = play(folder, tomlOf({ ...tables, emitter: { ...emitter, group: "lift" } }) +
        '[[collider]]\nfile = "lift.relief"\nplay = { clip = "rise", resolution = 128 }\n');
    const { page, messages } = await libraryPage(t, folder);
    const { rows, errors, gl } = await page.evaluate(async ([tables, emitter]) => {
        const lift = await relief.load("/files/lift.relief");
        const make = (keys) => new relief.ParticleSystem(gl, { scene: {
            ...tables, collider: [{ file: "lift.relief", play: { clip: "rise", resolution: 128 } }], emitter: [{ ...emitter, ...keys }],
        }, files: { "lift.relief": lift } });
        const system = make({ group: "lift" });
        for (let i = 0; i < 32; ++i) {
            system.step();
        }
        const rows = [...system.read()];
        // New keys restart the emitters; invalid keys change nothing.
        system.set({ emitter: [{ shape: "surface", attach: 0, rate: 100, speed: 1 }] });
        system.step();
        return { rows, gl: gl.getError(), errors: await errorsOf(
            () => make({ group: "Head" }), () => make({ material: "skin" }), () => make({ attach: 1 }),
            () => system.set({ emitter: [{ shape: "surface", attach: 0, group: "tail" }] })) };
    }, [tables, emitter]);
    assert.ok(native.size > 190);
    const far = Math.max(...distances(rows, native));
    assert.ok(far < 1e-3, `a spark is ${far} from its position in relief-sim`);
    assert.match(errors[0], /emitter\.group: there is no vertex group \(joint or node\) 'Head'; the mesh has 'lift'/);
    assert.match(errors[1], /emitter\.material: there is no material 'skin'; the mesh has none with a name/);
    assert.match(errors[2], /attach/);
    assert.match(errors[3], /'tail'/);
    assert.equal(gl, 0);
    assert.deepEqual(messages, []);
});

test("a body that plays a clip pushes as in relief-sim", { timeout: 60_000 }, async (t) => {
    const folder = scratch(t);
    bakeLift(folder);
    const native = pushedInReliefSim(folder, kSteps, '[[collider]]\nfile = "lift.relief"\nplay = { clip = "rise", resolution = 128 }\n');

    const { page, messages } = await libraryPage(t, folder);
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
        // The same motion by matrices of the page.
        const own = make();
        for (let i = 1; i <= steps; ++i) {
            own.pose(0, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, i / 64, 0, 1]);
            own.step();
        }
        const posed = [...own.read()];
        own.pose(0);
        return {
            rows, posed, animation, still, tops, triangles,
            errors: await errorsOf(() => system.set({ collider: [{ play: { clip: "run" } }] }),
                                   () => system.set({ collider: [{ play: { clip: "rise", resolution: 64 } }] }),
                                   () => system.pose(0, [1, 2, 3]),
                                   () => system.pose(0, new Float32Array(32)),
                                   () => system.pose(7, new Float32Array(16))),
            gl: gl.getError(),
        };
    }, [kSteps, pushedTables(kSteps)]);
    for (const found of [rows, posed]) {
        assertSamePushes(found, native);
        let inside = 0;
        for (let i = 0; i < found.length; i += 12) {
            inside += found[i + 1] < 1 + kSteps / 64 - 0.02;
        }
        assert.equal(inside, 0);
    }
    assert.deepEqual(animation, { clips: [{ name: "rise", duration: 1 }, { name: "sink", duration: 1 }], joints: ["lift"], weights: 0 });
    assert.equal(still, null);
    assert.equal(triangles, 12);
    assert.ok(Math.abs(tops[0] - kSteps / 64) < 1e-5 && tops[1] < -0.7, `${tops}`);
    assert.match(errors[0], /'run' is not a clip of .*'rise', 'sink'/);
    assert.match(errors[1], /only position, axis, angle and clip can change/);
    assert.match(errors[2], /16 numbers per joint/);
    assert.match(errors[3], /2 joints/);
    assert.match(errors[4], /plays no clip/);
    assert.equal(gl, 0);
    assert.deepEqual(messages, []);
});
