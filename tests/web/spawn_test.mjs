// [[spawn]] in the browser: as many births as relief-sim makes, where it makes them. The hits come back from WebGL2,
// which maps no buffers.
import assert from "node:assert/strict";
import path from "node:path";
import test from "node:test";

import { libraryPage } from "./lib/library.mjs";
import { bunny, playWithHits, run, scratch } from "./lib/native.mjs";

const kSteps = 150;
const kScene = `[time]
dt = 0.0078125
steps = ${kSteps}
[collider]
file = "bunny.relief"
[particles]
capacity = 5000
[emitter]
box_min = [6.0, 1.0, -1.0]
box_max = [8.0, 3.0, 1.0]
burst = 300
rate = 0.0
lifetime = 50.0
[forces]
gravity = [0.0, -9.8, 0.0]
drag = 0.0
[ground]
height = 0.0
[[type]]
name = "drop"
on_collision = "die"
[[type]]
name = "splash"
on_collision = "stop"
[[spawn]]
on = "collision"
of = "drop"
type = "splash"
count = 5
speed = [0.5, 1.0]
lifetime = 40
`;

test("a browser splashes as relief-sim does", { timeout: 120_000 }, async (t) => {
    const folder = scratch(t);
    run("relief", "bake", bunny, "-q", "-o", path.join(folder, "bunny.relief"), "--budget", "200kB");
    const { places: native, hits } = playWithHits(folder, kScene);
    // Those of the last two steps have made nothing yet.
    const due = 5 * hits.filter((hit) => hit.type === 0 && hit.step <= kSteps - 2).length;
    assert.ok(due > 1000, `${due}`);

    const { page, said } = await libraryPage(t, folder);
    const [rows, info, error] = await page.evaluate(async ([scene, steps]) => {
        const collider = await relief.load("/files/bunny.relief");
        const system = new relief.ParticleSystem(gl, { scene, files: { "bunny.relief": collider } });
        for (let i = 0; i < steps; ++i) {
            system.step();
        }
        return [[...system.read()], system.info, gl.getError()];
    }, [kScene, kSteps]);
    assert.equal(error, 0, "a GL error");
    assert.deepEqual(said, []);
    assert.equal(info.born, 300 + due);

    assert.equal(rows.length / 12, native.size);
    let far = 0;
    for (let i = 0; i < rows.length; i += 12) {
        const other = native.get(rows[i + 11]);
        assert.ok(other, `the native run has no ${rows[i + 11]}`);
        far = Math.max(far, Math.hypot(...other.map((x, k) => x - rows[i + k])));
    }
    assert.ok(far < 1e-4, `a particle is ${far} from where it is natively`);
});
