// SPDX-License-Identifier: Apache-2.0
// PassState for browsers: wraps the WebGL2 context for the WebAssembly and restores the state of the page after each
// pass.
//
// Some state (bindings, switches) can be queried immediately. Other state needs a round trip to the GPU process of the
// browser, which takes as long as a whole step. kPieces lists the slow state: it is queried only when a pass first sets
// it. From then on its value is known, because passes set it only through this object.
const kPack = ["PACK_ALIGNMENT", "PACK_ROW_LENGTH", "PACK_SKIP_ROWS", "PACK_SKIP_PIXELS"];
const kPieces = { // setter: parameters to query
    scissor: ["SCISSOR_BOX"],
    blendFuncSeparate: ["BLEND_SRC_RGB", "BLEND_DST_RGB", "BLEND_SRC_ALPHA", "BLEND_DST_ALPHA"],
    blendEquationSeparate: ["BLEND_EQUATION_RGB", "BLEND_EQUATION_ALPHA"],
    depthFunc: ["DEPTH_FUNC"],
    depthMask: ["DEPTH_WRITEMASK"],
    depthRange: ["DEPTH_RANGE"],
    colorMask: ["COLOR_WRITEMASK"],
    clearColor: ["COLOR_CLEAR_VALUE"],
    pack: kPack,
};
const kBlocks = [0, 1]; // uniform block bindings that passes use
const kBuffers = ["ARRAY_BUFFER", "COPY_READ_BUFFER", "COPY_WRITE_BUFFER", "PIXEL_PACK_BUFFER", "PIXEL_UNPACK_BUFFER",
                  "UNIFORM_BUFFER"];
const kCapabilities = ["BLEND", "DEPTH_TEST", "CULL_FACE", "SCISSOR_TEST", "STENCIL_TEST", "DITHER", "SAMPLE_ALPHA_TO_COVERAGE",
                   "SAMPLE_COVERAGE", "RASTERIZER_DISCARD", "POLYGON_OFFSET_FILL"]; // disabled during a pass
const kUnpackParameters = { UNPACK_ALIGNMENT: 1, UNPACK_ROW_LENGTH: 0, UNPACK_SKIP_ROWS: 0, UNPACK_SKIP_PIXELS: 0, UNPACK_IMAGE_HEIGHT: 0,
                  UNPACK_SKIP_IMAGES: 0, UNPACK_FLIP_Y_WEBGL: false, UNPACK_PREMULTIPLY_ALPHA_WEBGL: false,
                  UNPACK_COLORSPACE_CONVERSION_WEBGL: 0 };
// properties that emscripten stores on the context: current program and pixel buffers
const kContextProperties = ["currentProgram", "currentPixelPackBufferBinding", "currentPixelUnpackBufferBinding"];

export function withPassState(gl) {
    const levels = []; // one entry per nested pass: { kept, undo }
    let known = {}; // values of pieces during the outermost pass
    const get = (name) => gl.getParameter(gl[name]);
    const own = {};
    for (const key in gl) {
        own[key] = typeof gl[key] === "function" ? gl[key].bind(gl) : gl[key];
    }

    const blockPiece = (index) => `block ${index}`;
    const writers = Object.fromEntries(Object.keys(kPieces).map((piece) => [piece, (values) => gl[piece](...values)]));
    writers.pack = (values) => kPack.forEach((name, i) => gl.pixelStorei(gl[name], values[i]));
    const readers = Object.fromEntries(Object.entries(kPieces).map(([piece, names]) =>
        [piece, () => names.map(get).flatMap((one) => (one.length === undefined ? one : [...one]))]));
    for (const index of kBlocks) { // buffer, start and size; 0, 0: the whole buffer
        writers[blockPiece(index)] = ([buffer, start, size]) => (size > 0
            ? gl.bindBufferRange(gl.UNIFORM_BUFFER, index, buffer, start, size) : gl.bindBufferBase(gl.UNIFORM_BUFFER, index, buffer));
        readers[blockPiece(index)] = () => {
            const query = (part) => gl.getIndexedParameter(gl[`UNIFORM_BUFFER_${part}`], index);
            const buffer = query("BINDING");
            return buffer === null ? [null, 0, 0] : [buffer, query("START"), query("SIZE")];
        };
    }
    const set = (piece, values) => {
        if (levels.length > 0) {
            const before = known[piece] ?? readers[piece]();
            levels.forEach(({ kept }) => (kept[piece] ??= before));
            known[piece] = values;
        }
        writers[piece](values);
    };
    // Sets a value that a pass requires, unless the pass has already set that state.
    const need = (piece, values) => known[piece] ?? set(piece, values);
    const needPack = () => need("pack", [1, 0, 0, 0]);
    const needDepth = (matters) => matters && need("depthMask", [true]);

    for (const piece of Object.keys(kPieces)) {
        own[piece] = (...values) => set(piece, values);
    }
    for (const [how, part] of [["bindBufferBase", () => [0, 0]], ["bindBufferRange", (start, size) => [start, size]]]) {
        own[how] = (target, index, buffer, ...rest) => (target === gl.UNIFORM_BUFFER && kBlocks.includes(index)
            ? set(blockPiece(index), [buffer, ...part(...rest)]) : gl[how](target, index, buffer, ...rest));
    }
    own.isBuffer = (buffer) => Boolean(buffer); // emscripten removes deleted buffers from its table
    own.blendFunc = (from, to) => own.blendFuncSeparate(from, to, from, to);
    own.blendEquation = (mode) => own.blendEquationSeparate(mode, mode);
    own.enable = (what) => (needDepth(what === gl.DEPTH_TEST), gl.enable(what));
    own.clear = (what) => (needDepth(what & gl.DEPTH_BUFFER_BIT), gl.clear(what));
    own.clearBufferfv = (buffer, ...rest) => (needDepth(buffer === gl.DEPTH), gl.clearBufferfv(buffer, ...rest));
    own.readPixels = (...all) => (needPack(), gl.readPixels(...all));
    own.pixelStorei = (what, value) => {
        if (kPack.some((name) => gl[name] === what)) {
            needPack();
            set("pack", known.pack.map((one, i) => (gl[kPack[i]] === what ? value : one)));
        } else {
            gl.pixelStorei(what, value);
        }
    };

    // While transform feedback of the page is active, no other program can be used; pause it. A pass binds its own
    // transform feedback object, because the page may be using the default one.
    const leaveFeedback = () => {
        const [object, buffer] = [get("TRANSFORM_FEEDBACK_BINDING"), get("TRANSFORM_FEEDBACK_BUFFER_BINDING")];
        const pauses = gl.getIndexedParameter(gl.TRANSFORM_FEEDBACK_BUFFER_BINDING, 0) !== null &&
            get("TRANSFORM_FEEDBACK_ACTIVE") && !get("TRANSFORM_FEEDBACK_PAUSED");
        if (pauses) {
            gl.pauseTransformFeedback();
        }
        const instead = gl.createTransformFeedback();
        gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, instead);
        return () => {
            gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, object);
            gl.deleteTransformFeedback(instead);
            gl.bindBuffer(gl.TRANSFORM_FEEDBACK_BUFFER, buffer);
            if (pauses) {
                gl.resumeTransformFeedback();
            }
        };
    };

    /** Saves bindings and switches, which are cheap to query, and sets the values that a pass requires. */
    own.savePassState = (units) => {
        const undo = [];
        const keep = (value, put) => undo.push(() => put(value));
        if (levels.length === 0) {
            known = {};
        }
        kContextProperties.forEach((note) => keep(own[note], (value) => (own[note] = value)));
        keep(get("CURRENT_PROGRAM"), (program) => gl.useProgram(program));
        keep(get("VERTEX_ARRAY_BINDING"), (array) => gl.bindVertexArray(array));
        for (const target of ["DRAW_FRAMEBUFFER", "READ_FRAMEBUFFER"]) {
            keep(get(`${target}_BINDING`), (framebuffer) => gl.bindFramebuffer(gl[target], framebuffer));
        }
        keep(get("VIEWPORT"), (box) => gl.viewport(...box));
        const active = get("ACTIVE_TEXTURE");
        for (let unit = units - 1; unit >= 0; --unit) { // unit 0 stays active: new textures are bound there
            gl.activeTexture(gl.TEXTURE0 + unit);
            keep([get("TEXTURE_BINDING_2D"), get("TEXTURE_BINDING_3D"), get("SAMPLER_BINDING")], ([flat, solid, sampler]) => {
                gl.activeTexture(gl.TEXTURE0 + unit);
                gl.bindTexture(gl.TEXTURE_2D, flat);
                gl.bindTexture(gl.TEXTURE_3D, solid);
                gl.bindSampler(unit, sampler);
            });
            gl.bindSampler(unit, null);
        }
        keep(active, (unit) => gl.activeTexture(unit));
        for (const target of kBuffers) {
            keep(get(`${target}_BINDING`), (buffer) => gl.bindBuffer(gl[target], buffer));
        }
        for (const name of kCapabilities) {
            keep(gl.isEnabled(gl[name]), (on) => (on ? gl.enable(gl[name]) : gl.disable(gl[name])));
            gl.disable(gl[name]);
        }
        for (const [name, wanted] of Object.entries(kUnpackParameters)) {
            keep(get(name), (value) => gl.pixelStorei(gl[name], value));
            gl.pixelStorei(gl[name], wanted);
        }
        gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
        gl.bindBuffer(gl.PIXEL_UNPACK_BUFFER, null);
        own.currentPixelPackBufferBinding = own.currentPixelUnpackBufferBinding = 0;
        if (levels.length === 0) {
            undo.push(leaveFeedback());
        }
        levels.push({ kept: {}, undo });
        set("colorMask", [true, true, true, true]);
        if (known.depthMask) {
            set("depthMask", [true]);
        }
    };

    own.restorePassState = () => {
        const { kept, undo } = levels.pop();
        // Restored before the bindings, because binding a uniform block also binds a buffer.
        Object.entries(kept).forEach(([piece, values]) => writers[piece](known[piece] = values));
        undo.forEach((put) => put());
    };
    return own;
}
