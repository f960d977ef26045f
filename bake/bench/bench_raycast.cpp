// relief-bench-raycast MESH OUT.relief: the least that a whole bake can cost, done once in this fresh
// process: import, tree, the bare loop, and writing a container of that size. Prints JSON; its sum is to be
// compared with the time of a process `relief bake MESH -o OUT.relief --decode projected --depth half
// --map front-back:dir=-x --map …`, run in turns.
#include <malloc.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/import/mesh_import.h"
#include "bake/mesh/embree.h"
#include "bake/plan/view.h"
#include "formats/base/heap.h"
#include "formats/base/stopwatch.h"
#include "formats/container.h"

namespace relief {
namespace {

constexpr std::uint32_t kResolution = 512;  // texels, a multiple of 4

double milliseconds(const std::function<void()>& work) {
    const Stopwatch watch;
    work();
    return watch.ms();
}

int failure(const Error& error) {
    std::fprintf(stderr, "relief-bench-raycast: error: %s\n", error.message.c_str());
    return static_cast<int>(error.code);
}

/// The least that tracing six orthographic ends can cost: rtcIntersect16 over the rays, and nothing else.
class BareLoop {
  public:
    explicit BareLoop(const TriangleMesh& mesh) {
        const Stopwatch watch;
        device_ = rtcNewDevice(kEmbreeConfig);
        scene_ = rtcNewScene(device_);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                         RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                                                         mesh.positions.size()));
        std::copy(mesh.positions.begin(), mesh.positions.end(), vertices);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   mesh.triangles.data(), 0, sizeof(glm::uvec3), mesh.triangles.size());
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene_);
        build_ms_ = watch.ms();
    }
    BareLoop(const BareLoop&) = delete;
    BareLoop& operator=(const BareLoop&) = delete;
    ~BareLoop() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    /// Milliseconds that building the tree took.
    [[nodiscard]] double buildMs() const { return build_ms_; }

    /// Traces both ends of every view.
    /// \return the number of rays that hit.
    [[nodiscard]] std::uint64_t trace(std::span<const View> views) const {
        std::uint64_t hits = 0;
        for (const View& view : views) {
            for (int end = 0; end < 2; ++end) {
                const glm::vec3 direction = end == 0 ? view.axis[2] : -view.axis[2];
                const glm::vec3 corner =
                    view.ray(0, 0, 0).origin + (end == 0 ? glm::dvec3(0.0) : view.axis[2]);
                const glm::vec3 right = view.axis[0] / static_cast<double>(view.width);
                const glm::vec3 up = view.axis[1] / static_cast<double>(view.height);
                const auto traceRows = [&](const tbb::blocked_range<std::uint32_t>& rows,
                                           std::uint64_t count) {
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
                            query.intersect(scene_, valid, packet);
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

  private:
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
    double build_ms_ = 0.0;
};

int printFloor(const TriangleMesh& mesh, const std::vector<View>& views, double import_ms,
               const std::string& output) {
    Collider collider;
    collider.bounds = mesh.bounds;
    for (const View& view : views) {
        collider.maps.push_back(view.emptyMap());
    }
    const BareLoop bare(mesh);
    const double trace_ms = milliseconds([&] { (void)bare.trace(views); });
    Result<void> written;
    const double write_ms = milliseconds([&] { written = saveCollider(output, collider); });
    if (!written) {
        return failure(written.error());
    }
    const nlohmann::ordered_json json = {{"import", import_ms},
                                         {"embree_build", bare.buildMs()},
                                         {"bare_loop", trace_ms},
                                         {"write", write_ms},
                                         {"sum", import_ms + bare.buildMs() + trace_ms + write_ms}};
    std::printf("%s\n", json.dump(2).c_str());
    return 0;
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    using namespace relief;
    if (argc != 3) {
        return failure({ErrorCode::kUsage, "usage: relief-bench-raycast MESH OUT.relief"});
    }
    prepareHeap(kBakeHeapBytes);
    mallopt(M_ARENA_MAX, 1);  // as relief's importer, which has a thread of its own
    std::optional<Result<TriangleMesh>> imported;
    const double import_ms = milliseconds([&] { imported.emplace(importMesh(argv[1])); });
    mallopt(M_ARENA_MAX, 128);
    const Result<TriangleMesh>& mesh = *imported;
    if (!mesh) {
        return failure(mesh.error());
    }
    // Six orthographic ends, as texels that cost one ray each.
    std::vector<View> views;
    for (const glm::vec3& direction : {glm::vec3(-1, 0, 0), glm::vec3(0, -1, 0), glm::vec3(0, 0, -1)}) {
        MapSpec spec;
        spec.format = MapFormat::kFrontBackHalf;
        spec.decode = Decode::kProjected;
        spec.direction = direction;
        const Result<MapSpec> complete = completeSpec(spec, *mesh, kResolution);
        const Result<View> view = complete ? makeView(*complete, *mesh) : forward(complete);
        if (!view) {
            return failure(view.error());
        }
        views.push_back(*view);
    }
    return printFloor(*mesh, views, import_ms, argv[2]);
}
