// SPDX-License-Identifier: Apache-2.0
// Ten colliders and their queries, to compare the shader texts of shaders/engines with the CPU (formats/collider.h).
// Every program that executes a text uses the inputs of Case and returns one Answer per query.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <vector>

#include "formats/collider.h"
#include "formats/patch_constants.h"

namespace relief::engines {

inline constexpr std::uint32_t kWidth = 2048;  ///< texels per row of the texture

/// The inputs of reliefDistance() and reliefCollide(); object space. The last number of point and velocity is unused.
struct Query {
    glm::vec4 point;
    glm::vec4 velocity;
    glm::vec4 reaction;  ///< radius, restitution, friction, unused
};

/// The results of both functions. A motion is the result of reliefCollide().
struct Answer {
    glm::vec4 surface;   ///< normal and distance of reliefDistance()
    glm::vec4 position;  ///< position and distance of the motion
    glm::vec4 velocity;  ///< velocity of the motion, 0
    glm::vec4 normal;    ///< normal of the motion, 0
};

struct Case {
    std::string name;
    Collider collider;  ///< one map of patches
    PatchConstants constants;
    std::vector<std::uint16_t> texels;  ///< rows of kWidth texels, four words each
    std::vector<Query> queries;

    [[nodiscard]] std::uint32_t height() const {
        return static_cast<std::uint32_t>(texels.size() / (4 * kWidth));
    }
};

/// Patches in all 13 frames and 3 sizes, pairs, cells without a patch, coarse cells, one root and many, a deep tree, a
/// tree that follows other texels in its texture, rotations, reflections, scales from 0.001 to 1000, and a baked bunny.
/// \param count  queries per collider: uniform, near the surface, on borders of cells, and a few that are not finite.
[[nodiscard]] std::vector<Case> makeCases(std::size_t count);

/// Makes a case from a baked collider, such as one read from a file.
/// \param before  texels in front of the tree.
[[nodiscard]] Case makeCase(std::string name, Collider collider, std::size_t count, std::uint32_t seed,
                            std::uint32_t before = 0);

/// How closely a text matches the CPU. No reaction may differ, and motions must match their formula.
enum class Match {
    kFused,  ///< compilers may fuse multiplications and additions: points may be in other cells, and few signs differ
    kRounded,  ///< compilers may reorder operations: no sign differs, and few points are at borders
    kCells,    ///< `precise`: every point is in the same cell and on the same side
    kBits,     ///< also, distances to patches are bit-identical: divisions and roots are rounded correctly
};

/// How the answers of a text differ from the CPU's. The largest differences include only queries that agree in sign and
/// are not at a border.
struct Difference {
    std::size_t inside = 0;   ///< queries that both evaluate as inside
    std::size_t outside = 0;  ///< queries that both evaluate as outside, within the roots
    std::size_t beyond = 0;   ///< queries that both evaluate as outside the roots
    std::size_t hits = 0;     ///< queries that move the particle

    std::size_t signs = 0;    ///< queries with different signs, or outside the roots for only one
    std::size_t rounded = 0;  ///< the same, but within kRounding of the surface
    std::size_t borders = 0;  ///< queries that rounding moves into another cell, or across the surface
    double patches = 0.0;     ///< largest difference of distances to patches, in root cells
    double flat = 0.0;    ///< the same in cells without a patch; relative if the distance exceeds a root cell
    double normal = 0.0;  ///< largest difference of normals
    double motion = 0.0;  ///< largest error of reliefCollide(), relative to its inputs
    std::size_t reactions = 0;  ///< queries whose motion differs from its formula in distance, hit or normal
    std::string first;          ///< the first query with a different sign or reaction

    /// Returns whether all differences are within the bounds of this match; see the constants below.
    [[nodiscard]] bool isWithinBounds(Match match) const;
    [[nodiscard]] std::string text() const;
};

/// Compares distances and normals with the CPU's, and motions with their formula in doubles for the text's own surface.
[[nodiscard]] Difference compare(const Case& one, std::span<const Answer> answers);

/// One ulp of a root cell's edge, as a fraction of that edge.
inline constexpr double kUlp = 0x1p-23;
/// Bound of distances. Compilers may reorder operations unless a text is `precise`. In cells without a patch, texts
/// multiply normals by 1 / length, whereas the CPU divides them by their length.
inline constexpr double kRounding = 4.0 * kUlp;
inline constexpr double kNormalMax = 2e-6;
inline constexpr double kMotionMax = 4e-7;
inline constexpr double kBorderMax = 1e-3;  ///< fraction of queries
inline constexpr double kFusedSignsMax =
    5e-4;  ///< fraction of queries; an eighth of them is placed on borders

}  // namespace relief::engines
