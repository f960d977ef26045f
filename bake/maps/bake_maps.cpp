// SPDX-License-Identifier: Apache-2.0
#include "bake/maps/bake_maps.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/measure/patch_cells.h"
#include "bake/mesh/mesh_query.h"
#include "bake/named_maps/encode.h"
#include "bake/named_maps/fitted_map.h"
#include "bake/named_maps/scan_convert.h"
#include "bake/patches/patch_planner.h"
#include "bake/views/view.h"
#include "formats/base/stopwatch.h"
#include "formats/base/text.h"
#include "formats/container_limits.h"
#include "formats/patch_tree.h"
#include "formats/validate.h"

namespace relief {
namespace {

/// Texels that a task traces and then encodes: few enough that their hits stay in the cache and need no new pages (the
/// first touch of 12 MB takes 8 ms).
constexpr std::uint64_t kBlockTexels = std::uint64_t{1} << 13;

/// Limit on triangles times maps in progress at the same time.
constexpr std::size_t kTrianglesAtOnce = std::size_t{1} << 21;

/// Floats cannot tell the sides of a surface apart at a centre this near to it, in units of the longest side.
constexpr double kOnSurface = 1e-5;

struct Job {
    MapSpec spec;  // complete
    View view;
    bool centre_inside = false;  // of a cube with a given compare=less

    [[nodiscard]] std::uint64_t texels() const {
        return std::uint64_t{view.faceCount()} * view.width * view.height;
    }
};

Result<std::vector<Job>> planJobs(const PreparedMesh& mesh, const BakeOptions& options) {
    const std::vector<MapSpec> specs = options.maps.empty() ? paperMapSpecs() : options.maps;
    const ContainerLimits limits;
    if (specs.size() > limits.maps) {
        return fail(ErrorCode::kLimit, std::to_string(specs.size()) + " maps exceed the limit of " +
                                           std::to_string(limits.maps) + "; bake fewer");
    }
    std::vector<Job> jobs;
    std::uint64_t bytes = 0;
    for (const MapSpec& spec : specs) {
        const MapSpec complete = RELIEF_TRY(completeSpec(spec, mesh, options.resolution));
        const View view = RELIEF_TRY(makeView(complete, *mesh));
        Job& job = jobs.emplace_back(Job{complete, view});
        if (view.projection() == Projection::kCube && view.compare == Compare::kLess) {
            const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
            job.view.centre_on_surface =
                query.closest(view.origin).distance <= kOnSurface * mesh->bounds.longestSide();
            job.centre_inside = spec.compare.has_value() && query.inside(view.origin);
        }
        bytes += job.texels() * texelSize(view.format);
    }
    if (bytes > limits.texel_bytes) {
        return fail(ErrorCode::kLimit, "the texels of the maps take " + std::to_string(bytes) +
                                           " bytes; the limit is " + std::to_string(limits.texel_bytes) +
                                           "; lower --resolution or the sizes of the maps");
    }
    return jobs;
}

std::vector<RecordedOption> effectiveOptions(const std::vector<Job>& jobs, const BakeOptions& options) {
    std::vector<RecordedOption> recorded;
    bool fitted = false;
    for (const Job& job : jobs) {
        recorded.push_back({"map", toString(job.spec)});
        fitted = fitted || job.spec.decode == Decode::kPlane;
    }
    if (fitted) {
        recorded.push_back({"quality", std::string(wordOf(options.quality))});
        if (options.prefer != Prefer::kNeither) {
            recorded.push_back({"prefer", std::string(wordOf(options.prefer))});
        }
    }
    return recorded;
}

void warnAbout(const PreparedMesh& mesh, const std::vector<Job>& jobs, BakeReport& report) {
    if (const std::optional<std::string> warning = coarseFloatsWarning(*mesh)) {
        report.warnings.push_back(*warning);
    }
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const auto warn = [&](const char* fault) {
            report.warnings.push_back("map " + std::to_string(i) + " (" + toString(jobs[i].spec) + ") " +
                                      fault);
        };
        if (jobs[i].view.centre_on_surface) {
            warn("has its centre on the surface of the mesh; move the center into free space");
        } else if (jobs[i].centre_inside) {
            warn(
                "has compare=less, but its centre seems to be inside the mesh; move the center, or use "
                "compare=greater");
        }
        if (report.maps[i].covered == 0) {
            warn("is empty: its rays hit no outer side of the mesh; change its dir, box or size");
        }
    }
}

/// Weight of the error that --prefer avoids, for patches.
constexpr double kPreferredCost = 8.0;

FittedMapOptions fitOptions(const TriangleMesh& mesh, const View& view, const BakeOptions& bake) {
    const Quality quality = bake.quality;
    const double side = mesh.bounds.longestSide();
    FittedMapOptions options;
    options.samples = quality == Quality::kFast ? 1 : quality == Quality::kNormal ? 4 : 6;
    options.refinements = quality == Quality::kFast ? 0 : 3;
    options.reach = 0.02 * side;
    // A hundredth of a texel, which is below the resolution of the map.
    options.good_enough = 0.01 * side / std::max(view.width, view.height);
    options.cautious = bake.prefer == Prefer::kInside;
    options.inward_shift = bake.prefer == Prefer::kOutside ? 0.4 : 0.0;
    return options;
}

PatchOptions patchOptions(const BakeOptions& bake, const MapSpec& spec) {
    PatchOptions options;
    options.bytes = spec.bytes > 0 ? spec.bytes : kPatchBytesMax;
    options.texel = double{spec.texel};
    options.coarsen = spec.bytes > 0;
    options.roots_contain = bake.roots_contain;
    options.costs.false_inside = bake.prefer == Prefer::kOutside ? kPreferredCost : 1.0;
    options.costs.false_outside = bake.prefer == Prefer::kInside ? kPreferredCost : 1.0;
    if (bake.quality == Quality::kFast) {
        options.lines.keep = options.lines.choose;
        options.trial_bytes *= 2.0;
    } else if (bake.quality == Quality::kBest) {
        options.lines = {.choose = 16, .keep = 28};
        options.trial_bytes *= 0.6;
    }
    return options;
}

/// Bakes a map that stores the surface at the centre of each texel.
/// \param scan  of the view.
/// \param rowsDone  called with the number of newly finished texel rows, from several threads.
DepthMap bakeSurfaces(const RayScene& scene, const NormalTable& normals, const View& view,
                      const ScanConverter& scan, BakeReport& report, std::uint64_t& covered,
                      const std::function<void(std::uint32_t)>& rowsDone) {
    struct Worker {
        std::vector<Hit> hits[2];
        std::uint64_t covered = 0;
        double trace_ms = 0.0;
        double encode_ms = 0.0;
    };
    DepthMap map = view.emptyMap();
    const auto block_rows =
        static_cast<std::uint32_t>(std::clamp<std::uint64_t>(kBlockTexels / view.width, 4, view.height));
    const std::uint32_t blocks = (view.height + block_rows - 1) / block_rows;  // per face
    tbb::enumerable_thread_specific<Worker> workers;
    const Stopwatch watch;
    tbb::parallel_for(std::uint32_t{0}, view.faceCount() * blocks, [&](std::uint32_t block) {
        const std::uint32_t begin = block % blocks * block_rows;
        const RowRange rows{block / blocks, begin, std::min(begin + block_rows, view.height)};
        Worker& worker = workers.local();
        {
            const TimeAdder watch_trace(worker.trace_ms);
            for (const RayEnd end : {RayEnd::kNear, RayEnd::kFar}) {
                worker.hits[static_cast<std::size_t>(end)].resize(
                    view.keeps(end) ? std::size_t{rows.end - rows.begin} * view.width : 0);
            }
            scan.scan(rows, worker.hits[0], worker.hits[1]);
        }
        {
            const TimeAdder watch_encode(worker.encode_ms);
            worker.covered += encodeRows(scene, normals, view, rows, worker.hits[0], worker.hits[1], map);
        }
        rowsDone(rows.end - rows.begin);
    });
    const double elapsed_ms = watch.ms();
    double trace_ms = 0.0;
    double encode_ms = 0.0;
    for (const Worker& worker : workers) {
        covered += worker.covered;
        trace_ms += worker.trace_ms;
        encode_ms += worker.encode_ms;
    }
    // Times of the threads, scaled to elapsed time.
    const double share = elapsed_ms / std::max(trace_ms + encode_ms, 1e-9);
    report.trace_ms += share * trace_ms;
    report.encode_ms += share * encode_ms;
    return map;
}

class Bake {
  public:
    Bake(const PreparedMesh& mesh, const BakeOptions& options) : mesh_(mesh), options_(options) {}

    Result<Baked> run() {
        jobs_ = RELIEF_TRY(planJobs(mesh_, options_));
        for (const Job& job : jobs_) {
            texels_ += job.texels();
        }
        RELIEF_TRY(makeMaps());
        RELIEF_TRY(checkCovered());
        warnAbout(mesh_, jobs_, baked_.report);
        baked_.collider.bounds = mesh_->bounds;
        baked_.collider.unit = mesh_->unit;
        baked_.collider.provenance = {storedMeshName(mesh_->name), mesh_->content_hash,
                                      mesh_->sourceTriangles(), "relief " RELIEF_VERSION,
                                      effectiveOptions(jobs_, options_)};
        return std::move(baked_);
    }

  private:
    void finish(std::uint64_t texels) {
        const std::lock_guard lock(finish_);
        done_ += texels;
        if (options_.progress) {
            options_.progress(static_cast<double>(done_) / static_cast<double>(texels_));
        }
    }
    [[nodiscard]] auto rowsDone(const View& view) {
        return [this, width = view.width](std::uint32_t rows) { finish(std::uint64_t{rows} * width); };
    }
    void add(DepthMap map, MapReport report) {
        baked_.collider.maps.push_back(std::move(map));
        baked_.report.maps.push_back(std::move(report));
    }

    Result<void> makeMaps() {
        std::optional<RayScene> scene;
        {
            const TimeAdder watch(baked_.report.build_ms);
            scene = RELIEF_TRY(RayScene::build(mesh_));
        }
        std::optional<NormalTable> packed_normals;
        std::vector<glm::dvec3> unit_normals;
        for (auto job = jobs_.begin(); job != jobs_.end();) {
            const Kind kind = kindOf(*job);
            if (kind == Kind::kPatches) {
                RELIEF_TRY(bakeTree(*job++));
                continue;
            }
            const std::ptrdiff_t most = std::min(atOnce(), jobs_.end() - job);
            const auto end = std::find_if(job, job + most, [&](const Job& j) { return kindOf(j) != kind; });
            const std::span<const Job> jobs(job, end);
            job = end;
            if (kind == Kind::kSurfaces) {
                if (!packed_normals) {
                    const TimeAdder watch(baked_.report.encode_ms);
                    packed_normals.emplace(*mesh_, scene->winding(), texels_);
                }
                traceMaps(*scene, *packed_normals, jobs);
                continue;
            }
            const TimeAdder watch(baked_.report.fit_ms);
            if (unit_normals.empty()) {
                unit_normals = unitNormals(*mesh_);
            }
            fitMaps(*scene, unit_normals, jobs);
        }
        return {};
    }

    enum class Kind : std::uint8_t { kSurfaces, kPlanes, kPatches };
    static Kind kindOf(const Job& job) {
        return job.spec.format == MapFormat::kPatches ? Kind::kPatches
               : job.spec.decode == Decode::kPlane    ? Kind::kPlanes
                                                      : Kind::kSurfaces;
    }

    /// Maximum number of maps in progress at the same time: each temporarily needs about 80 bytes per triangle.
    [[nodiscard]] std::ptrdiff_t atOnce() const {
        return std::max<std::ptrdiff_t>(
            1, static_cast<std::ptrdiff_t>(kTrianglesAtOnce /
                                           std::max<std::size_t>(mesh_->triangles.size(), 1)));
    }

    void traceMaps(const RayScene& scene, const NormalTable& normals, std::span<const Job> jobs) {
        std::vector<std::optional<ScanConverter>> scans(jobs.size());
        {
            const TimeAdder watch(baked_.report.trace_ms);
            tbb::parallel_for(std::size_t{0}, jobs.size(),
                              [&](std::size_t i) { scans[i].emplace(scene, jobs[i].view); });
        }
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            const Job& job = jobs[i];
            MapReport report{job.spec, 0, job.texels()};
            DepthMap map = bakeSurfaces(scene, normals, job.view, *scans[i], baked_.report, report.covered,
                                        rowsDone(job.view));
            add(std::move(map), std::move(report));
            scans[i].reset();
        }
    }

    /// Fits the maps in parallel, so that idle threads start on the next map.
    void fitMaps(const RayScene& scene, const std::vector<glm::dvec3>& normals, std::span<const Job> jobs) {
        struct Fitted {
            DepthMap map;
            MapReport report;
        };
        std::vector<Fitted> fitted(jobs.size());
        tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t i) {
            const Job& job = jobs[i];
            fitted[i].report = {job.spec, 0, job.texels()};
            fitted[i].map = bakeFittedMap(scene, normals, job.view, fitOptions(*mesh_, job.view, options_),
                                          fitted[i].report.covered, rowsDone(job.view));
        });
        for (Fitted& f : fitted) {
            add(std::move(f.map), std::move(f.report));
        }
    }

    Result<void> bakeTree(const Job& job) {
        const TimeAdder watch(baked_.report.fit_ms);
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh_));
        PatchOptions options = patchOptions(options_, job.spec);
        if (options_.progress) {
            options.progress = [&, before = static_cast<double>(done_)](double share) {
                options_.progress((before + share * static_cast<double>(job.texels())) /
                                  static_cast<double>(texels_));
            };
        }
        PatchTree tree = RELIEF_TRY(bakePatches(query, options));
        const std::uint64_t covered = patchCount(tree.map) > 0 ? job.texels() : 0;
        const bool coarser = tree.texel > options.texel;
        add(std::move(tree.map), MapReport{job.spec, covered, job.texels(), coarser});
        finish(job.texels());
        if (coarser) {
            baked_.report.warnings.push_back(
                mesh_->name + ": the texel is " + shortest(static_cast<float>(tree.texel)) + ", not " +
                shortest(job.spec.texel) + " as requested, which would take more than " +
                std::to_string(job.spec.bytes) + " bytes; give more bytes or a larger texel");
        }
        return {};
    }

    [[nodiscard]] Result<void> checkCovered() const {
        const std::vector<MapReport>& maps = baked_.report.maps;
        if (std::all_of(maps.begin(), maps.end(), [](const MapReport& map) { return map.covered == 0; })) {
            const auto tree = std::find_if(jobs_.begin(), jobs_.end(),
                                           [](const Job& job) { return kindOf(job) == Kind::kPatches; });
            return fail(ErrorCode::kFailure,
                        mesh_->name + ": no map sees the surface of the mesh" +
                            (tree != jobs_.end()
                                 ? ": its parts are smaller than a texel of " +
                                       shortest(static_cast<float>(finestTexel())) + " in a box of " +
                                       shortest(mesh_->bounds.longestSide()) +
                                       "; bake parts that are far apart separately, or " +
                                       (tree->spec.texel > 0.0F ? "lower the texel" : "give more bytes")
                                 : "; raise the sizes of the maps, or change their dir or box"));
        }
        return {};
    }

    /// In object units.
    [[nodiscard]] double finestTexel() const {
        double finest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < jobs_.size(); ++i) {
            const glm::dvec3& across = jobs_[i].view.axis[0];
            const DepthMap& map = baked_.collider.maps[i];
            const double texel = kindOf(jobs_[i]) == Kind::kPatches
                                     ? patchSpacing(map.texels) * double{map.object_per_map.x}
                                     : std::sqrt(dot(across, across)) / jobs_[i].view.width;
            finest = std::min(finest, texel);
        }
        return finest;
    }

    const PreparedMesh& mesh_;
    const BakeOptions& options_;
    std::vector<Job> jobs_;
    std::uint64_t texels_ = 0;  // of all jobs
    std::mutex finish_;
    std::uint64_t done_ = 0;
    Baked baked_;
};

}  // namespace

Result<Baked> bake(const PreparedMesh& mesh, const BakeOptions& options) {
    if (options.threads == 0) {
        return Bake(mesh, options).run();
    }
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, options.threads);
    tbb::task_arena arena(static_cast<int>(options.threads));
    std::optional<Result<Baked>> result;
    arena.execute([&] { result.emplace(Bake(mesh, options).run()); });
    return std::move(*result);
}

namespace {

/// Measured with a house at (4e5, 0, 8e5) m and a ball there.
constexpr double kWrongPerStep = 0.1;

}  // namespace

double wrongByFloats(const TriangleMesh& mesh) {
    const double step = std::ldexp(1.0, std::ilogb(mesh.bounds.farthest()) - 23);
    const double sigma = AccuracyOptions().sigma_fraction * double{mesh.bounds.longestSide()};
    return std::min(50.0, 100.0 * kWrongPerStep * step / sigma);
}

std::optional<std::string> coarseFloatsWarning(const TriangleMesh& mesh) {
    if (mesh.bounds.longestSide() >= 1e-3F * mesh.bounds.farthest()) {
        return std::nullopt;
    }
    return mesh.name +
           " is more than 1000 times its size away from the origin, where floats are coarse; move it to the "
           "origin";
}

Result<ErrorCurve> planErrors(const PreparedMesh& mesh, const BakeOptions& options, std::uint64_t bytes) {
    MapSpec spec;
    spec.bytes = bytes;
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
    return planErrors(query, patchOptions(options, spec));
}

}  // namespace relief
