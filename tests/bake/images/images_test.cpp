// SPDX-License-Identifier: Apache-2.0
// Images, read with the OpenEXR library: exported maps, slices, and views of closed-form shapes.
#include <gtest/gtest.h>
#include <cmath>
#include <glm/geometric.hpp>

#include "bake/images/axis_grid.h"
#include "bake/images/exr.h"
#include "bake/images/map_image.h"
#include "bake/images/slice.h"
#include "bake/images/view_image.h"
#include "bake/import/mesh_import.h"
#include "tests/bake/images/exr_file.h"
#include "tests/bake/meshes.h"
#include "tests/bake/threads.h"
#include "tests/formats/random_patches.h"

namespace relief::test {
namespace {

TEST(ExrExport, ContainsTheMapAndItsCamera) {
    const Collider collider = bakeSpecs(makeIcosphere({0.2, 0.1, -0.3}, 0.9, 3),
                                        {"front-back:dir=1/2/3,size=40x30", "cube:size=20", "float:size=16"});
    EXPECT_EQ(mapImageName(collider.maps[2], 2, 0), "map2_float.exr");
    EXPECT_EQ(mapImageName(collider.maps[1], 1, 5), "map1_cube_-z.exr");
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        const DepthMap& map = collider.maps[i];
        for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
            SCOPED_TRACE(mapImageName(map, i, face));
            const ExrImage image = mapImage(map, face, "m");
            ExrFile file(image);
            EXPECT_FALSE(Imf::hasCapDate(file.header()));
            EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
            ASSERT_TRUE(Imf::hasWorldToCamera(file.header()) && Imf::hasWorldToNDC(file.header()));
            EXPECT_EQ(file.text("relief.format"), mapFormatName(map.format));
            EXPECT_EQ(file.text("relief.compare"), compareName(map.compare));
            EXPECT_EQ(file.header().channels().findChannel("ZBack") != nullptr, i == 0);
            const Imath::M44f camera = Imf::worldToCamera(file.header());

            const std::vector<float> z = file.channel("Z");
            const std::vector<float> ny = file.channel("N.Y");
            int hits = 0;
            for (std::uint32_t y = 0; y < map.height; ++y) {
                for (std::uint32_t x = 0; x < map.width; ++x) {
                    const bool cube = map.projection() == Projection::kCube;
                    const std::size_t pixel = std::size_t{cube ? y : map.height - 1 - y} * map.width + x;
                    const Texel texel = decodeTexel(map.format, map.texelAt(face, x, y));
                    if (!texel.front) {
                        ASSERT_TRUE(std::isinf(z[pixel]) && z[pixel] > 0.0F);
                        ASSERT_EQ(ny[pixel], 0.0F);
                        continue;
                    }
                    ++hits;
                    ASSERT_EQ(ny[pixel], texel.front->normal.y);
                    // The surface point of this texel, by the definition of the map,
                    glm::dvec3 in_map;
                    const double s = (x + 0.5) / map.width;
                    const double t = (y + 0.5) / map.height;
                    if (cube) {
                        const glm::dvec3 d =
                            cubeDirection({face, static_cast<float>(s), static_cast<float>(t)});
                        in_map =
                            double{texel.front->depth} * d / std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
                    } else {
                        in_map = {s, t, texel.front->depth};
                    }
                    glm::dvec3 p(0.0);
                    for (int k = 0; k < 3; ++k) {
                        const glm::dvec4 row = map.object_to_map.row[k];
                        const double square = row.x * row.x + row.y * row.y + row.z * row.z;
                        p += (in_map[k] - row.w) / square * glm::dvec3(row);
                    }
                    // projects onto its own pixel, at distance Z from the camera.
                    const Imath::V3f world(static_cast<float>(p.x), static_cast<float>(p.y),
                                           static_cast<float>(p.z));
                    const glm::vec3 at = file.project(glm::vec3(p));
                    ASSERT_NEAR(at.x, static_cast<float>(pixel % map.width) + 0.5F, 2e-3);
                    ASSERT_NEAR(at.y, static_cast<float>(pixel / map.width) + 0.5F, 2e-3);
                    Imath::V3f in_camera;
                    camera.multVecMatrix(world, in_camera);
                    ASSERT_GT(in_camera.z, 0.0F) << "not in front of the camera";
                    ASSERT_NEAR(cube ? in_camera.length() : in_camera.z, z[pixel], 1e-4);
                }
            }
            EXPECT_GT(hits, 50);
        }
    }
}

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

TEST(Errors, PlaneContainsTheNormalAndSamplesSurroundThePlace) {
    const VerdictSlice wall = verdictSlice({1.0F, 2.0F, 3.0F}, {0.6F, 0.8F, 0.0F}, 4.0);
    EXPECT_EQ(wall.axis, 2);
    EXPECT_EQ(verdictSlice({}, {0.0F, 0.6F, 0.8F}, 1.0).axis, 0);
    EXPECT_EQ(verdictSlice({}, {0.6F, 0.0F, -0.8F}, 1.0).axis, 1);
    EXPECT_EQ(verdictSlice({}, {0.0F, 1.0F, 0.0F}, 1.0).axis, 2);
    const double half = 2.0 * (1.0 - 1.0 / wall.size);
    const glm::dvec3 low = wall.point(0, 0);
    const glm::dvec3 high = wall.point(wall.size - 1, wall.size - 1);
    EXPECT_NEAR(low.x, 1.0 - half, 1e-12);
    EXPECT_NEAR(high.y, 2.0 + half, 1e-12);
    EXPECT_EQ(low.z, 3.0);
}

TEST(Errors, EveryVerdictHasAColorAndPicturesAreDeterministic) {
    VerdictSlice slice = verdictSlice({}, {0.0F, 1.0F, 0.0F}, 1.0);
    const auto picture = [&] { return *drawVerdicts(slice, "m"); };
    const std::vector<std::byte> outside = picture();
    EXPECT_EQ(outside, picture());
    std::vector<std::vector<std::byte>> pictures{outside};
    for (const SideVerdict verdict :
         {SideVerdict::kInside, SideVerdict::kFalseInside, SideVerdict::kFalseOutside}) {
        for (std::size_t i = 0; i < 25; ++i) {  // the outline of the inside is the contour
            slice.verdicts[(50 + i / 5) * slice.size + 50 + i % 5] = verdict;
        }
        const std::vector<std::byte> drawn = picture();
        for (const std::vector<std::byte>& other : pictures) {
            EXPECT_NE(drawn, other);
        }
        pictures.push_back(drawn);
    }
}

/// A view, and the object-space point of each pixel on the near face of the bounds.
struct SeenImage {
    SeenImage(const Collider& collider, int view, std::uint32_t size)
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
        const SeenImage image(box, view, 40);
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
        const SeenImage image(ball, view, 64);
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
            const SeenImage view(collider, 2 * axis, 48);
            const SeenImage opposite(collider, 2 * axis + 1, 48);
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
        const SeenImage image(box, 0, 16);
        EXPECT_EQ(image.grid.height, 2U);
        EXPECT_EQ(image.grid.width, 16U);
        const SeenImage above(box, 2, 16);
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
        const SeenImage image(ridge, 0, size.x > 0.0F ? 32 : 2);
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
