// SPDX-License-Identifier: Apache-2.0
// Evaluates a GpuCollider at points with the page's own shader, as a user would. Runs in a page.

/** Points are x, y, z triples. @returns { distance, normal, map } of each point */
export function gpuQuery(gl, gpu, points) {
    const count = points.length / 3;
    const width = 128;
    const height = Math.ceil(count / width);
    const program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, `
        void main() { gl_Position = vec4(2 * (gl_VertexID & 2) - 1, 4 * (gl_VertexID & 1) - 1, 0, 1); }`],
                                [gl.FRAGMENT_SHADER, `${gpu.glsl}
        uniform sampler2D u_points;
        layout(location = 0) out vec4 o_sample;
        layout(location = 1) out vec4 o_map;
        void main() {
            ReliefField field = reliefEvaluate(texelFetch(u_points, ivec2(gl_FragCoord.xy), 0).xyz);
            o_sample = vec4(field.distance, field.normal);
            o_map = vec4(field.map);
        }`]]) {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, `#version 300 es\n${text}`);
        gl.compileShader(shader);
        gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    const texture = (values) => {
        const made = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, made);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, values);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
        return made;
    };
    const texels = new Float32Array(4 * width * height);
    for (let i = 0; i < count; ++i) {
        texels.set(points.slice(3 * i, 3 * i + 3), 4 * i);
    }
    gl.activeTexture(gl.TEXTURE0);
    const outputs = [texture(null), texture(null)];
    const input = texture(texels);
    const framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    outputs.forEach((one, i) => gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, one, 0));
    gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
    gl.viewport(0, 0, width, height);
    gpu.attach(program, 4);
    gpu.bind(4);
    gl.useProgram(program);
    gl.uniform1i(gl.getUniformLocation(program, "u_points"), 0);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, input);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const [samples, maps] = [0, 1].map((i) => {
        const read = new Float32Array(4 * width * height);
        gl.readBuffer(gl.COLOR_ATTACHMENT0 + i);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, read);
        return read;
    });
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    const each = Array.from({ length: count }, (_, i) => i);
    return { distance: each.map((i) => samples[4 * i]), normal: each.flatMap((i) => [...samples.subarray(4 * i + 1, 4 * i + 4)]),
             map: each.map((i) => maps[4 * i]) };
}
