// SPDX-License-Identifier: Apache-2.0
#include "bake/images/slice.h"

#include <cmath>

#include "tests/bake/images/exr_file.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

Collider sampleCollider() {
    return bakeSpecs(makeTorusMesh(1.0, 0.3, 60, 30),
                     {"front-back:dir=-z", "fixed8:dir=-x,box=0/-1/-1/2/1/1", "cube"}, 48);
}

TEST(Slice, ContainsTheFieldAtItsPoints) {
    const Collider collider = sampleCollider();
    for (int axis = 0; axis < 3; ++axis) {
        const Slice slice = required(evaluateSlice(collider, {.axis = axis, .at = 0.125F, .size = 90}));
        EXPECT_EQ(std::max(slice.width, slice.height), 90U);
        int inside = 0;
        for (std::uint32_t y = 0; y < slice.height; ++y) {
            for (std::uint32_t x = 0; x < slice.width; ++x) {
                const glm::vec3 p = slice.point(x, y);
                ASSERT_EQ(p[axis], 0.125F);
                const FieldSample expected = evaluate(collider, p);
                const FieldSample& sample = slice.sample(x, y);
                ASSERT_EQ(sample.map, expected.map);
                ASSERT_EQ(sample.distance, expected.distance);
                ASSERT_EQ(sample.normal, expected.normal);
                inside += sample.inside() ? 1 : 0;
            }
        }
        EXPECT_GT(inside, 100);
        // The area contains the bounds and is centred on them.
        const glm::vec3 first = slice.point(0, 0);
        const glm::vec3 last = slice.point(slice.width - 1, slice.height - 1);
        for (const int i : {slice.right, slice.up}) {
            EXPECT_LT(first[i], collider.bounds.min[i]);
            EXPECT_GT(last[i], collider.bounds.max[i]);
            EXPECT_NEAR(first[i] + last[i], collider.bounds.min[i] + collider.bounds.max[i], 1e-5);
        }
    }
    EXPECT_EQ(evaluateSlice(collider, {.axis = 2, .at = {}, .size = 16})->at, 0.0F);
}

// Reads the image with the OpenEXR library. The camera in the header maps each point to its pixel.
TEST(Slice, WritesDistancesAsExr) {
    Collider collider = sampleCollider();
    for (int axis = 0; axis < 3; ++axis) {
        const Slice slice = required(evaluateSlice(collider, {.axis = axis, .at = 0.125F, .size = 60}));
        ExrFile file(distanceImage(slice, collider));
        ASSERT_EQ(file.width, slice.width);
        ASSERT_EQ(file.height, slice.height);
        EXPECT_EQ(file.text("relief.plane"), std::string(1, axisName(axis)) + " = 0.125");
        const std::vector<float> distance = file.channel("distance");
        int inside = 0;
        int far = 0;
        int none = 0;
        for (std::uint32_t y = 0; y < slice.height; ++y) {
            for (std::uint32_t x = 0; x < slice.width; ++x) {
                const glm::vec3 at = file.project(slice.point(x, y));
                ASSERT_NEAR(at.x, static_cast<float>(x) + 0.5F, 1e-3);
                ASSERT_NEAR(at.y, static_cast<float>(slice.height - 1 - y) + 0.5F, 1e-3);
                ASSERT_NEAR(at.z, 0.0F, 1e-6);
                const FieldSample sample = evaluate(collider, slice.point(x, y));
                const float value = distance[std::size_t{slice.height - 1 - y} * slice.width + x];
                const bool known = sample.map >= 0 && sample.distance < kFarOutside;
                ASSERT_EQ(known, value == sample.distance);
                inside += sample.inside() && value < 0.0F ? 1 : 0;
                far += !known && sample.map >= 0 && value > 0.0F && std::isinf(value) ? 1 : 0;
                none += sample.map < 0 && std::isnan(value) ? 1 : 0;
            }
        }
        EXPECT_GT(inside, 50);
        EXPECT_GT(far, 50);
        EXPECT_EQ(none, 0);
    }
    collider.maps = {collider.maps[1]};  // covers only one half
    const Slice slice = required(evaluateSlice(collider, {.axis = 2, .at = {}, .size = 20}));
    EXPECT_TRUE(std::isnan(ExrFile(distanceImage(slice, collider)).channel("distance").front()));
}

TEST(Slice, RejectsInvalidSizes) {
    const Collider collider = sampleCollider();
    EXPECT_EQ(evaluateSlice(collider, {.axis = 0, .at = {}, .size = 1}).error().code, ErrorCode::kUsage);
    EXPECT_EQ(evaluateSlice(collider, {.axis = 0, .at = {}, .size = 8193}).error().code, ErrorCode::kLimit);
}

TEST(SliceFigure, DrawsAnyField) {
    // Only far outside, only abstentions, names of any length, huge and tiny coordinates.
    Collider collider = sampleCollider();
    EXPECT_TRUE(drawSlice(*evaluateSlice(collider, {.axis = 0, .at = 1e6F, .size = 20}),
                          {std::string(5000, 'n'), "m"}));
    collider.maps = {collider.maps[1]};
    EXPECT_TRUE(drawSlice(*evaluateSlice(collider, {.axis = 0, .at = 50.0F, .size = 20}), {"", ""}));
    for (const float scale : {1e-14F, 1e14F}) {
        const Collider scaled = bakeSpecs(makeBoxMesh({0, 0, 0}, glm::dvec3(scale)), {"cube"}, 8);
        EXPECT_TRUE(
            drawSlice(*evaluateSlice(scaled, {.axis = 2, .at = {}, .size = 20}), {"\xf0\x9f\x90\x87", "m"}));
    }
}

}  // namespace
}  // namespace relief::test
