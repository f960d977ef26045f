// SPDX-License-Identifier: Apache-2.0
// Snow on a bunny: PlayCanvas steps its particles in a fragment shader, and reliefCollide() in GLSL stops them.
import * as pc from "playcanvas";
import { glsl, openCollider } from "relief-particles/collider";
import { kParticles, sceneOf } from "./snow.js";

// The collider: a texture, a matrix and a vector, for all particle systems of the device.
function setCollider(device, { texels, width, height, floats, integers }, radius) {
    const format = pc.PIXELFORMAT_RGBA16U;
    const texture = new pc.Texture(device, { width, height, format, levels: [texels], mipmaps: false });
    device.scope.resolve("reliefTexels").setValue(texture);
    device.scope.resolve("reliefRows").setValue(floats);
    device.scope.resolve("reliefPlace").setValue(integers);
    device.scope.resolve("reliefRadius").setValue(radius);
    const chunks = pc.ShaderChunks.get(device, pc.SHADERLANGUAGE_GLSL);
    chunks.set("particleUpdaterInitPS", `${chunks.get("particleUpdaterInitPS")}\n${glsl}
        uniform highp usampler2D reliefTexels;
        uniform mat4 reliefRows;
        uniform ivec4 reliefPlace;
        uniform float reliefRadius;`);
    chunks.set("particleUpdaterEndPS", `
        mat4 rows = reliefRows;
        ReliefCollider collider = ReliefCollider(rows[0], rows[1], rows[2], rows[3], reliefPlace);
        outPos = reliefCollide(reliefTexels, collider, outPos, outVel, reliefRadius, 0.0, 0.0).position;
        writeOutput();
    }`);
}

export async function start() {
    const collider = openCollider(await (await fetch(new URL("body.relief", import.meta.url))).arrayBuffer());
    const canvas = document.body.appendChild(document.createElement("canvas"));
    const app = new pc.Application(canvas, { graphicsDeviceOptions: { preserveDrawingBuffer: true } });
    app.setCanvasFillMode(pc.FILLMODE_FILL_WINDOW);
    app.setCanvasResolution(pc.RESOLUTION_AUTO);
    app.start();
    cancelAnimationFrame(app.frameRequestId); // snow.js calls step() and draw()
    const { center: [x, y, z], side, top, radius } = sceneOf(collider.bounds);
    setCollider(app.graphicsDevice, collider, radius);

    // A particle system has at most as many particles as a texture has columns.
    const perSystem = Math.min(kParticles, 8000);
    const { min, max } = collider.bounds;
    const systems = Array.from({ length: Math.ceil(kParticles / perSystem) }, () => {
        const entity = new pc.Entity();
        entity.addComponent("particlesystem", {
            numParticles: perSystem, lifetime: 3, rate: 3 / perSystem, preWarm: false,
            emitterShape: pc.EMITTERSHAPE_BOX, emitterExtents: new pc.Vec3(max[0] - min[0], 0.05 * side, max[2] - min[2]),
            velocityGraph: new pc.CurveSet([[0, 0], [0, -0.5 * side], [0, 0]]),
            scaleGraph: new pc.Curve([0, 0.004 * side]), colorGraph: new pc.CurveSet([[0, 0.75], [0, 0.84], [0, 0.92]]),
        });
        entity.setPosition(x, top - 0.9 * side, z);
        app.root.addChild(entity);
        return entity.particlesystem;
    });
    const camera = new pc.Entity();
    camera.addComponent("camera", { fov: 35, nearClip: 0.05 * side, farClip: 10 * side,
                                    clearColor: new pc.Color(0.133, 0.188, 0.235) });
    camera.setPosition(x + side, y + 0.6 * side, z + 2.1 * side);
    camera.lookAt(x, y, z);
    app.root.addChild(camera);

    return {
        collider,
        step: (seconds) => app.update(seconds),
        draw: () => app.render(),
        /** Four floats for each particle: its position, and a number that is negative before its birth. */
        read: async () => {
            const rows = await Promise.all(systems.map(({ emitter }) => {
                const texture = emitter.swapTex ? emitter.particleTexOUT : emitter.particleTexIN;
                const renderTarget = emitter.swapTex ? emitter.rtParticleTexOUT : emitter.rtParticleTexIN;
                return texture.read(0, 0, perSystem, 1, { renderTarget });
            }));
            return Float32Array.from(rows.flatMap((row) => [...row]));
        },
    };
}
