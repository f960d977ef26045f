// SPDX-License-Identifier: Apache-2.0
// Random points on and near a mesh with the truth at each of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_sampler.h"

namespace relief {

struct AccuracyOptions {
    std::uint32_t samples = 200'000;  ///< of each kind; not 0
    std::uint64_t seed = 1;
    /// Standard deviation of the points near the surface, in units of the longest side of the mesh's box.
    double sigma_share = 0.005;
};

/// A point near the surface, or anywhere in the box.
struct TruthPoint {
    glm::vec3 position{0.0F};
    float distance = 0.0F;  ///< object units, negative inside; of uniform points ±1

    [[nodiscard]] bool inside() const { return distance < 0.0F; }
};

/// A point on the surface.
struct SurfacePoint {
    glm::vec3 position{0.0F};
    glm::vec3 normal{0.0F};  ///< of its triangle, unit length, towards the outside
    bool buried = false;     ///< both sides are inside, where nothing collides: it does not count
};
[[nodiscard]] inline std::size_t buriedPoints(std::span<const SurfacePoint> points) {
    return static_cast<std::size_t>(std::ranges::count(points, true, &SurfacePoint::buried));
}

/// A point inside, with the boundary nearest to it. Surfaces with the inside on both sides are no boundary: points that are nearer
/// to one of them are left out.
struct InsidePoint {
    glm::vec3 position{0.0F};
    double depth = 0.0;   ///< to the boundary, object units, above 0
    glm::dvec3 out{0.0};  ///< unit length, towards it
};

struct TruthSamples {
    AccuracyOptions options;
    double longest_side = 0.0;          ///< of the mesh's box, object units
    std::vector<TruthPoint> near;       ///< area-weighted surface points plus an isotropic Gaussian offset
    std::vector<TruthPoint> uniform;    ///< in the mesh's box
    std::vector<SurfacePoint> surface;  ///< area-weighted
    /// Below area-weighted surface points, uniformly up to 0.45 of the thickness there; fewer than the others.
    std::vector<InsidePoint> inside;
    double seconds = 0.0;  ///< spent here
};

/// Points near the surface alone, with ±1 for distances: a fifth of the time of sampleTruth.
[[nodiscard]] std::vector<TruthPoint> sampleNear(const MeshQuery& query, const AccuracyOptions& options);

/// The same for any number of threads. Normals face the outside by MeshQuery::inside; where both sides are outside, as on
/// open meshes, they follow the winding.
[[nodiscard]] TruthSamples sampleTruth(const MeshQuery& query, const AccuracyOptions& options);

/// The points on the surface alone: sampleTruth(…).surface.
[[nodiscard]] std::vector<SurfacePoint> sampleSurface(const MeshQuery& query, const AccuracyOptions& options);

}  // namespace relief
