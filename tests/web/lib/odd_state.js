// SPDX-License-Identifier: Apache-2.0
// Sets all state of a WebGL2 context to unusual values, and records it. Runs in a page.

/** Sets all state to values other than the defaults. The result keeps the created objects alive. */
export function setOddState(gl) {
    const shader = (type, text) => {
        const made = gl.createShader(type);
        gl.shaderSource(made, text);
        gl.compileShader(made);
        return made;
    };
    const program = gl.createProgram();
    gl.attachShader(program, shader(gl.VERTEX_SHADER, `#version 300 es
        in vec4 a; out vec4 v; uniform Block { vec4 add; }; void main() { gl_Position = v = a + add; }`));
    gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `#version 300 es
        precision highp float; out vec4 color; void main() { color = vec4(0.5); }`));
    gl.transformFeedbackVaryings(program, ["v"], gl.INTERLEAVED_ATTRIBS);
    gl.linkProgram(program);
    gl.useProgram(program);

    const buffer = (target, size = 256) => {
        const made = gl.createBuffer();
        gl.bindBuffer(target, made);
        gl.bufferData(target, size, gl.STATIC_DRAW);
        return made;
    };
    const captured = buffer(gl.TRANSFORM_FEEDBACK_BUFFER, 4096);
    gl.bindBuffer(gl.TRANSFORM_FEEDBACK_BUFFER, null);
    const feedback = gl.createTransformFeedback();
    gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, feedback);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, captured);

    gl.bindVertexArray(gl.createVertexArray());
    buffer(gl.ELEMENT_ARRAY_BUFFER);
    for (const index of [0, 3]) {
        buffer(gl.ARRAY_BUFFER);
        gl.enableVertexAttribArray(index);
        gl.vertexAttribPointer(index, 3, gl.FLOAT, false, 16, 4);
        gl.vertexAttribDivisor(index, index);
    }
    gl.vertexAttrib4f(5, 1, 2, 3, 4);
    ["ARRAY", "COPY_READ", "COPY_WRITE", "PIXEL_PACK", "PIXEL_UNPACK"].forEach((name) => buffer(gl[`${name}_BUFFER`]));
    const blocks = buffer(gl.UNIFORM_BUFFER, 4096);
    for (let i = 0; i < 12; ++i) {
        if (i % 3 === 0) {
            gl.bindBufferBase(gl.UNIFORM_BUFFER, i, blocks);
        } else if (i % 3 === 1) {
            gl.bindBufferRange(gl.UNIFORM_BUFFER, i, blocks, 256 * i, 64);
        }
    }
    buffer(gl.UNIFORM_BUFFER);

    for (let unit = 0; unit < 16; ++unit) {
        gl.activeTexture(gl.TEXTURE0 + unit);
        [gl.TEXTURE_2D, gl.TEXTURE_3D, gl.TEXTURE_2D_ARRAY, gl.TEXTURE_CUBE_MAP].forEach((target, i) => {
            if (unit % 5 !== i) { // some stay empty
                gl.bindTexture(target, gl.createTexture());
            }
        });
        if (unit % 2 === 1) {
            const sampler = gl.createSampler();
            gl.samplerParameteri(sampler, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
            gl.bindSampler(unit, sampler);
        }
    }
    const framebuffer = (target) => {
        const texture = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, 64, 64);
        const made = gl.createFramebuffer();
        gl.bindFramebuffer(target, made);
        gl.framebufferTexture2D(target, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    };
    framebuffer(gl.DRAW_FRAMEBUFFER);
    gl.drawBuffers([gl.COLOR_ATTACHMENT0]);
    framebuffer(gl.READ_FRAMEBUFFER);
    gl.bindRenderbuffer(gl.RENDERBUFFER, gl.createRenderbuffer());
    gl.activeTexture(gl.TEXTURE11);

    gl.viewport(3, 5, 31, 37);
    gl.scissor(7, 11, 13, 17);
    gl.enable(gl.BLEND);
    gl.blendColor(0.1, 0.2, 0.3, 0.4);
    gl.blendFuncSeparate(gl.DST_COLOR, gl.ONE_MINUS_DST_ALPHA, gl.CONSTANT_COLOR, gl.SRC_ALPHA_SATURATE);
    gl.blendEquationSeparate(gl.FUNC_REVERSE_SUBTRACT, gl.MAX);
    gl.depthFunc(gl.GREATER);
    gl.depthMask(false);
    gl.depthRange(0.25, 0.75);
    gl.stencilFuncSeparate(gl.FRONT, gl.NOTEQUAL, 3, 0x1f);
    gl.stencilFuncSeparate(gl.BACK, gl.LEQUAL, 5, 0x2f);
    gl.stencilOpSeparate(gl.FRONT, gl.INCR, gl.DECR_WRAP, gl.INVERT);
    gl.stencilOpSeparate(gl.BACK, gl.ZERO, gl.REPLACE, gl.INCR_WRAP);
    gl.stencilMaskSeparate(gl.FRONT, 0x55);
    gl.stencilMaskSeparate(gl.BACK, 0x33);
    gl.cullFace(gl.FRONT_AND_BACK);
    gl.frontFace(gl.CW);
    gl.polygonOffset(2, 3);
    gl.sampleCoverage(0.5, true);
    gl.colorMask(true, false, true, false);
    gl.clearColor(0.2, 0.4, 0.6, 0.8);
    gl.clearDepth(0.5);
    gl.clearStencil(7);
    gl.lineWidth(1);
    gl.hint(gl.FRAGMENT_SHADER_DERIVATIVE_HINT, gl.NICEST);
    gl.pixelStorei(gl.PACK_ALIGNMENT, 8);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 2);
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    for (const name of ["PACK_ROW_LENGTH", "PACK_SKIP_ROWS", "PACK_SKIP_PIXELS", "UNPACK_ROW_LENGTH",
                        "UNPACK_SKIP_ROWS", "UNPACK_SKIP_PIXELS", "UNPACK_IMAGE_HEIGHT", "UNPACK_SKIP_IMAGES",
                        "UNPACK_FLIP_Y_WEBGL", "UNPACK_PREMULTIPLY_ALPHA_WEBGL"]) {
        gl.pixelStorei(gl[name], name.endsWith("WEBGL") ? true : 3);
    }
    for (const name of ["DEPTH_TEST", "CULL_FACE", "SCISSOR_TEST", "STENCIL_TEST", "SAMPLE_ALPHA_TO_COVERAGE",
                        "SAMPLE_COVERAGE", "RASTERIZER_DISCARD", "POLYGON_OFFSET_FILL"]) {
        gl.enable(gl[name]);
    }
    gl.disable(gl.DITHER);
    gl.beginTransformFeedback(gl.TRIANGLES); // stays active
    const error = gl.getError();
    if (error !== 0) {
        throw new Error(`setOddState: GL error ${error}`);
    }
}

const kNames = `CURRENT_PROGRAM VERTEX_ARRAY_BINDING ARRAY_BUFFER_BINDING ELEMENT_ARRAY_BUFFER_BINDING
    COPY_READ_BUFFER_BINDING COPY_WRITE_BUFFER_BINDING PIXEL_PACK_BUFFER_BINDING PIXEL_UNPACK_BUFFER_BINDING
    UNIFORM_BUFFER_BINDING TRANSFORM_FEEDBACK_BUFFER_BINDING TRANSFORM_FEEDBACK_BINDING TRANSFORM_FEEDBACK_ACTIVE
    TRANSFORM_FEEDBACK_PAUSED DRAW_FRAMEBUFFER_BINDING READ_FRAMEBUFFER_BINDING RENDERBUFFER_BINDING ACTIVE_TEXTURE
    VIEWPORT SCISSOR_BOX BLEND BLEND_COLOR BLEND_SRC_RGB BLEND_DST_RGB BLEND_SRC_ALPHA BLEND_DST_ALPHA
    BLEND_EQUATION_RGB BLEND_EQUATION_ALPHA DEPTH_TEST DEPTH_FUNC DEPTH_WRITEMASK DEPTH_RANGE STENCIL_TEST STENCIL_FUNC
    STENCIL_REF STENCIL_VALUE_MASK STENCIL_FAIL STENCIL_PASS_DEPTH_FAIL STENCIL_PASS_DEPTH_PASS STENCIL_WRITEMASK
    STENCIL_BACK_FUNC STENCIL_BACK_REF STENCIL_BACK_VALUE_MASK STENCIL_BACK_FAIL STENCIL_BACK_PASS_DEPTH_FAIL
    STENCIL_BACK_PASS_DEPTH_PASS STENCIL_BACK_WRITEMASK CULL_FACE CULL_FACE_MODE FRONT_FACE POLYGON_OFFSET_FILL
    POLYGON_OFFSET_FACTOR POLYGON_OFFSET_UNITS SAMPLE_ALPHA_TO_COVERAGE SAMPLE_COVERAGE SAMPLE_COVERAGE_VALUE
    SAMPLE_COVERAGE_INVERT RASTERIZER_DISCARD SCISSOR_TEST DITHER COLOR_WRITEMASK COLOR_CLEAR_VALUE DEPTH_CLEAR_VALUE
    STENCIL_CLEAR_VALUE LINE_WIDTH FRAGMENT_SHADER_DERIVATIVE_HINT GENERATE_MIPMAP_HINT READ_BUFFER DRAW_BUFFER0
    PACK_ALIGNMENT PACK_ROW_LENGTH PACK_SKIP_ROWS PACK_SKIP_PIXELS UNPACK_ALIGNMENT UNPACK_ROW_LENGTH UNPACK_SKIP_ROWS
    UNPACK_SKIP_PIXELS UNPACK_IMAGE_HEIGHT UNPACK_SKIP_IMAGES UNPACK_FLIP_Y_WEBGL UNPACK_PREMULTIPLY_ALPHA_WEBGL
    UNPACK_COLORSPACE_CONVERSION_WEBGL`.split(/\s+/);

/** All state by name: objects by reference, arrays as text. Does not change the state. */
export function recordState(gl) {
    const plain = (value) => (value !== null && value.length !== undefined ? [...value].join(" ") : value);
    const state = {};
    kNames.forEach((name) => (state[name] = plain(gl.getParameter(gl[name]))));
    const active = gl.getParameter(gl.ACTIVE_TEXTURE);
    for (let unit = 0; unit < gl.getParameter(gl.MAX_COMBINED_TEXTURE_IMAGE_UNITS); ++unit) {
        gl.activeTexture(gl.TEXTURE0 + unit);
        for (const name of ["TEXTURE_BINDING_2D", "TEXTURE_BINDING_3D", "TEXTURE_BINDING_2D_ARRAY",
                            "TEXTURE_BINDING_CUBE_MAP", "SAMPLER_BINDING"]) {
            state[`${name} of unit ${unit}`] = gl.getParameter(gl[name]);
        }
    }
    gl.activeTexture(active);
    for (let i = 0; i < gl.getParameter(gl.MAX_UNIFORM_BUFFER_BINDINGS); ++i) {
        for (const name of ["BINDING", "START", "SIZE"]) {
            state[`uniform block ${i}'s ${name}`] = gl.getIndexedParameter(gl[`UNIFORM_BUFFER_${name}`], i);
        }
    }
    state["transform feedback buffer 0"] = gl.getIndexedParameter(gl.TRANSFORM_FEEDBACK_BUFFER_BINDING, 0);
    for (let i = 0; i < gl.getParameter(gl.MAX_VERTEX_ATTRIBS); ++i) {
        for (const name of ["BUFFER_BINDING", "ENABLED", "SIZE", "STRIDE", "DIVISOR"]) {
            state[`attribute ${i}'s ${name}`] = gl.getVertexAttrib(i, gl[`VERTEX_ATTRIB_ARRAY_${name}`]);
        }
        state[`attribute ${i}'s value`] = plain(gl.getVertexAttrib(i, gl.CURRENT_VERTEX_ATTRIB));
    }
    return state;
}
