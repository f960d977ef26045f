// SPDX-License-Identifier: Apache-2.0
// relief-accuracy: misclassified points per byte of dense and sparse distance volumes, of the paper's maps and of our
// maps, as JSON. scripts/accuracy.sh runs it on a list of meshes and makes tables of the results.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <glm/vec2.hpp>
#include <nlohmann/json.hpp>

#include "bake/bench/brick_volume.h"
#include "bake/bench/distance_volume.h"
#include "bake/bench/sheet_truth.h"
#include "bake/import/mesh_import.h"
#include "bake/measure/accuracy.h"
#include "bake/pipeline/bake.h"
#include "bake/repair/winding.h"
#include "bake/report/bake_report.h"
#include "bake/shape/shape.h"
#include "bake/verdict/check_report.h"
#include "bake/views/view.h"
#include "formats/base/file_io.h"
#include "formats/base/stopwatch.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "formats/fields/json_value.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

/// The result of a method for one mesh and budget.
struct AccuracyEntry {
    std::string what;  ///< description of the lattice or the maps
    std::size_t maps = 0;
    std::uint64_t bytes = 0;
    std::optional<double> build_seconds;  ///< for maps: acceleration structure, rays and fit
    Json accuracy;                        ///< of FieldAccuracyReport or ColliderAccuracyReport
};

// --- Methods ---

/// Returns three front-back maps along the axes on tight boxes, with as many texels as fit into `bytes`. The texels are
/// as square and as equal in size as whole numbers allow.
Result<std::vector<MapSpec>> threeMaps(const TriangleMesh& mesh, std::uint64_t bytes) {
    std::vector<MapSpec> specs(3);
    glm::dvec2 extent[3];
    for (int axis = 0; axis < 3; ++axis) {
        MapSpec& spec = specs[static_cast<std::size_t>(axis)];
        spec.format = MapFormat::kFrontBackHalf;
        spec.decode = Decode::kProjected;
        spec.direction = glm::vec3(0.0F);
        spec.direction[axis] = -1.0F;
        spec.width = spec.height = kMapSizeMin;
        const View view = RELIEF_TRY(makeView(spec, mesh));
        // One texel between the borders: the tight volume is a third of the texture.
        extent[axis] = glm::dvec2(view.object_per_map.x, view.object_per_map.y) / 3.0;
    }
    const auto resize = [&](double texel) {
        std::uint64_t total = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto side = [&](double length) {
                const double texels = std::ceil(length / texel * (1.0 - 1e-9)) + 2.0;
                return static_cast<std::uint32_t>(std::min<double>(texels, kMapSizeMax));
            };
            specs[i].width = side(extent[i].x);
            specs[i].height = side(extent[i].y);
            total += std::uint64_t{specs[i].width} * specs[i].height * texelSize(specs[i].format);
        }
        return total <= bytes;
    };
    double large = static_cast<double>(mesh.bounds.longestSide()) * 2.0;
    if (!resize(large)) {
        return fail(ErrorCode::kUsage, "--budget is too small for three maps; raise it");
    }
    double small = 0.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (small + large);
        (resize(middle) ? large : small) = middle;
    }
    (void)resize(large);
    return specs;
}

/// Bakes the projected depth of the paper in its front-back format.
Result<Baked> bakePaper(const PreparedMesh& mesh, std::uint64_t bytes) {
    BakeOptions options;
    options.maps = RELIEF_TRY(threeMaps(*mesh, bytes));
    return bake(mesh, options);
}

/// Bakes as `relief bake --budget`.
Result<Baked> bakeOurs(const PreparedMesh& mesh, std::uint64_t bytes) {
    BakeRequest request;
    request.budget = bytes;
    return bakeSolid(request, mesh);
}

// --- Measurements ---

/// Keeps the volume with the fewest wrong points.
class BestVolume {
  public:
    /// \param atlas  receives the data of the best volume; may be null
    BestVolume(const TruthSamples& samples, BrickAtlas* atlas) : samples_(samples), atlas_(atlas) {}

    /// \param volume  DistanceVolume or BrickVolume
    template <class Volume>
    void offer(const Volume& volume, const std::string& what, double build_seconds) {
        const FieldAccuracy accuracy = measureField(samples_, fieldOf(volume));
        if (wrong_ && accuracy.near.total() >= *wrong_) {
            return;
        }
        wrong_ = accuracy.near.total();
        entry_ = {what, 0, volume.bytes(), build_seconds,
                  jsonOf(FieldAccuracyReport{accuracy, samples_.longest_side})};
        if (atlas_ != nullptr) {
            *atlas_ = volume.atlas();
        }
    }
    AccuracyEntry take() { return std::move(entry_); }

  private:
    const TruthSamples& samples_;
    BrickAtlas* atlas_;
    std::optional<double> wrong_;  // percent
    AccuracyEntry entry_;
};

/// Measures all positions and quantisations of the volume, and returns the best.
AccuracyEntry measureVolume(const MeshQuery& query, const TruthSamples& samples, std::uint64_t budget,
                            BrickAtlas* atlas) {
    BestVolume best(samples, atlas);
    // Four standard deviations include all but 6 in 100,000 of the points near the surface.
    const double reach = 4.0 * samples.options.sigma_fraction * samples.longest_side;
    for (const LatticeFit fit : {LatticeFit::kCentered, LatticeFit::kCorner, LatticeFit::kStretched}) {
        const Stopwatch watch;
        const DistanceGrid grid =
            sampleDistances(query, makeLattice(query.mesh().bounds, budget / sizeof(std::int16_t), fit));
        const double seconds = watch.seconds();
        const glm::uvec3 n = grid.lattice.nodes;
        const std::string what = std::to_string(n.x) + "x" + std::to_string(n.y) + "x" + std::to_string(n.z) +
                                 (fit == LatticeFit::kCentered ? " centred"
                                  : fit == LatticeFit::kCorner ? " from a corner"
                                                               : " stretched");
        best.offer(DistanceVolume(grid, DistanceVolume::fullRange(grid)), what, seconds);
        best.offer(DistanceVolume(grid, DistanceVolume::bandRange(grid, reach)), what + ", band", seconds);
    }
    return best.take();
}

/// Measures several layouts, and returns the best.
AccuracyEntry measureBricks(const MeshQuery& query, const TruthSamples& samples, const std::string& method,
                            std::uint64_t budget, BrickAtlas* atlas) {
    // Unreal's band is 2 to 4 voxels; 2 has the finest codes. Bricks of 3³ and an octree of 2³ were the best of 2³ to
    // 8³.
    std::vector<BrickLayout> layouts = {{.cells = 8, .flat_index = true}};
    if (method != "unreal") {
        const bool fitted = method == "fitted";
        layouts = {{.cells = 3, .fitted = fitted}, {.cells = 2, .octree = true, .fitted = fitted}};
    }
    if (atlas != nullptr) {
        std::erase_if(layouts, [](const BrickLayout& layout) { return layout.octree; });
    }
    BestVolume best(samples, atlas);
    for (const BrickLayout& layout : layouts) {
        const Stopwatch watch;
        const BrickVolume volume = BrickVolume::build(query, layout, budget);
        best.offer(volume, volume.text(), watch.seconds());
    }
    return best.take();
}

struct Truth {
    const MeshQuery& query;  ///< of the baked solid
    const TruthSamples& samples;
    const std::vector<TruthPoint>& sheets;  ///< of SheetTruth::sample
};

AccuracyEntry measureMaps(const Truth& truth, const Collider& collider) {
    AccuracyEntry entry;
    const ColliderAccuracy accuracy = measureCollider(truth.samples, truth.query, collider);
    for (const DepthMap& map : collider.maps) {
        entry.what += (entry.what.empty() ? "" : " ") + std::to_string(map.width) + "x" +
                      std::to_string(map.height) + (map.faceCount() == 6 ? "x6" : "");
    }
    entry.maps = collider.maps.size();
    entry.bytes = accuracy.gpu_bytes;
    entry.accuracy = jsonOf(ColliderAccuracyReport{accuracy, truth.samples.longest_side});
    if (!truth.sheets.empty()) {
        entry.accuracy["as_it_came"] = jsonOf(measureNear(truth.sheets, fieldOf(collider)));
    }
    return entry;
}

Result<AccuracyEntry> bakeAndMeasure(const Truth& truth, const std::string& method, std::uint64_t budget) {
    const Stopwatch watch;
    const PreparedMesh& mesh = truth.query.prepared();
    const Baked baked = RELIEF_TRY(method == "paper" ? bakePaper(mesh, budget) : bakeOurs(mesh, budget));
    const double seconds = watch.seconds();
    AccuracyEntry entry = measureMaps(truth, baked.collider);
    entry.build_seconds = seconds;
    return entry;
}

/// Loads and measures a file written by `relief bake` with any options.
Result<AccuracyEntry> loadAndMeasure(const Truth& truth, const std::string& path) {
    const Collider collider = RELIEF_TRY(loadCollider(path));
    const TriangleMesh& mesh = truth.query.mesh();
    if (collider.provenance.mesh_hash != mesh.content_hash) {
        return invalidInput(quotedPath(path) + " was not baked from " + mesh.name +
                            "; bake that mesh, or give --collider another file");
    }
    return measureMaps(truth, collider);
}

// --- Program ---

struct Arguments {
    std::vector<std::string> meshes;
    std::vector<std::string> budgets = {"0.25MB", "1MB", "4MB"};
    std::uint32_t samples = AccuracyOptions{}.samples;
    std::uint64_t seed = AccuracyOptions{}.seed;
    std::vector<std::string> methods = {"volume", "unreal", "bricks", "fitted", "paper", "ours"};
    std::string collider;
    std::string atlas;
};

Result<std::vector<std::uint64_t>> parseBudgets(const std::vector<std::string>& texts) {
    std::vector<std::uint64_t> budgets;
    for (const std::string& text : texts) {
        const std::optional<std::uint64_t> bytes = parseByteCount(text);
        if (!bytes) {
            return fail(ErrorCode::kUsage,
                        "--budgets contains '" + cleanUtf8(text) + "'; write sizes such as 0.25MB,1MB,4MB");
        }
        budgets.push_back(*bytes);
    }
    return budgets;
}

struct Measured {
    Json meshes = Json::array();
    Json results = Json::array();  ///< results of the same mesh and budget are adjacent
};

/// Returns the parts, thickness and voids recorded in the given collider.
Result<BakeRequest> recordedShapeOf(const Arguments& arguments) {
    BakeRequest request;
    if (!arguments.collider.empty()) {
        const Collider collider = RELIEF_TRY(loadCollider(arguments.collider));
        BakeRequest recorded = recordedBake(collider.provenance.options).request;
        request.as = std::move(recorded.as);
        request.thickness = recorded.thickness;
        request.voids = voidsOf(recorded);
    }
    return request;
}

/// Measures one mesh at one budget with all methods.
/// \param shape  the default of its thickness depends on the budget.
Result<void> measureBudget(const PreparedMesh& imported, const Arguments& arguments, BakeRequest shape,
                           std::uint64_t budget, Measured& measured) {
    shape.budget = budget;
    const ShapedMesh shaped = RELIEF_TRY(makeSolid(shape, imported));
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(shaped.mesh));
    AccuracyOptions options;
    options.samples = arguments.samples;
    options.seed = arguments.seed;
    const TruthSamples samples = sampleTruth(query, options);
    Json mesh_report = jsonOf(samples);
    mesh_report["mesh"] = imported->name;
    mesh_report["mesh_hash"] = imported->content_hash;
    mesh_report["budget"] = budget;
    mesh_report["triangles"] = imported->triangles.size();
    mesh_report["shape"] = jsonOf(shapesIfAny(shaped.report));
    const SheetTruth sheet_truth = RELIEF_TRY(SheetTruth::build(imported, shaped));
    const std::vector<TruthPoint> sheets = sheet_truth.sample(query, options);
    const Truth truth{query, samples, sheets};
    if (!sheets.empty()) {
        mesh_report["as_it_came"] = jsonOf(measureNear(sheets, [&query](const glm::vec3& p) {
            return FieldValue{query.inside(p) ? -1.0F : 1.0F, glm::vec3(0.0F)};
        }));
    }
    measured.meshes.push_back(std::move(mesh_report));
    BrickAtlas atlas;
    BrickAtlas* const atlas_output = arguments.atlas.empty() ? nullptr : &atlas;
    for (const std::string& method : arguments.methods) {
        AccuracyEntry entry;
        if (method == "ours" && !arguments.collider.empty()) {
            entry = RELIEF_TRY(loadAndMeasure(truth, arguments.collider));
        } else if (method == "volume") {
            entry = measureVolume(query, samples, budget, atlas_output);
        } else if (method != "paper" && method != "ours") {
            entry = measureBricks(query, samples, method, budget, atlas_output);
        } else {
            entry = RELIEF_TRY(bakeAndMeasure(truth, method, budget));
        }
        measured.results.push_back(
            {{"mesh", imported->name},
             {"closed", shaped.report.solids_with_holes + shaped.report.sheets + shaped.report.terrains == 0},
             {"budget", budget},
             {"method", method},
             {"what", entry.what},
             {"maps", entry.maps},
             {"bytes", entry.bytes},
             {"build_seconds", entry.build_seconds ? Json(*entry.build_seconds) : Json()},
             {"accuracy", entry.accuracy}});
    }
    if (atlas_output != nullptr) {
        RELIEF_TRY(saveBrickAtlas(atlas, arguments.atlas));
    }
    return {};
}

Result<void> run(const Arguments& arguments) {
    const std::vector<std::uint64_t> budgets = RELIEF_TRY(parseBudgets(arguments.budgets));
    if (!arguments.atlas.empty()) {
        if (arguments.meshes.size() != 1 || budgets.size() != 1 || arguments.methods.size() != 1 ||
            arguments.methods[0] == "paper" || arguments.methods[0] == "ours") {
            return fail(
                ErrorCode::kUsage,
                "--atlas writes a single volume; give one MESH, one --budget, and one of --methods volume, "
                "unreal, bricks or fitted");
        }
        RELIEF_TRY(preflightFile(arguments.atlas, "--atlas"));
    }
    if (!arguments.collider.empty() && (arguments.meshes.size() != 1 || budgets.size() != 1)) {
        return fail(ErrorCode::kUsage, "--collider is for a single mesh; give one MESH and one --budget");
    }
    const BakeRequest shape = RELIEF_TRY(recordedShapeOf(arguments));
    ImportOptions import;
    import.names = RELIEF_TRY(parseShapeOptions(shape.as)).names();
    Measured measured;
    for (const std::string& path : arguments.meshes) {
        const Stopwatch watch;
        TriangleMesh mesh = RELIEF_TRY(importMeshInWorker(path, import));
        const auto winding = RELIEF_TRY(windOutwards(std::move(mesh)));
        for (const std::uint64_t budget : budgets) {
            RELIEF_TRY(measureBudget(winding.mesh, arguments, shape, budget, measured));
        }
        std::fprintf(stderr, "%s: %.1f s\n", winding.mesh->name.c_str(), watch.seconds());
    }
    return writeText("-", jsonText({{"meshes", measured.meshes}, {"results", measured.results}}));
}

int report(const Error& error) {
    std::fprintf(stderr, "relief-accuracy: error: %s\n", error.message.c_str());
    return static_cast<int>(error.code);
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    using namespace relief;
    CLI::App app("Measures wrong points per byte of distance volumes, the paper's maps and our maps",
                 "relief-accuracy");
    Arguments arguments;
    app.add_option("mesh", arguments.meshes, "Meshes")->option_text("MESH...")->required();
    app.add_option("--budgets,--budget", arguments.budgets, "Bytes per collider (default: 0.25MB,1MB,4MB)")
        ->delimiter(',');
    app.add_option("--samples", arguments.samples, "Number of points of each kind (default: 200000)")
        ->check(CLI::Range(1U, 100'000'000U));
    app.add_option("--seed", arguments.seed, "Seed of the points (default: 1)");
    app.add_option("--methods", arguments.methods,
                   "volume, unreal, bricks, fitted, paper or ours (default: all)")
        ->delimiter(',')
        ->check(CLI::IsMember({"volume", "unreal", "bricks", "fitted", "paper", "ours"}));
    app.add_option("--collider", arguments.collider,
                   "Measure this output of `relief bake` instead of baking; for one mesh and one budget");
    app.add_option(
        "--atlas", arguments.atlas,
        "Write the volume (not an octree) to this file, for relief-bench step --bricks; for one mesh, "
        "budget and method");
    CLI11_PARSE(app, argc, argv);
    try {
        const Result<void> done = run(arguments);
        return done ? 0 : report(done.error());
    } catch (const std::exception& e) {
        return report({ErrorCode::kFailure, e.what()});
    }
}
