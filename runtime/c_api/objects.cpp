#include "runtime/c_api/objects.h"

#include <utility>

#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"

namespace relief {

Result<TexturesObject> texturesObject(ColliderTextures textures) {
    std::string glsl = textures.defines() + RELIEF_TRY(shaderText("collider/collider.glsl"));
    TexturesObject made{.textures = std::move(textures), .glsl = std::move(glsl)};
    glGetIntegerv(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, &made.units);
    glGetIntegerv(GL_MAX_UNIFORM_BUFFER_BINDINGS, &made.blocks);
    return made;
}

}  // namespace relief
