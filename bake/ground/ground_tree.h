// SPDX-License-Identifier: Apache-2.0
// Builds a tree of patches directly from heights, without a mesh: each leaf holds 4² squares of the height map, with
// their heights.
//
//        root: 64 squares                        the cells of one root, from the side:
//        +-------------------------------+
//        |               |               |       outside      no record (likewise inside)
//        |    outside    |_______________|__
//        |            _..+-´     |   |   |       patches      4² squares, 5² heights of 8 bits over the leaf's range
//        |       _.-´|   |inside |___|___|
//        |___.--´|___|___|_______|_______|       inside
//
// The surface of a leaf's 4² squares may cross several stacked cells; these cells and the next cell below share one set
// of heights. Distances are therefore measured to the surface itself, down to one leaf side below it. A column of cells
// that is partly without ground, or too steep, is split, at most to half squares of 2² heights.
//
// Every stored height differs from its sample by at most half a code step of its leaf. 255 steps span the range of the
// leaf's 25 samples plus a 512th of the leaf's side; this span is rounded up by at most a sixteenth. The same bound
// holds for the surface, because the stored and the true surface are both bilinear between the samples. Neighbouring
// leaves differ by at most the sum of their bounds. Squares that rise by more than kSteepest times their side are the
// exception: there the surface may be displaced sideways by up to kAside times the side.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>

#include "bake/ground/column_ranges.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// Largest rise within a leaf that a patch can store, relative to the leaf's side. A plane with this rise per square
/// has a slope of 71° along a row, or 64° along a diagonal.
inline constexpr double kSteepest = 2.9;
/// Maximum sideways displacement of the surface of a steeper square, relative to its side.
inline constexpr double kAside = 0.15;

/// Maximum distance of a square from the origin, in squares; there a float step is a sixteenth of a square.
inline constexpr double kFloatSteps = 524'288.0;

inline constexpr unsigned kLeafLevel = 4;

struct GroundPlace {
    double spacing = 1.0;    ///< between samples, object units
    glm::dvec3 origin{0.0};  ///< position of the first sample at height 0, object space
    /// The squares to count in Ground::steep; if tiles overlap, each square is counted in one tile.
    glm::uvec2 first{0};
    glm::uvec2 squares{std::numeric_limits<std::uint32_t>::max()};
    /// Number of splits from a root to a leaf; smaller for a coarse collider, which keeps the roots of the ground.
    unsigned leaf_level = kLeafLevel;
    /// Lowest and highest height that the roots must contain; nullopt: those of the samples.
    std::optional<glm::dvec2> heights = {};
};

struct Ground {
    std::uint64_t squares = 0;  ///< number with ground; if 0, no other member is set
    DepthMap map;
    Bounds bounds;            ///< of the surface, object space
    std::uint64_t steep = 0;  ///< counted squares that are steeper than kSteepest
    double error_max = 0.0;   ///< half of the largest code step, object units; 0: all squares are steep
};

/// Builds the tree. The ground extends below its lowest point by a twentieth of its longest side, or more, as for
/// meshes (bake/shape). Leaves start at the first sample and at height 0: grids whose origins differ by whole leaves
/// have identical leaves. The result does not depend on the number of threads.
/// Errors, without a file name: kLimit (a tree beyond kPatchTexelsMax, or finer than floats resolve).
[[nodiscard]] Result<Ground> bakeGround(const HeightGrid& grid, const GroundPlace& place);

}  // namespace relief
