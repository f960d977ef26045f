// SPDX-License-Identifier: Apache-2.0
// JavaScript functions that stand_ins.cpp calls, linked into the emscripten module. GLctx is the current context.
mergeInto(LibraryManager.library, {
    relief_js_has_extension: function (name) {
        return GLctx.getSupportedExtensions().includes(UTF8ToString(name).replace(/^GL_/, "")) ? 1 : 0;
    },

    relief_js_is_lost: function () {
        return GLctx.isContextLost() ? 1 : 0;
    },

    relief_js_is_software: function () {
        let name = GLctx.getParameter(GLctx.RENDERER);
        if (/^WebKit/.test(name)) { // masked; do not query the extension otherwise, because some browsers log a warning
            const info = GLctx.getExtension("WEBGL_debug_renderer_info");
            name = info ? GLctx.getParameter(info.UNMASKED_RENDERER_WEBGL) : name;
        }
        return /llvmpipe|softpipe|swrast|SwiftShader|Software|Basic Render/i.test(name) ? 1 : 0;
    },

    // --- implemented by pass_state.js
    relief_js_save_state: function (units) {
        GLctx.savePassState(units);
    },

    relief_js_restore_state: function () {
        GLctx.restorePassState();
    },

    relief_js_read_buffer: function (buffer, offset, out, bytes) {
        const bound = GLctx.getParameter(GLctx.PIXEL_PACK_BUFFER_BINDING);
        GLctx.bindBuffer(GLctx.PIXEL_PACK_BUFFER, GL.buffers[buffer]);
        GLctx.getBufferSubData(GLctx.PIXEL_PACK_BUFFER, offset, HEAPU8, out, bytes);
        GLctx.bindBuffer(GLctx.PIXEL_PACK_BUFFER, bound);
    },

    // Returns the size of the result, or -1 if the input is not a zstd frame.
    relief_js_decompress: function (stored, storedSize, raw, rawSize) {
        try {
            const bytes = Module.decompress(HEAPU8.slice(stored, stored + storedSize), rawSize);
            if (bytes.length === rawSize) {
                HEAPU8.set(bytes, raw);
            }
            return bytes.length;
        } catch (error) {
            return -1;
        }
    },
});
