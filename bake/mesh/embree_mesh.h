// SPDX-License-Identifier: Apache-2.0
// Builds the Embree scene of a mesh.
#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "bake/mesh/embree.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

struct EmbreeMesh {
    struct Release {
        void operator()(RTCDevice released) const { rtcReleaseDevice(released); }
        void operator()(RTCScene released) const { rtcReleaseScene(released); }
        void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
    };

    std::shared_ptr<RTCDeviceTy> device;  ///< shared by all meshes
    /// Robust, with filter functions per ray. Medium build quality never splits triangles, so a ray hits each at most
    /// once and crossings can be counted.
    std::unique_ptr<RTCSceneTy, Release> scene;
    /// Embree's coordinates are (p − center) · scale: floats are most precise near 0, and no product overflows.
    glm::dvec3 center{0.0};
    double scale = 1.0;  ///< a power of two

    [[nodiscard]] glm::dvec3 toLocal(const glm::dvec3& p) const { return (p - center) * scale; }

    /// Builds the scene. Embree shares the triangles of `mesh`, which must outlive the result.
    /// Errors: kLimit (out of memory), kUnsupported (the processor), kFailure.
    [[nodiscard]] static Result<EmbreeMesh> build(const TriangleMesh& mesh);
};

}  // namespace relief
