// SPDX-License-Identifier: Apache-2.0
// Pictures for sprites: cells of equal size in one texture.
//
//     ┌───┬───┬───┐      cells are counted row by row from the top left; a texel is linear and premultiplied
//     │ 0 │ 1 │ 2 │      by alpha, so that filtering makes no dark edges
//     ├───┼───┼───┤
//     │ 3 │ 4 │ 5 │      bytes on the GPU = 8 · width · height, a third more for the smaller levels
//     └───┴───┴───┘
#pragma once

#include <cstdint>
#include <span>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"

namespace relief {

class SpriteAtlas {
  public:
    static constexpr std::uint32_t kSideMax = 8192;

    /// Needs a current context; restores what it touches.
    /// \param rgba  4 · width · height bytes, sRGB with straight alpha, the top row first.
    /// \param columns, rows  cells; they divide width and height.
    /// Errors: kUsage (sizes that do not fit), kLimit (above kSideMax or what this GL takes).
    [[nodiscard]] static Result<SpriteAtlas> create(std::span<const std::uint8_t> rgba, std::uint32_t width,
                                                    std::uint32_t height, std::uint32_t columns,
                                                    std::uint32_t rows);

    [[nodiscard]] const GlTexture& texture() const { return texture_; }
    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    /// The smallest level in which no texel belongs to two cells.
    [[nodiscard]] int lastLevel() const { return last_level_; }

  private:
    GlTexture texture_;
    int columns_ = 1;
    int rows_ = 1;
    int last_level_ = 0;
};

}  // namespace relief
