// SPDX-License-Identifier: Apache-2.0
// Runs the shader texts of relief-particles/collider in a page, through WebGPU or WebGL2.
import { glsl, openCollider, wgsl } from "/package/engines.js";

export const kContact = { radius: 0.05, restitution: 0.4, friction: 0.2 };
const kArguments = `${kContact.radius}, ${kContact.restitution}, ${kContact.friction}`;

/** The velocity of a particle in the test, by its place. */
const kVelocity = "v = vec3(p.y, -p.z, p.x)";

const bytesOf = async (file) => (await fetch(file)).arrayBuffer();

/** Floats as base64, which the driver passes faster than an array. */
function encoded(floats) {
    const bytes = new Uint8Array(floats.buffer, floats.byteOffset, floats.byteLength);
    let text = "";
    for (let at = 0; at < bytes.length; at += 0x8000) {
        text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
    }
    return btoa(text);
}

/**
 * @param files  addresses of containers; beside each, FILE.points has three floats per point
 * @returns for each container, encoded(), 12 floats per point: normal, distance; position after the contact, distance;
 *     velocity, 0
 */
export async function onWebGpu(files) {
    const adapter = await navigator.gpu?.requestAdapter();
    if (!adapter) {
        throw new Error("this browser has no WebGPU");
    }
    const device = await adapter.requestDevice();
    const errors = [];
    device.addEventListener("uncapturederror", ({ error }) => errors.push(error.message));
    const module = device.createShaderModule({ code: `${wgsl}
        @group(0) @binding(0) var texels: texture_2d<u32>;
        @group(0) @binding(1) var<uniform> collider: ReliefCollider;
        @group(0) @binding(2) var<storage> points: array<f32>;
        @group(0) @binding(3) var<storage, read_write> answers: array<vec4f>;
        @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
            let i = id.x;
            if (3 * i + 2 < arrayLength(&points)) {
                let p = vec3f(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
                let ${kVelocity.replace("vec3", "vec3f")};
                let s = reliefDistance(texels, collider, p);
                let m = reliefCollide(texels, collider, p, v, ${kArguments});
                answers[3 * i] = vec4f(s.normal, s.distance);
                answers[3 * i + 1] = vec4f(m.position, m.distance);
                answers[3 * i + 2] = vec4f(m.velocity, 0.0);
            }
        }` });
    const pipeline = await device.createComputePipelineAsync({ layout: "auto", compute: { module, entryPoint: "main" } });
    const buffer = (size, usage, data) => {
        const made = device.createBuffer({ size, usage });
        if (data) {
            device.queue.writeBuffer(made, 0, data);
        }
        return made;
    };
    const { UNIFORM, STORAGE, COPY_DST, COPY_SRC, MAP_READ } = GPUBufferUsage;
    const answers = [];
    for (const file of files) {
        const { constants, texels, width, height } = openCollider(await bytesOf(file));
        const points = new Float32Array(await bytesOf(`${file}.points`));
        const count = points.length / 3;
        const texture = device.createTexture({ size: [width, height], format: "rgba16uint",
                                               usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST });
        device.queue.writeTexture({ texture }, texels, { bytesPerRow: 8 * width }, [width, height]);
        const out = buffer(48 * count, STORAGE | COPY_SRC);
        const back = buffer(48 * count, COPY_DST | MAP_READ);
        const resources = [texture.createView(), { buffer: buffer(80, UNIFORM | COPY_DST, constants) },
                           { buffer: buffer(12 * count, STORAGE | COPY_DST, points) }, { buffer: out }];
        const group = device.createBindGroup({ layout: pipeline.getBindGroupLayout(0),
                                               entries: resources.map((resource, binding) => ({ binding, resource })) });
        const encoder = device.createCommandEncoder();
        const pass = encoder.beginComputePass();
        pass.setPipeline(pipeline);
        pass.setBindGroup(0, group);
        pass.dispatchWorkgroups(Math.ceil(count / 64));
        pass.end();
        encoder.copyBufferToBuffer(out, 0, back, 0, 48 * count);
        device.queue.submit([encoder.finish()]);
        await back.mapAsync(GPUMapMode.READ);
        answers.push(encoded(new Float32Array(back.getMappedRange())));
    }
    if (errors.length > 0) {
        throw new Error(errors.join("\n"));
    }
    return answers;
}

/** Likewise, through WebGL2. */
export async function onWebGl(files) {
    const gl = document.createElement("canvas").getContext("webgl2");
    if (!gl.getExtension("EXT_color_buffer_float")) {
        throw new Error("this browser cannot draw floats");
    }
    const program = gl.createProgram();
    const shaders = [[gl.VERTEX_SHADER, `#version 300 es
        void main() {
            gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
        }`], [gl.FRAGMENT_SHADER, `#version 300 es
        precision highp float;
        precision highp int;
        ${glsl}
        uniform highp usampler2D texels;
        layout(std140) uniform Block { ReliefCollider collider; };
        uniform highp sampler2D points;
        layout(location = 0) out vec4 surface;
        layout(location = 1) out vec4 position;
        layout(location = 2) out vec4 velocity;
        void main() {
            vec3 p = texelFetch(points, ivec2(gl_FragCoord.xy), 0).xyz;
            vec3 ${kVelocity};
            ReliefSurface s = reliefDistance(texels, collider, p);
            ReliefMotion m = reliefCollide(texels, collider, p, v, ${kArguments});
            surface = vec4(s.normal, s.distance);
            position = vec4(m.position, m.distance);
            velocity = vec4(m.velocity, 0.0);
        }`]];
    for (const [kind, text] of shaders) {
        const shader = gl.createShader(kind);
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        gl.attachShader(program, shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) {
            throw new Error(gl.getShaderInfoLog(shader));
        }
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    ["texels", "points"].forEach((name, unit) => gl.uniform1i(gl.getUniformLocation(program, name), unit));
    const texture = (unit, ...image) => {
        gl.activeTexture(gl.TEXTURE0 + unit);
        const made = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, made);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
        gl.texImage2D(gl.TEXTURE_2D, 0, ...image);
        return made;
    };
    const answers = [];
    for (const file of files) {
        const { constants, texels, width, height } = openCollider(await bytesOf(file));
        const points = new Float32Array(await bytesOf(`${file}.points`));
        const count = points.length / 3;
        const rows = Math.ceil(count / 512);
        const places = new Float32Array(4 * 512 * rows);
        for (let i = 0; i < count; ++i) {
            places.set(points.subarray(3 * i, 3 * i + 3), 4 * i);
        }
        texture(0, gl.RGBA16UI, width, height, 0, gl.RGBA_INTEGER, gl.UNSIGNED_SHORT, texels);
        texture(1, gl.RGBA32F, 512, rows, 0, gl.RGBA, gl.FLOAT, places);
        gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, gl.createBuffer());
        gl.bufferData(gl.UNIFORM_BUFFER, constants, gl.STATIC_DRAW);
        gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
        const targets = [0, 1, 2].map((i) => {
            gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D,
                                    texture(2, gl.RGBA32F, 512, rows, 0, gl.RGBA, gl.FLOAT, null), 0);
            return gl.COLOR_ATTACHMENT0 + i;
        });
        gl.drawBuffers(targets);
        gl.viewport(0, 0, 512, rows);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
        const out = new Float32Array(12 * count);
        targets.forEach((target, i) => {
            const pixels = new Float32Array(4 * 512 * rows);
            gl.readBuffer(target);
            gl.readPixels(0, 0, 512, rows, gl.RGBA, gl.FLOAT, pixels);
            for (let j = 0; j < count; ++j) {
                out.set(pixels.subarray(4 * j, 4 * j + 4), 12 * j + 4 * i);
            }
        });
        answers.push(encoded(out));
    }
    if (gl.getError() !== gl.NO_ERROR) {
        throw new Error("a GL error");
    }
    return answers;
}
