// A mesh as Embree holds it, built the same way for every use.
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

    std::unique_ptr<RTCDeviceTy, Release> device;
    /// Robust, for filter functions of a ray's own, and of medium quality, which never splits a triangle:
    /// each is met at most once a ray, so that crossings can be counted.
    std::unique_ptr<RTCSceneTy, Release> scene;
    /// Embree sees (p − center) · scale: floats are finest there, and no product of coordinates can overflow.
    glm::dvec3 center{0.0};
    double scale = 1.0;  ///< a power of two

    [[nodiscard]] glm::dvec3 toLocal(const glm::dvec3& p) const { return (p - center) * scale; }

    /// Embree reads the triangles where they are: `mesh` must outlive the result and keep them.
    /// Errors: kLimit (out of memory), kUnsupported (the processor), kFailure.
    [[nodiscard]] static Result<EmbreeMesh> build(const TriangleMesh& mesh);
};

}  // namespace relief
