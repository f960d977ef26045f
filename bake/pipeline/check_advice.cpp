// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "bake/measure/accuracy.h"
#include "bake/pipeline/bake.h"
#include "bake/pipeline/mesh_check.h"
#include "bake/verdict/report_text.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Larger meshes and budgets take more than a few seconds to bake, and are not tried.
constexpr std::uint64_t kTrialTrianglesMax = 200'000;
constexpr std::uint64_t kTrialBytesMax = 2'500'000;
/// Points near the surface that measure a trial.
constexpr std::uint32_t kTrialSamplesMax = 50'000;
/// An option helps if at most this fraction of the wrong points remains.
constexpr double kHelps = 0.9;

class Advisor {
  public:
    Advisor(const MeshCheck& run, const std::string& mesh_file, const std::string& output)
        : run_(run),
          output_(output),
          patches_(run.recorded.request),
          closes_(patches_.holes == Holes::kClose) {
        const TruthSamples& truth = run.judged().samples;
        truth_.options = truth.options;
        truth_.options.samples = std::min(truth_.options.samples, kTrialSamplesMax);
        truth_.longest_side = truth.longest_side;
        truth_.near.assign(truth.near.begin(), truth.near.begin() + truth_.options.samples);
        patches_.mesh = mesh_file;
        patches_.map.clear();
        patches_.texel.reset();
        patches_.holes = Holes::kClose;
        patches_.resolution.reset();
        patches_.budget = roundBudget(run.collider.texelBytes());
        if (!closes_) {
            // The size of its maps is determined by --resolution, not by a budget.
            patches_.budget = std::min(*patches_.budget, kBudgetDefault);
        }
        // A default thickness depends on the budget of the next bake.
        if (patches_.thickness && patches_.thickness->by_part) {
            patches_.thickness.reset();
        }
        if (patches_.voids == VoidMode::kFill) {
            patches_.voids.reset();  // the default
        }
    }

    std::vector<Advice> run() {
        const bool sheet = any({WrongCause::kSheet});
        const bool open = any({WrongCause::kOpen});
        // Patches fix most errors of other maps, and do not cost more per step.
        if (!run_.collider.hasPatches() && closes_ && !run_.places.empty()) {
            tryBudget(*patches_.budget, "patches of the same size");
        }
        if (closes_ && any({WrongCause::kTexel, WrongCause::kSilhouette, WrongCause::kUnseen})) {
            tryBudget(roundBudget(2 * run_.collider.texelBytes()), "patches of twice the size");
        }
        if (run_.shape.sheets > 0 && run_.shape.thickness > 0.0 && !repaired()) {
            const double twice = 2.0 * run_.shape.thickness;
            // Four digits, to keep the command short.
            const float length = parseFloat(shortNumber(twice)).value_or(static_cast<float>(twice));
            BakeRequest request = patches_;
            request.thickness = Thickness{double{length}, false};
            attempt(request, "sheets twice as thick", *request.budget, false);
        }
        if ((open || sheet) && !repaired()) {
            if (!closes_) {  // without --holes keep
                attempt(patches_, "closed holes, and sheets as shells", *patches_.budget, false);
            }
            if (std::ranges::none_of(advice_, [](const Advice& advice) {
                    return advice.helps && *advice.wrong_percent <= kGoodPercent;
                })) {
                BakeRequest wrapped = patches_;
                wrapped.repair.method = "wrap";
                advice_.push_back({commandLine(wrapped, output_), "a closed surface wrapped around the mesh",
                                   std::nullopt, "wrapping takes up to a minute", false});
            }
        }
        std::ranges::stable_sort(advice_, {}, rank);
        return std::move(advice_);
    }

  private:
    [[nodiscard]] bool any(std::initializer_list<WrongCause> causes) const {
        return std::ranges::any_of(run_.places, [&](const WorstPlace& place) {
            return std::ranges::find(causes, place.cause) != causes.end();
        });
    }
    static double rank(const Advice& advice) {
        const double untried = 200.0;
        return !advice.wrong_percent ? untried : *advice.wrong_percent + (advice.helps ? 0.0 : 2.0 * untried);
    }
    [[nodiscard]] bool repaired() const { return !patches_.repair.method.empty(); }

    /// Returns why a bake is not tried; empty if it is tried.
    [[nodiscard]] std::string tooMuch(std::uint64_t bytes) const {
        if (!run_.recorded.understood) {
            return "the options recorded in the collider are not understood";
        }
        const std::size_t triangles = run_.baked->triangles.size();
        if (triangles > kTrialTrianglesMax) {
            return std::to_string(triangles) + " triangles would take more than a few seconds";
        }
        return bytes > kTrialBytesMax ? bytesWord(bytes) + " would take more than a few seconds" : "";
    }

    /// Returns the percentage of misclassified points near the surface.
    static Result<double> wrongOf(const BakeRequest& request, const PreparedMesh& solid,
                                  const TruthSamples& truth) {
        const Baked baked = RELIEF_TRY(bakeSolid(request, solid));
        return measureField(truth, fieldOf(baked.collider)).near.total();
    }
    /// Measures the bake of another solid against that solid.
    [[nodiscard]] Result<double> wrongOfSolid(const BakeRequest& request) const {
        const ShapedMesh shaped = RELIEF_TRY(makeSolid(request, run_.imported));
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(shaped.mesh));
        return wrongOf(request, shaped.mesh, sampleTruth(query, truth_.options));
    }

    /// Tries a bake, and adds it to the advice if the trial succeeded or was too large.
    void attempt(const BakeRequest& request, const char* description, std::uint64_t bytes, bool same_solid) {
        const std::string command = commandLine(request, output_);
        const std::string too_much = tooMuch(bytes);
        if (!too_much.empty()) {
            advice_.push_back({command, description, std::nullopt, too_much, false});
        } else if (const Result<double> wrong =
                       same_solid ? wrongOf(request, run_.baked, truth_) : wrongOfSolid(request)) {
            advice_.push_back({command, description, *wrong, "", *wrong <= kHelps * run_.wrongPercent()});
        }
    }

    void tryBudget(std::uint64_t budget, const char* description) {
        BakeRequest request = patches_;
        request.budget = budget;
        attempt(request, description, budget, !(run_.shape.default_thickness > 0.0) || repaired());
    }

    const MeshCheck& run_;
    const std::string& output_;
    BakeRequest patches_;  // the recorded bake as patches of the same size, with closed holes
    bool closes_;          // the recorded bake closes holes
    TruthSamples truth_;   // only points near the surface, and fewer
    std::vector<Advice> advice_;
};

}  // namespace

std::vector<Advice> adviceFor(const MeshCheck& run, const std::string& mesh_file, const std::string& output) {
    // If floats are too coarse, no maps help.
    return floatsLimit(*run.mesh, run.wrongPercent()) ? std::vector<Advice>()
                                                      : Advisor(run, mesh_file, output).run();
}

}  // namespace relief
