// The layout of maps in a texture of ColliderTextures: texels that follow each other row by row, and below them
// rectangles that are drawn to.
#pragma once

#include <cstddef>
#include <vector>

#include "runtime/gl/gl_types.h"

namespace relief {

struct TexelRectangle {
    GLint x = 0;
    GLint y = 0;
    GLsizei width = 0;
    GLsizei height = 0;
};

/// Add everything, call finish(), then query.
class TexelLayout {
  public:
    void addPacked(std::size_t texels) { packed_ += texels; }
    void addRectangle(GLsizei width, GLsizei height) { rectangles_.push_back({0, 0, width, height}); }
    /// Chooses the least power of two as width that holds it all no higher than wide. False where that is
    /// above `side_max`.
    [[nodiscard]] bool finish(GLint side_max);

    [[nodiscard]] GLint log2Width() const { return log2_width_; }
    [[nodiscard]] GLint width() const { return GLint{1} << log2_width_; }
    [[nodiscard]] GLint height() const { return height_; }  ///< 0: nothing in it
    [[nodiscard]] std::size_t texels() const;               ///< of what was added
    /// The i-th that was added.
    [[nodiscard]] const TexelRectangle& rectangle(std::size_t i) const { return rectangles_[i]; }
    /// Of its texel (0, 0), counted row by row.
    [[nodiscard]] std::size_t index(const TexelRectangle& r) const {
        return (static_cast<std::size_t>(r.y) << log2_width_) + static_cast<std::size_t>(r.x);
    }

  private:
    /// On shelves from left to right; the height, or side_max + 1 where it does not fit.
    GLint place(GLint side_max);

    std::size_t packed_ = 0;
    std::vector<TexelRectangle> rectangles_;
    GLint log2_width_ = 0;
    GLint height_ = 0;
};

}  // namespace relief
