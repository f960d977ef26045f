// SPDX-License-Identifier: Apache-2.0
#include "runtime/c_api/objects.h"

#include <utility>

#include "runtime/gl/gl_functions.h"
#include "shaders/shader_text.h"

namespace relief {

namespace {

Result<TexturesObject> completed(TexturesObject made) {
    made.glsl = std::string(kShaderLicence) + made.textures().defines() +
                RELIEF_TRY(shaderText("collider/collider.glsl"));
    glGetIntegerv(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, &made.units);
    glGetIntegerv(GL_MAX_UNIFORM_BUFFER_BINDINGS, &made.blocks);
    return made;
}

}  // namespace

Result<TexturesObject> texturesObject(WorldTextures textures) {
    return completed({.own = std::move(textures)});
}

Result<TexturesObject> texturesObject(std::unique_ptr<WorldStream> stream) {
    return completed({.own = {}, .stream = std::move(stream)});
}

}  // namespace relief
