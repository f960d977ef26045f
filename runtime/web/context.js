// SPDX-License-Identifier: Apache-2.0
// WebGL2 contexts: makes one current for the WebAssembly module, and tracks its losses.
import { check } from "./fetch.js";
import { withPassState } from "./pass_state.js";
import { call, instance, wasm } from "./wasm.js";

const contexts = new WeakMap(); // WebGL2 context to its record (recordOf())
let nullContext = 0; // emscripten handle of a context whose functions do nothing

/** Returns the record of a context: emscripten handle, number of losses, and whether its extension is enabled. */
function recordOf(gl) {
    let known = contexts.get(gl);
    if (known === undefined) {
        check(typeof WebGL2RenderingContext !== "undefined" && gl instanceof WebGL2RenderingContext,
              gl === null ? "this browser provides no WebGL2 context; try another browser or newer drivers"
                  : "particles need a WebGL2 context from canvas.getContext('webgl2')");
        const handle = wasm.GL.registerContext(withPassState(gl), { majorVersion: 2, enableExtensionsByDefault: false });
        known = { handle, losses: 0, ready: false };
        contexts.set(gl, known);
        gl.canvas.addEventListener("webglcontextlost", () => {
            known.losses += 1;
            known.ready = false;
        });
    }
    return known;
}

/** Makes a context current and returns its number of losses. Throws if the context does not support particles. */
export function use(gl) {
    instance();
    const known = recordOf(gl);
    check(!gl.isContextLost(),
          "the WebGL context is lost; wait for 'webglcontextrestored', " +
          "then restart() systems and create new GpuColliders");
    if (!known.ready) {
        check(gl.getExtension("EXT_color_buffer_float"),
              "this browser cannot render to float textures (EXT_color_buffer_float); " +
              "try another browser or newer drivers");
        known.ready = true;
    }
    wasm.GL.makeContextCurrent(known.handle);
    return known.losses;
}

/** Like use(), but also throws if the number of losses is no longer `losses`. fix: advice for the message. */
export function useUnlessLost(gl, losses, fix) {
    check(use(gl) === losses, `the WebGL context was lost meanwhile; ${fix}`);
}

/** Frees an object of a context. For objects lost with their context, only the emscripten tables are updated. */
export function free(gl, losses, name, handle) {
    const known = recordOf(gl);
    if (known.losses !== losses || gl.isContextLost()) {
        const nothing = new Proxy({}, { get: (kept, key) => kept[key] ?? (key === "canvas" ? undefined : () => null) });
        nullContext ||= wasm.GL.registerContext(nothing, { majorVersion: 2, enableExtensionsByDefault: false });
        wasm.GL.makeContextCurrent(nullContext);
    } else {
        wasm.GL.makeContextCurrent(known.handle);
    }
    call(name, handle);
}
