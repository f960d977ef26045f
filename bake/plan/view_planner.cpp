// SPDX-License-Identifier: Apache-2.0
#include "bake/plan/view_planner.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vector_relational.hpp>
#include <iterator>
#include <optional>
#include <utility>

#include "bake/mesh/oriented_box.h"
#include "bake/plan/cavities.h"
#include "bake/plan/gap_grid.h"
#include "bake/plan/outer_views.h"
#include "bake/plan/plan_points.h"
#include "bake/plan/view.h"

namespace relief {
namespace {

/// Service to a point that a view sees from both sides: it lies off a silhouette, where a standing plane is (plane_fit.h).
constexpr float kSilhouette = 0.9F;
/// Gain in mean service for which an outer view is taken before places within are tried.
constexpr double kClearGain = 0.03;
/// Price of a map in mean service: every step of a simulation samples all maps.
constexpr double kMapPrice = 0.0013;
/// Price of a map with as many bytes as all before it, whose texels grow for it.
constexpr double kBytePrice = 0.02;
/// With Prefer::kOutside, the share of these prices.
constexpr double kOutsidePriceShare = 0.2;
/// Points of less service are badly served. Places within are tried while these are more than kCavityShare of all.
constexpr double kUnserved = 0.5;
constexpr double kCavityShare = 0.002;
/// Consecutive rounds without a place within that is worth its price.
constexpr int kIdleRounds = 3;
/// An eighth of the points eliminates half of the outer views, a fourth half of the others, and so on.
constexpr std::size_t kFirstStride = 8;
constexpr std::size_t kBlock = 1024;  // points per task
/// Estimated area of the gaps along an outer view's direction, as a share of its area.
constexpr double kGapShare = 0.3;
/// Limit of the maps' rectangles, as the budget counts row spans alone: so many bytes, or so many budgets.
constexpr std::uint64_t kRectangleBytes = std::uint64_t{128} << 20;
constexpr std::uint64_t kRectangleShare = 16;
/// Texels of a map of gaps across one of an outer view: no other map sees much of its content.
constexpr double kGapDetail = 1.4;

std::string text(const char* format, double a, double b = 0.0, double c = 0.0, double d = 0.0) {
    char buffer[160];
    std::snprintf(buffer, sizeof(buffer), format, a, b, c, d);
    return buffer;
}

struct RatedView : OuterView {
    std::vector<float> service;  ///< by point
    std::size_t stride = 0;      ///< of the points with a service; 0: none
};

class Planner {
  public:
    Planner(const MeshQuery& query, const ViewOptions& options)
        : mesh_(query.mesh()), query_(query), options_(options) {
        choice_.mesh_name = mesh_.name;
    }

    Result<ViewChoice> run() {
        const VertexBlocks& blocks = query_.prepared().vertexBlocks();
        std::vector<RatedView> spread;
        for (const glm::dvec3& direction : outerDirections(mesh_.bounds)) {
            spread.emplace_back().spec.direction = glm::vec3(direction) + 0.0F;
        }
        std::optional<OrientedBox> box;
        // The box takes one thread for a while.
        tbb::parallel_invoke([&] { box = options_.oriented_box ? orientedBox(blocks) : std::nullopt; },
                             [&] {
                                 points_ = drawPlanPoints(query_, options_.seed);
                                 rate(pointersTo(spread), kFirstStride);
                             });
        served_.assign(points_.size(), 0.0F);
        std::vector<glm::dvec3> positions;
        for (const PlanPoint& point : points_) {
            positions.push_back(point.position);
        }
        std::vector<RatedView> views;
        for (OuterView& view : RELIEF_TRY(outerViews(mesh_, blocks, positions, box))) {
            const auto rated = std::ranges::find_if(
                spread, [&](const RatedView& other) { return other.spec.direction == view.spec.direction; });
            views.push_back({std::move(view), {}, 0});
            if (rated != spread.end()) {
                views.back().service = rated->service;  // a copy: directions may coincide
                views.back().stride = rated->stride;
            }
        }
        RELIEF_TRY(addViews(views));
        // Maps of gaps depend on those before them.
        std::stable_partition(
            choice_.views.begin(), choice_.views.end(),
            [](const ViewChoice::Chosen& chosen) { return chosen.map.spec.compare != Compare::kGap; });
        RELIEF_TRY(addSilhouettes());
        return std::move(choice_);
    }

  private:
    [[nodiscard]] Result<void> addSilhouettes() {
        std::vector<Result<void>> done(choice_.views.size());
        tbb::parallel_for(std::size_t{0}, done.size(),
                          [&](std::size_t i) { done[i] = addSilhouette(choice_.views[i]); });
        for (Result<void>& result : done) {
            RELIEF_TRY(std::move(result));
        }
        return {};
    }
    [[nodiscard]] Result<void> addSilhouette(ViewChoice::Chosen& chosen) const {
        if (chosen.map.spec.format != MapFormat::kCube8 && !chosen.silhouette) {
            chosen.silhouette.emplace(mesh_, RELIEF_TRY(viewOf(chosen.map.spec)));
        }
        return {};
    }
    /// For its outline, which is independent of its size.
    [[nodiscard]] Result<View> viewOf(MapSpec spec) const {
        spec.width = spec.height = 64;
        return makeView(spec, mesh_, &query_.prepared().vertexBlocks());
    }

    static std::vector<RatedView*> pointersTo(std::vector<RatedView>& views) {
        std::vector<RatedView*> pointers;
        for (RatedView& view : views) {
            pointers.push_back(&view);
        }
        return pointers;
    }

    /// Computes the service of views to every stride-th point.
    void rate(const std::vector<RatedView*>& views, std::size_t stride) const {
        for (RatedView* view : views) {
            view->service.resize(points_.size());
        }
        const std::size_t blocks = (points_.size() + kBlock - 1) / kBlock;
        tbb::parallel_for(std::size_t{0}, views.size() * blocks, [&](std::size_t task) {
            RatedView& view = *views[task / blocks];
            const std::size_t begin = task % blocks * kBlock;
            static_assert(kBlock % kFirstStride == 0);
            for (std::size_t i = begin; i < std::min(begin + kBlock, points_.size()); i += stride) {
                if (view.stride == 0 || i % view.stride != 0) {
                    view.service[i] = serviceOf(points_[i], glm::dvec3(view.spec.direction));
                }
            }
        });
        for (RatedView* view : views) {
            view->stride = view->stride == 0 ? stride : std::min(view->stride, stride);
        }
    }

    [[nodiscard]] float serviceOf(const PlanPoint& point, const glm::dvec3& along) const {
        const double cosine = dot(point.normal, along);
        const glm::dvec3 away = cosine < 0.0 ? -along : along;
        const bool free = query_.rayIsFree(point.position, away);
        const float value = free ? service(std::abs(cosine)) : 0.0F;
        // The ray into the surface cannot improve on good service.
        if (value < kSilhouette && query_.rayIsFree(point.position, -away)) {
            return free ? kSilhouette : service(-std::abs(cosine));
        }
        return value;
    }

    /// Adds maps while one more is worth its price.
    [[nodiscard]] Result<void> addViews(std::vector<RatedView>& views) {
        int idle_rounds = 0;
        std::optional<Gaps> gaps;
        std::size_t gaps_after = 0;  // number of maps at the last search for gaps
        for (std::uint64_t round = 0; idle_rounds < kIdleRounds; ++round) {
            const OuterChoice outer = bestOuterView(views);
            const bool full = choice_.views.size() >= options_.max_maps;
            if (!full && outer.view != nullptr && (outer.gain >= kClearGain || choice_.views.empty())) {
                take(*outer.view, outer.gain * total());
                continue;
            }
            const std::vector<std::size_t> unserved = unservedPoints();
            const std::optional<Cavity> cavity =
                bestCavity(query_, points_, unserved, served_, outer_area_,
                           options_.seed * 1'000'003 + round * kCavityCandidates);
            if (choice_.views.size() != gaps_after) {  // else unchanged
                gaps_after = choice_.views.size();
                gaps = bestGaps(views, unserved);
            }
            const double cavity_gain = cavity ? cavity->gain / total() : 0.0;
            const double gap_gain = gaps ? gaps->gain / total() : 0.0;
            const double outer_value =
                outer.view == nullptr ? 0.0 : valueOf(outer.gain, 8.0 * outer.view->area);
            const double cavity_value = cavity ? valueOf(cavity_gain, cavity->area) : 0.0;
            const double gap_value = gaps ? valueOf(gap_gain, gaps->area) : 0.0;
            if (full) {
                choice_.next_gain = std::max({outer.gain, cavity_gain, gap_gain});
                return {};
            }
            if (std::max({outer_value, cavity_value, gap_value}) <= 0.0) {
                choice_.next_gain = std::max({choice_.next_gain, outer.gain, cavity_gain, gap_gain});
                idle_rounds = cavity ? idle_rounds + 1 : kIdleRounds;  // places within are random
                continue;
            }
            choice_.next_gain = 0.0;
            if (gap_value >= std::max(outer_value, cavity_value)) {
                RELIEF_TRY(take(*gaps, unserved));
            } else if (cavity_value > outer_value) {
                take(*cavity);
            } else {
                take(*outer.view, outer.gain * total());
            }
        }
        return {};
    }

    [[nodiscard]] double total() const { return static_cast<double>(points_.size()); }

    /// The value of a map that raises the mean service by `gain` and takes `area` from the others.
    [[nodiscard]] double valueOf(double gain, double area) const {
        const double share = options_.prefer == Prefer::kOutside ? kOutsidePriceShare : 1.0;
        return gain - share * (kBytePrice * area / choice_.area + kMapPrice);
    }

    struct OuterChoice {
        const RatedView* view = nullptr;
        double gain = 0.0;  ///< in the mean service
    };
    [[nodiscard]] OuterChoice bestOuterView(std::vector<RatedView>& views) const {
        std::vector<RatedView*> left = pointersTo(views);
        std::vector<std::pair<double, RatedView*>> scored;
        for (std::size_t stride = kFirstStride;; stride /= 2) {
            rate(left, stride);
            scored.clear();
            for (RatedView* view : left) {
                // By the root of its bytes: an oblique image of half the size has texels as large on the surface, and
                // silhouettes as long.
                const double gain = gainOf(*view, stride);
                scored.emplace_back(gain > 0.0 ? gain / std::sqrt(view->area) : 0.0, view);
            }
            std::ranges::stable_sort(scored, std::greater<>(), [](const auto& entry) { return entry.first; });
            if (stride == 1) {
                break;
            }
            left.clear();
            for (std::size_t i = 0; i < (scored.size() + 1) / 2; ++i) {
                left.push_back(scored[i].second);
            }
        }
        if (scored.empty() || !(scored[0].first > 0.0)) {
            return {};
        }
        return {scored[0].second, gainOf(*scored[0].second, 1) / total()};
    }

    /// The gain of a view in the service of every stride-th point.
    [[nodiscard]] double gainOf(const RatedView& view, std::size_t stride) const {
        double gain = 0.0;
        for (std::size_t i = 0; i < points_.size(); i += stride) {
            gain += std::max(0.0F, view.service[i] - served_[i]);
        }
        return gain;
    }

    /// \param gain  in the service of all points.
    void take(const RatedView& view, double gain) {
        std::size_t sees = 0;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            served_[i] = std::max(served_[i], view.service[i]);
            sees += view.service[i] > 0.0F ? 1U : 0U;
        }
        const glm::vec3& d = view.spec.direction;
        add(view.spec, gain,
            text("both sides along (%.3g, %.3g, %.3g)", d.x, d.y, d.z) +
                text(" see %.1f %% of the surface; service +%.1f %%",
                     100.0 * static_cast<double>(sees) / total(), 100.0 * gain / total()),
            {view.width, view.height}, 8.0 * view.area);
        outer_area_ = choice_.area;
    }

    ViewChoice::Chosen& add(const MapSpec& spec, double gain, std::string reason, const glm::dvec2& size,
                            double area) {
        choice_.area += area;
        return choice_.views.emplace_back(ViewChoice::Chosen{
            {spec, gain / total(), std::move(reason)}, size.x, size.y, area, std::nullopt});
    }

    /// Badly served points; none if they are too few to matter.
    [[nodiscard]] std::vector<std::size_t> unservedPoints() const {
        std::vector<std::size_t> unserved;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (served_[i] < kUnserved) {
                unserved.push_back(i);
            }
        }
        if (static_cast<double>(unserved.size()) < kCavityShare * total()) {
            unserved.clear();
        }
        return unserved;
    }

    /// A map of gaps along the direction of an outer view.
    struct Gaps {
        const RatedView* view = nullptr;
        double gain = 0.0;
        double area = 0.0;  ///< bytes for texels of side 1
    };

    /// A chosen map sees a point of free space.
    [[nodiscard]] bool isSeen(const glm::dvec3& p) const {
        for (const ViewChoice::Chosen& chosen : choice_.views) {
            const MapSpec& spec = chosen.map.spec;
            if (spec.compare == Compare::kGap) {
                continue;
            }
            if (spec.format != MapFormat::kCube8) {
                const glm::dvec3 along(spec.direction);
                if (query_.rayIsFree(p, along) || query_.rayIsFree(p, -along)) {
                    return true;
                }
                continue;
            }
            const glm::dvec3 low(spec.box->min);
            const glm::dvec3 high(spec.box->max);
            const bool within =
                glm::all(glm::greaterThanEqual(p, low)) && glm::all(glm::lessThanEqual(p, high));
            if (within && query_.segmentIsFree(0.5 * (low + high), p)) {
                return true;
            }
        }
        return std::ranges::any_of(gap_grids_, [&](const GapGrid& grid) { return grid.holds(p); });
    }
    [[nodiscard]] IsSeen isSeenByTaken() const {
        return [this](const glm::dvec3& p) { return isSeen(p); };
    }

    [[nodiscard]] float serviceOfGap(std::size_t i, const glm::dvec3& along) const {
        const float most = service(std::abs(dot(points_[i].normal, along)));
        // Only a better service than the maps so far needs the test.
        return most > served_[i] && isInKeptGap(query_, points_[i].position, along, isSeenByTaken()) ? most
                                                                                                     : 0.0F;
    }

    /// The best of the directions of all outer views.
    [[nodiscard]] std::optional<Gaps> bestGaps(const std::vector<RatedView>& views,
                                               const std::vector<std::size_t>& unserved) const {
        if (unserved.empty() || !options_.gaps) {
            return std::nullopt;
        }
        const std::vector<std::size_t> tried = somePoints(unserved);
        std::vector<Gaps> left(views.size());
        for (std::size_t v = 0; v < views.size(); ++v) {
            left[v].view = &views[v];
            left[v].area = 8.0 * kGapDetail * kGapDetail * kGapShare * views[v].area;
        }
        // A few points eliminate half of the directions, twice as many half of the others, and so on.
        std::size_t asked = 0;
        for (std::size_t parts = kSomeParts; parts > 0; parts /= 2) {
            const std::size_t end = tried.size() / parts;
            tbb::parallel_for(std::size_t{0}, left.size(), [&](std::size_t v) {
                const glm::dvec3 along(left[v].view->spec.direction);
                for (std::size_t k = asked; k < end; ++k) {
                    left[v].gain += std::max(0.0F, serviceOfGap(tried[k], along) - served_[tried[k]]);
                }
            });
            asked = end;
            std::ranges::stable_sort(left, [](const Gaps& a, const Gaps& b) {
                return a.gain * std::sqrt(b.area) > b.gain * std::sqrt(a.area);
            });
            left.resize(parts == 1 ? 1 : (left.size() + 1) / 2);
        }
        left[0].gain *= static_cast<double>(unserved.size()) / static_cast<double>(tried.size());
        return left[0].gain > 0.0 ? std::optional(left[0]) : std::nullopt;
    }

    [[nodiscard]] Result<void> take(const Gaps& gaps, const std::vector<std::size_t>& unserved) {
        const glm::dvec3 along(gaps.view->spec.direction);
        std::vector<float> values(unserved.size());
        tbb::parallel_for(std::size_t{0}, unserved.size(),
                          [&](std::size_t k) { values[k] = serviceOfGap(unserved[k], along); });
        double gain = 0.0;
        for (std::size_t k = 0; k < unserved.size(); ++k) {
            float& served = served_[unserved[k]];
            gain += std::max(0.0F, values[k] - served);
            served = std::max(served, values[k]);
        }
        MapSpec spec = gaps.view->spec;
        spec.compare = Compare::kGap;
        GapGrid grid(query_, RELIEF_TRY(viewOf(spec)), isSeenByTaken());
        add(spec, gain,
            text("gaps along (%.3g, %.3g, %.3g)", along.x, along.y, along.z) +
                text(": service +%.1f %%", 100.0 * gain / total()),
            {gaps.view->width, gaps.view->height}, 8.0 * kGapDetail * kGapDetail * grid.area())
            .silhouette = grid.silhouette();
        gap_grids_.push_back(std::move(grid));
        return {};
    }

    void take(const Cavity& cavity) {
        for (const auto& [i, value] : cavity.service) {
            served_[i] = std::max(served_[i], value);
        }
        MapSpec spec;
        spec.format = MapFormat::kCube8;
        spec.decode = Decode::kPlane;
        spec.compare = Compare::kLess;
        spec.box = Bounds{glm::vec3(cavity.center - cavity.half), glm::vec3(cavity.center + cavity.half)};
        add(spec, cavity.gain,
            text("a cavity round (%.4g, %.4g, %.4g): service +%.2f %%", cavity.center.x, cavity.center.y,
                 cavity.center.z, 100.0 * cavity.gain / total()),
            glm::dvec2(cavity.width()), cavity.area);
    }

    const TriangleMesh& mesh_;
    const MeshQuery& query_;
    const ViewOptions& options_;
    std::vector<PlanPoint> points_;
    std::vector<float> served_;  // by point, 0…1
    ViewChoice choice_;
    std::vector<GapGrid> gap_grids_;  // of the maps of gaps
    double outer_area_ = 0.0;
};

/// The maps with texels of this size, within the limits of maps.
Plan sizedPlan(const ViewChoice& choice, double texel) {
    Plan plan;
    plan.texel = texel;
    plan.next_gain = choice.next_gain;
    for (const ViewChoice::Chosen& view : choice.views) {
        PlannedMap map = view.map;
        const bool cube = map.spec.format == MapFormat::kCube8;
        const auto texels = [&](double extent) {
            const double detail = map.spec.compare == Compare::kGap ? kGapDetail : 1.0;
            const double count = extent * detail / texel + (cube ? 0.0 : 2.0);
            return static_cast<std::uint32_t>(std::clamp(count, cube ? 2.0 : 3.0, double{kMapSizeMax}));
        };
        map.spec.width = texels(view.width);
        map.spec.height = cube ? map.spec.width : texels(view.height);
        plan.bytes += view.silhouette ? view.silhouette->gpuBytes(map.spec.width, map.spec.height)
                                      : std::uint64_t{24} * map.spec.width * map.spec.height;
        plan.maps.push_back(std::move(map));
    }
    return plan;
}

/// Bytes with the empty ends of rows, which cost a bake time and memory; large for parts that lie far apart.
std::uint64_t rectangleBytes(const Plan& plan) {
    std::uint64_t bytes = 0;
    for (const PlannedMap& map : plan.maps) {
        const std::uint64_t texel = map.spec.format == MapFormat::kCube8 ? 24 : 8;
        bytes += texel * map.spec.width * map.spec.height;
    }
    return bytes;
}

}  // namespace

std::vector<MapSpec> specsOf(const Plan& plan) {
    std::vector<MapSpec> specs;
    for (const PlannedMap& map : plan.maps) {
        specs.push_back(map.spec);
    }
    return specs;
}

Result<ViewChoice> chooseViews(const MeshQuery& query, const ViewOptions& options) {
    ViewChoice choice = RELIEF_TRY(Planner(query, options).run());
    if (choice.views.empty()) {
        return fail(ErrorCode::kFailure,
                    choice.mesh_name +
                        ": no free space was found beside the surface, so that no view can "
                        "be planned; name the maps by --map");
    }
    return choice;
}

std::optional<Plan> sizesWithin(const ViewChoice& choice, std::uint64_t bytes) {
    // Because of partial texels at the ends of rows, shrink until all fit.
    const double least = static_cast<double>(std::max<std::uint64_t>(bytes, 1));
    for (double texel = 0.8 * std::sqrt(choice.area / least);; texel *= 1.002) {
        Plan plan = sizedPlan(choice, texel);
        if (plan.bytes <= bytes &&
            rectangleBytes(plan) <= std::max(kRectangleBytes, kRectangleShare * bytes)) {
            return plan;
        }
        const bool smallest = std::ranges::all_of(
            plan.maps, [](const PlannedMap& map) { return map.spec.width <= 3 && map.spec.height <= 3; });
        if (smallest) {
            return std::nullopt;
        }
    }
}

Error budgetTooSmall(const ViewChoice& choice, std::uint64_t budget_bytes) {
    return {ErrorCode::kUsage, "a budget of " + std::to_string(budget_bytes) +
                                   " bytes is too small for the " + std::to_string(choice.views.size()) +
                                   " maps that " + choice.mesh_name + " needs; raise --budget"};
}

Result<void> checkPlanBudget(std::uint64_t budget_bytes) {
    if (budget_bytes < kPlanBudgetMin) {
        return fail(ErrorCode::kUsage, "a budget of " + std::to_string(budget_bytes) +
                                           " bytes is below the least of " + std::to_string(kPlanBudgetMin));
    }
    return {};
}

Result<Plan> planSizes(const ViewChoice& choice, std::uint64_t budget_bytes) {
    RELIEF_TRY(checkPlanBudget(budget_bytes));
    std::optional<Plan> plan = sizesWithin(choice, budget_bytes);
    if (!plan) {
        return tl::unexpected<Error>(budgetTooSmall(choice, budget_bytes));
    }
    return std::move(*plan);
}

}  // namespace relief
