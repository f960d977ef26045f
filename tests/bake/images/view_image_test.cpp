// SPDX-License-Identifier: Apache-2.0
// Views of patches, read with the OpenEXR library: closed-form shapes, and a mesh from opposite sides.
#include "bake/images/view_image.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "bake/images/axis_grid.h"
#include "bake/import/mesh_import.h"
#include "tests/bake/images/exr_file.h"
#include "tests/bake/meshes.h"
#include "tests/bake/threads.h"
#include "tests/formats/random_patches.h"

namespace relief::test {
namespace {

/// A view, and the object-space point of each pixel on the near face of the bounds.
struct View {
    View(const Collider& collider, int view, std::uint32_t size)
        : file(required(viewImage(collider, view, size))),
          grid(required(gridAcross(collider.bounds, view, size, 0.0))),
          front(file.channel("depth.front")),
          back(file.channel("depth.back")),
          normal{file.channel("normal.X"), file.channel("normal.Y"), file.channel("normal.Z")},
          near(grid.sign() > 0.0 ? collider.bounds.min[grid.axis()] : collider.bounds.max[grid.axis()]) {
        EXPECT_EQ(file.width, grid.width);
        EXPECT_EQ(file.height, grid.height);
        EXPECT_EQ(std::max(grid.width, grid.height), size);
    }
    /// Calls use(point, pixel).
    template <class Use>
    void forEach(const Use& use) const {
        for (std::uint32_t y = 0; y < grid.height; ++y) {
            for (std::uint32_t x = 0; x < grid.width; ++x) {
                const glm::vec3 p = grid.point(x, y, near);
                const std::size_t pixel = grid.pixel(x, y);
                // The camera in the header must agree.
                const glm::vec3 seen = file.project(p);
                ASSERT_NEAR(seen.x, static_cast<float>(pixel % grid.width) + 0.5F, 1e-3);
                ASSERT_NEAR(seen.y, static_cast<float>(pixel / grid.width) + 0.5F, 1e-3);
                ASSERT_NEAR(seen.z, 0.0F, 1e-5);
                use(p, pixel);
            }
        }
    }
    [[nodiscard]] glm::vec3 normalAt(std::size_t pixel) const {
        return {normal[0][pixel], normal[1][pixel], normal[2][pixel]};
    }
    [[nodiscard]] glm::vec3 hit(glm::vec3 p, float depth) const {
        p[grid.axis()] += static_cast<float>(grid.sign()) * depth;
        return p;
    }
    [[nodiscard]] bool empty(std::size_t pixel) const {
        return std::isinf(front[pixel]) && front[pixel] > 0.0F && std::isinf(back[pixel]) &&
               back[pixel] > 0.0F && normalAt(pixel) == glm::vec3(0.0F);
    }

    ExrFile file;
    AxisGrid grid;
    std::vector<float> front;
    std::vector<float> back;
    std::vector<float> normal[3];
    float near;
};

TEST(ViewImage, ShowsABox) {
    const Collider box = bakeSpecs(makeBoxMesh({0.1, 0.2, -0.3}, {0.5, 0.3, 0.2}), {"patches:budget=8kB"});
    const float texel = finestTexel(box);
    for (int view = 0; view < 6; ++view) {
        SCOPED_TRACE(viewImageName(view));
        const View image(box, view, 40);
        const int axis = image.grid.axis();
        const float extent = box.bounds.size()[axis];
        int flat = 0;
        image.forEach([&](const glm::vec3&, std::size_t pixel) {
            ASSERT_NEAR(image.front[pixel], 0.0F, texel);
            ASSERT_NEAR(image.back[pixel], extent, texel);
            flat += std::abs(image.normalAt(pixel)[axis] + image.grid.sign()) < 0.01 ? 1 : 0;
        });
        EXPECT_GT(flat, 0.85 * image.grid.width * image.grid.height) << "patches round edges";
        EXPECT_EQ(image.file.text("relief.direction"), kDirectionNames[static_cast<std::size_t>(view)]);
        EXPECT_EQ(image.file.text("relief.bounds_min"), "-0.4 -0.1 -0.5");
    }
    EXPECT_EQ(viewImageName(3), "view_-y.exr");
}

// The field has errors below a texel, so errors along the ray are below a texel over the cosine.
TEST(ViewImage, ShowsABall) {
    const glm::dvec3 center(0.2, 0.1, -0.3);
    constexpr double kRadius = 0.9;
    const Collider ball = bakeSpecs(makeIcosphere(center, kRadius, 5), {"patches:budget=60kB"});
    const double texel = finestTexel(ball);
    for (int view = 0; view < 6; ++view) {
        SCOPED_TRACE(viewImageName(view));
        const View image(ball, view, 64);
        int hits = 0;
        image.forEach([&](const glm::vec3& p, std::size_t pixel) {
            glm::dvec3 beside = glm::dvec3(p) - center;
            const double before = -image.grid.sign() * beside[image.grid.axis()];
            beside[image.grid.axis()] = 0.0;
            const double r = glm::length(beside);
            if (r > kRadius + texel) {
                ASSERT_TRUE(image.empty(pixel));
                return;
            }
            if (r > 0.98 * kRadius) {
                return;
            }
            ++hits;
            const double half = std::sqrt(kRadius * kRadius - r * r);
            const double tolerance = texel * kRadius / half;
            ASSERT_NEAR(image.front[pixel], before - half, tolerance);
            ASSERT_NEAR(image.back[pixel], before + half, tolerance);
            const glm::dvec3 outwards = glm::normalize(glm::dvec3(image.hit(p, image.front[pixel])) - center);
            ASSERT_GT(glm::dot(outwards, glm::dvec3(image.normalAt(pixel))), 0.98);
        });
        EXPECT_GT(hits, 64 * 64 * 0.7);
    }
}

// Both ends lie on the surface of the field, and all points outside them are outside. Results do not depend on threads.
TEST(ViewImage, ShowsTheFieldFromOppositeSides) {
    const TriangleMesh bunny = required(importMesh("/usr/share/glmark2/models/bunny.obj"));
    for (const std::vector<std::string>& specs :
         {std::vector<std::string>{"patches:budget=40kB"},
          {"patches:budget=20kB", "front-back:dir=-y,size=32,decode=plane"}}) {
        const Collider collider = bakeSpecs(bunny, specs);
        const float longest = collider.bounds.longestSide();
        for (int axis = 0; axis < 3; ++axis) {
            SCOPED_TRACE(axis);
            const View view(collider, 2 * axis, 48);
            const View opposite(collider, 2 * axis + 1, 48);
            const float extent = collider.bounds.size()[axis];
            int hits = 0;
            int differ = 0;
            view.forEach([&](const glm::vec3& p, std::size_t pixel) {
                const glm::vec3 there = opposite.file.project(p);
                const std::size_t other = static_cast<std::size_t>(there.y) * opposite.grid.width +
                                          static_cast<std::size_t>(there.x);
                if (view.empty(pixel) || opposite.empty(other)) {
                    differ += view.empty(pixel) != opposite.empty(other) ? 1 : 0;
                    return;
                }
                ++hits;
                ASSERT_NEAR(view.front[pixel], extent - opposite.back[other], 1e-5F * longest);
                ASSERT_NEAR(view.back[pixel], extent - opposite.front[other], 1e-5F * longest);
                ASSERT_LE(view.front[pixel], view.back[pixel]);
                const glm::vec3 at = view.hit(p, view.front[pixel]);
                EXPECT_TRUE(
                    evaluateInside(collider, view.hit(p, view.front[pixel] + 1e-5F * longest)).inside ||
                    evaluateInside(collider, at).inside);
                for (int i = 1; i <= 32; ++i) {
                    const float before = view.front[pixel] * (1.0F - static_cast<float>(i) / 32.0F);
                    if (before < view.front[pixel] - 1e-5F * longest) {
                        ASSERT_GT(evaluate(collider, view.hit(p, before)).distance,
                                  -finestTexel(collider) / 8.0F)
                            << "missed a wall that is not thin";
                    }
                }
            });
            EXPECT_GT(hits, 48 * 48 / 3);
            EXPECT_LE(differ, 2);  // rays that graze the surface
        }
        const auto bytes = [&] { return required(encodeExr(required(viewImage(collider, 2, 40)))); };
        EXPECT_TRUE(onThreads(1, bytes) == onThreads(3, bytes));
    }
}

TEST(ViewImage, ShowsTinyAndHugeColliders) {
    for (const double scale : {1e-12, 1e12}) {
        const Collider box =
            bakeSpecs(makeBoxMesh({0, 0, 0}, scale * glm::dvec3(1.0, 0.01, 1.0)), {"patches:budget=4kB"});
        const View image(box, 0, 16);
        EXPECT_EQ(image.grid.height, 2U);
        EXPECT_EQ(image.grid.width, 16U);
        const View above(box, 2, 16);
        above.forEach([&](const glm::vec3&, std::size_t pixel) {
            ASSERT_NEAR(above.front[pixel], 0.0, 0.005 * scale);
            ASSERT_NEAR(above.back[pixel], 0.02 * scale, 0.005 * scale);
        });
    }
}

// One patch with a ridge along y at x = 0.5, as high as the cell, on a flat floor at z = 0.
TEST(ViewImage, ShowsARidgeWithinAPatch) {
    PatchHeights heights;
    heights.side = 5;
    heights.scale = 12 << 4;
    for (std::size_t i = 2; i < 25; i += 5) {
        heights.codes[i] = 255;
    }
    Collider ridge;
    ridge.maps = {patchesOf({{1, 1, 1}, 0}, {PatchRecord::patch({0, 2, 0}, false, heights, 2),
                                             heights.texel(0), heights.texel(1), heights.texel(2)})};
    ridge.maps[0].encloses = ridge.maps[0].empty_is_outside = true;
    // Point-sized bounds limit neither the field nor the ray steps. Half of the rays miss the tree.
    for (const glm::vec3& size : {glm::vec3(1.0F), glm::vec3(0.0F)}) {
        ridge.bounds = {glm::vec3(0.0F), size};
        const View image(ridge, 0, size.x > 0.0F ? 32 : 2);
        image.forEach([&](const glm::vec3& p, std::size_t pixel) {
            if (p.y < 0.0F || p.z < 0.0F) {
                ASSERT_TRUE(image.empty(pixel));
            } else if (p.z < 0.95F) {
                ASSERT_NEAR(image.front[pixel], 0.25F + 0.25F * p.z, 1e-3);
                ASSERT_NEAR(image.back[pixel], 0.75F - 0.25F * p.z, 1e-3);
            }
        });
    }
    for (int i = 0; i < 3; ++i) {
        glm::vec4& row = ridge.maps[0].object_to_map.row[i];
        row = glm::vec4(2e-38F * glm::vec3(row), -9.0F);
    }
    const Result<ExrImage> refused = viewImage(ridge, 0, 2);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidInput);
}

}  // namespace
}  // namespace relief::test
