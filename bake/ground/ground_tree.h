// SPDX-License-Identifier: Apache-2.0
// A tree of patches straight from heights, without a mesh: each leaf holds 4² squares of the height map, with its own heights.
//
//        root: 64 squares                        the cells of one root, from the side:
//        +-------------------------------+
//        |               |               |       outside      no record of its own, nor what is inside
//        |    outside    |_______________|__
//        |            _..+-´     |   |   |       patches      4 squares, 5² heights of 8 bits over the leaf's own range
//        |       _.-´|   |inside |___|___|
//        |___.--´|___|___|_______|_______|       inside
//
// A leaf's column of squares may be crossed by several cells above each other; they and the next cell below share its heights.
// So distances are those of the surface down to a leaf's side below it. A column that is partly without ground, or too steep, is
// split down to single squares of 2² heights.
//
// Every stored height is at most half a step of its leaf from the sample, where 255 steps are the range of its 25 samples and
// a 512th of the leaf's side, rounded up by at most a sixteenth. So is the surface, which is bilinear between them on either side,
// and neighbouring leaves differ by at most the sum of both. Squares that rise by more than kSteepest of their sides are the
// exception: there the surface stands up to kAside of a square beside its place.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>

#include "bake/ground/height_grid.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// The largest rise within a leaf that 8 bits hold, of its side. A plane of such single squares has 71° along a row, and 64°
/// along a diagonal.
inline constexpr double kSteepest = 2.9;
/// Of a square's side: how far the surface of a steeper square may stand beside its place.
inline constexpr double kAside = 0.15;

/// The farthest that a square may lie from the origin, in squares: there a sixteenth of it is a step of a float.
inline constexpr double kFloatSteps = 524'288.0;

inline constexpr unsigned kLeafLevel = 4;

struct GroundPlace {
    double spacing = 1.0;    ///< between samples, object units
    glm::dvec3 origin{0.0};  ///< of the first sample at height 0, object space
    /// The squares whose steepness is counted, from one on: in tiles that overlap each square is of one.
    glm::uvec2 first{0};
    glm::uvec2 squares{std::numeric_limits<std::uint32_t>::max()};
    /// Splits from a root down to a leaf: fewer for a coarse likeness, whose roots are those of the ground then.
    unsigned leaf_level = kLeafLevel;
    /// Heights from the lowest to the highest that the roots hold, whatever the samples are.
    std::optional<glm::dvec2> heights = {};
};

struct Ground {
    std::uint64_t squares = 0;  ///< with ground; of none there is no more than this
    DepthMap map;
    Bounds bounds;            ///< of the surface, object space
    std::uint64_t steep = 0;  ///< of those to be counted the ones that are steeper than kSteepest
    double error_max = 0.0;   ///< half of the largest step of a leaf, object units; 0: all is steep
};

/// The ground reaches down to a twentieth of its longest side below its lowest point, or further, as that of meshes does
/// (bake/shape). Leaves begin at the first sample, and at height 0: of grids whose origins differ by whole leaves they are the same.
/// The same for any number of threads.
/// Errors, without a name in front: kLimit (a tree beyond kPatchTexelsMax, or finer than floats).
[[nodiscard]] Result<Ground> bakeGround(const HeightGrid& grid, const GroundPlace& place);

}  // namespace relief
