// SPDX-License-Identifier: Apache-2.0
// The layout of all maps of some colliders in the three textures of ColliderTextures. Plain arithmetic, no GL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/depth_map.h"

namespace relief {

/// A map, and whether it is live: drawn anew before each step, its texels not yet known.
struct PlacedMap {
    const DepthMap* map = nullptr;
    bool live = false;
};

/// The maps of a collider by itself.
[[nodiscard]] std::vector<PlacedMap> placedMaps(const Collider& collider);

/// A part of a texture that is drawn to.
struct TexelRectangle {
    std::int32_t x = 0;
    std::int32_t y = 0;
    std::int32_t width = 0;
    std::int32_t height = 0;
};

/// The layout of one texture: texels that follow each other row by row, and below them rectangles. Add everything, call
/// finish(), then query.
class TexelLayout {
  public:
    void addPacked(std::size_t texels) { packed_ += texels; }
    void addRectangle(std::int32_t width, std::int32_t height) {
        rectangles_.push_back({0, 0, width, height});
    }
    /// Chooses the least power of two as width that holds it all no higher than wide. False where that is
    /// above `side_max`.
    [[nodiscard]] bool finish(std::int32_t side_max);

    [[nodiscard]] std::int32_t log2Width() const { return log2_width_; }
    [[nodiscard]] std::int32_t width() const { return std::int32_t{1} << log2_width_; }
    [[nodiscard]] std::int32_t height() const { return height_; }  ///< 0: nothing in it
    [[nodiscard]] std::size_t texels() const;                      ///< of what was added
    /// The i-th that was added.
    [[nodiscard]] const TexelRectangle& rectangle(std::size_t i) const { return rectangles_[i]; }
    /// Of its texel (0, 0), counted row by row.
    [[nodiscard]] std::size_t index(const TexelRectangle& r) const {
        return (static_cast<std::size_t>(r.y) << log2_width_) + static_cast<std::size_t>(r.x);
    }

  private:
    /// On shelves from left to right; the height, or side_max + 1 where it does not fit.
    std::int32_t place(std::int32_t side_max);

    std::size_t packed_ = 0;
    std::vector<TexelRectangle> rectangles_;
    std::int32_t log2_width_ = 0;
    std::int32_t height_ = 0;
};

/// The textures: one for each layout of texels, in the order of the block's widths.
enum TexelKind : std::size_t { kFloatTexels = 0, kFixedTexels = 1, kFrontBackTexels = 2 };
inline constexpr std::size_t kTexelKinds = 3;

[[nodiscard]] TexelKind texelKindOf(MapFormat format);

/// The place of one map.
struct MapPlace {
    TexelKind kind = kFloatTexels;
    std::size_t first = 0;   ///< index of its texel (0, 0), counted row by row of the texture
    std::int32_t pitch = 0;  ///< texels from one of its rows to the next
    TexelRectangle texels;   ///< of a live map: where it is drawn to
    TexelRectangle motion;   ///< of a live map: where its motion is drawn to, in the float texture
    std::size_t motion_first = 0;
};

struct MapLayout {
    std::array<TexelLayout, kTexelKinds> textures;  ///< by TexelKind
    std::vector<MapPlace> places;                   ///< of the maps, in their order

    /// The first texel of the room for more patches, behind those of the maps.
    std::size_t room = 0;

    /// \param side_max  of a texture, texels.
    /// \param room_texels  for patches that come later.
    /// Errors: kUnsupported (no maps), kLimit (a texture would have to be larger).
    [[nodiscard]] static Result<MapLayout> create(std::span<const PlacedMap> maps, std::int32_t side_max,
                                                  std::size_t room_texels = 0);
};

}  // namespace relief
