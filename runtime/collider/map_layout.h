// The layout of all maps of some colliders in the three textures of ColliderTextures. Plain arithmetic, no GL.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "formats/depth_map.h"
#include "runtime/collider/texel_layout.h"

namespace relief {

/// A map, and whether it is live: drawn anew before each step, its texels not yet known.
struct PlacedMap {
    const DepthMap* map = nullptr;
    bool live = false;
};

/// The textures: one for each layout of texels, in the order of the block's widths.
enum TexelKind : std::size_t { kFloatTexels = 0, kFixedTexels = 1, kFrontBackTexels = 2 };
inline constexpr std::size_t kTexelKinds = 3;

[[nodiscard]] TexelKind texelKindOf(MapFormat format);

/// The place of one map.
struct MapPlace {
    TexelKind kind = kFloatTexels;
    std::size_t first =
        0;  ///< index of its texel (0, 0), or of its first row's span (shader_texels.h), counted row by
            ///< row of the texture
    GLint pitch = 0;        ///< texels from one of its rows to the next; of no use where rows have spans
    TexelRectangle texels;  ///< of a live map: where it is drawn to
    TexelRectangle motion;  ///< of a live map: where its motion is drawn to, in the float texture
    std::size_t motion_first = 0;
};

struct MapLayout {
    std::array<TexelLayout, kTexelKinds> textures;  ///< by TexelKind
    std::vector<MapPlace> places;                   ///< of the maps, in their order

    /// \param side_max  of a texture, texels.
    /// Fails with kLimit where a texture would have to be larger.
    [[nodiscard]] static Result<MapLayout> create(std::span<const PlacedMap> maps, GLint side_max);
};

}  // namespace relief
