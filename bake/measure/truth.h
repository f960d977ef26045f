// Random points about a mesh, and the truth at each of them: what every field is measured against.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
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

/// A point off the surface, or anywhere in the box.
struct TruthPoint {
    glm::vec3 position{0.0F};
    /// Object units, negative inside. Of uniform points the sign alone is known: ±1.
    float distance = 0.0F;

    [[nodiscard]] bool inside() const { return distance < 0.0F; }
};

/// A point on the surface.
struct SurfacePoint {
    glm::vec3 position{0.0F};
    glm::vec3 normal{0.0F};  ///< of its triangle, unit length, towards the outside
    /// Both sides are inside: an inner surface of a mesh that meets itself. Nothing ever collides with it, so
    /// that it does not count.
    bool buried = false;
};

struct TruthSamples {
    AccuracyOptions options;
    double longest_side = 0.0;          ///< of the mesh's box, object units
    std::vector<TruthPoint> near;       ///< area-weighted surface points plus an isotropic Gaussian offset
    std::vector<TruthPoint> uniform;    ///< in the mesh's box
    std::vector<SurfacePoint> surface;  ///< area-weighted
    double seconds = 0.0;               ///< spent here
};

/// Points near the surface alone, whose distance is ±1: the sign is known. A fifth of the time of sampleTruth.
[[nodiscard]] std::vector<TruthPoint> sampleNear(const MeshQuery& query, const AccuracyOptions& options);

/// The same mesh and options give the same samples, for any number of threads.
/// Inside is the parity of MeshQuery::inside; a point of a surface both of whose sides are outside (an open
/// mesh) takes the side of its triangle's winding.
[[nodiscard]] TruthSamples sampleTruth(const MeshQuery& query, const AccuracyOptions& options);

/// The points on the surface alone: sampleTruth(…).surface.
[[nodiscard]] std::vector<SurfacePoint> sampleSurface(const MeshQuery& query, const AccuracyOptions& options);

}  // namespace relief
