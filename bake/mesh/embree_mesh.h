// SPDX-License-Identifier: Apache-2.0
// A mesh as an Embree scene.
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

    std::shared_ptr<RTCDeviceTy> device;  ///< one of all meshes
    /// Robust, with filter functions per ray. Medium quality never splits a triangle: a ray meets each at most once,
    /// so that crossings can be counted.
    std::unique_ptr<RTCSceneTy, Release> scene;
    /// Embree's coordinates are (p − center) · scale, where floats are finest and no product overflows.
    glm::dvec3 center{0.0};
    double scale = 1.0;  ///< a power of two

    [[nodiscard]] glm::dvec3 toLocal(const glm::dvec3& p) const { return (p - center) * scale; }

    /// Embree shares the triangles of `mesh`, which must outlive the result.
    /// Errors: kLimit (out of memory), kUnsupported (the processor), kFailure.
    [[nodiscard]] static Result<EmbreeMesh> build(const TriangleMesh& mesh);
};

}  // namespace relief
