// SPDX-License-Identifier: Apache-2.0
#include "bake/world/world_check.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

#include "bake/import/level.h"
#include "bake/measure/part_accuracy.h"
#include "bake/measure/percent.h"
#include "bake/mesh/loops.h"
#include "bake/repair/winding.h"
#include "bake/shape/shape_options.h"
#include "bake/verdict/parts_report.h"
#include "bake/verdict/report_text.h"
#include "bake/world/placed_mesh.h"
#include "bake/world/world_bake.h"
#include "bake/world/world_places.h"
#include "formats/base/stopwatch.h"

namespace relief {
namespace {

constexpr std::uint64_t kSamplesMax = 100'000'000;
constexpr std::uint64_t kPointsMin = 100;  ///< per body
constexpr std::size_t kWorst = 10;
/// Standard deviation of the points, in units of the longest side, as in AccuracyOptions.
constexpr double kSigma = AccuracyOptions().sigma_fraction;

glm::dvec3 inBall(MersenneRandom& random) {
    for (;;) {
        const glm::dvec3 v{2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0,
                           2.0 * random.uniform() - 1.0};
        if (glm::dot(v, v) <= 1.0) {
            return v;
        }
    }
}

class WorldChecker {
  public:
    WorldChecker(const WorldCheckRequest& request, const WorldField& field)
        : request_(request), field_(field) {}

    Result<WorldAccuracy> run() {
        const Stopwatch watch;
        if (request_.check.samples > kSamplesMax) {
            return fail(ErrorCode::kLimit, "--samples is " + std::to_string(request_.check.samples) +
                                               "; the limit is " + std::to_string(kSamplesMax));
        }
        RELIEF_TRY(readLevel());
        RELIEF_TRY(makeTruth());
        place();
        comparePoses();
        measure();
        findLostParts();
        result_.seconds = watch.seconds();
        return std::move(result_);
    }

  private:
    /// Reads the level with the names that the colliders were baked with.
    Result<void> readLevel() {
        HiddenMode hidden = request_.check.import.hidden;
        for (const WorldCollider& collider : field_.world().colliders) {
            const std::size_t index = static_cast<std::size_t>(&collider - field_.world().colliders.data());
            const Provenance& from = field_.colliders()[index].provenance;
            recorded_.push_back(recordedBake(from.options).request);
            hidden = std::max(hidden, recorded_.back().import.hidden);
            by_hash_.emplace(from.mesh_hash, index);
            for (const std::string& word : recorded_.back().as) {
                if (word.find('=') != std::string::npos && std::ranges::find(as_, word) == as_.end()) {
                    as_.push_back(word);
                }
            }
        }
        ImportOptions options = request_.check.import;
        options.hidden = hidden;
        options.names = RELIEF_TRY(parseShapeOptions(as_)).names();
        level_ = RELIEF_TRY(importLevel(request_.check.mesh, options, request_.check.import_limits));
        result_.warnings = level_.warnings;
        result_.dependencies = level_.dependencies;
        return {};
    }

    Result<void> makeTruth() {
        queries_.reserve(level_.meshes.size());
        const std::vector<std::string> names = RELIEF_TRY(parseShapeOptions(as_)).names();
        for (TriangleMesh& mesh : level_.meshes) {
            BakeRequest named;
            named.as = as_;
            const std::optional<std::size_t> collider =
                colliderOf(mesh.content_hash, requestOf(named, names, mesh).as);
            if (!collider) {
                return invalidInput(level_.name + " has a mesh '" + mesh.name +
                                    "' without a collider in the world; bake the level again, or give "
                                    "--mesh the level that it was baked from");
            }
            Winding winding = RELIEF_TRY(windOutwards(std::move(mesh)));
            ShapedMesh shaped = RELIEF_TRY(recordedSolid(recorded_[*collider], winding.mesh));
            queries_.push_back(RELIEF_TRY(MeshQuery::build(shaped.mesh)));
            parts_.push_back(std::move(shaped.parts));
            static_cast<void>(queries_.back().prepared().areas());  // computed before threads use it
        }
        return {};
    }

    /// Returns a collider of a mesh. If several exist (tiles, or different --as NAME=KIND), returns the last one baked
    /// with `as`.
    [[nodiscard]] std::optional<std::size_t> colliderOf(const std::string& hash,
                                                        const std::vector<std::string>& as) const {
        const auto [begin, end] = by_hash_.equal_range(hash);
        std::optional<std::size_t> found;
        for (auto entry = begin; entry != end; ++entry) {
            std::vector<std::string> own = recorded_[entry->second].as;
            std::erase_if(own, [](const std::string& word) { return word.find('=') == std::string::npos; });
            found = !found || own == as ? entry->second : *found;
        }
        return found;
    }

    void place() {
        for (const LevelBody& body : level_.bodies) {
            PlacedMesh placed{&body, &queries_[body.mesh], glm::dvec3(std::numeric_limits<double>::max()),
                              glm::dvec3(std::numeric_limits<double>::lowest())};
            const Bounds& box = placed.query->mesh().bounds;
            for (unsigned i = 0; i < 8; ++i) {
                const glm::dvec3 at = placed.toWorld(box.corner(i));
                placed.low = glm::min(placed.low, at);
                placed.high = glm::max(placed.high, at);
            }
            placed_.push_back(placed);
        }
    }

    /// Returns the first body of each node. The tiles of a mesh have the same pose, and follow each other in the order
    /// of the world's colliders.
    [[nodiscard]] std::vector<std::size_t> firstBodies() const {
        const std::vector<WorldBody>& bodies = field_.world().bodies;
        std::vector<std::size_t> first;
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            const WorldBody& body = bodies[i];
            const bool is_next_tile =
                i > 0 && body.node == bodies[i - 1].node && body.collider > bodies[i - 1].collider &&
                samePose(body, bodies[i - 1]) &&
                field_.colliderOf(i).provenance.mesh_hash == field_.colliderOf(i - 1).provenance.mesh_hash;
            if (!is_next_tile) {
                first.push_back(i);
            }
        }
        return first;
    }

    static bool samePose(const WorldBody& a, const WorldBody& b) {
        return a.position == b.position && a.rotation == b.rotation && a.scale == b.scale;
    }

    /// Warns if the level has changed; the world is still measured.
    void comparePoses() {
        const std::vector<std::size_t> first = firstBodies();
        std::size_t other = 0;
        moved_.assign(placed_.size(), false);
        tiles_.assign(placed_.size(), 0);
        for (std::size_t i = 0; first.size() == placed_.size() && i < first.size(); ++i) {
            const std::size_t end = i + 1 < first.size() ? first[i + 1] : field_.world().bodies.size();
            tiles_[i] = end - first[i];
        }
        for (std::size_t i = 0; i < std::min(first.size(), placed_.size()); ++i) {
            const LevelBody& body = *placed_[i].body;
            const WorldBody& own = field_.world().bodies[first[i]];
            double turn = 0.0;  // a quaternion and its negative are the same rotation
            for (std::size_t k = 0; k < 4; ++k) {
                turn += body.rotation[k] * double{own.rotation[k]};
            }
            bool same = static_cast<float>(body.scale) == own.scale && std::abs(turn) > 1.0 - 1e-6;
            for (int k = 0; k < 3; ++k) {
                same =
                    same && static_cast<float>(body.position[static_cast<std::size_t>(k)]) == own.position[k];
            }
            other += same ? 0 : 1;
            moved_[i] = !same;
        }
        if (first.size() != placed_.size() || other > 0) {
            result_.warnings.push_back(level_.name + ": " +
                                       (first.size() != placed_.size()
                                            ? "it places " + countText(placed_.size(), "mesh", "meshes") +
                                                  ", but the world places " + std::to_string(first.size())
                                            : countText(other, "node") + " differ in pose from the world") +
                                       "; bake the level again");
        }
    }

    void measure() {
        const std::uint64_t points = std::max(kPointsMin, request_.check.samples / placed_.size());
        std::uint64_t false_inside = 0;
        std::uint64_t false_outside = 0;
        for (std::size_t i = 0; i < placed_.size(); ++i) {
            const BodyCounts counts = measureBody(i, points);
            false_inside += counts.false_inside;
            false_outside += counts.false_outside;
        }
        const std::uint64_t all = points * placed_.size();
        result_.all = {percent(false_inside, all), percent(false_outside, all)};
        std::vector<std::size_t>& worst = result_.worst;
        for (std::size_t i = 0; i < result_.bodies.size(); ++i) {
            if (result_.bodies[i].wrong.total() > 0.0) {
                worst.push_back(i);
            }
        }
        std::stable_sort(worst.begin(), worst.end(), [this](std::size_t a, std::size_t b) {
            return result_.bodies[a].wrong.total() > result_.bodies[b].wrong.total();
        });
        worst.resize(std::min(worst.size(), kWorst));
        for (const std::size_t i : worst) {
            const BodyAccuracy& body = result_.bodies[i];
            result_.places.push_back(worldPlace(
                {placed_, field_, i, body.position, moved_[i], body.wrong.total()}, request_.pictures));
        }
    }

    /// Measures the parts of each mesh in its own space, against the colliders of its first body.
    void findLostParts() {
        const std::vector<std::size_t> first = firstBodies();
        std::vector<bool> done(queries_.size(), false);
        std::vector<double> scales(queries_.size(), 0.0);
        for (const LevelBody& body : level_.bodies) {
            scales[body.mesh] = std::max(scales[body.mesh], body.scale);
        }
        PartOptions options;
        options.seed = request_.check.seed;
        options.points_all = std::min(options.points_all, request_.check.samples / queries_.size());
        for (std::size_t i = 0; i < placed_.size(); ++i) {
            const std::size_t mesh = placed_[i].body->mesh;
            if (done[mesh] || tiles_[i] == 0) {
                continue;
            }
            done[mesh] = true;
            options.scale = scales[mesh];
            std::vector<Field> tiles;
            for (std::size_t k = 0; k < tiles_[i]; ++k) {
                tiles.push_back(fieldOf(field_.colliderOf(first[i] + k)));
            }
            const Field field = [&tiles](const glm::vec3& p) {
                std::optional<FieldValue> least;
                for (const Field& tile : tiles) {
                    const std::optional<FieldValue> value = tile(p);
                    least = value && (!least || value->distance < least->distance) ? value : least;
                }
                return least;
            };
            const PartsAccuracy accuracy = measureParts(queries_[mesh], parts_[mesh], field, options);
            result_.ignored.add(accuracy.ignored, options.scale);
            if (std::optional<std::string> text =
                    lostPartsWarning(accuracy, parts_[mesh], field_.colliderOf(first[i]))) {
                result_.lost.push_back(
                    {queries_[mesh].mesh().name, accuracy.countOf(PartVerdict::kLost), std::move(*text)});
            } else if (accuracy.countOf(PartVerdict::kCoarse) > 0 && accuracy.minor_counts) {
                ++result_.coarse;
            }
        }
    }

    struct BodyCounts {
        std::uint64_t false_inside = 0;
        std::uint64_t false_outside = 0;
    };

    BodyCounts measureBody(std::size_t index, std::uint64_t points) {
        enum Verdict : std::uint8_t { kRight, kFalseInside, kFalseOutside };
        const PlacedMesh& placed = placed_[index];
        std::vector<glm::vec3> positions(points);
        std::vector<std::uint8_t> verdicts(points);
        forEachIndex(0, points, 64,
                     [&](std::size_t i) { positions[i] = glm::vec3(draw(placed, index * points + i)); });
        const Bounds box = boundsOf(positions);
        const std::vector<std::uint32_t> bodies = field_.bodiesIn(box);
        const std::vector<const PlacedMesh*> others = placedIn(placed_, box.min, box.max);
        forEachIndex(0, points, 64, [&](std::size_t i) {
            const glm::dvec3 p(positions[i]);
            const bool truth =
                std::ranges::any_of(others, [&p](const PlacedMesh* one) { return one->inside(p); });
            const bool inside = field_.evaluate(positions[i], bodies).inside();
            verdicts[i] = inside == truth ? kRight : inside ? kFalseInside : kFalseOutside;
        });
        BodyCounts counts;
        glm::dvec3 sum(0.0);
        for (std::size_t i = 0; i < points; ++i) {
            counts.false_inside += verdicts[i] == kFalseInside ? 1 : 0;
            counts.false_outside += verdicts[i] == kFalseOutside ? 1 : 0;
            sum += verdicts[i] == kRight ? glm::dvec3(0.0) : glm::dvec3(positions[i]);
        }
        BodyAccuracy body{placed.body->node,
                          placed.query->mesh().name,
                          points,
                          {percent(counts.false_inside, points), percent(counts.false_outside, points)},
                          tiles_[index],
                          glm::vec3(placed.position())};
        const std::uint64_t wrong = counts.false_inside + counts.false_outside;
        double nearest = std::numeric_limits<double>::max();
        for (std::size_t i = 0; i < points; ++i) {
            const glm::dvec3 from = glm::dvec3(positions[i]) - sum / static_cast<double>(wrong);
            if (verdicts[i] != kRight && glm::dot(from, from) < nearest) {
                nearest = glm::dot(from, from);
                body.position = positions[i];
            }
        }
        result_.bodies.push_back(std::move(body));
        return counts;
    }

    /// Returns a point near the surface of a body, in world space.
    [[nodiscard]] glm::dvec3 draw(const PlacedMesh& placed, std::uint64_t number) const {
        MersenneRandom random(request_.check.seed, number);
        const TriangleMesh& mesh = placed.query->mesh();
        const SurfaceDraw surface =
            drawOnSurface(mesh, placed.query->prepared().areas(), random.uniform(), random);
        if (request_.within) {
            return placed.toWorld(surface.position) + double{*request_.within} * inBall(random);
        }
        const double sigma = kSigma * double{mesh.bounds.longestSide()};
        const glm::dvec3 offset{random.normal(), random.normal(), random.normal()};
        return placed.toWorld(surface.position + sigma * offset);
    }

    const WorldCheckRequest& request_;
    const WorldField& field_;
    WorldAccuracy result_;
    std::vector<BakeRequest> recorded_;                // by collider
    std::multimap<std::string, std::size_t> by_hash_;  // collider indices by the hash of their mesh
    std::vector<std::string> as_;                      // NAME=KIND of all colliders
    Level level_;
    std::vector<MeshQuery> queries_;   // by mesh of the level
    std::vector<SurfaceParts> parts_;  // by mesh of the level
    std::vector<PlacedMesh> placed_;
    std::vector<std::size_t> tiles_;  // by placed mesh: number of bodies of the world
    std::vector<bool> moved_;         // by placed mesh: the pose differs from the world's
};

}  // namespace

Result<WorldAccuracy> checkWorld(const WorldCheckRequest& request, const WorldField& field) {
    return WorldChecker(request, field).run();
}

}  // namespace relief
