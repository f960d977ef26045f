// Supporting planes: the plane that a texel stores when its map's decode is "plane".
//
// A texel speaks for a footprint, not for one ray. Its footprint is sampled by a block of rays. Of the planes
// with a normal from the footprint, each is pushed towards the viewer until no sampled surface point lies in
// front of it, quantised so that it stays there, and the one that leaves the least free space behind it wins:
//
//       viewer            The texel says "outside" in front of its plane and "inside" behind it. Pushed
//      | | | | |          planes never call a sampled surface point's inside "outside"; what they may call
//     --.-----.-- plane   "inside" wrongly is the space between plane and surface, which is what is
//       |\   /|           minimised. Another map that sees this space says so: more views only help.
//      surface
//
// Both ends of a map are fitted the same way, seen from where their rays start.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "bake/plan/view.h"
#include "bake/texels/deep_solid.h"
#include "formats/normal_index.h"
#include "formats/texel.h"

namespace relief {

/// One ray of a footprint.
struct FootprintRay {
    /// From the viewer on: the point at u is origin + u · direction, u in units of map depth.
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};
    double u = -1.0;         ///< of the surface; negative: the ray meets none
    glm::dvec3 normal{0.0};  ///< unit length, of the surface, towards the viewer
    double u_last = -1.0;    ///< of the last surface on the ray: nothing behind it is solid
};

/// Rays of a footprint, at most.
inline constexpr std::size_t kFootprintRaysMax = 64;

struct PlaneFitOptions {
    double u_max = 1.0;       ///< depth range: map depth 1, or kCubeDepthMax
    double reach = 1.0;       ///< free space behind the plane counts up to this length, in u
    double range = 0.0;       ///< standingRange of the map, object units
    double pixel_cost = 0.0;  ///< per ray: a fit whose mean error is below this, in u, is good enough, in u
    bool cautious = false;    ///< all planes keep behind the rays about the footprint, not only steep ones
    /// |cosine| with the ray from which on a plane is steep enough to be left out; above kStandingCosine none stands.
    double steepest = 0.0;
    int refinements = 3;  ///< rounds of search among neighbouring normals; 0: none
    /// Above 0 a plane is let back inwards by this part of the spread of the sampled points about it, so that
    /// it cuts some of the solid and spares as much free space; not at steps, whose spread is more than
    /// `range`/4.
    double let_back = 0.0;
    /// The farthest that a point of the texel is from a ray, in units of the texel's diagonal. A plane of a smaller cosine
    /// drops, between two rays, by more than the diagonal.
    double rays_apart = 0.0;
    /// Rays start in free space. Otherwise one that meets nothing may have run through the solid all the way.
    bool starts_free = true;
};

/// A half-space in a texel's own units.
struct FittedPlane {
    glm::dvec3 normal{0.0};  ///< unit length, of the free side; as decodeNormal gives it
    NormalIndex index;
    bool stands = false;  ///< along the ray (depth_map.h, kStandingCosine)
    /// 16-bit fixed point. Where the centre ray meets the plane, u = code / 65534 · u_max; of a standing
    /// plane its offset from zero_depth, (2 · code / 65534 − 1) · range.
    std::uint16_t code = 0;
};

using AroundRays = std::function<std::span<const FootprintRay>()>;

/// Fits one texel.
/// \param rays    the footprint; at least one, at most kFootprintRaysMax.
/// \param around  rays beside the footprint, whose surface points may not lie in front of steep planes either; asked for
///                when the first such plane is tried, and not after the call. May be null.
/// \param edge    rays that just meet a surface, beside ones that meet none: what a standing plane leans on.
/// \param centre  the texel's centre ray, from the viewer on: where the plane's depth is stored.
/// \param zero_depth  the point of that ray whose map depth is 0.
/// \param deep  of the texel: planes that the rays alone do not vouch for may not cut what is deep. May be null.
/// \return nullopt if no ray meets a surface: the texel is empty. Without starts_free also if nothing is known.
[[nodiscard]] std::optional<FittedPlane> fitSupportingPlane(
    std::span<const FootprintRay> rays, const AroundRays& around, std::span<const FootprintRay> edge,
    const FootprintRay& centre, const glm::dvec3& zero_depth, const PlaneFitOptions& options,
    DeepSolid* deep = nullptr);

}  // namespace relief
