// SPDX-License-Identifier: Apache-2.0
// Code that the pages share.
export const kParticles = 100_000;

/** Places above the bunny, four or three numbers each. */
export function randomPlaces({ min, max }, size) {
    const places = new Float32Array(size * kParticles);
    for (let i = 0; i < kParticles; ++i) {
        places.set([0, 1, 2].map((k) => min[k] + Math.random() * (max[k] - min[k])), size * i);
        places[size * i + 1] = max[1] + 2 * Math.random();
    }
    return places;
}

export function lookAt({ PerspectiveCamera }) {
    const camera = new PerspectiveCamera(35, innerWidth / innerHeight, 0.1, 20);
    camera.position.set(2, 1.2, 4.2);
    camera.lookAt(0, 0.1, 0);
    return camera;
}
