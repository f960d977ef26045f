// SPDX-License-Identifier: Apache-2.0
// Assigns the maps of colliders to regions of the three textures of ColliderTextures. Independent of GL.
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

/// A map. Live maps are rendered before each step, and their texels are not known in advance.
struct PlacedMap {
    const DepthMap* map = nullptr;
    bool live = false;
};

/// Returns the maps of a single collider.
[[nodiscard]] std::vector<PlacedMap> placedMaps(const Collider& collider);

/// A region of a texture that is rendered to.
struct TexelRectangle {
    std::int32_t x = 0;
    std::int32_t y = 0;
    std::int32_t width = 0;
    std::int32_t height = 0;
};

/// The layout of one texture: texels packed row by row, and rectangles below them. Add everything, call finish(), then
/// query.
class TexelLayout {
  public:
    void addPacked(std::size_t texels) { packed_ += texels; }
    void addRectangle(std::int32_t width, std::int32_t height) {
        rectangles_.push_back({0, 0, width, height});
    }
    /// Chooses the width: the smallest power of two that is not below the resulting height. Returns false if this width
    /// is above `side_max`.
    [[nodiscard]] bool finish(std::int32_t side_max);

    [[nodiscard]] std::int32_t log2Width() const { return log2_width_; }
    [[nodiscard]] std::int32_t width() const { return std::int32_t{1} << log2_width_; }
    [[nodiscard]] std::int32_t height() const { return height_; }  ///< 0 if empty
    [[nodiscard]] std::size_t texels() const;                      ///< total number of texels added
    /// Returns the i-th rectangle added.
    [[nodiscard]] const TexelRectangle& rectangle(std::size_t i) const { return rectangles_[i]; }
    /// Returns the row-major index of the rectangle's texel (0, 0).
    [[nodiscard]] std::size_t index(const TexelRectangle& r) const {
        return (static_cast<std::size_t>(r.y) << log2_width_) + static_cast<std::size_t>(r.x);
    }

  private:
    /// Places the rectangles on shelves from left to right. Returns the height, or side_max + 1 if they do not fit.
    std::int32_t place(std::int32_t side_max);

    std::size_t packed_ = 0;
    std::vector<TexelRectangle> rectangles_;
    std::int32_t log2_width_ = 0;
    std::int32_t height_ = 0;
};

/// The three textures: one for each size of a texel, in the order of the log2 widths in u_relief_count.
enum TexelKind : std::size_t { kFloatTexels = 0, kFixedTexels = 1, kFrontBackTexels = 2 };
inline constexpr std::size_t kTexelKinds = 3;

[[nodiscard]] TexelKind texelKindOf(MapFormat format);

/// The location of one map.
struct MapPlace {
    TexelKind kind = kFloatTexels;
    std::size_t first = 0;   ///< row-major index of the map's texel (0, 0) in the texture
    std::int32_t pitch = 0;  ///< texels from the start of a row to the start of the next
    TexelRectangle texels;   ///< live maps: where the map is rendered
    TexelRectangle motion;   ///< live maps: where surface motion is drawn, in the float texture
    std::size_t motion_first = 0;
};

struct MapLayout {
    std::array<TexelLayout, kTexelKinds> textures;  ///< indexed by TexelKind
    std::vector<MapPlace> places;                   ///< one for each map, in order

    /// Row-major index of the first texel reserved for later patches, in the front-back texture.
    std::size_t room = 0;

    /// \param side_max  maximum side of a texture, texels.
    /// \param room_texels  texels to reserve for later patches.
    /// Errors: kUnsupported (no maps), kLimit (a texture would exceed side_max).
    [[nodiscard]] static Result<MapLayout> create(std::span<const PlacedMap> maps, std::int32_t side_max,
                                                  std::size_t room_texels = 0);
};

}  // namespace relief
