// relief-bench-raycast MESH: where the baker's time goes, and how near its tracing is to a bare loop. Prints
// JSON: medians of repeats that take turns, all from this one run.
//
// relief-bench-raycast MESH OUT.relief: the least that a whole bake can cost, done once in this fresh
// process: import, tree, the bare loop, and writing a container of that size. Prints JSON; its sum is to be
// compared with the time of a process `relief bake MESH -o OUT.relief --decode projected --depth half
// --map front-back:dir=-x --map …`, run in turns.
#include <malloc.h>

#include <tbb/parallel_for.h>

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

#include "bake/bench/bench_bare_loop.h"
#include "bake/import/mesh_import.h"
#include "bake/pipeline/bake.h"
#include "bake/plan/view.h"
#include "bake/texels/scan_convert.h"
#include "formats/base/heap.h"
#include "formats/base/stopwatch.h"
#include "formats/container.h"

namespace {

constexpr int kRepeats = 15;
constexpr std::uint32_t kResolution = 512;  // texels, a multiple of 4

double milliseconds(const std::function<void()>& work) {
    const relief::Stopwatch watch;
    work();
    return watch.ms();
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

int failure(const relief::Error& error) {
    std::fprintf(stderr, "relief-bench-raycast: error: %s\n", error.message.c_str());
    return static_cast<int>(error.code);
}

int printFloor(const relief::TriangleMesh& mesh, const std::vector<relief::View>& views, double import_ms,
               const std::string& output) {
    relief::Collider collider;
    collider.bounds = mesh.bounds;
    for (const relief::View& view : views) {
        collider.maps.push_back(view.emptyMap());
    }
    const relief::BareLoop bare(mesh);
    const double trace_ms = milliseconds([&] { (void)bare.trace(views); });
    relief::Result<void> written;
    const double write_ms = milliseconds([&] { written = relief::saveCollider(output, collider); });
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
void scanAll(const relief::RayScene& scene, const relief::View& view, std::vector<relief::Hit>& near,
             std::vector<relief::Hit>& far) {
    constexpr std::uint32_t kRows = 32;
    static_assert(kResolution % kRows == 0);
    const relief::ScanConverter scan(scene, view);
    tbb::parallel_for(0U, kResolution / kRows, [&](std::uint32_t block) {
        const auto of = [&](std::vector<relief::Hit>& hits) {
            return std::span(hits).subspan(std::size_t{block} * kRows * kResolution,
                                           std::size_t{kRows} * kResolution);
        };
        scan.scan({0, block * kRows, (block + 1) * kRows}, of(near), of(far));
    });
}

}  // namespace

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
