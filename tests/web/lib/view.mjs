// SPDX-License-Identifier: Apache-2.0
// Pages of `relief view`, opened from disk.
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

import { built, launch, openPage } from "./browser.mjs";

const player = path.join(built, "bin/view.html");
process.env.RELIEF_VIEW_PAGE ??= player;
const kData = /(?<=id="relief-page-data"[^>]*>).*(?=<\/script>)/;

export const dataOf = (file) => JSON.parse(kData.exec(readFileSync(file, "utf8"))[0]);

/** The page in `file` with other data, in the same folder. data: an object, or literal text. */
export function withData(file, data, folder = path.dirname(file)) {
    const text = typeof data === "string" ? data : JSON.stringify(data).replaceAll("<", "\\u003c");
    const other = path.join(folder, "with_data.html");
    writeFileSync(other, readFileSync(file, "utf8").replace(kData, () => text));
    return other;
}

/** The page of a scene with one collider, without particles until the test steps: relief-particles reads its maps. */
export function scenePage(folder, file, more = "") {
    const name = path.basename(file);
    return withData(player, { format: 3, name, bytes: 0, collider: null, shows: name, mesh: null, check: null,
                              scene: `[collider]\nfile = "${name}"\n${more}`, files: { [name]: readFileSync(file, "base64") } }, folder);
}

/** Starts a browser that closes at the end of the test. @returns a function that opens files in it */
export async function viewer(t, more = []) {
    const browser = await launch(more);
    t.after(() => browser.close());
    return async (file, options = {}) => {
        const opened = await openPage(browser, pathToFileURL(file).href, options);
        await opened.page.waitForFunction("window.reliefView?.ready", undefined, { timeout: 60_000 });
        return opened;
    };
}

/** Opens the page in a file, in a browser that closes at the end of the test. */
export const openFile = async (t, file, options = {}) => (await viewer(t))(file, options);

/** Runs in the page. @returns the depths of the cached picture, from the bottom left */
export function keptDepths({ gl, view }) {
    const { width, height, depth } = view.kept;
    gl.getExtension("EXT_color_buffer_float"); // to read float textures
    const made = (type, text) => {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, `#version 300 es\nprecision highp float;\nprecision highp sampler2D;\n${text}`);
        gl.compileShader(shader);
        return shader;
    };
    const program = gl.createProgram();
    gl.attachShader(program, made(gl.VERTEX_SHADER, "void main() { gl_Position = vec4(2 * ((gl_VertexID << 1) & 2) - 1, 2 * (gl_VertexID & 2) - 1, 0, 1); }"));
    gl.attachShader(program, made(gl.FRAGMENT_SHADER, "uniform sampler2D u; out vec4 o; void main() { o = vec4(texelFetch(u, ivec2(gl_FragCoord.xy), 0).r); }"));
    gl.linkProgram(program);
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, height);
    const frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.viewport(0, 0, width, height);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.useProgram(program);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, depth);
    gl.bindVertexArray(null);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const values = new Float32Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, values);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return values.filter((_, i) => i % 4 === 0);
}
