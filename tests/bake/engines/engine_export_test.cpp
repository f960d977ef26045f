// SPDX-License-Identifier: Apache-2.0
#include "bake/engines/engine_export.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "bake/engines/body_cells.h"
#include "bake/engines/engine_constants.h"
#include "formats/container.h"
#include "formats/patch_tree.h"
#include "tests/bake/engines/many_balls.h"
#include "tests/bake/meshes.h"
#include "tests/results.h"

namespace relief::test {
namespace {

float row(const glm::vec4& r, const glm::vec3& p) {
    return r[0] * p.x + (r[1] * p.y + (r[2] * p.z + r[3]));
}

/// The distance from the exported bytes, with the C++ vote.
float distanceOf(const PatchConstants& constants, std::span<const std::byte> texels, const glm::vec3& p) {
    const glm::vec3 q(row(constants.row[0], p), row(constants.row[1], p), row(constants.row[2], p));
    const auto vote = votePatches(texels.subspan(8 * static_cast<std::size_t>(constants.place[0])), q);
    return vote ? constants.size[0] * vote->distance : kFarOutside;
}

TEST(EngineExport, DataOfAColliderGivesItsDistances) {
    const Collider collider = ball();
    const std::vector<EngineFile> files = required(engineFiles(collider, "ball", Engine::kC));
    EXPECT_EQ(required(readContainer(fileNamed(files, "ball.relief").bytes)).maps.front().texels,
              collider.maps.front().texels);
    const std::vector<std::byte>& texels = fileNamed(files, "ball.texels").bytes;
    EXPECT_EQ(texels.size() % (8 * kEngineTextureWidth), 0U);
    PatchConstants constants;
    ASSERT_EQ(fileNamed(files, "ball.constants").bytes.size(), sizeof(constants));
    std::memcpy(&constants, fileNamed(files, "ball.constants").bytes.data(), sizeof(constants));
    std::mt19937 random(1);
    std::uniform_real_distribution<float> coordinate(-1.2F, 1.2F);
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
        const glm::vec3 p(coordinate(random), coordinate(random), coordinate(random));
        const FieldSample field = evaluate(collider, p);
        inside += field.inside() ? 1 : 0;
        EXPECT_EQ(distanceOf(constants, texels, p), field.distance);
    }
    EXPECT_GT(inside, 100);
}

TEST(EngineExport, OtherMapsAreErrors) {
    const TriangleMesh mesh = makeIcosphere({0.0, 0.0, 0.0}, 1.0, 2);
    for (const std::vector<std::string>& specs :
         {std::vector<std::string>{"cube:size=8"}, {"patches:budget=4kB", "cube:size=8"}}) {
        const auto files = engineFiles(bakeSpecs(mesh, specs), "ball", Engine::kC);
        ASSERT_FALSE(files);
        EXPECT_EQ(files.error().code, ErrorCode::kUsage);
        EXPECT_NE(files.error().message.find("bake it again without --map"), std::string::npos);
    }
}

TEST(EngineExport, BodiesOfALevelGiveTheDistancesOfTheWorld) {
    const LoadedWorld level = manyBalls();
    const std::vector<EngineFile> files = required(engineFiles(level, "level", Engine::kC));
    const std::vector<std::byte>& texels = fileNamed(files, "level.texels").bytes;
    std::vector<EngineBody> bodies(level.world.bodies.size());
    ASSERT_EQ(fileNamed(files, "level.bodies").bytes.size(), 2 * kBodiesPerRow * sizeof(EngineBody));
    std::memcpy(bodies.data(), fileNamed(files, "level.bodies").bytes.data(),
                bodies.size() * sizeof(EngineBody));
    std::vector<std::uint32_t> cells(fileNamed(files, "level.cells").bytes.size() / 4);
    std::memcpy(cells.data(), fileNamed(files, "level.cells").bytes.data(), cells.size() * 4);
    glm::vec3 corner;
    float edge = 0.0F;
    std::memcpy(&corner, &cells[4], sizeof(corner));
    std::memcpy(&edge, &cells[7], sizeof(edge));
    const std::size_t entries = 9 + std::size_t{cells[0]} * cells[1] * cells[2];
    ASSERT_EQ(cells.size() % kEngineTextureWidth, 0U);
    ASSERT_GE(cells.size(), entries + cells[3]);
    EXPECT_GT(entries, 20U);

    int inside = 0;
    for (const glm::vec3& p : pointsAmongBalls(20'000)) {
        const float expected = depthIn(level, p);
        const glm::vec3 at = glm::floor((p - corner) / edge);
        float nearest = kFarOutside;
        if (glm::all(glm::greaterThanEqual(at, glm::vec3(0.0F))) &&
            glm::all(glm::lessThan(at, glm::vec3(glm::uvec3(cells[0], cells[1], cells[2]))))) {
            const glm::uvec3 c(at);
            const std::size_t cell = 8 + (std::size_t{c.z} * cells[1] + c.y) * cells[0] + c.x;
            for (std::uint32_t k = cells[cell]; k < cells[cell + 1]; ++k) {
                const EngineBody& body = bodies[cells[entries + k]];
                nearest = std::min(nearest, distanceOf(body.constants, texels, p));
            }
        }
        // Rows are rounded again for each body.
        if (std::abs(expected) > 1e-4F) {
            EXPECT_EQ(nearest < 0.0F, expected < 0.0F);
        }
        if (expected < -1e-4F) {
            ++inside;
            EXPECT_NEAR(nearest, expected, 1e-4F);
        }
    }
    EXPECT_GT(inside, 500);
}

TEST(BodyCells, ContainEveryBodyOfExtremeSizes) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> exponent(-6.0F, 4.0F);
    std::uniform_real_distribution<float> part(-1.0F, 1.0F);
    for (int round = 0; round < 30; ++round) {
        std::vector<EngineBody> bodies(static_cast<std::size_t>(1 + 17 * round));
        for (EngineBody& body : bodies) {
            for (std::size_t i = 0; i < 3; ++i) {
                const float center = 1000.0F * part(random);
                const float half = std::pow(10.0F, exponent(random));
                body.min_restitution[i] = center - half;
                body.max_friction[i] = center + half;
            }
        }
        const std::vector<std::uint32_t> cells = bodyCells(bodies);
        EXPECT_LE(cells[3], std::max<std::size_t>(16 * bodies.size(), bodies.size()));
        glm::vec3 corner;
        float edge = 0.0F;
        std::memcpy(&corner, &cells[4], sizeof(corner));
        std::memcpy(&edge, &cells[7], sizeof(edge));
        const std::size_t entries = 9 + std::size_t{cells[0]} * cells[1] * cells[2];
        for (std::uint32_t b = 0; b < bodies.size(); ++b) {
            for (int k = 0; k < 20; ++k) {
                glm::vec3 p;
                for (int i = 0; i < 3; ++i) {
                    const auto axis = static_cast<std::size_t>(i);
                    const float share = std::clamp(0.5F + 0.6F * part(random), 0.0F, 1.0F);
                    p[i] = bodies[b].min_restitution[axis] +
                           share * (bodies[b].max_friction[axis] - bodies[b].min_restitution[axis]);
                }
                const glm::uvec3 at(glm::floor((p - corner) / edge));
                ASSERT_TRUE(at.x <= cells[0] && at.y <= cells[1] && at.z <= cells[2]);
                const glm::uvec3 c = glm::min(at, glm::uvec3(cells[0], cells[1], cells[2]) - 1U);
                const std::size_t cell = 8 + (std::size_t{c.z} * cells[1] + c.y) * cells[0] + c.x;
                const auto first = cells.begin() + static_cast<std::ptrdiff_t>(entries + cells[cell]);
                const auto end = cells.begin() + static_cast<std::ptrdiff_t>(entries + cells[cell + 1]);
                EXPECT_TRUE(std::find(first, end, b) != end) << "body " << b << " of " << bodies.size();
            }
        }
    }
    EXPECT_EQ(bodyCells({}).size(), 10U);
}

}  // namespace
}  // namespace relief::test
