// Texels that know the other maps.
//
// A supporting plane is pushed outwards until no surface point of its texel lies in front of it, as if its
// map were alone (plane_fit.h). But a point is outside as soon as one map says so: what a plane calls inside
// wrongly does not matter where another map sees that it is free, and what it still gets wrong is worth a
// tighter plane. So points near the surface are drawn, each texel gets those that it decides (no other map
// says outside), and takes, of planes like its own and like the surface's, the one with the fewest mistakes
// among them, weighted by kind. One map after the other, each knowing what became of those before it.
#pragma once

#include <cstdint>

#include "bake/mesh/mesh_query.h"
#include "formats/collider.h"

namespace relief {

struct RefineOptions {
    /// What a mistake costs: a free point called inside, and an inside point called outside. 2 for the other
    /// kind keeps planes, which see few points each, from following them too closely.
    double false_inside = 1.0;
    double false_outside = 2.0;
    int sweeps = 1;                 ///< over all maps
    double points_per_texel = 4.0;  ///< and end of a map, at most; at least kRefinePointsMin in all
    /// Standard deviations of the points' distances from the surface, half of them each: in texels, where most mistakes lie,
    /// but at most the other; and in units of the mesh's longest side, for what lies in layers.
    double sigma_texels = 0.25;
    double sigma_share = 0.005;
    /// An eighth of the points is asked first, or more where they are few. Where that mended a smaller share of the mistakes
    /// than `worth_mending`, that is all: smooth meshes have nothing to mend. Below `worth_all` half of the others are asked,
    /// else all.
    double worth_mending = 0.012;
    double worth_all = 0.2;
    std::uint64_t seed = 1;
};

inline constexpr std::uint64_t kRefinePointsMin = 200'000;
inline constexpr std::uint64_t kRefinePointsMax = 6'000'000;

/// Changes texels of maps of planes whose depths are 16-bit fixed point; the others only vote. The same for
/// any number of threads.
void refineTexels(Collider& collider, const MeshQuery& query, const RefineOptions& options);

}  // namespace relief
