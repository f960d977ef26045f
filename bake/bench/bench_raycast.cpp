// relief-bench-raycast MESH: where the baker's time goes, and how near its tracing is to a bare loop. Prints
// JSON: medians of repeats that take turns, all from this one run.
//
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
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/import/mesh_import.h"
#include "bake/mesh/embree.h"
#include "bake/pipeline/bake.h"
#include "bake/plan/view.h"
#include "bake/texels/scan_convert.h"
#include "formats/base/heap.h"
#include "formats/base/stopwatch.h"
#include "formats/container.h"

namespace relief {
namespace {

constexpr int kRepeats = 15;
constexpr std::uint32_t kResolution = 512;  // texels, a multiple of 4

double milliseconds(const std::function<void()>& work) {
    const Stopwatch watch;
    work();
    return watch.ms();
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
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

/// What a bake has traced, on all cores.
void scanAll(const RayScene& scene, const View& view, std::vector<Hit>& near, std::vector<Hit>& far) {
    constexpr std::uint32_t kRows = 32;
    static_assert(kResolution % kRows == 0);
    const ScanConverter scan(scene, view);
    tbb::parallel_for(0U, kResolution / kRows, [&](std::uint32_t block) {
        const auto of = [&](std::vector<Hit>& hits) {
            return std::span(hits).subspan(std::size_t{block} * kRows * kResolution,
                                           std::size_t{kRows} * kResolution);
        };
        scan.scan({0, block * kRows, (block + 1) * kRows}, of(near), of(far));
    });
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    using namespace relief;
    if (argc != 2 && argc != 3) {
        return failure({ErrorCode::kUsage, "usage: relief-bench-raycast MESH [OUT.relief]"});
    }
    prepareHeap(kBakeHeapBytes);
    mallopt(M_ARENA_MAX, 1);  // as relief's importer, which has a thread of its own
    std::optional<Result<TriangleMesh>> imported;
    const double first_import_ms = milliseconds([&] { imported.emplace(importMesh(argv[1])); });
    mallopt(M_ARENA_MAX, 128);
    const Result<TriangleMesh>& mesh = *imported;
    if (!mesh) {
        return failure(mesh.error());
    }
    BakeOptions options;
    // Six orthographic ends, as texels that cost one ray each: said, not left to what a bake defaults to.
    for (const glm::vec3& direction : {glm::vec3(-1, 0, 0), glm::vec3(0, -1, 0), glm::vec3(0, 0, -1)}) {
        MapSpec spec;
        spec.format = MapFormat::kFrontBackHalf;
        spec.decode = Decode::kProjected;
        spec.direction = direction;
        options.maps.push_back(spec);
    }
    options.resolution = kResolution;
    std::vector<View> views;
    for (const MapSpec& spec : options.maps) {
        const Result<MapSpec> complete = completeSpec(spec, *mesh, kResolution);
        const Result<View> view = complete ? makeView(*complete, *mesh) : forward(complete);
        if (!view) {
            return failure(view.error());
        }
        views.push_back(*view);
    }
    if (argc == 3) {
        return printFloor(*mesh, views, first_import_ms, argv[2]);
    }
    const Result<RayScene> scene = RayScene::build(*mesh);
    const Result<Baked> baked = bake(*mesh, options);
    if (!scene || !baked) {
        return failure(scene ? baked.error() : scene.error());
    }
    const BareLoop bare(*mesh);
    const std::string output =
        (std::filesystem::temp_directory_path() / "relief-bench-raycast.relief").string();

    std::map<std::string, std::vector<double>> times;
    std::vector<Hit> hits(std::size_t{kResolution} * kResolution);
    std::vector<Hit> far_hits(hits.size());
    std::uint64_t bare_hits = 0;
    std::uint64_t our_hits = 0;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
        times["import"].push_back(milliseconds([&] { (void)importMesh(argv[1]); }));
        times["embree_build"].push_back(BareLoop(*mesh).buildMs());
        times["bare_loop"].push_back(milliseconds([&] { bare_hits = bare.trace(views); }));
        our_hits = 0;
        times["trace"].push_back(milliseconds([&] {
            for (const View& view : views) {
                scanAll(*scene, view, hits, far_hits);
            }
        }));
        const PreparedMesh fresh(*mesh);
        (void)fresh.closed();  // as `relief bake` does on the way
        const Result<Baked> again = bake(fresh, options);
        times["our_build"].push_back(again->report.build_ms);
        times["encode"].push_back(again->report.encode_ms);
        times["trace_in_bake"].push_back(again->report.trace_ms);
        times["write"].push_back(milliseconds([&] { (void)saveCollider(output, baked->collider); }));
    }
    std::filesystem::remove(output);
    for (const View& view : views) {
        scanAll(*scene, view, hits, far_hits);
        for (const std::vector<Hit>& end : {hits, far_hits}) {
            our_hits += static_cast<std::uint64_t>(
                std::count_if(end.begin(), end.end(), [](const Hit& hit) { return !hit.empty(); }));
        }
    }

    nlohmann::ordered_json json = {
        {"mesh", mesh->name}, {"triangles", mesh->triangles.size()}, {"repeats", kRepeats}};
    for (const auto& [name, values] : times) {
        json["median_ms"][name] = median(values);
    }
    json["rays"] = views.size() * 2 * kResolution * kResolution;
    json["hits"] = {{"bare_loop", bare_hits}, {"trace", our_hits}};
    json["trace_over_bare_loop"] = median(times["trace"]) / median(times["bare_loop"]);
    std::printf("%s\n", json.dump(2).c_str());
    return 0;
}
