// SPDX-License-Identifier: Apache-2.0
// Refines texels in view of the other maps.
//
// A supporting plane is pushed outwards until no surface point of its texel lies in front of it, as if its map were alone
// (plane_fit.h). But a point is outside as soon as one map has it outside. Free space behind a plane does not matter where
// another map sees it, and elsewhere is worth a tighter plane. So points are drawn near the surface, and each texel gets
// those that it decides (no other map has them outside). Of planes like its own and like the surface's it takes the one with
// the fewest errors, weighted by kind. The maps follow one another, each with the results of those before it.
#pragma once

#include <cstdint>

#include "bake/mesh/mesh_query.h"
#include "formats/collider.h"

namespace relief {

struct RefineOptions {
    /// Costs of errors: a free point inside, and an inside point outside. 2 keeps planes, which have few points each, from
    /// following them too closely.
    double false_inside = 1.0;
    double false_outside = 2.0;
    int sweeps = 1;                 ///< over all maps
    double points_per_texel = 4.0;  ///< per texel and end of a map, at most; at least kRefinePointsMin in all
    /// Standard deviations of the points' distances from the surface, half of them each: in texels, where most errors lie,
    /// but at most the other; and in units of the mesh's longest side, for layers.
    double sigma_texels = 0.25;
    double sigma_share = 0.005;
    /// A trial takes an eighth of the points, or more where they are few. If it corrects a smaller share of the errors than
    /// `worth_mending`, that is all, as for smooth meshes. Below `worth_all` half of the other points follow, else all.
    double worth_mending = 0.012;
    double worth_all = 0.2;
    std::uint64_t seed = 1;
};

inline constexpr std::uint64_t kRefinePointsMin = 200'000;
inline constexpr std::uint64_t kRefinePointsMax = 6'000'000;

/// Changes texels of maps of planes with 16-bit fixed-point depths; the others only vote. The same for any number of
/// threads.
void refineTexels(Collider& collider, const MeshQuery& query, const RefineOptions& options);

}  // namespace relief
