#include "runtime/collider/texel_layout.h"

#include <algorithm>

namespace relief {

std::size_t TexelLayout::texels() const {
    std::size_t sum = packed_;
    for (const TexelRectangle& r : rectangles_) {
        sum += static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height);
    }
    return sum;
}

bool TexelLayout::finish(GLint side_max) {
    for (log2_width_ = 0; width() <= side_max && log2_width_ < 30; ++log2_width_) {
        height_ = place(side_max);
        if (height_ <= width()) {
            return true;
        }
    }
    return false;
}

GLint TexelLayout::place(GLint side_max) {
    const GLint full = side_max + 1;
    const auto row_texels = static_cast<std::size_t>(width());
    const std::size_t rows = (packed_ + row_texels - 1) >> log2_width_;
    if (rows > static_cast<std::size_t>(side_max)) {
        return full;
    }
    GLint x = 0;
    auto shelf = static_cast<GLint>(rows);
    GLint top = shelf;
    for (TexelRectangle& r : rectangles_) {
        if (x + r.width > width()) {
            x = 0;
            shelf = top;
        }
        if (r.width > width() || r.height > side_max - shelf) {
            return full;
        }
        r.x = x;
        r.y = shelf;
        x += r.width;
        top = std::max(top, shelf + r.height);
    }
    return top;
}

}  // namespace relief
