// The exact drawing order of particles by compute shaders: a radix sort, whole in each call (shaders/picture/radix.glsl).
// DepthSorter's on the compute path.
//
//     bytes on the GPU = 24 · capacity and up to 2 MB:
//         elements  2 × 8 bytes (double-buffered)      index of a particle, key
//         counts    of 256 digits in up to 2048 blocks
//         order     RG32UI (on OpenGL ES, whose shaders cannot store into that, RGBA32UI of 16 bytes)
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"

namespace relief {

class RadixSort {
  public:
    /// Where hasCompute(), with the state of a pass (PassState).
    /// \param capacity  1…2^24. \param width  texels in a row of order().
    /// Errors: kLimit (above what this GL takes), kFailure.
    [[nodiscard]] static Result<RadixSort> create(std::uint32_t capacity, std::uint32_t width);

    /// Sorts the particles of the indices below `extent`, 1…capacity; the rest as DepthSorter::update(). Leaves program and
    /// textures changed; restores image and storage units.
    void sort(const GlTexture& positions, std::uint32_t width, std::uint32_t extent, const glm::vec3& eye);

    /// x: index, y: key of the rank; `extent` of the last sort() ranks.
    [[nodiscard]] const GlTexture& order() const { return order_; }

  private:
    /// The division of the elements into blocks.
    struct Cut {
        std::uint32_t count, turns, blocks;
    };

    RadixSort() = default;
    [[nodiscard]] Result<void> createPrograms(std::uint32_t width);
    static void dispatch(const GlProgram& program, const Cut& cut, std::uint32_t digit, std::uint32_t groups);

    GlBuffer elements_[2];
    GlBuffer counts_;
    GlBuffer totals_;
    GlTexture order_;
    GlProgram keys_;   // counts the first digit
    GlProgram count_;  // and the others
    GlProgram scan_;
    GlProgram move_;
    GlProgram place_;  // moves the last digit
};

}  // namespace relief
