// Objects behind the handles of colliders and textures, shared with other files that take handles of C.
#pragma once

#include <string>

#include "formats/collider.h"
#include "runtime/c_api/call.h"
#include "runtime/collider/collider_textures.h"

// Of relief.h, whose functions are built on this file.
struct relief_collider;
struct relief_textures;

namespace relief {

struct TexturesObject {
    ColliderTextures textures;
    std::string glsl;
    GLint units = 0;   // texture units of the context
    GLint blocks = 0;  // uniform block bindings
};

template <>
struct HandleType<relief_collider> {
    using Object = Collider;
    static constexpr HandleKind kKind = HandleKind::kCollider;
    static constexpr const char* kName = "relief_collider";
};
template <>
struct HandleType<relief_textures> {
    using Object = TexturesObject;
    static constexpr HandleKind kKind = HandleKind::kTextures;
    static constexpr const char* kName = "relief_textures";
};

}  // namespace relief
