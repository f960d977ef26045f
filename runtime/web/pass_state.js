// PassState in a browser: what pass_state_web.cpp calls.
//
// A browser answers some questions about the state at once (bindings, switches) and others only after a round trip to its
// GPU process, which costs as much as a whole step. The latter are the pieces below. They are asked for when a pass first
// sets them, not before; from then on this file knows their values, since passes set them by its own functions only.
mergeInto(LibraryManager.library, {
    $reliefState: {
        levels: [], // of passes within passes; the context is the same throughout
        known: {}, // values of pieces, as long as a pass runs

        // name: [read, write]
        pieces: {
            scissor: [(gl) => gl.getParameter(gl.SCISSOR_BOX), (gl, v) => gl.scissor(...v)],
            blend: [
                (gl) => [gl.BLEND_SRC_RGB, gl.BLEND_DST_RGB, gl.BLEND_SRC_ALPHA, gl.BLEND_DST_ALPHA]
                    .map((one) => gl.getParameter(one)),
                (gl, v) => gl.blendFuncSeparate(...v),
            ],
            equation: [
                (gl) => [gl.BLEND_EQUATION_RGB, gl.BLEND_EQUATION_ALPHA].map((one) => gl.getParameter(one)),
                (gl, v) => gl.blendEquationSeparate(...v),
            ],
            depthFunc: [(gl) => [gl.getParameter(gl.DEPTH_FUNC)], (gl, v) => gl.depthFunc(...v)],
            depthMask: [(gl) => [gl.getParameter(gl.DEPTH_WRITEMASK)], (gl, v) => gl.depthMask(...v)],
            depthRange: [(gl) => gl.getParameter(gl.DEPTH_RANGE), (gl, v) => gl.depthRange(...v)],
            colorMask: [(gl) => gl.getParameter(gl.COLOR_WRITEMASK), (gl, v) => gl.colorMask(...v)],
            clearColor: [(gl) => gl.getParameter(gl.COLOR_CLEAR_VALUE), (gl, v) => gl.clearColor(...v)],
            pack: [
                (gl) => [gl.PACK_ALIGNMENT, gl.PACK_ROW_LENGTH, gl.PACK_SKIP_ROWS, gl.PACK_SKIP_PIXELS]
                    .map((one) => gl.getParameter(one)),
                (gl, v) => [gl.PACK_ALIGNMENT, gl.PACK_ROW_LENGTH, gl.PACK_SKIP_ROWS, gl.PACK_SKIP_PIXELS]
                    .forEach((one, i) => gl.pixelStorei(one, v[i])),
            ],
        },

        set: function (name, value) {
            const self = reliefState;
            const [read, write] = self.pieces[name];
            if (self.levels.length > 0) {
                const before = self.known[name] || read(GLctx);
                self.levels.forEach((level) => (level.kept[name] = level.kept[name] || before));
                self.known[name] = value;
            }
            write(GLctx, value);
        },

        // What a pass counts on; asked for only where it matters.
        setOnce: function (name, value) {
            if (!reliefState.known[name]) {
                reliefState.set(name, value);
            }
        },

        // Bindings and switches, which cost nothing to ask for; and what a pass counts on.
        save: function (units) {
            const gl = GLctx;
            const get = (what) => gl.getParameter(what);
            const self = reliefState;
            if (self.levels.length === 0) {
                self.known = {};
            }
            const saved = {
                kept: {},
                current: gl.currentProgram, // emscripten's own notes, of the program and of pixel buffers
                packNote: gl.currentPixelPackBufferBinding,
                unpackNote: gl.currentPixelUnpackBufferBinding,
                program: get(gl.CURRENT_PROGRAM),
                vertexArray: get(gl.VERTEX_ARRAY_BINDING),
                buffers: [[gl.ARRAY_BUFFER, gl.ARRAY_BUFFER_BINDING], [gl.COPY_READ_BUFFER, gl.COPY_READ_BUFFER_BINDING],
                          [gl.COPY_WRITE_BUFFER, gl.COPY_WRITE_BUFFER_BINDING],
                          [gl.PIXEL_PACK_BUFFER, gl.PIXEL_PACK_BUFFER_BINDING],
                          [gl.PIXEL_UNPACK_BUFFER, gl.PIXEL_UNPACK_BUFFER_BINDING],
                          [gl.UNIFORM_BUFFER, gl.UNIFORM_BUFFER_BINDING]].map(([to, one]) => [to, get(one)]),
                drawTo: get(gl.DRAW_FRAMEBUFFER_BINDING),
                readFrom: get(gl.READ_FRAMEBUFFER_BINDING),
                viewport: get(gl.VIEWPORT),
                active: get(gl.ACTIVE_TEXTURE),
                units: [],
                blocks: [0, 1].map((i) => self.saveBlock(i)),
                switches: [gl.BLEND, gl.DEPTH_TEST, gl.CULL_FACE, gl.SCISSOR_TEST, gl.STENCIL_TEST, gl.DITHER,
                           gl.SAMPLE_ALPHA_TO_COVERAGE, gl.SAMPLE_COVERAGE, gl.RASTERIZER_DISCARD,
                           gl.POLYGON_OFFSET_FILL].map((one) => [one, gl.isEnabled(one)]),
                stores: [[gl.UNPACK_ALIGNMENT, 1], [gl.UNPACK_ROW_LENGTH, 0], [gl.UNPACK_SKIP_ROWS, 0],
                         [gl.UNPACK_SKIP_PIXELS, 0], [gl.UNPACK_IMAGE_HEIGHT, 0], [gl.UNPACK_SKIP_IMAGES, 0],
                         [gl.UNPACK_FLIP_Y_WEBGL, false], [gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false],
                         [gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE]]
                    .map(([one, wanted]) => [one, get(one), wanted]),
                feedback: self.levels.length === 0 ? self.saveFeedback() : null,
            };
            for (let i = 0; i < units; ++i) {
                gl.activeTexture(gl.TEXTURE0 + i);
                saved.units.push([get(gl.TEXTURE_BINDING_2D), get(gl.TEXTURE_BINDING_3D), get(gl.SAMPLER_BINDING)]);
                gl.bindSampler(i, null);
            }
            gl.activeTexture(gl.TEXTURE0); // what makes a texture binds it where it can be put back
            saved.switches.forEach(([one]) => gl.disable(one));
            saved.stores.forEach(([one, , wanted]) => gl.pixelStorei(one, wanted));
            gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
            gl.bindBuffer(gl.PIXEL_UNPACK_BUFFER, null);
            gl.currentPixelPackBufferBinding = gl.currentPixelUnpackBufferBinding = 0;
            self.levels.push(saved);
            self.set("colorMask", [true, true, true, true]);
            if (self.known.depthMask) {
                self.set("depthMask", [true]);
            }
        },

        restore: function () {
            const gl = GLctx;
            const self = reliefState;
            const saved = self.levels.pop();
            gl.useProgram(saved.program);
            gl.currentProgram = saved.current;
            gl.bindVertexArray(saved.vertexArray);
            gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, saved.drawTo);
            gl.bindFramebuffer(gl.READ_FRAMEBUFFER, saved.readFrom);
            gl.viewport(...saved.viewport);
            saved.units.forEach(([flat, solid, sampler], i) => {
                gl.activeTexture(gl.TEXTURE0 + i);
                gl.bindTexture(gl.TEXTURE_2D, flat);
                gl.bindTexture(gl.TEXTURE_3D, solid);
                gl.bindSampler(i, sampler);
            });
            gl.activeTexture(saved.active);
            saved.blocks.forEach((block, i) => self.restoreBlock(i, block));
            saved.buffers.forEach(([to, buffer]) => gl.bindBuffer(to, buffer)); // after the blocks, which bind one too
            gl.currentPixelPackBufferBinding = saved.packNote;
            gl.currentPixelUnpackBufferBinding = saved.unpackNote;
            saved.switches.forEach(([one, on]) => (on ? gl.enable(one) : gl.disable(one)));
            saved.stores.forEach(([one, value]) => gl.pixelStorei(one, value));
            Object.entries(saved.kept).forEach(([name, value]) => {
                self.pieces[name][1](gl, value);
                self.known[name] = value;
            });
            if (saved.feedback) {
                self.restoreFeedback(saved.feedback);
            }
        },

        saveBlock: function (i) {
            const gl = GLctx;
            const buffer = gl.getIndexedParameter(gl.UNIFORM_BUFFER_BINDING, i);
            return buffer === null
                ? { buffer, start: 0, size: 0 }
                : {
                      buffer,
                      start: gl.getIndexedParameter(gl.UNIFORM_BUFFER_START, i),
                      size: gl.getIndexedParameter(gl.UNIFORM_BUFFER_SIZE, i),
                  };
        },

        restoreBlock: function (i, { buffer, start, size }) {
            if (size > 0) {
                GLctx.bindBufferRange(GLctx.UNIFORM_BUFFER, i, buffer, start, size);
            } else {
                GLctx.bindBufferBase(GLctx.UNIFORM_BUFFER, i, buffer);
            }
        },

        // A page that captures vertices does so with a buffer bound, and can use no other program until it pauses.
        saveFeedback: function () {
            const gl = GLctx;
            const saved = {
                object: gl.getParameter(gl.TRANSFORM_FEEDBACK_BINDING),
                buffer: gl.getParameter(gl.TRANSFORM_FEEDBACK_BUFFER_BINDING),
                pauses: gl.getIndexedParameter(gl.TRANSFORM_FEEDBACK_BUFFER_BINDING, 0) !== null &&
                    gl.getParameter(gl.TRANSFORM_FEEDBACK_ACTIVE) && !gl.getParameter(gl.TRANSFORM_FEEDBACK_PAUSED),
            };
            if (saved.pauses) {
                gl.pauseTransformFeedback();
            }
            reliefState.ownFeedback(gl);
            return saved;
        },

        // One of Relief's own: the default one may be the page's, and busy.
        ownFeedback: function (gl) {
            gl.reliefFeedback = gl.reliefFeedback || gl.createTransformFeedback();
            gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, gl.reliefFeedback);
        },

        restoreFeedback: function ({ object, buffer, pauses }) {
            const gl = GLctx;
            gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, object);
            gl.bindBuffer(gl.TRANSFORM_FEEDBACK_BUFFER, buffer);
            if (pauses) {
                gl.resumeTransformFeedback();
            }
        },
    },

    relief_js_save_state__deps: ["$reliefState"],
    relief_js_save_state: function (units) {
        reliefState.save(units);
    },
    relief_js_restore_state__deps: ["$reliefState"],
    relief_js_restore_state: function () {
        reliefState.restore();
    },

    // --- the functions of GLES that set pieces, or need them
    glScissor__deps: ["$reliefState"],
    glScissor: function (x, y, width, height) {
        reliefState.set("scissor", [x, y, width, height]);
    },
    glBlendFunc__deps: ["$reliefState"],
    glBlendFunc: function (from, to) {
        reliefState.set("blend", [from, to, from, to]);
    },
    glBlendFuncSeparate__deps: ["$reliefState"],
    glBlendFuncSeparate: function (fromColor, toColor, fromAlpha, toAlpha) {
        reliefState.set("blend", [fromColor, toColor, fromAlpha, toAlpha]);
    },
    glBlendEquation__deps: ["$reliefState"],
    glBlendEquation: function (mode) {
        reliefState.set("equation", [mode, mode]);
    },
    glBlendEquationSeparate__deps: ["$reliefState"],
    glBlendEquationSeparate: function (color, alpha) {
        reliefState.set("equation", [color, alpha]);
    },
    glDepthFunc__deps: ["$reliefState"],
    glDepthFunc: function (compare) {
        reliefState.set("depthFunc", [compare]);
    },
    glDepthMask__deps: ["$reliefState"],
    glDepthMask: function (on) {
        reliefState.set("depthMask", [Boolean(on)]);
    },
    glDepthRangef__deps: ["$reliefState"],
    glDepthRangef: function (near, far) {
        reliefState.set("depthRange", [near, far]);
    },
    glColorMask__deps: ["$reliefState"],
    glColorMask: function (red, green, blue, alpha) {
        reliefState.set("colorMask", [red, green, blue, alpha].map(Boolean));
    },
    glClearColor__deps: ["$reliefState"],
    glClearColor: function (red, green, blue, alpha) {
        reliefState.set("clearColor", [red, green, blue, alpha]);
    },
    glEnable__deps: ["$reliefState"],
    glEnable: function (what) {
        if (what === 0x0b71 /* GL_DEPTH_TEST */) {
            reliefState.setOnce("depthMask", [true]);
        }
        GLctx.enable(what);
    },
    glClear__deps: ["$reliefState"],
    glClear: function (what) {
        if (what & 0x100 /* GL_DEPTH_BUFFER_BIT */) {
            reliefState.setOnce("depthMask", [true]);
        }
        GLctx.clear(what);
    },
    glClearBufferfv__deps: ["$reliefState"],
    glClearBufferfv: function (buffer, which, value) {
        if (buffer === 0x1801 /* GL_DEPTH */) {
            reliefState.setOnce("depthMask", [true]);
        }
        GLctx.clearBufferfv(buffer, which, HEAPF32, value >> 2);
    },
    glPixelStorei__deps: ["$reliefState"],
    glPixelStorei: function (what, value) {
        const packs = [0x0d05, 0x0d02, 0x0d03, 0x0d04]; // GL_PACK_ALIGNMENT and the rest, as the piece has them
        if (packs.includes(what)) {
            reliefState.setOnce("pack", [1, 0, 0, 0]);
            reliefState.set("pack", reliefState.known.pack.map((one, i) => (packs[i] === what ? value : one)));
        } else {
            GLctx.pixelStorei(what, value);
        }
    },
    glReadPixels__deps: ["$reliefState", "$heapObjectForWebGLType", "$heapAccessShiftForWebGLHeap"],
    glReadPixels: function (x, y, width, height, format, type, pixels) {
        reliefState.setOnce("pack", [1, 0, 0, 0]);
        if (GLctx.currentPixelPackBufferBinding) {
            GLctx.readPixels(x, y, width, height, format, type, pixels);
        } else {
            const heap = heapObjectForWebGLType(type);
            GLctx.readPixels(x, y, width, height, format, type, heap, pixels >> heapAccessShiftForWebGLHeap(heap));
        }
    },
});
