// SPDX-License-Identifier: Apache-2.0
// Sprite pictures: cells of equal size in one texture.
//
//     ┌───┬───┬───┐      cells are numbered row by row from the top left; texels are linear and premultiplied
//     │ 0 │ 1 │ 2 │      by alpha, so that filtering adds no dark edges
//     ├───┼───┼───┤
//     │ 3 │ 4 │ 5 │      bytes on the GPU = 8 · width · height, plus a third for mip levels
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

    /// Needs a current context; restores the GL state.
    /// \param rgba  4 · width · height bytes, sRGB with straight alpha, top row first.
    /// \param columns, rows  of cells; must divide width and height.
    /// Errors: kUsage (sizes do not match), kLimit (above kSideMax, or GL limits).
    [[nodiscard]] static Result<SpriteAtlas> create(std::span<const std::uint8_t> rgba, std::uint32_t width,
                                                    std::uint32_t height, std::uint32_t columns,
                                                    std::uint32_t rows);

    [[nodiscard]] const GlTexture& texture() const { return texture_; }
    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    /// Returns the last mip level in which no texel covers two cells.
    [[nodiscard]] int lastLevel() const { return last_level_; }

  private:
    GlTexture texture_;
    int columns_ = 1;
    int rows_ = 1;
    int last_level_ = 0;
};

}  // namespace relief
