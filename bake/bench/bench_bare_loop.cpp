#include "bake/bench/bench_bare_loop.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <functional>

#include "bake/mesh/embree.h"
#include "formats/base/stopwatch.h"

namespace relief {

struct BareLoop::Impl {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
};

BareLoop::BareLoop(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>()) {
    const Stopwatch watch;
    impl_->device = rtcNewDevice(kEmbreeConfig);
    impl_->scene = rtcNewScene(impl_->device);
    RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.positions.size()));
    std::copy(mesh.positions.begin(), mesh.positions.end(), vertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof(glm::uvec3), mesh.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(impl_->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(impl_->scene);
    build_ms_ = watch.ms();
}

BareLoop::~BareLoop() {
    rtcReleaseScene(impl_->scene);
    rtcReleaseDevice(impl_->device);
}

std::uint64_t BareLoop::trace(std::span<const View> views) const {
    std::uint64_t hits = 0;
    for (const View& view : views) {
        for (int end = 0; end < 2; ++end) {
            const glm::vec3 direction = end == 0 ? view.axis[2] : -view.axis[2];
            const glm::vec3 corner = view.ray(0, 0, 0).origin + (end == 0 ? glm::dvec3(0.0) : view.axis[2]);
            const glm::vec3 right = view.axis[0] / static_cast<double>(view.width);
            const glm::vec3 up = view.axis[1] / static_cast<double>(view.height);
            const auto traceRows = [&](const tbb::blocked_range<std::uint32_t>& rows, std::uint64_t count) {
                alignas(64) int valid[16];
                alignas(64) RTCRayHit16 packet{};
                RayQuery query(nullptr, RayOrder::kCoherent);
                for (int i = 0; i < 16; ++i) {
                    valid[i] = -1;
                }
                for (std::uint32_t y = rows.begin() * 4; y < rows.end() * 4; y += 4) {
                    for (std::uint32_t x = 0; x < view.width; x += 4) {
                        for (std::uint32_t i = 0; i < 16; ++i) {
                            const glm::vec3 origin = corner + static_cast<float>(x + i % 4) * right +
                                                     static_cast<float>(y + i / 4) * up;
                            packet.ray.org_x[i] = origin.x;
                            packet.ray.org_y[i] = origin.y;
                            packet.ray.org_z[i] = origin.z;
                            packet.ray.dir_x[i] = direction.x;
                            packet.ray.dir_y[i] = direction.y;
                            packet.ray.dir_z[i] = direction.z;
                            packet.ray.tnear[i] = 0.0F;
                            packet.ray.tfar[i] = 1.0F;
                            packet.ray.mask[i] = 0xffffffff;
                            packet.ray.flags[i] = 0;
                            packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
                            packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
                        }
                        query.intersect(impl_->scene, valid, packet);
                        for (unsigned geometry : packet.hit.geomID) {
                            count += geometry != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
                        }
                    }
                }
                return count;
            };
            hits += tbb::parallel_reduce(tbb::blocked_range<std::uint32_t>(0, view.height / 4),
                                         std::uint64_t{0}, traceRows, std::plus<>());
        }
    }
    return hits;
}

}  // namespace relief
