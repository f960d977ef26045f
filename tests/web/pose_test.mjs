// set() moves a collider while it plays: as relief-sim moves one by its keys.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { bakeCube } from "./lib/cube.mjs";
import { libraryPage } from "./lib/library.mjs";
import { run, scratch } from "./lib/native.mjs";

const kSteps = 64;
const kScene = `[time]
dt = 0.015625
steps = ${kSteps}
[particles]
capacity = 500
[emitter]
box_min = [-0.9, 1.02, -0.9]
box_max = [0.9, 1.5, 0.9]
burst = 400
rate = 0.0
lifetime = 50.0
velocity = [0.0, 0.0, 0.0]
velocity_spread = [0.0, 0.0, 0.0]
[forces]
gravity = [0.0, 0.0, 0.0]
drag = 0.0
[ground]
enabled = false
`;

test("a pose that is set before each step pushes as keys do", { timeout: 60_000 }, async (t) => {
    const folder = scratch(t);
    bakeCube(folder);
    writeFileSync(path.join(folder, "keys.toml"), `${kScene}[[collider]]
file = "cube.relief"
[[collider.key]]
time = 0.0
position = [0.0, 0.0, 0.0]
[[collider.key]]
time = 1.0
position = [0.0, 1.0, 0.0]
`);
    run("relief-sim", path.join(folder, "keys.toml"), "-q", "--dump", path.join(folder, "final.ply"));
    const bytes = readFileSync(path.join(folder, "final.ply"));
    const native = new Map();
    for (let at = bytes.indexOf("end_header\n") + 11; at < bytes.length; at += 40) {
        native.set(bytes.readUInt32LE(at + 32), [0, 4, 8].map((k) => bytes.readFloatLE(at + k)));
    }
    assert.equal(native.size, 400);

    const { page, said } = await libraryPage(t, folder);
    const { rows, matrix, several, errors, gl } = await page.evaluate(async (steps) => {
        const collider = await relief.load("/files/cube.relief");
        const rest = {
            time: { dt: 0.015625, steps }, particles: { capacity: 500 },
            emitter: { box_min: [-0.9, 1.02, -0.9], box_max: [0.9, 1.5, 0.9], burst: 400, rate: 0, lifetime: 50, velocity: [0, 0, 0],
                       velocity_spread: [0, 0, 0] },
            forces: { gravity: [0, 0, 0], drag: 0 }, ground: { enabled: false },
        };
        const system = new relief.ParticleSystem(gl, { collider, scene: { ...rest, collider: { position: [0, 0, 0] } } });
        for (let i = 1; i <= steps; ++i) {
            system.set({ collider: { position: [0, i / steps, 0] } });
            system.step();
        }
        const rows = [...system.read()];
        system.set({ collider: { angle: 32 } });
        // Of several one moves, and the other stays.
        const two = new relief.ParticleSystem(gl, {
            scene: { ...rest, collider: [{ file: "c.relief" }, { file: "c.relief", position: [4, 0, 0] }] }, files: { "c.relief": collider },
        });
        two.set({ collider: [{}, { position: [5, 0, 0] }] });
        const still = new relief.ParticleSystem(gl, { collider, scene: rest });
        const error = (f) => {
            try {
                f();
                return "no error";
            } catch (one) {
                return one.message;
            }
        };
        return {
            rows, matrix: system.info.bodies[0].matrix, several: two.info.bodies.map((body) => body.matrix[12]),
            errors: [error(() => still.set({ collider: { position: [0, 1, 0] } })),
                     error(() => system.set({ collider: { file: "other.relief" } })),
                     error(() => system.set({ collider: { scale: 2 } })),
                     error(() => still.set({ forces: { gravity: [0, -1, 0] } }))],
            gl: gl.getError(),
        };
    }, kSteps);
    assert.equal(rows.length / 12, 400);
    let far = 0;
    let pushed = 0;
    for (let i = 0; i < rows.length; i += 12) {
        const other = native.get(rows[i + 11]);
        far = Math.max(far, Math.hypot(...other.map((x, k) => x - rows[i + k])));
        pushed += rows[i + 1] > 1.6;
    }
    assert.ok(far < 1e-3, `a particle is ${far} from where keys move it`);
    assert.ok(pushed > 300, `${pushed} of 400 were pushed up`);
    assert.ok(Math.abs(matrix[13] - 1) < 1e-6 && Math.abs(matrix[0] - Math.cos(32 * Math.PI / 180)) < 1e-5, `${matrix}`);
    assert.deepEqual(several, [0, 5]);
    assert.match(errors[0], /position: \[0, 0, 0\]/);
    assert.match(errors[1], /only position, axis, angle and clip change/);
    assert.match(errors[2], /only position, axis, angle and clip change/);
    assert.equal(errors[3], "no error");
    assert.equal(gl, 0);
    assert.deepEqual(said, []);
});
