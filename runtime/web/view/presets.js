// Four scenes that suit a body of any size, as scene.toml has them. L: its longest side.

/** What the sliders begin with; lengths are in L, the wind in L a second. */
export const kDefaults = {
    rain: { bounce: 0.35, friction: 0.1, radius: 0.004, wind: 0, count: 65536, seconds: 2.4 },
    snow: { bounce: 0, friction: 1, radius: 0.006, wind: 0.12, count: 65536, seconds: 14 },
    fountain: { bounce: 0.35, friction: 0.05, radius: 0.005, wind: 0, count: 32768, seconds: 3.2 },
    smoke: { bounce: 0.1, friction: 0, radius: 0.004, wind: 0.55, count: 65536, seconds: 4 },
};

const near = (v) => Number(v.toPrecision(4));
const nears = (list) => list.map(near);

/**
 * @param file      of the collider, as the scene names it
 * @param box       of the body
 * @param settings  as kDefaults has them
 */
export function presetScene(preset, file, box, settings) {
    const { center: c, min, max, longest: L, size } = box;
    const common = {
        collider: { file },
        time: { dt: 0.016666667, steps: 600 },
        particles: { capacity: settings.count },
    };
    const emitter = { rate: near(settings.count / settings.seconds), duration: 100000 }; // as keeps that many alive
    const top = max[1];
    const over = (low, high, wide) => ({
        box_min: nears([c[0] - wide * size[0] - 0.05 * L, top + low * L, c[2] - wide * size[2] - 0.05 * L]),
        box_max: nears([c[0] + wide * size[0] + 0.05 * L, top + high * L, c[2] + wide * size[2] + 0.05 * L]),
    });
    const type = (more) => ({ radius: near(settings.radius * L), restitution: near(settings.bounce),
                              friction: near(settings.friction), ...more });
    const wind = nears([settings.wind * L, 0, 0]);
    switch (preset) {
        case "rain":
            return {
                ...common,
                forces: { gravity: nears([0, -3 * L, 0]), wind, drag: 0.5 },
                collision: { sweep: near(0.015 * L) },
                render: { sprite: "quad" },
                type: [type({ name: "drop", on_collision: "bounce", lifetime_loss: 0.12, size: near(0.0035 * L),
                             stretch: 0.025, color: [[0, 0.55, 0.72, 0.95], [1, 0.8, 0.9, 1]],
                             opacity: [[0, 0], [0.06, 0.7], [0.85, 0.65], [1, 0]] })],
                emitter: { ...over(0.25, 0.6, 0.6), ...emitter, velocity: nears([settings.wind * L, -1.4 * L, 0]),
                           velocity_spread: nears([0.03 * L, 0.15 * L, 0.03 * L]), lifetime: [1.8, 2.4],
                           type: "drop" },
            };
        case "snow":
            return {
                ...common,
                forces: { gravity: nears([0, -2.2 * L, 0]), wind, drag: 4.5 },
                curl_noise: { amplitude: near(0.12 * L), scale: near(0.6 * L) },
                type: [type({ name: "flake", on_collision: settings.bounce > 0 ? "bounce" : "stop",
                             size: near(0.011 * L), color: [0.97, 0.98, 1], opacity: 0.95 })],
                emitter: { ...over(0.12, 0.5, 0.6), ...emitter, velocity: nears([0, -0.4 * L, 0]),
                           velocity_spread: nears([0.08 * L, 0.06 * L, 0.08 * L]), lifetime: [11, 14], type: "flake" },
            };
        case "fountain":
            return {
                ...common,
                forces: { gravity: nears([0, -2 * L, 0]), wind, drag: 0.2 },
                collision: { sweep: near(0.015 * L) },
                type: [type({ name: "water", on_collision: "bounce", lifetime_loss: 0.01,
                             size: [[0, near(0.007 * L)], [1, near(0.013 * L)]],
                             color: [[0, 0.95, 0.98, 1], [0.4, 0.5, 0.78, 0.95], [1, 0.25, 0.55, 0.85]],
                             opacity: [[0, 0.6], [0.7, 0.5], [1, 0]] })],
                emitter: { shape: "disc", center: nears([c[0], top + 0.06 * L, c[2]]), radius: near(0.02 * L),
                           direction: [0, 1, 0], cone: 16, speed: { mean: near(0.85 * L), deviation: near(0.05 * L) },
                           ...emitter, lifetime: [2.6, 3.2], type: "water" },
            };
        default:
            return {
                ...common,
                forces: { gravity: [0, 0, 0], wind, drag: 8 },
                curl_noise: { amplitude: near(0.16 * L), scale: near(0.5 * L), drift: near(0.1 * L) },
                type: [type({ name: "smoke", on_collision: "slide", size: [[0, near(0.008 * L)], [1, near(0.022 * L)]],
                             color: [[0, 0.93, 0.94, 0.97], [1, 0.62, 0.68, 0.78]],
                             opacity: [[0, 0], [0.08, 0.3], [0.7, 0.18], [1, 0]] })],
                emitter: { box_min: nears([min[0] - 0.4 * L, min[1] + 0.06 * size[1], c[2] - 0.45 * size[2]]),
                           box_max: nears([min[0] - 0.38 * L, min[1] + 0.94 * size[1] + 0.05 * L, c[2] + 0.45 * size[2]]),
                           velocity: nears([settings.wind * L, 0, 0]), velocity_spread: [0, 0, 0],
                           ...emitter, lifetime: [3.2, 4], type: "smoke" },
            };
    }
}
