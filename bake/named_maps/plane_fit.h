// SPDX-License-Identifier: Apache-2.0
// Supporting planes: the plane that a texel stores when its map's decode is "plane".
//
// A texel's footprint is sampled by a block of rays. Candidate planes take their normals from the footprint. Each is pushed
// towards the viewer until no sampled surface point lies in front of it, and quantised so that this stays true; the one that
// leaves the least free space behind it wins:
//
//       viewer            In front of its plane a texel is outside, behind it inside. A pushed plane never puts the inside
//      | | | | |          of a sampled surface point outside. The space between plane and surface, inside by error, is
//     --.-----.-- plane   what is minimised; other maps that see this space correct it, so that more views only help.
//       |\   /|
//      surface
//
// Both ends of a map are fitted alike, from where their rays start.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "bake/named_maps/deep_solid.h"
#include "bake/views/view.h"
#include "formats/normal_index.h"
#include "formats/texel.h"

namespace relief {

/// One ray of a footprint.
struct FootprintRay {
    /// From the viewer: the point at u is origin + u · direction, u in units of map depth.
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};
    double u = -1.0;         ///< of the surface; negative without one
    glm::dvec3 normal{0.0};  ///< unit length, of the surface, towards the viewer
};

inline constexpr std::size_t kFootprintRaysMax = 64;

struct PlaneFitOptions {
    double u_max = 1.0;       ///< depth range: map depth 1, or kCubeDepthMax
    double reach = 1.0;       ///< free space behind the plane counts up to this length, in u
    double span = 0.0;        ///< both sides of a texel together, object units
    double pixel_cost = 0.0;  ///< mean free space per ray, in u, below which a fit is good enough
    bool cautious = false;    ///< all planes respect the rays around the footprint, not only steep ones
    int refinements = 3;      ///< rounds of search among neighbouring normals; 0: none
    /// Moves planes inwards by this share of the spread of the sampled points about them, which trades solid for free
    /// space; not at steps, whose spread is more than `span`/4.
    double let_back = 0.0;
    /// The greatest distance of a point of the texel from a ray, in texel diagonals. A plane of a smaller cosine drops by
    /// more than the diagonal between two rays.
    double rays_apart = 0.0;
    /// Rays start in free space. Otherwise one without a hit may lie in the solid entirely.
    bool starts_free = true;
};

/// A half-space in a texel's own units.
struct FittedPlane {
    glm::dvec3 normal{0.0};  ///< unit length, of the free side; as decodeNormal gives it
    NormalIndex index;
    /// 16-bit fixed point: the centre ray meets the plane at u = code / 65534 · u_max.
    std::uint16_t code = 0;
};

using AroundRays = std::function<std::span<const FootprintRay>()>;

/// Calls visit(index) for the index and its neighbours `step` away in s, t or both, as far as they exist.
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

/// Fits one texel.
/// \param rays    the footprint: 1 to kFootprintRaysMax.
/// \param around  rays beside the footprint, whose surface points may not lie in front of steep planes either; called for
///                the first such plane, at most once. May be null.
/// \param edge    rays that just meet a surface, beside ones that miss: they support steep planes, and the plane of a footprint
///                none of whose rays meets a surface, which faces the viewer.
/// \param centre  the texel's centre ray, from the viewer: the plane's depth is measured on it.
/// \param zero_depth  the point of that ray at map depth 0.
/// \param deep  of the texel: planes not justified by the rays alone may not cut deep solid. May be null.
/// \return nullopt for an empty texel: no ray meets a surface, or without starts_free nothing is known.
[[nodiscard]] std::optional<FittedPlane> fitSupportingPlane(
    std::span<const FootprintRay> rays, const AroundRays& around, std::span<const FootprintRay> edge,
    const FootprintRay& centre, const glm::dvec3& zero_depth, const PlaneFitOptions& options,
    DeepSolid* deep = nullptr);

}  // namespace relief
