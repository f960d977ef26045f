// SPDX-License-Identifier: Apache-2.0
// Exported maps, read with the OpenEXR library.
#include "bake/images/exr.h"

#include <cmath>

#include "bake/images/map_image.h"
#include "tests/bake/images/exr_file.h"
#include "tests/bake/meshes.h"

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

}  // namespace
}  // namespace relief::test
