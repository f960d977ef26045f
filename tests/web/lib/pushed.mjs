// Particles at rest above a cube of side 2, which pushes them upwards as it moves: the page against relief-sim.
import assert from "node:assert/strict";

import { play } from "./native.mjs";

const kScene = (steps) => `[time]
dt = 0.015625
steps = ${steps}
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

/** The same for a page, without its collider. */
export const pushedTables = (steps) => ({
    time: { dt: 0.015625, steps }, particles: { capacity: 500 },
    emitter: { box_min: [-0.9, 1.02, -0.9], box_max: [0.9, 1.5, 0.9], burst: 400, rate: 0, lifetime: 50, velocity: [0, 0, 0],
               velocity_spread: [0, 0, 0] },
    forces: { gravity: [0, 0, 0], drag: 0 }, ground: { enabled: false },
});

/** The places where relief-sim has them at the end, by id. `collider`: its table of the scene. */
export function pushedNatively(folder, steps, collider) {
    const native = play(folder, kScene(steps) + collider);
    assert.equal(native.size, 400);
    return native;
}

/** rows: ParticleSystem.read() of the page. */
export function assertPushedAlike(rows, native) {
    assert.equal(rows.length / 12, 400);
    let far = 0;
    let pushed = 0;
    for (let i = 0; i < rows.length; i += 12) {
        const other = native.get(rows[i + 11]);
        far = Math.max(far, Math.hypot(...other.map((x, k) => x - rows[i + k])));
        pushed += rows[i + 1] > 1.6;
    }
    assert.ok(far < 1e-3, `a particle is ${far} from where relief-sim has it`);
    assert.ok(pushed > 300, `${pushed} of 400 were pushed up`);
}
