// SPDX-License-Identifier: Apache-2.0
#include "bake/world/coarse_collider.h"

#include <glm/geometric.hpp>

#include "bake/pipeline/bake.h"
#include "tests/bake/meshes.h"
#include "tests/bake/points.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

bool contains(const Bounds& outer, const Bounds& inner) {
    return glm::all(glm::lessThanEqual(outer.min, inner.min)) &&
           glm::all(glm::greaterThanEqual(outer.max, inner.max));
}

TEST(CoarseCollider, IsTheSameShapeInASixteenthOfTheBytes) {
    MersenneRandom random(seedFrom(41));
    for (const double radius : {0.5, 30.0}) {
        const glm::dvec3 center(3.0 * random.uniform(), 20.0, -7.0);
        const TriangleMesh mesh = makeIcosphere(center, radius, 5);
        for (const std::uint64_t budget : {150'000U, 400'000U}) {
            BakeRequest request;
            request.budget = budget;
            request.no_check = true;
            const BakeResult fine = required(bake(request, {}, mesh));
            ASSERT_TRUE(hasCoarse(fine.baked.collider));
            const FineCollider of = FineCollider::of(fine.baked.collider);
            const auto by_mesh = [&](const BakeRequest& other) { return bake(other, {}, mesh); };
            const Collider coarse = required(bakeCoarse(request, of, by_mesh));
            EXPECT_LE(16 * coarse.texelBytes(), fine.baked.collider.texelBytes());
            EXPECT_TRUE(contains(insideBox(coarse).value(), insideBox(fine.baked.collider).value()));
            EXPECT_EQ(coarse.bounds, fine.baked.collider.bounds);
            EXPECT_EQ(required(bakeCoarse(request, of, by_mesh)), coarse);
            // About nine thousand bytes leave slivers of a ball without patches, up to a fiftieth of the radius thick.
            int known = 0;
            int wrong = 0;
            for (int i = 0; i < 4000; ++i) {
                const glm::dvec3 p = center + 1.2 * radius * inCube(random);
                const double away = glm::distance(p, center) - radius;
                if (std::abs(away) > 0.01 * radius) {
                    ++known;
                    const bool right = evaluate(coarse, glm::vec3(p)).inside() == (away < 0.0);
                    wrong += right ? 0 : 1;
                    ASSERT_TRUE(right || std::abs(away) < 0.02 * radius) << away / radius;
                }
            }
            EXPECT_LE(wrong, 4);
            EXPECT_GT(known, 3500);
        }
    }
}

TEST(CoarseCollider, SmallCollidersAndNamedMapsHaveNone) {
    const TriangleMesh mesh = makeIcosphere({0.0, 0.0, 0.0}, 1.0, 3);
    BakeRequest request;
    request.budget = 60'000;
    EXPECT_FALSE(hasCoarse(bake(request, {}, mesh).value().baked.collider));
    request.budget.reset();
    request.map = {"front-back:dir=-x,size=256"};
    EXPECT_FALSE(hasCoarse(bake(request, {}, mesh).value().baked.collider));
}

}  // namespace
}  // namespace relief::test
