// SPDX-License-Identifier: Apache-2.0
#include "runtime/vdb/vdb_writer.h"

#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointCount.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <random>
#include <sstream>

#include "tests/results.h"

namespace relief {
namespace {

using openvdb::points::AttributeHandle;
using openvdb::points::PointDataGrid;

std::vector<VdbPoint> someParticles(std::size_t count, float offset = 0.0F) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> at(-2.0F, 3.0F);
    std::vector<VdbPoint> out(count);
    for (std::size_t i = 0; i < count; ++i) {
        out[i].id = static_cast<std::uint32_t>(3 * i + 1);
        out[i].position = {offset + at(random), at(random), at(random)};
        out[i].velocity = {at(random), at(random), at(random)};
        out[i].age = at(random);
        out[i].lifetime = at(random);
        out[i].type = static_cast<std::uint32_t>(i % 5);
    }
    return out;
}

PointDataGrid::Ptr gridOf(const std::vector<std::byte>& bytes) {
    openvdb::initialize();
    std::istringstream in(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    openvdb::io::Stream stream(in);
    const auto grids = stream.getGrids();
    return grids->size() == 1 ? openvdb::gridPtrCast<PointDataGrid>((*grids)[0]) : nullptr;
}

/// The particles in a written file, by id.
std::map<std::uint32_t, VdbPoint> particlesOf(const PointDataGrid& grid) {
    std::map<std::uint32_t, VdbPoint> out;
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        const AttributeHandle<openvdb::Vec3f> position(leaf->constAttributeArray("P"));
        const AttributeHandle<openvdb::Vec3f> velocity(leaf->constAttributeArray("v"));
        const AttributeHandle<float> age(leaf->constAttributeArray("age"));
        const AttributeHandle<float> life(leaf->constAttributeArray("life"));
        const AttributeHandle<int> id(leaf->constAttributeArray("id"));
        const AttributeHandle<int> type(leaf->constAttributeArray("type"));
        for (auto i = leaf->beginIndexOn(); i; ++i) {
            const openvdb::Vec3d p = grid.indexToWorld(position.get(*i) + i.getCoord().asVec3d());
            const openvdb::Vec3f v = velocity.get(*i);
            VdbPoint state;
            state.id = static_cast<std::uint32_t>(id.get(*i));
            state.position = glm::vec3(glm::dvec3(p.x(), p.y(), p.z()));
            state.velocity = {v.x(), v.y(), v.z()};
            state.age = age.get(*i);
            state.lifetime = life.get(*i);
            state.type = static_cast<std::uint32_t>(type.get(*i));
            out[state.id] = state;
        }
    }
    return out;
}

TEST(VdbPoints, ReadersFindEachParticle) {
    const std::vector<VdbPoint> particles = someParticles(5000);
    const auto grid = gridOf(required(encodeVdbPoints(particles)));
    ASSERT_NE(grid, nullptr);
    EXPECT_EQ(grid->getName(), "particles");
    EXPECT_EQ(openvdb::points::pointCount(grid->tree()), particles.size());
    const auto found = particlesOf(*grid);
    ASSERT_EQ(found.size(), particles.size());
    for (const VdbPoint& particle : particles) {
        const VdbPoint& read = found.at(particle.id);
        EXPECT_LT(glm::distance(read.position, particle.position), 2e-6F);
        EXPECT_EQ(read.velocity, particle.velocity);
        EXPECT_EQ(read.age, particle.age);
        EXPECT_EQ(read.lifetime, particle.lifetime);
        EXPECT_EQ(read.type, particle.type);
    }
}

TEST(VdbPoints, BytesDoNotDependOnOrder) {
    std::vector<VdbPoint> particles = someParticles(2000);
    const auto bytes = required(encodeVdbPoints(particles));
    std::reverse(particles.begin(), particles.end());
    EXPECT_EQ(bytes, *encodeVdbPoints(particles));
    particles[3].age += 1.0F;
    EXPECT_NE(bytes, *encodeVdbPoints(particles));
}

TEST(VdbPoints, HandlesNoParticlesOneAndFarPositions) {
    EXPECT_EQ(openvdb::points::pointCount(gridOf(required(encodeVdbPoints({})))->tree()), 0U);
    EXPECT_EQ(particlesOf(*gridOf(required(encodeVdbPoints(someParticles(1))))).size(), 1U);
    const std::vector<VdbPoint> far = someParticles(500, 1e9F);
    const auto found = particlesOf(*gridOf(*encodeVdbPoints(far)));
    ASSERT_EQ(found.size(), far.size());
    for (const VdbPoint& particle : far) {
        EXPECT_LT(glm::distance(found.at(particle.id).position, particle.position), 100.0F);
    }
}

TEST(VdbPoints, NonFinitePositionsAreRejected) {
    std::vector<VdbPoint> particles = someParticles(3);
    particles[1].position.y = std::numeric_limits<float>::quiet_NaN();
    expectError(encodeVdbPoints(particles), ErrorCode::kFailure, "particle 4");
}

}  // namespace
}  // namespace relief
