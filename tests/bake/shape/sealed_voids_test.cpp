// SPDX-License-Identifier: Apache-2.0
// Space sealed off by several sheets: the guarantees of sealed_voids.h, on a shape with a closed-form inside. Also
// parts that are classified by name.
#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "bake/measure/truth.h"
#include "bake/patches/patch_planner.h"
#include "bake/shape/sealed_voids.h"
#include "tests/bake/points.h"
#include "tests/bake/shaped.h"

namespace relief::test {
namespace {

constexpr double kPanelThickness = 0.06;

bool inPanel(const glm::dvec3& p) {
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec2 across(p[(axis + 1) % 3], p[(axis + 2) % 3]);
        if (std::abs(std::abs(p[axis]) - 0.5) < 0.5 * kPanelThickness &&
            std::max(std::abs(across.x), std::abs(across.y)) < 1.5) {
            return true;
        }
    }
    return false;
}
bool inMiddle(const glm::dvec3& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 0.5;
}

ShapedMesh shapedRooms(const TriangleMesh& mesh, ShapeOptions options = {}) {
    options.thickness = kPanelThickness;
    return shapedBy(mesh, options);
}

/// Whether the middle room is filled, tested at its centre.
bool isFull(const TriangleMesh& mesh, const ShapeOptions& options = {}) {
    const ShapedMesh shape = shapedRooms(mesh, options);
    const bool full = queryOf(shape.mesh).inside(glm::vec3(0.01F, 0.02F, 0.03F));
    EXPECT_EQ(shape.report.voids, full ? 1U : 0U);
    return full;
}

TEST(SealedVoids, AreInsideAndEndNoRay) {
    const glm::dmat3 turn = rotation(glm::dvec3(0.3, 1.0, 0.2), 33.0);
    const ShapedMesh shape = shapedRooms(moved(makeRooms(), [&](const glm::dvec3& p) { return turn * p; }));
    EXPECT_EQ(shape.report.sheets, 6U);
    EXPECT_EQ(shape.report.voids, 1U);
    const MeshQuery query = queryOf(shape.mesh);
    int of_middle = 0;
    for (const glm::dvec3 p : pointsIn(makeRooms().bounds, 100'000)) {
        const bool inside = inPanel(p) || inMiddle(p);
        bool clear = true;  // not within float errors of the surface
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 step(0.0);
            step[axis] = 1e-3;
            clear = clear && inPanel(p + step) == inPanel(p) && inPanel(p - step) == inPanel(p);
        }
        if (clear) {
            of_middle += inMiddle(p) && !inPanel(p) ? 1 : 0;
            ASSERT_EQ(query.inside(glm::vec3(turn * p)), inside) << p.x << ' ' << p.y << ' ' << p.z;
        }
    }
    EXPECT_GT(of_middle, 1000);
    std::vector<LineSpan> spans;
    const glm::dvec3 middle = turn * glm::dvec3(0.01, 0.02, 0.03);
    const glm::dvec3 x = turn * glm::dvec3(1.0, 0.0, 0.0);
    ASSERT_TRUE(query.spansInside(middle, x, spans));
    ASSERT_EQ(spans.size(), 1U);
    EXPECT_NEAR(spans[0].begin, -0.54, 1e-5);
    EXPECT_NEAR(spans[0].end, 0.52, 1e-5);

    for (const SurfacePoint& point : sampleSurface(query, {.samples = 5'000})) {
        const glm::dvec3 p = glm::transpose(turn) * glm::dvec3(point.position);
        const bool faces_room = inMiddle(p + 0.01 * (glm::transpose(turn) * glm::dvec3(point.normal)));
        EXPECT_TRUE(!faces_room || point.buried);
    }
}

TEST(SealedVoid, IsFilled) {
    const MeshQuery query = queryOf(shapedRooms(makeRooms()).mesh);
    const DepthMap map = bakePatches(query, {.bytes = 200'000})->map;
    for (const glm::vec3& p : pointsIn(makeBoxMesh(glm::dvec3(0.0), glm::dvec3(0.4)).bounds, 20'000)) {
        ASSERT_LT(vote(map, p)->distance, 0.0F);
    }
    const auto isWrong = [&](const TruthPoint& point) {
        return (vote(map, point.position)->distance < 0.0F) != point.inside();
    };
    EXPECT_LT(std::ranges::count_if(sampleNear(query, {.samples = 20'000}), isWrong), 60);
}

TEST(SealedVoid, HasNoWindowAndCanStayHollow) {
    EXPECT_TRUE(isFull(makeRooms()));
    EXPECT_FALSE(isFull(makeRooms(0.08)));
    EXPECT_FALSE(isFull(makeRooms(), {.voids = VoidMode::kKeep}));
    EXPECT_FALSE(isFull(makeRooms(), {.as = ShapeAs::kShell}));
}

TEST(SealedVoid, ExcludesHollowsOfSolids) {
    const TriangleMesh hollow = joined({makeBoxMesh(glm::dvec3(0.0), glm::dvec3(0.4)),
                                        reversed(makeBoxMesh(glm::dvec3(0.0), glm::dvec3(0.3)))});
    EXPECT_FALSE(isFull(joined({hollow, makePanel(1, 1.2)})));
}

constexpr double kNamedThickness = 0.1;
using Named = std::vector<NamedShape>;

ShapedMesh shapedByName(const TriangleMesh& mesh, const Named& named, ShapeAs as = ShapeAs::kAuto) {
    return shapedBy(mesh, {as, kNamedThickness, named});
}

bool inside(const ShapedMesh& shape, const glm::vec3& p) {
    return queryOf(shape.mesh).inside(p);
}

/// A box of half sides 1. Its lid, at y = 1, has the first name, the rest the second.
TriangleMesh makeBoxWithLid() {
    TriangleMesh box = makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0));
    for (const glm::uvec3& t : box.triangles) {
        const bool lid = std::min({box.positions[t.x].y, box.positions[t.y].y, box.positions[t.z].y}) > 0.9F;
        box.marks.push_back(lid ? 1 : 2);
    }
    return box;
}

/// A box without a lid, with the first name, and a closed box at x = 4 with the second.
TriangleMesh makeTwoBoxes() {
    const TriangleMesh tub =
        without(makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0)), [](const glm::dvec3& p) { return p.y > 0.9; });
    TriangleMesh mesh = joined({tub, makeBoxMesh(glm::dvec3(4.0, 0.0, 0.0), glm::dvec3(1.0))});
    mesh.marks.assign(tub.triangles.size(), 1);
    mesh.marks.resize(mesh.triangles.size(), 2);
    return mesh;
}

TEST(NamedShape, NamesClassifyParts) {
    const glm::vec3 tub(0.0F);
    const glm::vec3 block(4.0F, 0.0F, 0.0F);
    const ShapedMesh found = shapedByName(makeTwoBoxes(), {});
    expectKinds(found.report, 1, 0, 1, 0);
    EXPECT_FALSE(inside(found, tub));
    EXPECT_TRUE(inside(found, block));
    const ShapedMesh told =
        shapedByName(makeTwoBoxes(), {{"tub", ShapeAs::kSolid}, {"block", ShapeAs::kShell}});
    expectKinds(told.report, 0, 1, 1, 0);
    EXPECT_TRUE(inside(told, tub));
    EXPECT_FALSE(inside(told, block));
    EXPECT_TRUE(inside(told, {4.98F, 0.2F, 0.3F}));
    EXPECT_EQ(asOptionWords(told.report), (std::vector<std::string>{"tub=solid", "block=shell"}));
    // Unnamed parts use the default.
    const ShapedMesh rest = shapedByName(makeTwoBoxes(), {{"tub", ShapeAs::kAuto}}, ShapeAs::kShell);
    expectKinds(rest.report, 0, 0, 2, 0);
    EXPECT_EQ(asOptionWords(rest.report), (std::vector<std::string>{"shell", "tub=auto"}));
}

TEST(NamedShape, NamedWallIsCutFromItsSurface) {
    // A glass lid leaves free space on both sides, so the box is empty.
    const ShapedMesh glass = shapedByName(makeBoxWithLid(), {{"lid", ShapeAs::kShell}});
    expectKinds(glass.report, 0, 0, 2, 0);
    EXPECT_FALSE(inside(glass, glm::vec3(0.0F)));
    for (const glm::vec3& wall : {glm::vec3(0.0F, 1.04F, 0.0F), {0.0F, 0.96F, 0.0F}, {0.2F, -0.96F, 0.3F}}) {
        EXPECT_TRUE(inside(glass, wall)) << wall.x << " " << wall.y;
    }
    // Below the lid, a part explicitly made solid.
    for (const auto& [named, as] :
         {std::pair{Named{{"lid", ShapeAs::kShell}}, ShapeAs::kSolid},
          {Named{{"lid", ShapeAs::kShell}, {"box", ShapeAs::kSolid}}, ShapeAs::kAuto}}) {
        const ShapedMesh full = shapedByName(makeBoxWithLid(), named, as);
        expectKinds(full.report, 0, 1, 1, 0);
        EXPECT_TRUE(inside(full, glm::vec3(0.0F)));
        EXPECT_TRUE(inside(full, {0.0F, 1.04F, 0.0F}));
        EXPECT_FALSE(inside(full, {0.0F, 1.06F, 0.0F}));
        EXPECT_FALSE(inside(full, {0.0F, -1.01F, 0.0F}));
    }
}

TEST(NamedShape, ClosedSurfaceWithoutWallStaysWhole) {
    const ShapedMesh plain = shapedByName(makeBoxWithLid(), {});
    for (const Named& named : {Named{{"lid", ShapeAs::kSolid}}, Named{{"lid", ShapeAs::kTerrain}},
                               Named{{"lid", ShapeAs::kSolid}, {"box", ShapeAs::kSolid}},
                               Named{{"lid", ShapeAs::kAuto}, {"box", ShapeAs::kSolid}}}) {
        const ShapedMesh shape = shapedByName(makeBoxWithLid(), named);
        expectKinds(shape.report, 1, 0, 0, 0);
        EXPECT_EQ(shape.mesh->triangles, plain.mesh->triangles);
        EXPECT_EQ(shape.mesh->positions, plain.mesh->positions);
    }
}

TEST(NamedShape, OpenPartsOfTwoKindsSplitAtSharedEdges) {
    // A floor in two halves: terrain, and a slab as a shell. Neither is closed.
    TriangleMesh floor = makePlane(0.0F, 8);
    for (const glm::uvec3& t : floor.triangles) {
        const float x = floor.positions[t.x].x + floor.positions[t.y].x + floor.positions[t.z].x;
        floor.marks.push_back(x < 0.0F ? 1 : 2);
    }
    const ShapedMesh shape = shapedByName(floor, {{"ground", ShapeAs::kTerrain}, {"slab", ShapeAs::kShell}});
    expectKinds(shape.report, 0, 0, 1, 1);
    EXPECT_TRUE(inside(shape, {-0.5F, -0.09F, 0.2F}));
    EXPECT_FALSE(inside(shape, {0.5F, -0.09F, 0.2F}));
    EXPECT_TRUE(inside(shape, {0.5F, 0.04F, 0.2F}));
    EXPECT_EQ(shape.mesh->sourceTriangles(), floor.triangles.size());
}

TEST(NamedShape, ShellsDoNotAffectEnclosedParts) {
    // A ball with a hole, enclosed by a box.
    const TriangleMesh box = makeBoxMesh(glm::dvec3(0.0), glm::dvec3(2.0));
    TriangleMesh ball = makeIcosphere(glm::dvec3(0.0), 1.0, 2);
    ball.triangles.erase(ball.triangles.begin());
    TriangleMesh mesh = joined({box, ball});
    mesh.marks.assign(box.triangles.size(), 1);
    mesh.marks.resize(mesh.triangles.size(), 0);
    const ShapedMesh shape = shapedByName(mesh, {{"room", ShapeAs::kShell}});
    expectKinds(shape.report, 0, 1, 1, 0);
    EXPECT_TRUE(inside(shape, glm::vec3(0.0F)));
    EXPECT_FALSE(inside(shape, {1.5F, 0.1F, 0.2F}));
}

TEST(NamedShape, UnknownMarksAreIgnored) {
    const ShapedMesh plain = shapedByName(makeBoxWithLid(), {});
    TriangleMesh hostile = makeBoxWithLid();
    hostile.marks.assign(hostile.triangles.size(), 200);
    const ShapedMesh beyond = shapedByName(hostile, {{"lid", ShapeAs::kShell}});
    EXPECT_EQ(beyond.mesh->triangles, plain.mesh->triangles);
    EXPECT_EQ(beyond.report.named.at(0).triangles, 0U);
    hostile.marks.clear();
    EXPECT_EQ(shapedByName(hostile, {{"lid", ShapeAs::kShell}}).mesh->triangles, plain.mesh->triangles);
}

TEST(FinishMesh, MarksFollowTriangles) {
    TriangleMesh mesh;
    mesh.name = "m";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 4}, {0, 2, 3}, {3, 3, 3}, {0, 1, 3}};
    mesh.marks = {5, 6, 7, 8, 9};
    const TriangleMesh finished = required(finishMesh(mesh));
    EXPECT_EQ(finished.marks, (std::vector<std::uint8_t>{5, 7, 9}));
    EXPECT_EQ(finished.dropped_triangles, 2U);
    mesh.marks.clear();
    EXPECT_TRUE(finishMesh(mesh)->marks.empty());
}

TEST(ShapeOptions, ParseFromTheCommandLine) {
    const ShapeOptions options = required(parseShapeOptions(
        {"a=b=solid", "shell", " glass top =terrain", "solid=auto", "caf\xc3\xa9\x01=shell"}));
    EXPECT_EQ(options.as, ShapeAs::kShell);
    const Named expected = {{"a=b", ShapeAs::kSolid},
                            {" glass top ", ShapeAs::kTerrain},
                            {"solid", ShapeAs::kAuto},
                            {"caf\xc3\xa9\xef\xbf\xbd", ShapeAs::kShell}};
    EXPECT_EQ(options.named, expected);
    EXPECT_EQ(parseShapeOptions({})->as, ShapeAs::kAuto);
    const std::string longest(kSelectedNameBytesMax, 'x');
    EXPECT_TRUE(parseShapeOptions({longest + "=solid"}));
    using Words = std::vector<std::string>;
    std::vector<Words> faults = {{"solid", "solid"}, {"a=solid", "a=shell"}};
    for (const std::string& word :
         Words{"", "sheet", "=solid", "a=", "a=sheet", "solid=a", longest + "x=solid", "\n"}) {
        faults.push_back({word});
    }
    for (const Words& words : faults) {
        SCOPED_TRACE(words.back());
        expectError(parseShapeOptions(words), ErrorCode::kUsage, "--as is '");
    }
    std::vector<std::string> many;
    for (std::size_t i = 0; i <= kSelectedNamesMax; ++i) {
        many.push_back("n" + std::to_string(i) + "=solid");
    }
    EXPECT_EQ(parseShapeOptions(many).error().code, ErrorCode::kLimit);
    many.pop_back();
    EXPECT_TRUE(parseShapeOptions(many));
}

}  // namespace
}  // namespace relief::test
