// SPDX-License-Identifier: Apache-2.0
#include "runtime/collider/collider_textures.h"

#include <vector>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/layout/collider_block.h"

namespace relief {

Result<ColliderTextures> ColliderTextures::create(const Collider& collider) {
    RELIEF_TRY(checkContext());
    GLint block_max = 0;
    glGetIntegerv(GL_MAX_UNIFORM_BLOCK_SIZE, &block_max);
    if (const std::size_t most = mapsInBlock(static_cast<std::size_t>(block_max));
        collider.maps.size() > most) {
        return fail(ErrorCode::kLimit, "the collider has " + std::to_string(collider.maps.size()) +
                                           " maps; this GL context supports " + std::to_string(most) +
                                           "; bake it with fewer maps");
    }
    const std::vector<PlacedMap> maps = placedMaps(collider);
    const MapLayout layout = RELIEF_TRY(MapLayout::create(maps, MapTextures::sideMax()));
    const PassState state;  // resets row lengths and skips, so that texels are tightly packed
    clearGlErrors();
    ColliderTextures result;
    result.defines_ = colliderDefines(maps, layout);
    result.maps_ = MapTextures(maps, layout);
    result.maps_.setBlock(colliderBlock(maps, layout));
    RELIEF_TRY(checkAllocated("the collider's " + std::to_string(result.bytes()) + " bytes of maps",
                              "bake it with fewer maps"));
    return result;
}

}  // namespace relief
