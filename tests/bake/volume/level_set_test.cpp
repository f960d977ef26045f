// SPDX-License-Identifier: Apache-2.0
#include "bake/volume/level_set.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetMeasure.h>

#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <sstream>

#include "tests/bake/meshes.h"
#include "tests/bake/threads.h"

namespace relief::test {
namespace {

constexpr glm::dvec3 kCenter(0.31, -0.2, 0.13);
constexpr double kRadius = 0.7;
constexpr double kVolume = 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius;
constexpr double kArea = 4.0 * std::numbers::pi * kRadius * kRadius;
constexpr std::uint32_t kVoxels = 64;
constexpr double kVoxel = 2.0 * kRadius / kVoxels;

const Collider& sphere() {
    static const Collider baked =
        bakeSpecs(makeIcosphere(kCenter, kRadius, 6),
                  {"front-back:dir=+x,decode=plane", "front-back:dir=+y,decode=plane",
                   "front-back:dir=+z,decode=plane"},
                  256);
    return baked;
}

Result<std::vector<std::byte>> levelSetOf(const Collider& collider, std::uint32_t voxels) {
    return RELIEF_TRY(encodeGrids(collider, {voxels, true, false})).level_set;
}

openvdb::FloatGrid::Ptr gridOf(const std::vector<std::byte>& bytes) {
    openvdb::initialize();
    std::istringstream in(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    openvdb::io::Stream stream(in);
    const auto grids = stream.getGrids();
    return grids->size() == 1 ? openvdb::gridPtrCast<openvdb::FloatGrid>((*grids)[0]) : nullptr;
}

double fromSphere(const openvdb::Vec3d& p) {
    return glm::distance(glm::dvec3(p.x(), p.y(), p.z()), kCenter) - kRadius;
}

// Distances, volume and area of a sphere have closed forms.
TEST(LevelSet, MatchesASphere) {
    const auto grid = gridOf(required(levelSetOf(sphere(), kVoxels)));
    ASSERT_NE(grid, nullptr);
    EXPECT_EQ(grid->getName(), "surface");
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
    EXPECT_NEAR(grid->voxelSize().x(), kVoxel, 1e-3 * kVoxel);
    EXPECT_NEAR(grid->background(), 3.0 * kVoxel, 1e-2 * kVoxel);

    // Facets are up to 0.01 voxels inside the sphere, and texel planes add errors. The search is coarser far away.
    double worst = 0.0;
    double sum = 0.0;
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        const double truth = fromSphere(grid->indexToWorld(value.getCoord()));
        worst = std::max(worst, std::abs(double{*value} - truth));
        sum += std::abs(double{*value} - truth);
    }
    EXPECT_LT(worst, 0.15 * kVoxel);
    EXPECT_LT(sum / static_cast<double>(grid->activeVoxelCount()), 0.02 * kVoxel);
    // The band has no gaps: voxels on both sides of every sign change are active.
    const auto all = grid->getConstAccessor();
    std::size_t torn = 0;
    for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) {
        for (auto value = leaf->cbeginValueAll(); value; ++value) {
            for (int axis = 0; axis < 3; ++axis) {
                openvdb::Coord beside = value.getCoord();
                beside[axis] += 1;
                const bool change = (all.getValue(beside) < 0.0F) != (*value < 0.0F);
                torn += change && !(value.isValueOn() && all.isValueOn(beside)) ? 1 : 0;
            }
        }
    }
    EXPECT_EQ(torn, 0U);
    const auto wanted = static_cast<double>(grid->activeVoxelCount());
    // The band is six voxels thick.
    EXPECT_NEAR(wanted * kVoxel * kVoxel * kVoxel, kArea * 6.0 * kVoxel, 0.03 * kArea * 6.0 * kVoxel);
    const auto at = grid->getConstAccessor();
    EXPECT_FLOAT_EQ(at.getValue(openvdb::Coord::round(grid->worldToIndex({kCenter.x, kCenter.y, kCenter.z}))),
                    -grid->background());
    EXPECT_FLOAT_EQ(at.getValue(openvdb::Coord(10000, 0, 0)), grid->background());
    EXPECT_NEAR(openvdb::tools::levelSetVolume(*grid), kVolume, 0.01);
    EXPECT_NEAR(openvdb::tools::levelSetArea(*grid), kArea, 0.05);
}

TEST(LevelSet, IsDeterministic) {
    const auto bytes = [](std::uint32_t voxels) { return required(levelSetOf(sphere(), voxels)); };
    const std::vector<std::byte> first = bytes(kVoxels);
    EXPECT_EQ(first, bytes(kVoxels));
    EXPECT_EQ(first, onThreads(1, [&] { return bytes(kVoxels); }));
    EXPECT_NE(first, bytes(kVoxels + 1));
}

/// Vertices and faces of the PLY written by encodeGrids().
struct Surface {
    std::vector<glm::vec3> vertices;
    std::vector<std::vector<std::uint32_t>> faces;
};

Surface surfaceOf(const std::vector<std::byte>& bytes) {
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto count = [&](const std::string& element) {
        return std::stoul(text.substr(text.find("element " + element) + element.size() + 9));
    };
    std::size_t at = text.find("end_header\n") + 11;
    const auto read = [&](auto& to) {
        std::memcpy(&to, text.data() + at, sizeof(to));
        at += sizeof(to);
    };
    Surface surface;
    surface.vertices.resize(count("vertex"));
    for (glm::vec3& vertex : surface.vertices) {
        read(vertex);
    }
    surface.faces.resize(count("face"));
    for (auto& face : surface.faces) {
        std::uint8_t corners = 0;
        read(corners);
        face.resize(corners);
        for (std::uint32_t& corner : face) {
            read(corner);
        }
    }
    EXPECT_EQ(at, text.size());
    return surface;
}

TEST(SurfaceMesh, SphereIsClosedAndFacesOutward) {
    const Surface surface = surfaceOf(required(encodeGrids(sphere(), {kVoxels, false, true})).surface);
    double volume = 0.0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& face : surface.faces) {
        ASSERT_GE(face.size(), 3U);
        for (std::size_t i = 0; i < face.size(); ++i) {
            ++edges[{face[i], face[(i + 1) % face.size()]}];
        }
        const glm::dvec3 a(surface.vertices[face[0]]);
        for (std::size_t i = 2; i < face.size(); ++i) {
            const glm::dvec3 b(surface.vertices[face[i - 1]]);
            const glm::dvec3 c(surface.vertices[face[i]]);
            volume += glm::dot(a - kCenter, glm::cross(b - kCenter, c - kCenter)) / 6.0;
        }
    }
    for (const auto& [edge, times] : edges) {
        ASSERT_EQ(times, 1);
        ASSERT_EQ(edges.count({edge.second, edge.first}), 1U);
    }
    EXPECT_EQ(static_cast<long>(surface.vertices.size()) - static_cast<long>(edges.size() / 2) +
                  static_cast<long>(surface.faces.size()),
              2);
    EXPECT_NEAR(volume, kVolume, 0.01);
    double worst = 0.0;
    for (const glm::vec3& vertex : surface.vertices) {
        worst = std::max(worst, std::abs(fromSphere({vertex.x, vertex.y, vertex.z})));
    }
    EXPECT_LT(worst, 0.1 * kVoxel);
}

TEST(LevelSet, SheetThinnerThanAVoxelIsRejected) {
    const PreparedMesh mesh(makeBoxMesh({0.0, 0.002, 0.0}, {1.0, 1e-4, 1.0}));
    const Collider sheet = bakeSpecs(mesh, {"front-back:dir=+y"}, 32);
    EXPECT_FALSE(levelSetOf(sheet, 16));
    EXPECT_EQ(levelSetOf(sheet, 4).error().code, ErrorCode::kLimit);
}

// A thick box, and a plate that contains no voxel centre: only the box remains, and the missing fraction is reported.
TEST(LevelSet, WarnsOfMissingThinParts) {
    const Collider collider = bakeSpecs(
        joined({makeBoxMesh({0.0, -0.25, 0.0}, {0.2, 0.25, 0.2}),
                makeBoxMesh({0.0, 0.26, 0.0}, {0.5, 5e-3, 0.5})}),
        {"front-back:dir=+y,decode=plane", "front-back:dir=+x,decode=plane", "front-back:dir=+z"}, 128);
    EXPECT_GT(required(encodeGrids(collider, {20})).missing, 0.3);
    EXPECT_LT(required(encodeGrids(collider, {128, false, false})).missing, 1e-3);
    EXPECT_LT(required(encodeGrids(sphere(), {kVoxels})).missing, 1e-5);
}

// The bounds are those of the mesh. The inside can extend beyond them, as for ground.
TEST(LevelSet, CoversAllInsidePoints) {
    Collider collider = sphere();
    // The voxel size is unchanged: x and z are equally long.
    collider.bounds.max.y = static_cast<float>(kCenter.y);
    const auto grid = gridOf(*levelSetOf(collider, kVoxels));
    EXPECT_NEAR(openvdb::tools::levelSetVolume(*grid), kVolume, 0.01);
}

TEST(LevelSet, UnboundedInsideIsRejected) {
    const PreparedMesh mesh(makeBoxMesh({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}));
    Collider collider = bakeSpecs(mesh, {"float:dir=1/1/1,compare=less"}, 32);
    collider.maps[0].encloses = false;
    collider.bounds.min *= 0.5F;
    collider.bounds.max *= 0.5F;
    EXPECT_EQ(levelSetOf(collider, 16).error().code, ErrorCode::kInvalidInput);
}

TEST(LevelSet, CoordinatesTooLargeForVoxelsAreRejected) {
    Collider collider = sphere();
    collider.bounds.min.x += 1e8F;
    collider.bounds.max.x = collider.bounds.min.x;
    EXPECT_EQ(levelSetOf(collider, 1024).error().code, ErrorCode::kLimit);
}

}  // namespace
}  // namespace relief::test
