// SPDX-License-Identifier: Apache-2.0
// The places where a collider is most wrong, with causes.
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
    kSheet,       ///< the surface beside it has the outside on both of its sides
    kOpen,        ///< inside, but a line of sight reaches it: the mesh is open, and the map looks in
    kUnseen,      ///< outside, but no line of sight reaches it, nor the surface beside it; or no map votes
    kSilhouette,  ///< for the deciding map, the surface beside it lies behind another part of the mesh
    kTexel,       ///< the surface beside it is finer than the texel of the deciding map
};
template <>
inline constexpr std::array<std::string_view, 5> kWordsOf<WrongCause>{"sheet", "open", "unseen", "silhouette",
                                                                      "texel"};
inline constexpr std::size_t kWrongCauses = kWordsOf<WrongCause>.size();

/// A part of the surface with many points near it on the wrong side.
struct WorstPlace {
    glm::vec3 position{0.0F};     ///< a typical point on the wrong side
    Bounds box;                   ///< of its points on the wrong side
    std::uint64_t points = 0;     ///< on the wrong side
    double share_percent = 0.0;   ///< of all points near the surface on the wrong side
    double inside_percent = 0.0;  ///< of its points: inside by error
    int map = -1;                 ///< that decides most of them; −1: no map votes
    double map_percent = 0.0;     ///< of its points: decided by that map
    double texel = 0.0;           ///< side of that map's texels at `position`, object units; 0 without a map
    WrongCause cause = WrongCause::kTexel;  ///< of most of them
    double cause_percent = 0.0;

    /// Object units.
    [[nodiscard]] double size() const { return box.longestSide(); }
};

/// The places with the most points near the surface on the wrong side, the worst first: each a cell of 3 % of the longest side
/// and the similarly bad cells within three of it. At most `count`; the same for any number of threads.
/// \param query  of the mesh of `samples`.
/// \param sights  of the collider's maps, in the baked mesh.
[[nodiscard]] std::vector<WorstPlace> worstPlaces(const TruthSamples& samples, const MeshQuery& query,
                                                  const Sights& sights, const Collider& collider,
                                                  std::size_t count = 3);

/// Side of a map's texels at a point of its volume, object units, the longer one; of patches patchSpacingAt().
[[nodiscard]] double texelAt(const DepthMap& map, const glm::vec3& p);

}  // namespace relief
