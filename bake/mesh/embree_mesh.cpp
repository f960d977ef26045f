// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/embree_mesh.h"

#include <cmath>
#include <mutex>
#include <string>

namespace relief {
namespace {

tl::unexpected<Error> embreeError(RTCError error, const std::string& what) {
    switch (error) {
        case RTC_ERROR_OUT_OF_MEMORY:
            return fail(ErrorCode::kLimit, what + ": the ray tracer is out of memory; simplify the mesh");
        case RTC_ERROR_UNSUPPORTED_CPU:
            return fail(ErrorCode::kUnsupported,
                        what + ": the ray tracer reports: this processor is not supported");
        case RTC_ERROR_INVALID_ARGUMENT:
            return fail(ErrorCode::kFailure, what + ": the ray tracer reports: invalid argument");
        case RTC_ERROR_INVALID_OPERATION:
            return fail(ErrorCode::kFailure, what + ": the ray tracer reports: invalid operation");
        default:
            return fail(ErrorCode::kFailure,
                        what + ": the ray tracer reports: error " + std::to_string(static_cast<int>(error)));
    }
}

/// Returns the device that all live meshes share. A device uses one of a process's thousand thread-local keys, and a
/// level may have four thousand meshes. Null on failure: rtcGetDeviceError(nullptr) then returns the error.
std::shared_ptr<RTCDeviceTy> sharedDevice() {
    static std::mutex mutex;
    static std::weak_ptr<RTCDeviceTy> living;
    const std::scoped_lock lock(mutex);
    std::shared_ptr<RTCDeviceTy> device = living.lock();
    if (!device) {
        if (const RTCDevice made = rtcNewDevice(kEmbreeConfig)) {
            device = {made, EmbreeMesh::Release()};
        }
        living = device;
    }
    return device;
}

}  // namespace

Result<EmbreeMesh> EmbreeMesh::build(const TriangleMesh& mesh) {
    EmbreeMesh tree;
    tree.center = 0.5 * glm::dvec3(mesh.bounds.min) + 0.5 * glm::dvec3(mesh.bounds.max);
    tree.scale = std::ldexp(1.0, -std::ilogb(mesh.bounds.longestSide()));
    tree.device = sharedDevice();
    if (!tree.device) {
        return embreeError(rtcGetDeviceError(nullptr), mesh.name);
    }
    RTCDevice device = tree.device.get();
    tree.scene.reset(rtcNewScene(device));
    const std::unique_ptr<RTCGeometryTy, Release> geometry(
        rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    if (!tree.scene || !geometry) {
        return embreeError(rtcGetDeviceError(device), mesh.name);
    }
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                                                 RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                                                 mesh.positions.size()));
    if (vertices == nullptr) {
        return embreeError(rtcGetDeviceError(device), mesh.name);
    }
    for (const glm::vec3& p : mesh.positions) {
        const glm::vec3 local = tree.toLocal(p);
        *vertices++ = local.x;
        *vertices++ = local.y;
        *vertices++ = local.z;
    }
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.triangles.data(), 0, sizeof(glm::uvec3), mesh.triangles.size());
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(tree.scene.get(), geometry.get());
    rtcSetSceneFlags(tree.scene.get(), RTC_SCENE_FLAG_ROBUST | kEmbreeRayFilters);
    rtcSetSceneBuildQuality(tree.scene.get(), RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitScene(tree.scene.get());
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) {
        return embreeError(error, mesh.name);
    }
    return tree;
}

}  // namespace relief
