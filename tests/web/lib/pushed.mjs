// SPDX-License-Identifier: Apache-2.0
// Particles at rest above a cube of side 2 that pushes them upwards: compares the page with relief-sim.
import assert from "node:assert/strict";

import { distances, play, tomlOf } from "./native.mjs";

/** The scene without its collider. */
export const pushedTables = (steps) => ({
    time: { dt: 0.015625, steps }, particles: { capacity: 500 },
    emitter: { box_min: [-0.9, 1.02, -0.9], box_max: [0.9, 1.5, 0.9], burst: 400, rate: 0, lifetime: 50, velocity: [0, 0, 0],
               velocity_spread: [0, 0, 0] },
    forces: { gravity: [0, 0, 0], drag: 0 }, ground: { enabled: false },
});

/** The final particles in relief-sim. `collider`: the scene's collider table. */
export function pushedInReliefSim(folder, steps, collider) {
    const native = play(folder, tomlOf(pushedTables(steps)) + collider);
    assert.equal(native.size, 400);
    return native;
}

/** rows: the page's ParticleSystem.read() */
export function assertSamePushes(rows, native) {
    const far = Math.max(...distances(rows, native));
    assert.ok(far < 1e-3, `a particle is ${far} from its position in relief-sim`);
    const pushed = rows.filter((value, i) => i % 12 === 1 && value > 1.6).length;
    assert.ok(pushed > 300, `${pushed} of 400 were pushed up`);
}
