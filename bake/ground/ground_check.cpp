// SPDX-License-Identifier: Apache-2.0
#include "bake/ground/ground_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bake/ground/ground_tree.h"
#include "bake/height_map/height_map.h"
#include "bake/measure/percent.h"
#include "bake/mesh/loops.h"
#include "bake/pipeline/bake_request.h"
#include "formats/base/stopwatch.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kBatch = 65'536;  ///< points measured at once
constexpr std::size_t kWorst = 10;
/// Minimum distance between worst places along an axis, in squares.
constexpr double kApart = 4.0 * kLeafSquares;
/// Depth of ground below its lowest point, relative to the longest side of its box.
constexpr double kDeep = 0.05;
constexpr std::uint32_t kRowsBetweenChecks = 256;

struct Square {
    double near_left, near_right, far_left, far_right;

    [[nodiscard]] bool hasGround() const {
        return !std::isnan(near_left + near_right + far_left + far_right);
    }
    [[nodiscard]] double rise() const {
        return std::max({near_left, near_right, far_left, far_right}) -
               std::min({near_left, near_right, far_left, far_right});
    }
    [[nodiscard]] double at(double s, double t) const {
        return (1.0 - t) * ((1.0 - s) * near_left + s * near_right) +
               t * ((1.0 - s) * far_left + s * far_right);
    }
};

/// A column in which a point is measured.
struct Probe {
    GroundSample kind;
    float x, z;     // world space
    double height;  // of the surface there, world space; NaN: no ground
    double rise;    // of the square, metres
    double share;   // relative height of the point in the range of its kind, in [0, 1)
};

/// The part of the plane that a body covers.
struct Footprint {
    glm::dvec2 low, high;              // of its surface
    glm::dvec2 solid_low, solid_high;  // of all points that it may classify as inside
    double floor;                      // its ground is solid down to this height

    [[nodiscard]] bool holds(double x, double z) const {
        return x >= low.x && z >= low.y && x <= high.x && z <= high.y;
    }
    [[nodiscard]] bool mayHold(double x, double z) const {
        return x >= solid_low.x && z >= solid_low.y && x <= solid_high.x && z <= solid_high.y;
    }
};

class GroundChecker {
  public:
    GroundChecker(const GroundCheckRequest& request, const WorldField& field, const std::string& name,
                  HeightMap& map)
        : request_(request),
          field_(field),
          name_(name),
          map_(map),
          within_(request.within.value_or(request.heights.spacing)),
          above_(map.columns()),
          below_(map.columns()) {}

    Result<GroundAccuracy> run() {
        const Stopwatch watch;
        result_.height_map = map_.name();
        result_.hash = map_.hash();
        result_.columns = map_.columns();
        result_.rows = map_.rows();
        result_.within = within_;
        RELIEF_TRY(placeBodies());
        RELIEF_TRY(survey());
        RELIEF_TRY(compareExtents());
        compareHashes();
        RELIEF_TRY(map_.rewind());
        RELIEF_TRY(measure());
        result_.near = near_.result();
        if (seam_squares_ > 0) {
            result_.seams = seams_.result();
        }
        result_.uniform = {percent(false_inside_, result_.uniform_points),
                           percent(false_outside_, result_.uniform_points)};
        result_.seconds = watch.seconds();
        return std::move(result_);
    }

  private:
    [[nodiscard]] double spacing() const { return request_.heights.spacing; }
    [[nodiscard]] const glm::dvec3& offset() const { return request_.heights.offset.at; }

    void report(double share) const {
        if (request_.progress) {
            request_.progress(share);
        }
    }

    Result<void> placeBodies() {
        for (std::size_t i = 0; i < field_.world().bodies.size(); ++i) {
            const WorldBody& body = field_.world().bodies[i];
            if (body.scale != 1.0F || body.rotation != std::array{0.0F, 0.0F, 0.0F, 1.0F}) {
                return invalidInput(
                    name_ + ": its body '" + body.node +
                    "' is rotated or scaled, but ground must not be; bake it again with --heights");
            }
            const Bounds& box = field_.colliderOf(i).bounds;
            const Bounds solid = solidBox(field_.colliderOf(i));
            const glm::dvec3 at(body.position);
            const double room = spacing() + 0.01 * double{solid.longestSide()};
            bodies_.push_back({{at.x + box.min.x, at.z + box.min.z},
                               {at.x + box.max.x, at.z + box.max.z},
                               {at.x + solid.min.x - room, at.z + solid.min.z - room},
                               {at.x + solid.max.x + room, at.z + solid.max.z + room},
                               at.y + box.min.y - kDeep * double{box.longestSide()}});
            low_ = glm::min(low_, glm::dvec3(box.min) + at);
            high_ = glm::max(high_, glm::dvec3(box.max) + at);
        }
        return {};
    }

    /// Calls visit(row) for each row of squares; above_ and below_ hold its samples.
    template <class Visit>
    Result<void> forEachRow(double from, const Visit& visit) {
        RELIEF_TRY(map_.next(above_));
        for (std::uint32_t row = 0; row + 1 < map_.rows(); ++row) {
            RELIEF_TRY(map_.next(below_));
            visit(row);
            above_.swap(below_);
            if (row % kRowsBetweenChecks == 0) {
                report(from + 0.5 * row / map_.rows());
            }
        }
        return {};
    }
    [[nodiscard]] Square square(std::size_t column) const {
        return {double{above_[column]}, double{above_[column + 1]}, double{below_[column]},
                double{below_[column + 1]}};
    }

    /// Whether a square is at a seam along an axis. \param number  index of the square. \param squares  along the axis.
    [[nodiscard]] bool atSeam(std::uint32_t number, std::uint32_t squares) const {
        const std::uint32_t tile = request_.heights.tile;
        const std::uint32_t at = number % tile;
        return (number >= tile && at < kLeafSquares) ||
               (at + kLeafSquares >= tile && number - at + tile < squares);
    }
    [[nodiscard]] bool isSeam(std::uint32_t column, std::uint32_t row) const {
        return bodies_.size() > 1 && (atSeam(column, map_.columns() - 1) || atSeam(row, map_.rows() - 1));
    }

    Result<void> survey() {
        RELIEF_TRY(forEachRow(0.0, [this](std::uint32_t row) {
            std::uint32_t ground = 0;
            for (std::uint32_t column = 0; column + 1 < map_.columns(); ++column) {
                const Square one = square(column);
                if (!one.hasGround()) {
                    continue;
                }
                ++ground;
                seam_squares_ += isSeam(column, row) ? 1 : 0;
                result_.steep += one.rise() > kSteepest * spacing() ? 1 : 0;
                first_ = {std::min(first_.x, column), std::min(first_.y, row)};
                last_ = {std::max(last_.x, column), std::max(last_.y, row)};
                for (const double height : {one.near_left, one.near_right, one.far_left, one.far_right}) {
                    lowest_ = std::min(lowest_, height);
                    highest_ = std::max(highest_, height);
                }
            }
            result_.squares += ground;
        }));
        result_.holes = std::uint64_t{map_.columns() - 1} * (map_.rows() - 1) - result_.squares;
        if (result_.squares == 0) {
            return invalidInput(
                map_.name() +
                ": there is no ground: each square of four samples has a hole; check --heights hole");
        }
        return {};
    }

    [[nodiscard]] static std::string extentText(const glm::dvec2& low, const glm::dvec2& high) {
        return "from (" + shortest(static_cast<float>(low.x)) + ", " + shortest(static_cast<float>(low.y)) +
               ") to (" + shortest(static_cast<float>(high.x)) + ", " + shortest(static_cast<float>(high.y)) +
               ")";
    }

    /// Fails if map and field cover different areas: with another map or other settings, nearly all points would be
    /// wrong.
    [[nodiscard]] Result<void> compareExtents() const {
        const glm::dvec2 from(offset().x, offset().z);
        const glm::dvec2 low = from + spacing() * glm::dvec2(first_);
        const glm::dvec2 high = from + spacing() * glm::dvec2(last_ + 1U);
        const glm::dvec2 own_low(low_.x, low_.z);
        const glm::dvec2 own_high(high_.x, high_.z);
        const glm::dvec2 off = glm::max(glm::abs(low - own_low), glm::abs(high - own_high));
        if (!(std::max(off.x, off.y) <= kLeafSquares * spacing())) {
            return invalidInput(
                map_.name() + ": its ground lies " + extentText(low, high) +
                " in x and z, but the ground of " + name_ + " lies " + extentText(own_low, own_high) +
                "; give the height map that it was baked from, and its --heights spacing and offset");
        }
        return {};
    }

    void compareHashes() {
        for (const Collider& collider : field_.colliders()) {
            if (collider.provenance.mesh_hash != map_.hash()) {
                result_.warnings.push_back(map_.name() + " is not the file that " + name_ +
                                           " was baked from");
                return;
            }
        }
    }

    Result<void> measure() {
        const std::uint64_t all = (std::uint64_t{map_.columns()} + 1) * (std::uint64_t{map_.rows()} + 1);
        GroundStrata near(result_.squares, request_.samples, request_.seed, GroundSample::kNear);
        GroundStrata seams(seam_squares_, request_.samples, request_.seed, GroundSample::kSeam);
        GroundStrata anywhere(all, request_.samples, request_.seed, GroundSample::kAnywhere);
        std::uint64_t ground = 0;
        std::uint64_t ground_at_seams = 0;
        drawAnywhere(anywhere, 0);
        RELIEF_TRY(forEachRow(0.5, [&](std::uint32_t row) {
            for (std::uint32_t column = 0; column + 1 < map_.columns(); ++column) {
                if (!square(column).hasGround()) {
                    continue;
                }
                ++ground;
                for (; near.before(ground); near.advance()) {
                    add(GroundSample::kNear, column, row, near.place());
                }
                ground_at_seams += isSeam(column, row) ? 1 : 0;
                for (; seams.before(ground_at_seams); seams.advance()) {
                    add(GroundSample::kSeam, column, row, seams.place());
                }
            }
            drawAnywhere(anywhere, row + 1);
        }));
        drawAnywhere(anywhere, map_.rows());
        evaluate();
        return {};
    }

    /// Draws points in a row of squares, which may be outside the map. \param row  0 is the row before the map's first
    /// row.
    void drawAnywhere(GroundStrata& strata, std::uint32_t row) {
        const std::uint64_t squares = std::uint64_t{map_.columns()} + 1;
        for (; strata.before((row + std::uint64_t{1}) * squares); strata.advance()) {
            add(GroundSample::kAnywhere, static_cast<std::int64_t>(strata.square() % squares) - 1,
                std::int64_t{row} - 1, strata.place());
        }
    }

    /// \param column, row  of the point's square, which may be outside the map.
    void add(GroundSample kind, std::int64_t column, std::int64_t row, const std::array<double, 3>& place) {
        const double across = static_cast<double>(column);
        const double along = static_cast<double>(row);
        Probe probe{kind,
                    static_cast<float>(offset().x + spacing() * (across + place[0])),
                    static_cast<float>(offset().z + spacing() * (along + place[1])),
                    std::numeric_limits<double>::quiet_NaN(),
                    0.0,
                    place[2]};
        if (column >= 0 && row >= 0 && column + 1 < std::int64_t{map_.columns()} &&
            row + 1 < std::int64_t{map_.rows()}) {
            const Square one = square(static_cast<std::size_t>(column));
            // Evaluated at the coordinates after rounding to floats.
            const double s = (double{probe.x} - offset().x) / spacing() - across;
            const double t = (double{probe.z} - offset().z) / spacing() - along;
            probe.height = offset().y + one.at(std::clamp(s, 0.0, 1.0), std::clamp(t, 0.0, 1.0));
            probe.rise = one.rise();
        }
        probes_.push_back(probe);
        if (probes_.size() == kBatch) {
            evaluate();
        }
    }

    void evaluate() {
        glm::dvec2 low(std::numeric_limits<double>::max());
        glm::dvec2 high(std::numeric_limits<double>::lowest());
        for (const Probe& probe : probes_) {
            low = glm::min(low, glm::dvec2(probe.x, probe.z));
            high = glm::max(high, glm::dvec2(probe.x, probe.z));
        }
        std::vector<std::uint32_t> bodies;
        for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
            const Footprint& one = bodies_[i];
            if (one.solid_low.x <= high.x && one.solid_low.y <= high.y && one.solid_high.x >= low.x &&
                one.solid_high.y >= low.y) {
                bodies.push_back(i);
            }
        }
        std::vector<GroundOutcome> outcomes(probes_.size());
        forEachIndex(0, probes_.size(), 64,
                     [&](std::size_t i) { outcomes[i] = outcomeOf(probes_[i], bodies); });
        for (std::size_t i = 0; i < probes_.size(); ++i) {
            count(probes_[i], outcomes[i]);
        }
        probes_.clear();
    }

    [[nodiscard]] GroundOutcome outcomeOf(const Probe& probe,
                                          const std::vector<std::uint32_t>& candidates) const {
        std::vector<std::uint32_t> bodies;
        std::optional<double> floor;
        for (const std::uint32_t i : candidates) {
            if (bodies_[i].mayHold(probe.x, probe.z)) {
                bodies.push_back(i);
            }
            if (bodies_[i].holds(probe.x, probe.z)) {
                floor = std::min(floor.value_or(bodies_[i].floor), bodies_[i].floor);
            }
        }
        const auto insideAt = [&](float y) {
            return field_.evaluate({probe.x, y, probe.z}, bodies).inside();
        };
        const auto [from, to] = rangeOf(probe, floor);
        const auto y = static_cast<float>(from + probe.share * (to - from));
        // Comparison with NaN is false.
        GroundOutcome outcome{double{y} < probe.height, insideAt(y), {}};
        if (probe.kind != GroundSample::kAnywhere) {
            outcome.error = errorAlong(insideAt, from, to, probe.height);
        }
        return outcome;
    }

    /// Returns the range of heights for a point. \param floor  of the ground there, if a body covers it.
    [[nodiscard]] std::pair<double, double> rangeOf(const Probe& probe, std::optional<double> floor) const {
        // With a wrong map, the surface may be below the ground's floor.
        const double reach = probe.height - within_;
        if (probe.kind != GroundSample::kAnywhere) {
            return {floor && *floor < probe.height ? std::max(*floor, reach) : reach, probe.height + within_};
        }
        const double deep = kDeep * std::max({high_.x - low_.x, high_.y - low_.y, high_.z - low_.z});
        const double bottom = std::isnan(probe.height)         ? offset().y + lowest_ - deep
                              : floor && *floor < probe.height ? *floor
                                                               : reach;
        return {bottom, offset().y + highest_ + deep};
    }

    /// Returns the height error of the collider's surface, by bisection down to adjacent floats; nullopt if the range
    /// does not contain that surface.
    template <class Inside>
    static std::optional<double> errorAlong(const Inside& inside, double from, double to, double height) {
        auto low = static_cast<float>(from);
        auto high = static_cast<float>(to);
        if (!inside(low) || inside(high)) {
            return std::nullopt;
        }
        for (;;) {
            const float middle = 0.5F * low + 0.5F * high;
            if (!(low < middle && middle < high)) {
                return 0.5 * (double{low} + double{high}) - height;
            }
            (inside(middle) ? low : high) = middle;
        }
    }

    void count(const Probe& probe, const GroundOutcome& outcome) {
        if (probe.kind == GroundSample::kAnywhere) {
            ++result_.uniform_points;
            false_inside_ += outcome.inside && !outcome.truth ? 1 : 0;
            false_outside_ += !outcome.inside && outcome.truth ? 1 : 0;
            return;
        }
        (probe.kind == GroundSample::kNear ? near_ : seams_).add(outcome);
        addWorst(probe, outcome);
    }

    [[nodiscard]] static double badness(const GroundWorstPlace& place) {
        return place.error ? std::abs(*place.error) : std::numeric_limits<double>::max();
    }

    void addWorst(const Probe& probe, const GroundOutcome& outcome) {
        std::vector<GroundWorstPlace>& worst = result_.worst;
        GroundWorstPlace place{
            {probe.x, static_cast<float>(probe.height), probe.z}, {}, outcome.error, probe.rise / spacing()};
        if (worst.size() == kWorst && badness(place) <= badness(worst.back())) {
            return;
        }
        const auto isClose = [&](const GroundWorstPlace& other) {
            return std::max(std::abs(double{other.position.x} - double{probe.x}),
                            std::abs(double{other.position.z} - double{probe.z})) < kApart * spacing();
        };
        if (std::ranges::any_of(worst, [&](const GroundWorstPlace& other) {
                return isClose(other) && badness(other) >= badness(place);
            })) {
            return;
        }
        std::erase_if(worst, isClose);
        place.node = nodeAt(probe);
        worst.insert(
            std::ranges::find_if(
                worst, [&](const GroundWorstPlace& other) { return badness(other) < badness(place); }),
            std::move(place));
        worst.resize(std::min(worst.size(), kWorst));
    }

    /// Returns the body at a point. If several overlap there, returns the body whose nearest edge is farthest away.
    [[nodiscard]] std::string nodeAt(const Probe& probe) const {
        const glm::dvec2 p(probe.x, probe.z);
        std::string node;
        double farthest = -1.0;
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const glm::dvec2 rim = glm::min(p - bodies_[i].low, bodies_[i].high - p);
            if (std::min(rim.x, rim.y) > farthest) {
                farthest = std::min(rim.x, rim.y);
                node = field_.world().bodies[i].node;
            }
        }
        return node;
    }

    const GroundCheckRequest& request_;
    const WorldField& field_;
    const std::string& name_;
    HeightMap& map_;
    double within_;
    std::vector<float> above_;  // samples of the previous row
    std::vector<float> below_;
    std::vector<Footprint> bodies_;
    glm::dvec3 low_{std::numeric_limits<double>::max()};  // of all surfaces, world space
    glm::dvec3 high_{std::numeric_limits<double>::lowest()};
    glm::uvec2 first_{std::numeric_limits<std::uint32_t>::max()};  // of the squares with ground
    glm::uvec2 last_{0};
    double lowest_ = std::numeric_limits<double>::max();  // of all ground samples, without the offset
    double highest_ = std::numeric_limits<double>::lowest();
    std::uint64_t seam_squares_ = 0;
    std::vector<Probe> probes_;
    GroundNearSums near_;
    GroundNearSums seams_;
    std::uint64_t false_inside_ = 0;  // points anywhere
    std::uint64_t false_outside_ = 0;
    GroundAccuracy result_;
};

}  // namespace

Result<HeightsSpec> recordedHeights(const WorldField& field, const std::string& name) {
    std::optional<std::string> recorded;
    for (const Collider& collider : field.colliders()) {
        const std::string heights = recordedBake(collider.provenance.options).request.heights;
        if (heights.empty()) {
            return fail(ErrorCode::kUsage, name +
                                               " was not baked from a height map; give its mesh with --mesh, "
                                               "or use --heights if it is ground");
        }
        if (recorded && *recorded != heights) {
            return fail(ErrorCode::kUsage, name + " was baked from several height maps, with --heights " +
                                               *recorded + " and " + heights + "; check each separately");
        }
        recorded = heights;
    }
    return parseHeightsSpec(recorded.value_or(""));
}

Result<GroundAccuracy> checkGround(const GroundCheckRequest& request, const WorldField& field,
                                   const std::string& name) {
    if (request.samples > kGroundSamplesMax) {
        return fail(ErrorCode::kLimit, "--samples is " + std::to_string(request.samples) + "; the limit is " +
                                           std::to_string(kGroundSamplesMax) + " for a height map");
    }
    HeightMap map = RELIEF_TRY(HeightMap::open(request.map, request.heights, request.limits));
    return GroundChecker(request, field, name, map).run();
}

}  // namespace relief
