// SPDX-License-Identifier: Apache-2.0
// Uses every declaration of relief-particles once, for the compiler: types_test.mjs.
import Relief, { Collider, GpuCollider, ParticleSystem, ReliefError, World, init, load, streamWorld } from "relief-particles";
import type { Samples, Birth, Scene } from "relief-particles";
import { collide, distance, glsl, openCollider, wgsl } from "relief-particles/collider";
import type { CollideOptions } from "relief-particles/collider";

export async function everything(gl: WebGL2RenderingContext, program: WebGLProgram, file: File): Promise<string[]> {
    await init({ wasmUrl: new URL("https://example.org/relief_wasm.wasm") });
    const collider: Collider = await Relief.load("bunny.relief");
    const dropped = await load(file);
    const { distance, normal, map }: Samples = collider.query([0, 1, 2]);
    const sum: number = distance[0] + normal[0] + map[0] + dropped.texels(0)[0] + dropped.tree(0)[0] + collider.bounds.min[1];

    const gpu = new GpuCollider(gl, collider);
    gpu.attach(program, 4, 1);
    gpu.bind(4, 1);
    const source: string = `#version 300 es\n${gpu.glsl}`;

    const scene: Scene = { particles: { capacity: 4096 }, emitter: [{ rate: 100, point: [0, 2, 0] }], type: [{ radius: 0.1 }] };
    const system = new ParticleSystem(gl, { collider, scene, shaded: false });
    const other = new ParticleSystem(gl, { scene: "[collider]\nfile = \"a/b.relief\"", files: { "a/b.relief": dropped, "c.obj": "v 0 0 0" } });
    const births: Birth[] = [{ position: [0, 1, 0], velocity: new Float32Array(3), lifetime: 2 }];
    const accepted: number = system.spawn(births) + system.spawn(new Float32Array(8));
    system.set({ forces: { wind: [1, 0, 0], drag: 1 } });
    system.set({ collider: { position: [0, 1, 0], axis: [0, 1, 0], angle: 30 } });
    system.set({ collider: [{}, { position: [0, 1, 0] }] });
    // @ts-expect-error: a position has three numbers
    system.set({ collider: { position: 1 } });
    // @ts-expect-error: unknown key
    system.set({ collider: { positoin: [0, 1, 0] } });
    system.step();
    system.step(1 / 60);
    const view = new Float32Array(16);
    system.draw({ view, projection: { elements: [...view] }, framebuffer: null, width: 640, height: 480, srgb: false });
    const texture: WebGLTexture = system.textures().position;
    const alive: number = system.info.alive + system.read().length;
    system.restart();
    const island: World = await streamWorld("island/world.json", { radius: 50, memory: 64 });
    const own = new World(island.files, { radius: 5, load: async (name: string, signal: AbortSignal) => new Uint8Array(await (await fetch(name, { signal })).arrayBuffer()) });
    const streamed = new ParticleSystem(gl, { world: own, onWarning: (line: string) => document.title = line });
    streamed.setPointsOfInterest([{ position: [0, 1, 0], radius: 2 }]);
    await streamed.loaded();
    const missing: number = (streamed.info.stream?.requested ?? 0) - (own.stream?.radius ?? 0) + (island.colliders[0].coarse?.gpu_bytes ?? 0);
    // @ts-expect-error: radius is required
    await streamWorld("island/world.json", { memory: 64 });
    // @ts-expect-error: time must be a number
    system.step("1");
    // @ts-expect-error: unknown option
    new ParticleSystem(gl, { colider: collider });
    // @ts-expect-error: both matrices are required
    system.draw({ view });
    try {
        other.step();
    } catch (error) {
        if (error instanceof ReliefError) {
            return [error.message];
        }
    }
    [system, other, gpu, collider, dropped].forEach((one) => one.dispose());
    return [source, String(texture), String(sum + accepted + alive + missing)];
}

export function withoutWebAssembly(bytes: Uint8Array, unzip: (packed: Uint8Array) => Uint8Array): string {
    const { constants, texels, width, height, bounds, unit, ...collider } = openCollider(bytes, { decompress: (packed) => unzip(packed) });
    const position = new Float32Array(3);
    const velocity = [0, -1, 0];
    const contact: CollideOptions = { radius: 0.01, restitution: 0.4, friction: 0.2, normal: new Float32Array(3) };
    const whole = openCollider(bytes.buffer as ArrayBuffer);
    const left: number = collide(whole, position, velocity, contact) + distance(whole, [0, 1, 0], position);
    // @ts-expect-error: a point has three numbers
    distance(whole, 1);
    return `${glsl}${wgsl}${unit}${left + constants.byteLength + texels[0] + width + height + bounds.min[0] + collider.floats[0] + collider.integers[0]}`;
}
