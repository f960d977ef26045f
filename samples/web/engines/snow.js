// SPDX-License-Identifier: Apache-2.0
// Code that the pages share.
export const kParticles = 100_000;

/** Lengths in object units for a mesh with these bounds. Snow falls by `height`, and then again from the top. */
export function sceneOf({ min, max }) {
    const side = Math.max(...max.map((to, i) => to - min[i]));
    return { center: max.map((to, i) => (min[i] + to) / 2), top: max[1] + side, height: 2 * side, speed: 1.5 * side,
             radius: 0.0025 * side, side };
}

/** Random places above the mesh, four numbers each. */
export function randomPlaces({ min, max }) {
    const { side } = sceneOf({ min, max });
    const places = new Float32Array(4 * kParticles);
    for (let i = 0; i < kParticles; ++i) {
        places.set([0, 1, 2].map((k) => min[k] + Math.random() * (max[k] - min[k])), 4 * i);
        places[4 * i + 1] = max[1] + side * Math.random();
    }
    return places;
}

/** A camera of three.js. */
export function cameraOf({ PerspectiveCamera }, { center: [x, y, z], side }) {
    const camera = new PerspectiveCamera(35, innerWidth / innerHeight, 0.05 * side, 10 * side);
    camera.position.set(x + side, y + 0.6 * side, z + 2.1 * side);
    camera.lookAt(x, y, z);
    return camera;
}

/** Plays a module with a function start(), or shows an error. */
export async function play(module) {
    try {
        const sample = await (await module).start();
        const frame = () => {
            sample.step(1 / 60);
            sample.draw();
            requestAnimationFrame(frame);
        };
        frame();
        window.sample = sample; // for the console
    } catch (error) {
        document.getElementById("note").textContent = `The page cannot start: ${error.message}`;
        throw error;
    }
}
