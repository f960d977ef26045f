#include "bake/cli/check_advice.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "bake/measure/accuracy.h"
#include "bake/pipeline/bake.h"
#include "bake/pipeline/planned_bake.h"
#include "bake/plan/view_planner.h"
#include "bake/report/report_text.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// What must be gained to speak of help.
constexpr double kHelps = 0.9;
/// A cube at a place looks this far from the surface at most, in units of the longest side.
constexpr double kCubeReach = 0.1;
constexpr std::uint32_t kCubeSizeMin = 8;
constexpr std::uint32_t kCubeSizeMax = 64;

/// With four digits, so that commands stay short.
float rounded(double value) {
    return parseFloat(shortNumber(value)).value_or(static_cast<float>(value));
}

class Advisor {
  public:
    explicit Advisor(const AdviceInput& input) : input_(input) {
        truth_.options = input.truth.options;
        truth_.options.samples = std::min(truth_.options.samples, kTrialSamplesMax);
        truth_.longest_side = input.truth.longest_side;
        truth_.near.assign(input.truth.near.begin(), input.truth.near.begin() + truth_.options.samples);
    }

    std::vector<Advice> run() {
        const bool sheet = any({WrongCause::kSheet});
        const bool open = any({WrongCause::kOpen});
        if (any({WrongCause::kTexel, WrongCause::kSilhouette, WrongCause::kUnseen})) {
            tryBudget(roundBudget(2 * input_.collider.gpuBytes()), "planned maps of twice the bytes");
        }
        if (any({WrongCause::kOther})) {
            tryBudget(roundBudget(input_.collider.gpuBytes()), "planned maps of as many bytes");
        }
        if (input_.shape.sheets > 0 && input_.shape.thickness > 0.0) {
            tryThicker();
        }
        if (any({WrongCause::kSilhouette, WrongCause::kUnseen})) {
            tryCubes();
            tryMoreMaps();
        }
        if ((open || sheet) && input_.recorded.repair.empty()) {
            trySolid();
            if (std::none_of(advice_.begin(), advice_.end(), [](const Advice& advice) {
                    return advice.helps && *advice.wrong_percent <= kGoodPercent;
                })) {
                advice_.push_back({command() + plannedBudget() + " --repair wrap",
                                   "a closed surface wrapped round the mesh", std::nullopt,
                                   "wrapping takes up to a minute", false});
            }
        }
        std::stable_sort(advice_.begin(), advice_.end(),
                         [](const Advice& a, const Advice& b) { return rank(a) < rank(b); });
        return std::move(advice_);
    }

  private:
    [[nodiscard]] bool any(std::initializer_list<WrongCause> causes) const {
        return std::any_of(input_.places.begin(), input_.places.end(), [&](const WorstPlace& place) {
            return std::find(causes.begin(), causes.end(), place.cause) != causes.end();
        });
    }
    static double rank(const Advice& advice) {
        const double untried = 200.0;
        return !advice.wrong_percent ? untried : *advice.wrong_percent + (advice.helps ? 0.0 : 2.0 * untried);
    }

    [[nodiscard]] std::string command() const {
        return "relief bake " + shellWord(input_.mesh_file) + " -o " + shellWord(input_.output);
    }
    [[nodiscard]] std::string plannedBudget() const {
        return " --budget " + budgetText(roundBudget(input_.collider.gpuBytes())) + input_.recorded.words();
    }

    /// Why a bake is not tried; empty: it is.
    [[nodiscard]] std::string tooMuch(std::uint64_t bytes) const {
        if (!input_.recorded.understood) {
            return "the collider's record of its options is not understood";
        }
        const std::size_t triangles = input_.baked->triangles.size();
        if (triangles > kTrialTrianglesMax) {
            return std::to_string(triangles) + " triangles would take more than a few seconds";
        }
        return bytes > kTrialBytesMax ? budgetText(bytes) + " would take more than a few seconds" : "";
    }

    [[nodiscard]] BakeOptions bakeOptions() const {
        BakeOptions options;
        options.quality = input_.recorded.quality;
        options.prefer = input_.recorded.prefer;
        return options;
    }
    [[nodiscard]] static Result<double> wrongOf(const PreparedMesh& mesh, const BakeOptions& options,
                                                const TruthSamples& truth) {
        const Baked baked = RELIEF_TRY(bake(mesh, options));
        return measureField(truth, fieldOf(baked.collider)).near.total();
    }
    [[nodiscard]] Result<double> wrongOfPlan(const PreparedMesh& mesh, std::uint64_t budget,
                                             const TruthSamples& truth,
                                             std::uint32_t max_maps = kPlannedMapsMax) const {
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
        ViewOptions options;
        options.prefer = input_.recorded.prefer;
        options.max_maps = max_maps;
        const ViewChoice views = RELIEF_TRY(chooseViews(query, options));
        const PlannedBake planned = RELIEF_TRY(bakePlanned(query, views, budget, bakeOptions()));
        return measureField(truth, fieldOf(planned.baked.collider)).near.total();
    }

    /// Tries, and advises if it could be tried or is too much to be.
    void attempt(const std::string& command, const char* about, std::uint64_t bytes,
                 const std::function<Result<double>()>& trial) {
        const std::string too_much = tooMuch(bytes);
        if (!too_much.empty()) {
            advice_.push_back({command, about, std::nullopt, too_much, false});
        } else if (const Result<double> wrong = trial()) {
            advice_.push_back({command, about, *wrong, "", *wrong <= kHelps * input_.wrong_percent});
        }
    }

    void tryBudget(std::uint64_t budget, const char* about) {
        attempt(command() + " --budget " + budgetText(budget) + input_.recorded.words(), about, budget, [&] {
            if (input_.shape.default_thickness > 0.0 && input_.recorded.repair.empty()) {
                RecordedBake recorded = input_.recorded;
                recorded.shape.thickness = defaultThickness(input_.imported->bounds, budget);
                return wrongOfShape(recorded, budget);
            }
            return wrongOfPlan(input_.baked, budget, truth_);
        });
    }

    /// More maps than a plan has by default, where there are as many.
    void tryMoreMaps() {
        if (input_.collider.maps.size() != kPlannedMapsMax) {
            return;
        }
        const std::uint64_t budget = roundBudget(input_.collider.gpuBytes());
        constexpr std::uint32_t kMaps = 2 * kPlannedMapsMax;
        attempt(command() + " --budget " + budgetText(budget) + " --max-maps " + std::to_string(kMaps) +
                    input_.recorded.words(),
                "more maps of as many bytes, which make each step slower", budget,
                [&] { return wrongOfPlan(input_.baked, budget, truth_, kMaps); });
    }

    /// A cube in the free space before a place, as far as its size and no wall reach. nullopt: there is none.
    [[nodiscard]] std::optional<MapSpec> cubeAt(const WorstPlace& place) const {
        const double side = input_.truth.longest_side;
        const ClosestPoint closest = input_.query.closest(place.position);
        const glm::dvec3 offset = glm::dvec3(place.position) - closest.point;
        const double distance = glm::length(offset);
        if (!(distance > 0.0)) {
            return std::nullopt;
        }
        // The place may lie in the solid: the free space is on the other side of the surface then.
        const glm::dvec3 away = (input_.query.inside(place.position) ? -1.0 : 1.0) / distance * offset;
        const glm::dvec3 at = closest.point + std::max(distance, 1e-3 * side) * away;
        const std::optional<FirstHit> hit = input_.query.firstHit(at, away);
        const double reach = std::min(
            {hit ? hit->along : kCubeReach * side, kCubeReach * side, std::max(place.size(), 0.01 * side)});
        const glm::dvec3 center = at + 0.5 * reach * away;
        const glm::dvec3 half = 1.1 * glm::max(glm::abs(glm::dvec3(place.box.min) - center),
                                               glm::abs(glm::dvec3(place.box.max) - center)) +
                                1e-3 * side;
        MapSpec spec;
        spec.format = MapFormat::kCube8;
        spec.compare = Compare::kLess;
        spec.box = Bounds{};
        for (int i = 0; i < 3; ++i) {
            spec.box->min[i] = rounded(center[i] - half[i]);
            spec.box->max[i] = rounded(center[i] + half[i]);
        }
        const double wanted = std::min(place.texel > 0.0 ? place.texel : side, 0.005 * side);
        const double size = 2.0 * std::max({half.x, half.y, half.z}) / wanted;
        spec.width = spec.height = static_cast<std::uint32_t>(
            std::clamp(std::ceil(size), double{kCubeSizeMin}, double{kCubeSizeMax}));
        return spec;
    }

    /// The maps that there are, and a cube at each place that they do not see.
    void tryCubes() {
        BakeOptions options = bakeOptions();
        options.maps = input_.recorded.maps;
        std::uint64_t bytes = input_.collider.gpuBytes();
        for (const WorstPlace& place : input_.places) {
            if (place.cause != WrongCause::kUnseen && place.cause != WrongCause::kSilhouette) {
                continue;
            }
            if (const std::optional<MapSpec> cube = cubeAt(place)) {
                options.maps.push_back(*cube);
                bytes += std::uint64_t{24} * cube->width * cube->width;
            }
        }
        if (input_.recorded.maps.empty() || options.maps.size() == input_.recorded.maps.size()) {
            return;
        }
        std::string line = command();
        for (const MapSpec& map : options.maps) {
            line += " --map " + toString(map);
        }
        attempt(line + input_.recorded.words(),
                "the same maps, and a cube at each place that they do not see", bytes,
                [&] { return wrongOf(input_.baked, options, truth_); });
    }

    /// Planned maps for another solid, against that solid.
    Result<double> wrongOfShape(const RecordedBake& recorded, std::uint64_t budget) const {
        const ShapedMesh shaped = RELIEF_TRY(shapedMesh(recorded, input_.imported));
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(shaped.mesh));
        return wrongOfPlan(shaped.mesh, budget, sampleTruth(query, truth_.options));
    }

    /// A bake without --holes keep.
    void trySolid() {
        if (!input_.recorded.keeps_holes) {
            return;
        }
        RecordedBake recorded = input_.recorded;
        recorded.keeps_holes = false;
        const std::uint64_t budget = roundBudget(input_.collider.gpuBytes());
        recorded.shape.thickness = defaultThickness(input_.imported->bounds, budget);
        recorded.shape.thickness_by_part = true;
        attempt(command() + " --budget " + budgetText(budget) + recorded.words("--holes"),
                "holes closed, and sheets made shells", budget,
                [&] { return wrongOfShape(recorded, budget); });
    }

    void tryThicker() {
        RecordedBake recorded = input_.recorded;
        if (!recorded.repair.empty()) {
            return;
        }
        const float thickness = rounded(2.0 * input_.shape.thickness);
        recorded.shape.thickness = double{thickness};
        recorded.shape.thickness_by_part = false;
        const std::uint64_t budget = roundBudget(input_.collider.gpuBytes());
        attempt(command() + " --budget " + budgetText(budget) + recorded.words("--thickness") +
                    " --thickness " + shortest(thickness),
                "sheets twice as thick", budget, [&] { return wrongOfShape(recorded, budget); });
    }

    const AdviceInput& input_;
    TruthSamples truth_;  // near the surface alone, and fewer
    std::vector<Advice> advice_;
};

}  // namespace

std::vector<Advice> adviceFor(const AdviceInput& input) {
    return Advisor(input).run();
}

}  // namespace relief
