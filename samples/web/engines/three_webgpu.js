// SPDX-License-Identifier: Apache-2.0
// Snow on a bunny: a compute shader of three.js moves the particles, and reliefCollide() in WGSL stops them.
import * as THREE from "three/webgpu";
import { float, instancedArray, instanceIndex, texture, uniform, wgsl, wgslFn } from "three/tsl";
import { openCollider, wgsl as reliefWgsl } from "relief-particles/collider";
import { cameraOf, kParticles, randomPlaces, sceneOf } from "./snow.js";

// The collider: a texture, a matrix and a vector, the arguments of a WGSL function.
function colliderNodes({ texels, width, height, floats, integers }) {
    // WebGPURenderer has no format RGBA16UI: four words of 32 bits hold the same numbers.
    const words = Uint32Array.from(texels);
    const image = new THREE.DataTexture(words, width, height, THREE.RGBAIntegerFormat, THREE.UnsignedIntType);
    image.needsUpdate = true;
    return { texels: texture(image), rows: uniform(new THREE.Matrix4().fromArray(floats)),
             place: uniform(new THREE.Vector4(...integers), "ivec4") };
}

const moveParticle = wgslFn(`
    fn moveParticle(texels: texture_2d<u32>, rows: mat4x4f, place: vec4i, snow: vec4f, dt: f32, i: u32,
                    places: ptr<storage, array<vec4f>, read_write>,
                    velocities: ptr<storage, array<vec4f>, read_write>) -> void {
        let v = mix(velocities[i].xyz, vec3f(0.0, -snow.z, 0.0), dt);
        var p = places[i].xyz + dt * v;
        p.y += select(0.0, snow.y, p.y < snow.x); // falls again
        let collider = ReliefCollider(rows[0], rows[1], rows[2], rows[3], place);
        let motion = reliefCollide(texels, collider, p, v, snow.w, 0.2, 0.1);
        places[i] = vec4f(motion.position, 1.0);
        velocities[i] = vec4f(motion.velocity, 0.0);
    }`, [wgsl(reliefWgsl)]);

export async function start() {
    const collider = openCollider(await (await fetch(new URL("body.relief", import.meta.url))).arrayBuffer());
    const renderer = new THREE.WebGPURenderer({ antialias: true });
    renderer.setSize(innerWidth, innerHeight);
    await renderer.init();
    document.body.append(renderer.domElement);

    const scene = sceneOf(collider.bounds);
    const snow = uniform(new THREE.Vector4(scene.top - scene.height, scene.height, scene.speed, scene.radius));
    const places = instancedArray(randomPlaces(collider.bounds), "vec4");
    const velocities = instancedArray(kParticles, "vec4");
    const dt = uniform(0);
    const move = moveParticle({ ...colliderNodes(collider), snow, dt, i: instanceIndex, places, velocities })
        .compute(kParticles);

    const material = new THREE.SpriteNodeMaterial({ color: 0xdfeaf5 });
    material.positionNode = places.toAttribute().xyz;
    material.scaleNode = float(0.004 * scene.side);
    const flakes = new THREE.Sprite(material);
    flakes.count = kParticles;
    flakes.frustumCulled = false;
    const picture = new THREE.Scene();
    picture.background = new THREE.Color(0x22303c);
    picture.add(flakes);
    const camera = cameraOf(THREE, scene);

    return {
        collider,
        step: (seconds) => {
            dt.value = seconds;
            renderer.compute(move);
        },
        draw: () => renderer.render(picture, camera),
        /** Four floats for each particle: its position, and 1. */
        read: async () => new Float32Array(await renderer.getArrayBufferAsync(places.value)),
    };
}
