// Materials in the browser: as many births on one of them, and as many deaths on another, as relief-sim has.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";

import { libraryPage } from "./lib/library.mjs";
import { playWithHits, run, scratch } from "./lib/native.mjs";

const kSteps = 120;
// A slab whose halves are oak and ice.
const kMesh = `v -1 0 -1\nv 0 0 -1\nv 1 0 -1\nv -1 0 1\nv 0 0 1\nv 1 0 1
v -1 0.2 -1\nv 0 0.2 -1\nv 1 0.2 -1\nv -1 0.2 1\nv 0 0.2 1\nv 1 0.2 1
usemtl oak\nf 1 2 5 4\nf 7 10 11 8\nf 1 4 10 7\nf 4 5 11 10\nf 2 1 7 8
usemtl ice\nf 2 3 6 5\nf 8 11 12 9\nf 3 9 12 6\nf 5 6 12 11\nf 3 2 8 9
`;
const kScene = `[time]
dt = 0.0078125
steps = ${kSteps}
[collider]
file = "slab.relief"
[[material]]
name = "ice"
lifetime_loss = 49.5
[particles]
capacity = 5000
[emitter]
box_min = [-0.9, 0.4, -0.9]
box_max = [0.9, 0.6, 0.9]
burst = 400
rate = 0.0
lifetime = 50.0
[forces]
gravity = [0.0, -9.8, 0.0]
drag = 0.0
[ground]
enabled = false
[[type]]
name = "drop"
on_collision = "stop"
[[type]]
name = "chip"
on_collision = "stop"
[[spawn]]
on = "collision"
of = "drop"
material = "oak"
type = "chip"
count = 2
speed = [0.5, 1.0]
lifetime = 40
`;

test("a browser knows the material that is hit as relief-sim does", { timeout: 120_000 }, async (t) => {
    const folder = scratch(t);
    writeFileSync(path.join(folder, "slab.obj"), kMesh);
    run("relief", "bake", path.join(folder, "slab.obj"), "-q", "-o", path.join(folder, "slab.relief"), "--budget", "200kB");
    const { places, hits } = playWithHits(folder, kScene);
    const drops = hits.filter((hit) => hit.type === 0);
    const oak = drops.filter((hit) => hit.material === "oak").length;
    assert.ok(oak > 100 && drops.length - oak > 100, `${oak} of ${drops.length}`);
    assert.ok(drops.every((hit) => Math.abs(hit.position[0]) < 0.01 || (hit.position[0] < 0) === (hit.material === "oak")));

    const { page, said } = await libraryPage(t, folder);
    const [rows, info, error] = await page.evaluate(async ([scene, steps]) => {
        const collider = await relief.load("/files/slab.relief");
        const system = new relief.ParticleSystem(gl, { scene, files: { "slab.relief": collider } });
        for (let i = 0; i < steps; ++i) {
            system.step();
        }
        return [[...system.read()].length, system.info, gl.getError()];
    }, [kScene, kSteps]);
    assert.equal(error, 0, "a GL error");
    assert.deepEqual(said, []);
    assert.equal(info.born, 400 + 2 * oak);
    // On ice a drop has half a second left, of which it has fallen for some: at the end none is there any more.
    const native = places.size;
    assert.ok(native < info.born - 100, `${native} of ${info.born}`);
    assert.equal(rows / 12, native);
});
