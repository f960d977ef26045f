// SPDX-License-Identifier: Apache-2.0
// Snow on a bunny: a compute shader of three.js moves the particles, and reliefCollide() in WGSL stops them.
import * as THREE from "three/webgpu";
import { float, instancedArray, instanceIndex, texture, uniform, wgsl, wgslFn } from "three/tsl";
import { openCollider, wgsl as reliefWgsl } from "relief-particles/collider";
import { kParticles, lookAt, randomPlaces } from "./snow.js";

// The collider: a texture and five uniforms, the arguments of a WGSL function.
function colliderNodes({ texels, width, height, floats, integers }) {
    // WebGPURenderer has no format RGBA16UI: four words of 32 bits hold the same numbers.
    const image = new THREE.DataTexture(Uint32Array.from(texels), width, height, THREE.RGBAIntegerFormat, THREE.UnsignedIntType);
    image.needsUpdate = true;
    const row = (at) => uniform(new THREE.Vector4(...floats.subarray(at, at + 4)));
    return { texels: texture(image), row_x: row(0), row_y: row(4), row_z: row(8), size: row(12),
             place: uniform(new THREE.Vector4(...integers), "ivec4") };
}

const moveParticle = wgslFn(`
    fn moveParticle(texels: texture_2d<u32>, row_x: vec4f, row_y: vec4f, row_z: vec4f, size: vec4f, place: vec4i,
                    places: ptr<storage, array<vec4f>, read_write>, velocities: ptr<storage, array<vec4f>, read_write>,
                    i: u32, dt: f32) -> void {
        let collider = ReliefCollider(row_x, row_y, row_z, size, place);
        var p = places[i].xyz;
        if (p.y < -1.5) {
            p.y += 4.0; // below the picture: falls again
        }
        let v = velocities[i].xyz + dt * (vec3f(0.0, -3.0, 0.0) - velocities[i].xyz);
        let motion = reliefCollide(texels, collider, p + dt * v, v, 0.005, 0.2, 0.1);
        places[i] = vec4f(motion.position, 1.0);
        velocities[i] = vec4f(motion.velocity, 0.0);
    }`, [wgsl(reliefWgsl)]);

export async function start() {
    const collider = openCollider(await (await fetch("body.relief")).arrayBuffer());
    const renderer = new THREE.WebGPURenderer({ antialias: true });
    renderer.setSize(innerWidth, innerHeight);
    await renderer.init();
    document.body.append(renderer.domElement);

    const places = instancedArray(randomPlaces(collider.bounds, 4), "vec4");
    const velocities = instancedArray(kParticles, "vec4");
    const dt = uniform(0);
    const move = moveParticle({ ...colliderNodes(collider), places, velocities, i: instanceIndex, dt }).compute(kParticles);

    const material = new THREE.SpriteNodeMaterial({ color: 0xdfeaf5 });
    material.positionNode = places.toAttribute().xyz;
    material.scaleNode = float(0.008);
    const snow = new THREE.Sprite(material);
    snow.count = kParticles;
    snow.frustumCulled = false;
    const scene = new THREE.Scene();
    scene.background = new THREE.Color(0x22303c);
    scene.add(snow);
    const camera = lookAt(THREE);

    return {
        collider,
        step: (seconds) => {
            dt.value = seconds;
            renderer.compute(move);
        },
        draw: () => renderer.render(scene, camera),
        /** Four floats for each particle: its place, 1. */
        read: async () => new Float32Array(await renderer.getArrayBufferAsync(places.value)),
    };
}
