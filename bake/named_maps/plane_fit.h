// SPDX-License-Identifier: Apache-2.0
// Fits supporting planes: the planes that texels store if DepthMap::decode is Decode::kPlane.
//
// A block of rays samples the footprint of a texel. Candidate planes have normals of the sampled surfaces. Each
// candidate is pushed towards the viewer until no sampled surface point lies in front of it, and is rounded so that
// this remains true. The candidate with the least free space behind it wins:
//
//       viewer            Points in front of the plane are outside, points behind it inside. A pushed plane never
//      | | | | |          misclassifies the solid behind a sampled surface point. The fit minimises the space between
//     --.-----.-- plane   plane and surface, which is wrongly inside. Other maps correct this space if they see it, so
//       |\   /|            additional views can only help.
//      surface
//
// The far surfaces of a map are fitted in the same way, along reversed rays.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "bake/named_maps/deep_solid.h"
#include "bake/views/view.h"
#include "formats/normal_index.h"

namespace relief {

struct FootprintRay {
    /// From the viewer: the point at u is origin + u · direction, with u in units of map depth.
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};
    double u = -1.0;         ///< at the surface; negative without a hit
    glm::dvec3 normal{0.0};  ///< unit length, of the surface, towards the viewer
};

inline constexpr std::size_t kFootprintRaysMax = 64;

struct PlaneFitOptions {
    double u_max = 1.0;       ///< depth range: map depth 1, or kCubeDepthMax
    double reach = 1.0;       ///< maximum free space behind the plane that a ray contributes, in u
    double span = 0.0;        ///< sum of both sides of a texel, object units
    double pixel_cost = 0.0;  ///< mean free space per ray, in u, below which the fit stops
    bool cautious = false;    ///< the rays around the footprint constrain all planes, not only steep ones
    int refinements = 3;      ///< rounds of search among neighbouring normals; 0: none
    /// Moves planes inwards by this fraction of the sampled points' spread; more free space is then outside, but also
    /// some solid. Has no effect at steps, where the spread exceeds `span`/4.
    double inward_shift = 0.0;
    /// Maximum distance of a point of the texel from its nearest ray, in texel diagonals. If the |cosine| of
    /// normal and ray is below rays_apart, a plane drops by more than about a texel diagonal over that distance.
    double rays_apart = 0.0;
    /// Rays start in free space. If false, a ray without a hit may be entirely in the solid.
    bool starts_free = true;
};

/// A half-space, quantised as in a texel.
struct FittedPlane {
    glm::dvec3 normal{0.0};  ///< unit length, towards the free side; as decoded by decodeNormal()
    NormalIndex index;
    /// 16-bit fixed point: the centre ray intersects the plane at u = code / 65534 · u_max.
    std::uint16_t code = 0;
};

using AroundRays = std::function<std::span<const FootprintRay>()>;

/// Calls visit(index) for the index and its existing neighbours `step` away in s, t or both.
template <class Visit>
void forNeighbours(NormalIndex from, int step, const Visit& visit) {
    for (int t = from.t - step; t <= from.t + step; t += step) {
        for (int s = from.s - step; s <= from.s + step; s += step) {
            if (s >= 0 && s <= 2 * kNormalHalfRange && t >= 0 && t <= 2 * kNormalHalfRange) {
                visit(NormalIndex{static_cast<std::uint8_t>(s), static_cast<std::uint8_t>(t)});
            }
        }
    }
}

/// Fits a plane to a texel.
/// \param rays    the footprint: 1 to kFootprintRaysMax.
/// \param around  returns rays around the footprint, whose surface points may not lie in front of steep planes either.
/// Called at most once, when first needed. May be null.
/// \param edge    rays that barely hit a surface, next to rays that miss it. Their points may not lie in front of steep
/// planes either. If no ray of the footprint hits, the plane faces the viewer at the nearest of these points.
/// \param centre  the texel's centre ray, from the viewer; the depth of the plane is measured along it.
/// \param zero_depth  the point of that ray at map depth 0.
/// \param deep  rejects planes that cut off deep solid. Tests planes steeper than `rays_apart` or moved by
/// `inward_shift`, and all planes if `starts_free` is false. May be null.
/// \return nullopt for an empty texel: no ray hits a surface, or `starts_free` is false and `deep` rejects all planes.
[[nodiscard]] std::optional<FittedPlane> fitSupportingPlane(
    std::span<const FootprintRay> rays, const AroundRays& around, std::span<const FootprintRay> edge,
    const FootprintRay& centre, const glm::dvec3& zero_depth, const PlaneFitOptions& options,
    DeepSolid* deep = nullptr);

}  // namespace relief
