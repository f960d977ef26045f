// SPDX-License-Identifier: Apache-2.0
// Finds the places where a collider is least accurate, with causes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "bake/measure/sight.h"
#include "bake/measure/truth.h"
#include "bake/mesh/mesh_query.h"
#include "formats/collider.h"
#include "formats/fields/field.h"

namespace relief {

/// The cause of a point on the wrong side: the first that applies.
enum class WrongCause : std::uint8_t {
    kSheet,       ///< the nearby surface has the outside on both sides
    kOpen,        ///< inside, but a line of sight reaches it: the mesh is open, and the map looks in
    kUnseen,      ///< outside, but no line of sight reaches the point or the nearby surface; or no map votes
    kSilhouette,  ///< in the deciding map, another part of the mesh hides the nearby surface
    kTexel,       ///< the nearby surface is finer than the deciding map's texel
};
template <>
inline constexpr std::array<std::string_view, 5> kWordsOf<WrongCause>{"sheet", "open", "unseen", "silhouette",
                                                                      "texel"};
inline constexpr std::size_t kWrongCauses = kWordsOf<WrongCause>.size();

/// A region of the surface with many nearby points on the wrong side.
struct WorstPlace {
    glm::vec3 position{0.0F};           ///< a typical wrong point
    Bounds box;                         ///< of its wrong points
    std::uint64_t points = 0;           ///< number of wrong points
    double contribution_percent = 0.0;  ///< of all wrong points near the surface
    double false_inside_percent = 0.0;  ///< of its wrong points: classified as inside
    int map = -1;                       ///< the map that decides its points most often; −1: no map votes
    double map_percent = 0.0;           ///< of its wrong points: decided by that map
    /// Longer side of that map's texels at `position`, object units; 0 without a map.
    double texel = 0.0;
    WrongCause cause = WrongCause::kTexel;  ///< the most frequent cause of its points
    double cause_percent = 0.0;             ///< of at most 200 of its wrong points: due to that cause

    /// Object units.
    [[nodiscard]] double size() const { return box.longestSide(); }
};

/// Finds the places with the most wrong points near the surface, in descending order. A place starts at its worst
/// cell, a cube whose side is 3 % of the mesh's longest side. It grows over neighbouring cells with at least a quarter
/// as many wrong points, up to three cells away, and includes the neighbours of all these cells within that distance.
/// The result does not depend on the number of threads.
/// \param query   of the mesh of `samples`.
/// \param sights  of the collider's maps, in the baked mesh.
/// \param count   maximum number of places.
[[nodiscard]] std::vector<WorstPlace> worstPlaces(const TruthSamples& samples, const MeshQuery& query,
                                                  const Sights& sights, const Collider& collider,
                                                  std::size_t count = 3);

/// Returns the longer side of a map's texels at a point of its volume, object units; for patches, patchSpacingAt().
[[nodiscard]] double texelAt(const DepthMap& map, const glm::vec3& p);

}  // namespace relief
