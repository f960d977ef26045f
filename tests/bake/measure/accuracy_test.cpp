// SPDX-License-Identifier: Apache-2.0
// Accuracy measurement compared with closed forms: the truth of solids and shells, errors of fields with known errors,
// the reference distance volume, and the report.
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "bake/bench/distance_volume.h"
#include "bake/bench/sheet_truth.h"
#include "bake/measure/accuracy.h"
#include "bake/verdict/check_report.h"
#include "bake/verdict/report_text.h"
#include "formats/base/text.h"
#include "formats/fields/json_value.h"
#include "tests/bake/meshes.h"
#include "tests/bake/points.h"
#include "tests/bake/shaped.h"
#include "tests/bake/threads.h"

namespace relief::test {
namespace {

// --- truth ---

TEST(MeshQuery, BoxDistancesMatchTheFormula) {
    const glm::dvec3 half(1.0, 0.5, 2.0);
    const glm::dmat3 axes = rotation({1, 1, 0}, 40.0);
    const glm::dvec3 center(3.0, -1.0, 2.0);
    const TriangleMesh mesh = makeBoxMesh(center, half, axes);
    const MeshQuery query = queryOf(mesh);
    EXPECT_TRUE(query.watertight());
    for (const glm::vec3& p : pointsIn(mesh.bounds, 3000)) {
        const double expected = boxDistance(glm::transpose(axes) * (glm::dvec3(p) - center), half);
        // The mesh has float coordinates.
        EXPECT_NEAR(query.signedDistance(p), expected, 2e-6);
    }
}

TEST(MeshQuery, HoleAffectsOnlyPointsNearIt) {
    TriangleMesh mesh = makeIcosphere({0, 0, 0}, 1.0, 3);
    mesh.triangles.erase(mesh.triangles.begin() + 100, mesh.triangles.begin() + 104);
    const MeshQuery query = queryOf(mesh);
    EXPECT_FALSE(query.watertight());
    for (const glm::vec3& p : pointsIn(mesh.bounds, 2000)) {
        const float radius = glm::length(p);
        if (radius < 0.8F || radius > 1.0F) {
            EXPECT_EQ(query.inside(p), radius < 1.0F) << p.x << " " << p.y << " " << p.z;
        }
    }
}

TEST(MeshQuery, ClosestPointsMatchASearchOfAllTrianglesWithAnyHint) {
    for (const TriangleMesh& mesh :
         {makeIcosphere({0, 0, 0}, 1.0, 4), makeTorusMesh(1.0, 0.4, 96, 48),
          makeBoxMesh({2000, -500, 300}, {1, 2, 0.5}, rotation({1, 1, 0}, 40.0))}) {
        const MeshQuery query = queryOf(mesh);
        std::uint32_t hint = 0;
        for (const glm::vec3& p : pointsIn(mesh.bounds, 300)) {
            double least = std::numeric_limits<double>::infinity();
            for (const glm::uvec3& corners : mesh.triangles) {
                const glm::dvec3 at(p);
                const glm::dvec3 on = closestOnTriangle(at, glm::dvec3(mesh.positions[corners.x]),
                                                        glm::dvec3(mesh.positions[corners.y]),
                                                        glm::dvec3(mesh.positions[corners.z]));
                least = std::min(least, glm::distance(at, on));
            }
            const ClosestPoint plain = query.closest(p);
            EXPECT_NEAR(plain.distance, least, 1e-9 * std::max(1.0, least));
            EXPECT_NEAR(glm::distance(plain.point, glm::dvec3(p)), plain.distance,
                        1e-12 * std::max(1.0, glm::length(glm::dvec3(p))));
            const ClosestPoint hinted = query.closest(p, hint);
            EXPECT_EQ(plain.distance, hinted.distance);
            EXPECT_EQ(plain.triangle, hinted.triangle);
            hint = (hint + 97) % static_cast<std::uint32_t>(mesh.triangles.size());
        }
    }
}

TEST(MeshQuery, RaysAndSegmentsHitABox) {
    const MeshQuery query = queryOf(makeBoxMesh({0, 0, 0}, {1, 1, 1}));
    EXPECT_NEAR(query.firstHit({0.1, 0.2, 5.0}, {0.0, 0.0, -2.0}).value().along, 2.0, 1e-6);
    EXPECT_FALSE(query.firstHit({0.1, 0.2, 5.0}, {0.0, 0.0, 2.0}));
    EXPECT_FALSE(query.isSegmentFree({0.1, 0.2, 5.0}, {0.1, 0.2, 0.0}));
    EXPECT_TRUE(query.isSegmentFree({0.1, 0.2, 5.0}, {0.1, 0.2, 1.001}));
    EXPECT_TRUE(query.isSegmentFree({0.1, 0.2, 0.9}, {0.1, 0.2, -0.9}));
}

// --- accuracy ---

/// P(|P| <= r) for P on a sphere of radius R plus an isotropic normal deviate σ (noncentral Maxwell distribution).
double radiusBelow(double r, double sphere, double sigma) {
    const auto normal = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
    const auto bell = [&](double x) { return std::exp(-0.5 * x * x / (sigma * sigma)); };
    return normal((r - sphere) / sigma) - normal(-(r + sphere) / sigma) -
           sigma / (sphere * std::sqrt(2.0 * 3.14159265358979323846)) * (bell(r - sphere) - bell(r + sphere));
}

constexpr std::uint32_t kSamples = 40'000;
/// Four standard deviations of a fraction near 1/4 of kSamples points, in percent, plus the mesh error.
constexpr double kShareTolerance = 400.0 * 0.433 / 200.0 + 0.1;

class AccuracyOfASphere : public ::testing::Test {
  protected:
    static constexpr double kRadius = 1.0;
    static const TriangleMesh& mesh() {
        static const TriangleMesh sphere = makeIcosphere({0, 0, 0}, kRadius, 5);
        return sphere;
    }
    static const MeshQuery& query() {
        static const MeshQuery of_sphere = queryOf(mesh());
        return of_sphere;
    }
    static const TruthSamples& samples() {
        static const TruthSamples truth = sampleTruth(query(), {.samples = kSamples});
        return truth;
    }
    /// The signed distance of the mesh minus `shift`: the solid grown by `shift`.
    static Field grown(double shift) {
        return [shift](const glm::vec3& p) -> std::optional<FieldValue> {
            return FieldValue{static_cast<float>(query().signedDistance(p) - shift),
                              glm::normalize(glm::vec3(p))};
        };
    }
};

TEST_F(AccuracyOfASphere, ExactFieldHasNoErrors) {
    const FieldAccuracy accuracy = measureField(samples(), grown(0.0));
    EXPECT_EQ(accuracy.near.total() + accuracy.uniform.total(), 0.0);
    EXPECT_EQ(accuracy.distance_p99, 0.0);
    EXPECT_EQ(accuracy.far_percent + accuracy.unknown_percent + accuracy.no_normal_percent, 0.0);
    // The field has the normals of the sphere, the truth those of triangles with edges of 0.036.
    EXPECT_LT(accuracy.normal_p99, 1.4);
    EXPECT_GT(accuracy.normal_mean, 0.1);
}

TEST_F(AccuracyOfASphere, ShiftedFieldHasTheExpectedErrors) {
    const double sigma = samples().options.sigma_fraction * samples().longest_side;
    const auto below = [&](double r) { return 100.0 * radiusBelow(r, kRadius, sigma); };
    for (const double shift : {0.5 * sigma, 2.0 * sigma, -sigma}) {
        const FieldAccuracy accuracy = measureField(samples(), grown(shift));
        const double share = below(kRadius + shift) - below(kRadius);
        EXPECT_NEAR(accuracy.near.false_inside, std::max(share, 0.0),
                    kShareTolerance * (share > 0.0 ? 1 : 0));
        EXPECT_NEAR(accuracy.near.false_outside, std::max(-share, 0.0),
                    kShareTolerance * (share < 0.0 ? 1 : 0));
        EXPECT_NEAR(accuracy.distance_mean, std::abs(shift), 1e-7);
        EXPECT_NEAR(accuracy.distance_p99, std::abs(shift), 1e-6);
    }
    // Uniform points: the volume of a thick shell in the box of side 2.
    const FieldAccuracy thick = measureField(samples(), grown(-0.3));
    const double shell = 4.0 / 3.0 * 3.14159265358979323846 * (1.0 - 0.7 * 0.7 * 0.7) / 8.0;
    EXPECT_NEAR(thick.uniform.false_outside, 100.0 * shell, kShareTolerance);
}

TEST_F(AccuracyOfASphere, AbstentionsCountAsOutside) {
    const FieldAccuracy silent = measureField(samples(), [](const glm::vec3&) { return std::nullopt; });
    EXPECT_EQ(silent.unknown_percent, 100.0);
    EXPECT_EQ(silent.no_normal_percent, 100.0);
    EXPECT_EQ(silent.near.false_inside, 0.0);
    EXPECT_NEAR(silent.near.false_outside, 50.0, 1.5);
    const FieldAccuracy far = measureField(samples(), [](const glm::vec3&) {
        return FieldValue{kFarOutside, glm::vec3(0.0F)};
    });
    EXPECT_EQ(far.far_percent, 100.0);
    EXPECT_EQ(far.unknown_percent, 0.0);
    EXPECT_EQ(far.near.false_outside, silent.near.false_outside);
}

TEST_F(AccuracyOfASphere, DepthErrorsInsideAreMeasured) {
    const InsideAccuracy right = measureField(samples(), grown(0.0)).inside;
    EXPECT_EQ(right.far_face_percent, 0.0);
    EXPECT_LT(right.depth_p99, 1e-6);
    EXPECT_LT(right.normal_mean, 1.0);
    EXPECT_GT(samples().inside.size(), 0.99 * kSamples);
    EXPECT_EQ(right.points, samples().inside.size());
    // Depth of the far side: 1 + r instead of 1 − r, with r uniform in 0.1…1. It is too large for r above 0.25 / 2.25.
    const InsideAccuracy deep = measureField(samples(), [](const glm::vec3& p) {
                                    return FieldValue{-1.0F - glm::length(p), glm::normalize(p)};
                                }).inside;
    EXPECT_NEAR(deep.far_face_percent, 100.0 * (1.0 - 0.25 / 2.25) / 0.9, 0.2);
    EXPECT_NEAR(deep.depth_mean, 2.0 * 0.55, 0.01);
    // Reversed normals with correct depths; then an empty field.
    const InsideAccuracy turned = measureField(samples(), [](const glm::vec3& p) {
                                      return FieldValue{glm::length(p) - 1.0F, -glm::normalize(p)};
                                  }).inside;
    EXPECT_EQ(turned.far_face_percent, 100.0);
    EXPECT_GT(turned.normal_mean, 179.0);
    const InsideAccuracy empty = measureField(samples(), [](const glm::vec3&) {
                                     return FieldValue{1.0F, glm::vec3(0, 1, 0)};
                                 }).inside;
    EXPECT_EQ(empty.far_face_percent, 100.0);
}

// The ends of overlapping boxes inside the other box are not a boundary.
TEST(Accuracy, OverlapsHaveNoBoundary) {
    const TriangleMesh boxes =
        joined({makeBoxMesh({-0.4, 0, 0}, {1, 1, 1}), makeBoxMesh({0.4, 0, 0}, {1, 1, 1})});
    const MeshQuery query =
        queryOf(PreparedMesh::unionOf(boxes, std::vector<std::uint32_t>(boxes.triangles.size(), 0)));
    const TruthSamples samples = sampleTruth(query, {.samples = 20'000});
    ASSERT_GT(samples.inside.size(), 5'000U);
    for (const InsidePoint& point : samples.inside) {
        const glm::dvec3 d = glm::dvec3(1.4, 1.0, 1.0) - glm::abs(glm::dvec3(point.position));
        ASSERT_NEAR(point.depth, std::min({d.x, d.y, d.z}), 1e-5);
    }
}

TEST_F(AccuracyOfASphere, NormalErrorsAreInDegrees) {
    // A rotation by 10° about a fixed axis moves a normal n by 2·asin(sin 5° · sin ∠(n, axis)), at most 10°.
    const glm::mat3 turn(rotation({0, 0, 1}, 10.0));
    const FieldAccuracy accuracy = measureField(samples(), [&](const glm::vec3& p) {
        return FieldValue{0.0F, turn * glm::normalize(p)};
    });
    EXPECT_NEAR(accuracy.normal_p99, 10.0, 1.0);
    // The mean of sin over the sphere is π/4.
    EXPECT_NEAR(accuracy.normal_mean, 10.0 * 3.14159265 / 4.0, 0.1);
}

TEST_F(AccuracyOfASphere, VisibleSurfaceFraction) {
    const auto unseen = [&](const std::vector<std::string>& specs) {
        return measureCollider(samples(), query(), bakeSpecs(mesh(), specs, 32)).unseen_percent;
    };
    EXPECT_NEAR(unseen({"fixed8:dir=-z"}), 50.0, 1.2);
    EXPECT_NEAR(unseen({"fixed8:dir=-z", "fixed8:dir=-x"}), 25.0, 1.2);
    EXPECT_NEAR(unseen({"fixed8:dir=-z,compare=greater"}), 50.0, 1.2);
    EXPECT_LT(unseen({"front-back:dir=1/2/3"}), 0.2);
    EXPECT_EQ(unseen({"cube:center=0/0/0"}), 0.0);
    // Half of the sphere is in the box, and half of that is visible.
    EXPECT_NEAR(unseen({"fixed8:dir=-z,box=0/-1.1/-1.1/1.1/1.1/1.1"}), 75.0, 1.2);
    // From twice the radius, a cap of (1 − 1/2) / 2 is visible.
    EXPECT_NEAR(unseen({"cube:center=0/0/2,compare=less"}), 75.0, 1.2);
}

/// Sides and normals are bit-identical to those of collisions, distances to those of the nearest-surface query.
TEST_F(AccuracyOfASphere, ColliderUsesVotesAndNearestDistances) {
    const Collider collider = bakeSpecs(mesh(), {"front-back:dir=+x", "front-back:dir=1/2/3"}, 48);
    const FieldAccuracy whole = measureCollider(samples(), query(), collider).field;
    const FieldAccuracy votes = measureField(samples(), fieldOf(collider));
    const FieldAccuracy nearest = measureField(samples(), nearestFieldOf(collider));
    EXPECT_EQ(whole.near.false_inside, votes.near.false_inside);
    EXPECT_EQ(whole.near.false_outside, votes.near.false_outside);
    EXPECT_EQ(whole.uniform.total(), votes.uniform.total());
    EXPECT_EQ(whole.normal_mean, votes.normal_mean);
    EXPECT_EQ(whole.distance_mean, nearest.distance_mean);
    EXPECT_LT(whole.distance_mean, 0.7 * votes.distance_mean);
    EXPECT_GT(votes.far_percent, 0.0);
    EXPECT_EQ(whole.far_percent + whole.unknown_percent, 0.0);
}

TEST(Accuracy, BuriedSurfaceIsExcluded) {
    // Two touching boxes: both copies of the common face have the inside on both sides.
    const TriangleMesh mesh = joined({makeBoxMesh({-1, 0, 0}, {1, 1, 1}), makeBoxMesh({1, 0, 0}, {1, 1, 1})});
    const MeshQuery query = queryOf(mesh);
    EXPECT_TRUE(query.watertight());
    const TruthSamples samples = sampleTruth(query, {.samples = 20'000});
    const ColliderAccuracy accuracy = measureCollider(
        samples, query, bakeSpecs(mesh, {"front-back:dir=-x", "front-back:dir=-y", "front-back:dir=-z"}));
    EXPECT_NEAR(accuracy.buried_percent, 100.0 * 8.0 / 48.0, 1.1);
}

TEST(Accuracy, IsDeterministic) {
    const TriangleMesh mesh = makeTorusMesh(1.0, 0.3, 64, 32);
    const Collider collider = bakeSpecs(mesh, {"front-back", "cube"});
    const auto everything = [&] {
        const MeshQuery query = queryOf(mesh);
        const TruthSamples samples = sampleTruth(query, {.samples = 5000});
        const ColliderAccuracy maps = measureCollider(samples, query, collider);
        const DistanceGrid grid =
            sampleDistances(query, makeLattice(mesh.bounds, 5000, LatticeFit::kCentered));
        std::string text = jsonOf(ColliderAccuracyReport{maps, samples.longest_side}).dump();
        for (const float distance : grid.distances) {
            text += shortNumber(static_cast<double>(distance)) + " ";
        }
        return text;
    };
    EXPECT_EQ(onThreads(1, everything), onThreads(7, everything));
}

TEST(Accuracy, SeedsChangePointsAndPrefixesAreStable) {
    const MeshQuery query = queryOf(makeBoxMesh({0, 0, 0}, {1, 1, 1}));
    const TruthSamples first = sampleTruth(query, {.samples = 100});
    AccuracyOptions options{.samples = 200};
    const TruthSamples more = sampleTruth(query, options);
    options.seed = 2;
    const TruthSamples other = sampleTruth(query, options);
    const std::vector<TruthPoint> near = sampleNear(query, {.samples = 100});
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_EQ(near[i].position, first.near[i].position);
        EXPECT_EQ(near[i].inside(), first.near[i].inside());
        EXPECT_EQ(first.near[i].position, more.near[i].position);
        EXPECT_NE(more.near[i].position, other.near[i].position);
        EXPECT_NE(more.uniform[i].position, other.uniform[i].position);
    }
}

TEST(Accuracy, SurfacePointsFollowTheArea) {
    // In a box of 4 × 1 × 1 the two small faces have a ninth of the area.
    const TruthSamples samples =
        sampleTruth(queryOf(makeBoxMesh({0, 0, 0}, {2, 0.5, 0.5})), {.samples = kSamples});
    std::size_t small = 0;
    for (const SurfacePoint& point : samples.surface) {
        small += std::abs(point.normal.x) > 0.5F ? 1 : 0;
        EXPECT_TRUE(glm::dot(point.normal, point.position) > 0.0F && !point.buried);
    }
    EXPECT_NEAR(static_cast<double>(small) / kSamples, 1.0 / 9.0, 0.01);
}

// --- the distance volume ---

TEST(DistanceVolume, LinearFieldIsExact) {
    Bounds box;
    box.add({-1.0F, 0.0F, 2.0F});
    box.add({3.0F, 1.3F, 4.1F});
    const glm::dvec3 slope(0.3, -0.5, 0.2);
    const auto linear = [&](const glm::dvec3& p) { return glm::dot(slope, p) - 0.4; };
    for (const LatticeFit fit : {LatticeFit::kCentered, LatticeFit::kCorner, LatticeFit::kStretched}) {
        DistanceGrid grid{makeLattice(box, 3000, fit), {}};
        const Lattice& lattice = grid.lattice;
        EXPECT_LE(lattice.count(), 3000U);
        EXPECT_GT(lattice.count(), 2400U) << "the budget must be used";
        const glm::uvec3 n = lattice.nodes;
        for (std::uint32_t i = 0; i < lattice.count(); ++i) {
            const glm::dvec3 node(i % n.x, i / n.x % n.y, i / n.x / n.y);
            grid.distances.push_back(static_cast<float>(linear(lattice.origin + lattice.spacing * node)));
        }
        const double range = DistanceVolume::fullRange(grid);
        const DistanceVolume volume(grid, range);
        for (const glm::vec3& p : pointsIn(box, 2000)) {
            if (glm::clamp(p, box.min, box.max) != p) {
                continue;
            }
            const FieldValue value = volume.at(p);
            EXPECT_NEAR(value.distance, linear(p), 0.51 * range / 32767.0);
            EXPECT_GT(glm::dot(glm::dvec3(value.normal), glm::normalize(slope)), 0.9999);
        }
        // All points beyond the box are outside. Their distance includes the distance to the box.
        const glm::vec3 beyond(-1.5F, 0.5F, 3.0F);
        EXPECT_NEAR(volume.at(beyond).distance, std::max(0.0, linear({-1.0, 0.5, 3.0})) + 0.5, 1e-4);
        EXPECT_GT(volume.at({1.0F, 5.0F, 3.0F}).distance, 0.0F);
    }
}

TEST(DistanceVolume, NodesEqualTheTruth) {
    // A closed mesh, whose signs are propagated along rows, and an open mesh, whose nodes are tested one by one.
    for (const bool open : {false, true}) {
        TriangleMesh mesh = makeTorusMesh(1.0, 0.3, 48, 24);
        if (open) {
            mesh.triangles.pop_back();
        }
        const MeshQuery query = queryOf(mesh);
        const DistanceGrid grid =
            sampleDistances(query, makeLattice(mesh.bounds, 20'000, LatticeFit::kStretched));
        const glm::uvec3 n = grid.lattice.nodes;
        for (std::uint32_t i = 0; i < grid.distances.size(); ++i) {
            const glm::vec3 p = grid.lattice.origin +
                                grid.lattice.spacing * glm::dvec3(i % n.x, i / n.x % n.y, i / n.x / n.y);
            ASSERT_EQ(grid.distances[i], static_cast<float>(query.signedDistance(p)));
        }
        // A narrow band has the same distances near the surface, in finer steps.
        const DistanceVolume full(grid, DistanceVolume::fullRange(grid));
        const DistanceVolume band(grid, DistanceVolume::bandRange(grid, 0.04));
        EXPECT_LT(band.range(), 0.7 * full.range());
        for (const TruthPoint& point : sampleNear(query, {.samples = 3000})) {
            if (std::abs(static_cast<double>(point.distance)) < 0.04) {
                EXPECT_NEAR(band.at(point.position).distance, full.at(point.position).distance,
                            full.range() / 32767.0);
            }
        }
    }
}

// --- reports ---

// The schema defines names and types. This test covers computed values.
TEST(AccuracyReport, SumsAndPercentagesAreConsistent) {
    const MeshQuery query = queryOf(makeBoxMesh({0, 0, 0}, {1, 2, 0.5}));
    const TruthSamples samples = sampleTruth(query, {.samples = 1000});
    const ColliderAccuracy accuracy =
        measureCollider(samples, query, bakeSpecs(query.mesh(), {"front-back"}));
    const nlohmann::ordered_json json = jsonOf(ColliderAccuracyReport{accuracy, samples.longest_side});
    const auto number = [&](const char* group, const char* name) {
        return json.at(group).at(name).get<double>();
    };
    EXPECT_DOUBLE_EQ(number("near", "wrong_percent"),
                     number("near", "false_inside_percent") + number("near", "false_outside_percent"));
    EXPECT_NEAR(number("distance_error", "mean_percent"), number("distance_error", "mean") / 4.0 * 100.0,
                1e-9);
    EXPECT_DOUBLE_EQ(jsonOf(samples).at("sigma").get<double>(), 0.02);
    EXPECT_NE(accuracyText(accuracy, samples, "m").find("1000 points"), std::string::npos);
}

TEST(ByteCount, ParsesUnits) {
    const std::vector<std::pair<const char*, std::uint64_t>> counts = {
        {"0.25MB", 250'000U}, {"1 MB", 1'000'000U},     {"4mb", 4'000'000U}, {"1MiB", 1'048'576U},
        {"512kB", 512'000U},  {"2GiB", 2'147'483'648U}, {"65536", 65536U},   {"64B", 64U}};
    for (const auto& [text, bytes] : counts) {
        EXPECT_EQ(parseByteCount(text), bytes) << text;
    }
    for (const char* text : {"", "MB", "-1MB", "0", "0.1B", "1 TBB", "1e3", "nan", "inf", "1MB2", "1,5MB",
                             "99999999999999999999GB"}) {
        EXPECT_EQ(parseByteCount(text), std::nullopt) << text;
    }
}

/// The fraction of points that a solid classifies wrongly.
WrongPercent wrongIn(const MeshQuery& solid, const std::vector<TruthPoint>& points) {
    return measureNear(points, [&](const glm::vec3& p) {
        return FieldValue{solid.inside(p) ? -1.0F : 1.0F, {}};
    });
}

TEST(SheetTruth, RodInsideItsShellIsSolid) {
    const TriangleMesh rod = makeBoxMesh({0, 0, 0}, {0.5, 0.02, 0.02});
    const ShapedMesh shaped = shapedBy(rod, {.as = ShapeAs::kShell, .thickness = 0.1});
    const SheetTruth truth = required(SheetTruth::build(PreparedMesh(rod), shaped));
    ASSERT_FALSE(truth.empty());
    EXPECT_EQ(truth.inside({0, 0, 0}), true);
    EXPECT_EQ(truth.inside({0, 0.069F, 0}), true);
    EXPECT_EQ(truth.inside({0, 0.071F, 0}), false);
    EXPECT_EQ(truth.inside({0, 0.05F, 0.05F}), std::nullopt);  // at the mitre of an edge
    const MeshQuery solid = queryOf(shaped.mesh);
    const std::vector<TruthPoint> points = truth.sample(solid, {.samples = 5000});
    EXPECT_GT(points.size(), 4000U);
    EXPECT_EQ(wrongIn(solid, points).total(), 0.0);
    // A former bug: the inverted inner offset left a hollow of 0.03. Sampling that solid itself finds no error.
    const TriangleMesh hollow = joined(
        {makeBoxMesh({0, 0, 0}, {0.55, 0.07, 0.07}), reversed(makeBoxMesh({0, 0, 0}, {0.47, 0.03, 0.03}))});
    EXPECT_GT(wrongIn(queryOf(hollow), points).false_outside, 20.0);
}

TEST(SheetTruth, SheetAndBlockKeepTheirKinds) {
    // The block stays solid. Only the sheet gets a shell.
    const TriangleMesh mesh = joined({makePlane(0.0F, 4), makeBoxMesh({5, 0, 0}, {1, 1, 1})});
    const ShapeOptions options{.thickness = 0.1};
    const ShapedMesh shaped = shapedBy(mesh, options);
    expectKinds(shaped.report, 1, 0, 1, 0);
    const Result<SheetTruth> truth = SheetTruth::build(PreparedMesh(mesh), shaped);
    ASSERT_TRUE(truth && !truth->empty());
    EXPECT_EQ(truth->inside({5, 0, 0}), false);
    AccuracyOptions few{.samples = 2000};
    const std::vector<TruthPoint> points = truth->sample(queryOf(shaped.mesh), few);
    EXPECT_GT(points.size(), 1900U);
    for (const TruthPoint& point : points) {
        ASSERT_EQ(point.inside(), std::abs(point.position.y) < 0.05F) << point.position.y;
    }
    // A mesh without sheets has nothing to measure.
    const TriangleMesh block = makeBoxMesh({0, 0, 0}, {1, 1, 1});
    const SheetTruth none = required(SheetTruth::build(PreparedMesh(block), shapedBy(block, options)));
    EXPECT_TRUE(none.empty() && none.sample(queryOf(block), few).empty());
}

}  // namespace
}  // namespace relief::test
