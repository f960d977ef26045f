// SPDX-License-Identifier: Apache-2.0
// Samples random points on and near a mesh, with the truth at each.
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
    std::uint32_t samples = 200'000;  ///< per kind; above 0
    std::uint64_t seed = 1;
    /// Standard deviation of the offset of points near the surface, in units of the longest side of the mesh's box.
    double sigma_fraction = 0.005;
};

/// A point near the surface, or anywhere in the box.
struct TruthPoint {
    glm::vec3 position{0.0F};
    float distance = 0.0F;  ///< object units, negative inside; ±1 for uniform points and in sampleNear()

    [[nodiscard]] bool inside() const { return distance < 0.0F; }
};

/// A point on the surface.
struct SurfacePoint {
    glm::vec3 position{0.0F};
    glm::vec3 normal{0.0F};  ///< of its triangle, unit length, outwards
    bool buried = false;     ///< both sides are inside, where nothing can collide; not counted
};
[[nodiscard]] inline std::size_t buriedPoints(std::span<const SurfacePoint> points) {
    return static_cast<std::size_t>(std::ranges::count(points, true, &SurfacePoint::buried));
}

/// A point inside, with its nearest boundary. A surface with the inside on both sides is not a boundary; points are
/// omitted if such a surface is nearer.
struct InsidePoint {
    glm::vec3 position{0.0F};
    double depth = 0.0;   ///< distance to the boundary, object units, above 0
    glm::dvec3 out{0.0};  ///< direction to the boundary, unit length
};

struct TruthSamples {
    AccuracyOptions options;
    double longest_side = 0.0;          ///< of the mesh's box, object units
    std::vector<TruthPoint> near;       ///< area-weighted surface points plus an isotropic Gaussian offset
    std::vector<TruthPoint> uniform;    ///< in the mesh's box
    std::vector<SurfacePoint> surface;  ///< area-weighted
    /// Below area-weighted surface points, uniformly up to 0.45 of the local thickness; fewer than the other kinds.
    std::vector<InsidePoint> inside;
    double seconds = 0.0;  ///< duration of the sampling
};

/// Samples only points near the surface, with ±1 as distances; takes a fifth of the time of sampleTruth().
[[nodiscard]] std::vector<TruthPoint> sampleNear(const MeshQuery& query, const AccuracyOptions& options);

/// Samples all kinds. The result does not depend on the number of threads. Normals face the outside as
/// MeshQuery::inside defines it. If both sides are outside, as on open meshes, normals follow the winding.
[[nodiscard]] TruthSamples sampleTruth(const MeshQuery& query, const AccuracyOptions& options);

/// Samples only the points on the surface: sampleTruth(…).surface.
[[nodiscard]] std::vector<SurfacePoint> sampleSurface(const MeshQuery& query, const AccuracyOptions& options);

}  // namespace relief
